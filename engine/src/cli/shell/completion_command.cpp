#include <memory>

#include "shell/completion.hpp"
#include "verb.hpp"

namespace gravure::cli {

void add_completion(CLI::App& app, Command& command) {
  CLI::App* verb =
      add_verb(app, command, "completion", "Completion script for a shell, made from the verbs themselves");
  const auto shell = std::make_shared<std::string>();
  verb->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  verb->callback([&app, &command, shell] {
    command.run = [&app, &command, shell]() -> Result<int> {
      const TreeVerb root = describe_tree(app);
      const std::string script = *shell == "bash"  ? bash_completion(root)
                                 : *shell == "zsh" ? zsh_completion(root)
                                                   : fish_completion(root);
      if (command.json) {
        print_json({{"shell", *shell}, {"script", script}});
      } else {
        print(script);
      }
      return kDone;
    };
  });
}

}  // namespace gravure::cli
