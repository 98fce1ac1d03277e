#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "shell/man_page.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

Result<int> write_pages(const TreeVerb& root, const std::string& folder, const Command& command) {
  std::vector<std::pair<std::string, std::string>> pages;
  for (const TreeVerb* verb : all_verbs(root)) {
    pages.emplace_back((fs::path(folder) / (verb->full_name("-") + ".1")).string(), man_page(*verb, GRAVURE_VERSION));
  }
  cancel_token();  // from here on all pages are written, whatever comes
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorCode::io, folder + ": cannot make the folder: " + failed.message()};
  }
  Json written = Json::array();
  for (const auto& [path, page] : pages) {
    GRAVURE_CHECK(write_file(path, page));
    written.push_back(path);
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
