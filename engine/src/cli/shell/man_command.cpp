#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "shell/man_page.hpp"
#include "text_output.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

Result<int> write_pages(const TreeVerb& root, const std::string& folder, const Command& command) {
  std::vector<TextFile> pages;
  for (const TreeVerb* verb : all_verbs(root)) {
    pages.push_back({(fs::path(folder) / (verb->full_name("-") + ".1")).string(), man_page(*verb, GRAVURE_VERSION)});
  }
  cancel_token();  // before there is a folder
  std::error_code failed;
  const bool made = fs::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorCode::io, folder + ": cannot make the folder: " + failed.message()};
  }
  if (const Result<void> all = write_texts(pages); !all) {
    if (made) {
      fs::remove(folder, failed);  // nothing is in it
    }
    return all.error();
  }
  Json written = Json::array();
  for (const TextFile& page : pages) {
    written.push_back(page.path);
  }
  if (command.json) {
    print_json({{"written", written}});
  } else {
    print(std::to_string(written.size()) + " pages in " + folder + "; man -l shows one\n");
  }
  return kDone;
}

}  // namespace

void add_man(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "man", "Manual pages, made from the same words as --help");
  const auto folder = std::make_shared<std::string>();
  verb->add_option("DIR", *folder, "Folder for gravure.1 and a page for each verb; without it gravure.1 is printed");
  verb->callback([&app, &command, folder] {
    command.run = [&app, &command, folder]() -> Result<int> {
      const TreeVerb root = describe_tree(app);
      if (!folder->empty()) {
        return write_pages(root, *folder, command);
      }
      const std::string page = man_page(root, GRAVURE_VERSION);
      if (command.json) {
        print_json({{"page", page}});
      } else {
        print(page);
      }
      return kDone;
    };
  });
}

}  // namespace gravure::cli
