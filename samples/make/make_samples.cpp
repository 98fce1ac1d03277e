#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "sample_sets.hpp"

namespace {

int usage() {
  std::fputs("usage: gravure_make_samples NAME FOLDER\nwrites the pictures of a sample into FOLDER. NAME is one of\n",
             stderr);
  for (const auto& set : gravure::samples::sample_sets()) {
    std::fprintf(stderr, "  %-14s %s\n", std::string(set.name).c_str(), std::string(set.about).c_str());
  }
  return 2;
}

int make(const std::string& name, const std::string& folder) {
  for (const auto& set : gravure::samples::sample_sets()) {
    if (set.name == name) {
      std::filesystem::create_directories(folder);
      const auto made = set.make(folder);
      if (!made) {
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
        return gravure::exit_status(made.error().code);
      }
      return 0;
    }
  }
  return usage();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return argc == 3 ? make(argv[1], argv[2]) : usage();
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 3;
  }
}
