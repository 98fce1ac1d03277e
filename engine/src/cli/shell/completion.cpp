#include "shell/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

// All three scripts find the verb in the same way: they put the words before the cursor together, "motion/profile",
// as long as that is a verb. So a file that is called like a verb is taken for none.

namespace gravure::cli {
namespace {

std::string key_of(const TreeVerb& verb) {
  std::string key;
  for (const std::string& part : verb.path) {
    key += (key.empty() ? "" : "/") + part;
  }
  return key;
}

/// The patterns "/init", "motion/profile": a verb, and the word that leads on from it.
std::string steps(const TreeVerb& root, const std::string& separator, const std::string& quote) {
  std::string joined;
  for (const TreeVerb* verb : all_verbs(root)) {
    if (!verb->path.empty()) {
      const std::string slash = verb->path.size() == 1 ? "/" : "";
      joined.append(joined.empty() ? "" : separator).append(quote).append(slash).append(key_of(*verb)).append(quote);
    }
  }
  return joined;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator = " ") {
  std::string all;
  for (const std::string& word : words) {
    all += (all.empty() ? "" : separator) + word;
  }
  return all;
}

std::string replaced(std::string text, char from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, 1, to);
  }
  return text;
}

/// What a description says before its first colon, semicolon or full stop: a line of a menu.
std::string short_description(const std::string& description) {
  const std::size_t end = std::min({description.find(": "), description.find("; "), description.find(". ")});
  return description.substr(0, end);
}

/// What may stand where no option does.
struct Positional {
  std::vector<std::string> words;  ///< verbs, or the words allowed
  bool files = false;
};

Positional positional_of(const TreeVerb& verb) {
  Positional positional;
  for (const TreeVerb& below : verb.verbs) {
    positional.words.push_back(below.name());
  }
  for (const TreeOption& option : verb.options) {
    if (option.positional) {
      positional.words.insert(positional.words.end(), option.choices.begin(), option.choices.end());
      positional.files = positional.files || option.takes_file();
    }
  }
  return positional;
}

/// The branches of "case VERB:OPTION in": what an option that takes a value is followed by.
std::string value_cases(const TreeVerb& root, std::string_view words, std::string_view files) {
  std::string cases;
  for (const TreeVerb* verb : all_verbs(root)) {
    for (const TreeOption& option : verb->options) {
      if (option.positional || option.value.empty()) {
        continue;
      }
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) {
        patterns.push_back(key_of(*verb) + ":" + name);
      }
      const std::string action = !option.choices.empty() ? fmt::format(fmt::runtime(words), joined(option.choices))
                                 : option.takes_file()   ? std::string(files)
                                                         : "";
      cases += fmt::format("    {}) {}{}return ;;\n", joined(patterns, "|"), action, action.empty() ? "" : "; ");
    }
  }
  return cases;
}

}  // namespace

std::string bash_completion(const TreeVerb& root) {
  std::string options;
  std::string places;
  for (const TreeVerb* verb : all_verbs(root)) {
    std::vector<std::string> names;
    for (const TreeOption& option : verb->options) {
      if (!option.positional) {
        names.insert(names.end(), option.names.begin(), option.names.end());
      }
    }
    options += fmt::format("      '{}') _gravure_words '{}' ;;\n", key_of(*verb), joined(names));
    const Positional positional = positional_of(*verb);
    if (!positional.words.empty()) {
      places += fmt::format("      '{}') _gravure_words '{}' ;;\n", key_of(*verb), joined(positional.words));
    } else if (positional.files) {
      places += fmt::format("      '{}') _gravure_files ;;\n", key_of(*verb));
    }
  }
  return "# bash completion for gravure, made by `gravure completion bash`\n"
         "_gravure_words() { mapfile -t COMPREPLY < <(compgen -W \"$1\" -- \"$cur\"); }\n"
         "_gravure_files() {\n"
         "  compopt -o filenames 2>/dev/null\n"
         "  mapfile -t COMPREPLY < <(compgen -f -- \"$cur\")\n"
         "}\n"
         "_gravure() {\n"
         "  local cur=\"${COMP_WORDS[COMP_CWORD]}\" prev=\"${COMP_WORDS[COMP_CWORD - 1]}\" verb=\"\" at\n"
         "  COMPREPLY=()\n"
         "  for ((at = 1; at < COMP_CWORD; at++)); do\n"
         "    case \"$verb/${COMP_WORDS[at]}\" in\n"
         "      " +
         steps(root, "|", "") +
         ")\n"
         "        verb=\"${verb:+$verb/}${COMP_WORDS[at]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$verb:$prev\" in\n" +
         value_cases(root, "_gravure_words '{}'", "_gravure_files") +
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    case \"$verb\" in\n" +
         options +
         "    esac\n"
         "  else\n"
         "    case \"$verb\" in\n" +
         places +
         "    esac\n"
         "  fi\n"
         "}\n"
         "complete -F _gravure gravure\n";
}

std::string zsh_completion(const TreeVerb& root) {
  const auto item = [](const std::string& name, const std::string& description) {
    return " '" + replaced(name + ":" + replaced(short_description(description), ':', "\\:"), '\'', "'\\''") + "'";
  };
  std::string options;
  std::string places;
  for (const TreeVerb* verb : all_verbs(root)) {
    std::string items;
    for (const TreeOption& option : verb->options) {
      for (const std::string& name : option.names) {
        items += option.positional ? "" : item(name, option.description);
      }
    }
    options += fmt::format("      '{}') items=({} ) ;;\n", key_of(*verb), items);
    const Positional positional = positional_of(*verb);
    if (!verb->verbs.empty()) {
      items.clear();
      for (const TreeVerb& below : verb->verbs) {
        items += item(below.name(), below.description);
      }
      places += fmt::format("      '{}') items=({} ); _describe 'verb' items ;;\n", key_of(*verb), items);
    } else if (!positional.words.empty()) {
      places += fmt::format("      '{}') compadd -- {} ;;\n", key_of(*verb), joined(positional.words));
    } else if (positional.files) {
      places += fmt::format("      '{}') _files ;;\n", key_of(*verb));
    }
  }
  return "#compdef gravure\n"
         "# zsh completion for gravure, made by `gravure completion zsh`\n"
         "_gravure() {\n"
         "  local verb=\"\" word\n"
         "  local -a items\n"
         "  for word in \"${(@)words[2,CURRENT-1]}\"; do\n"
         "    case \"$verb/$word\" in\n"
         "      " +
         steps(root, "|", "") +
         ")\n"
         "        verb=\"${verb:+$verb/}$word\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$verb:${words[CURRENT-1]}\" in\n" +
         value_cases(root, "compadd -- {}", "_files") +
         "  esac\n"
         "  if [[ ${words[CURRENT]} == -* ]]; then\n"
         "    case \"$verb\" in\n" +
         options +
         "    esac\n"
         "    _describe -o 'option' items\n"
         "  else\n"
         "    case \"$verb\" in\n" +
         places +
         "    esac\n"
         "  fi\n"
         "}\n"
         "if [[ ${funcstack[1]} == _gravure ]]; then _gravure; else compdef _gravure gravure; fi\n";
}

std::string fish_completion(const TreeVerb& root) {
  const auto quoted = [](const std::string& text) {
    return "'" + replaced(replaced(short_description(text), '\\', "\\\\"), '\'', "\\'") + "'";
  };
  std::string lines;
  for (const TreeVerb* verb : all_verbs(root)) {
    const std::string start = fmt::format("complete -c gravure -n '__gravure_verb \"{}\"'", key_of(*verb));
    for (const TreeVerb& below : verb->verbs) {
      lines += fmt::format("{} -a {} -d {}\n", start, below.name(), quoted(below.description));
    }
    for (const TreeOption& option : verb->options) {
      std::string line = start;
      if (!option.positional) {
        for (const std::string& name : option.names) {
          line += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
        }
        line += option.value.empty() ? "" : option.takes_file() ? " -r -F" : " -x";
      } else if (option.takes_file()) {
        line += " -F";
      }
      line += option.choices.empty() ? "" : " -a '" + joined(option.choices) + "'";
      lines += line + " -d " + quoted(option.description) + "\n";
    }
  }
  return "# fish completion for gravure, made by `gravure completion fish`\n"
         "function __gravure_verb\n"
         "  set -l verb ''\n"
         "  for word in (commandline -opc)[2..-1]\n"
         "    switch \"$verb/$word\"\n"
         "      case " +
         steps(root, " ", "'") +
         "\n"
         "        if test -n \"$verb\"\n"
         "          set verb \"$verb/$word\"\n"
         "        else\n"
         "          set verb $word\n"
         "        end\n"
         "    end\n"
         "  end\n"
         "  test \"$verb\" = \"$argv[1]\"\n"
         "end\n"
         "complete -c gravure -f\n" +
         lines;
}

}  // namespace gravure::cli
