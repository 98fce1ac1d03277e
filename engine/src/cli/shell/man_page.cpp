#include "shell/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace gravure::cli {
namespace {

/// `text` as roff shows it: no escapes, no hyphens that break, no line that is a request.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) {
      escaped += "\\&";
    }
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string value_of(const TreeOption& option) {
  if (option.choices.empty()) {
    return italic(option.value);
  }
  std::string words;
  for (const std::string& choice : option.choices) {
    words += (words.empty() ? "" : "|") + bold(choice);
  }
  return words;
}

std::string option_entry(const TreeOption& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "" : ", ") + (option.positional ? italic(name) : bold(name));
  }
  std::string entry = ".TP\n" + names;
  if (!option.positional && !option.value.empty()) {
    entry += " " + value_of(option);
  }
  entry += "\n" + roff(option.description) + ".";
  if (option.positional && !option.choices.empty()) {
    entry += " One of " + value_of(option) + ".";
  }
  if (!option.range.empty()) {
    entry += " From " + roff(option.range) + ".";
  }
  if (!option.fallback.empty()) {
    entry += " Default: " + roff(option.fallback) + ".";
  }
  if (option.required) {
    entry += " Required.";
  }
  return entry + (option.repeats ? " May be repeated.\n" : "\n");
}

std::string options_section(const TreeVerb& verb, bool positional, const std::string& heading) {
  std::string entries;
  for (const TreeOption& option : verb.options) {
    entries += option.positional == positional ? option_entry(option) : "";
  }
  return entries.empty() ? "" : ".SH " + heading + "\n" + entries;
}

std::string synopsis(const TreeVerb& verb) {
  std::string line = ".B " + roff(verb.full_name()) + "\n";
  if (!verb.verbs.empty()) {
    return line + italic("verb") + " [" + italic("options") + "]\n";
  }
  for (const TreeOption& option : verb.options) {
    if (!option.positional && option.required) {
      line += bold(option.names.back()) + " " + value_of(option) + "\n";
    }
  }
  line += "[" + italic("options") + "]\n";
  for (const TreeOption& option : verb.options) {
    if (option.positional) {
      line += (option.required ? italic(option.names[0]) : "[" + italic(option.names[0]) + "]") + "\n";
    }
  }
  return line;
}

std::string verbs_section(const TreeVerb& verb) {
  std::string text;
  for (const TreeVerb& below : verb.verbs) {
    text += ".TP\n.BR " + roff(below.full_name("-")) + " (1)\n" + roff(below.description) + ".\n";
  }
  return text.empty() ? "" : ".SH VERBS\n" + text;
}

std::string see_also(const TreeVerb& verb) {
  if (verb.path.empty()) {
    return "";
  }
  TreeVerb above = verb;
  above.path.pop_back();
  const bool deep = !above.path.empty();
  return ".SH SEE ALSO\n.BR gravure (1)" + (deep ? ",\n.BR " + roff(above.full_name("-")) + " (1)\n" : "\n");
}

/// "Exit status: 0 done ..., 1 ...": what --help ends with, as a section.
std::string exit_status(const std::string& footer) {
  const std::size_t colon = footer.find(": ");
  return colon == std::string::npos ? "" : ".SH EXIT STATUS\n" + roff(footer.substr(colon + 2)) + "\n";
}

}  // namespace

std::string man_page(const TreeVerb& verb, const std::string& version) {
  std::string title = verb.full_name("-");
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(".TH {} 1 \"\" \"gravure {}\" \"gravure manual\"\n", roff(title),
                     version) +  // undated: same bytes every day
         ".ad l\n.SH NAME\n" +
         roff(verb.full_name("-")) + " \\- " + roff(verb.description) + "\n.SH SYNOPSIS\n" + synopsis(verb) +
         ".SH DESCRIPTION\n" + roff(verb.description) + (verb.description.back() == '.' ? "\n" : ".\n") +
         verbs_section(verb) + options_section(verb, true, "ARGUMENTS") + options_section(verb, false, "OPTIONS") +
         exit_status(verb.footer) + see_also(verb);
}

}  // namespace gravure::cli
