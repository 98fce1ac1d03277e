#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string mode;
  std::string folder = ".";
};

const std::map<std::string, Mode> kModes = {{"rotary", Mode::rotary}, {"helical", Mode::helical}, {"flat", Mode::flat}};

/// A diamond lattice that closes round the circumference; the second layer keeps only its crossings.
std::vector<std::byte> starter_picture(int layer) {
  constexpr int kCell = 16;  // pixels and lines; divides both sides
  static_assert(kStarterPixels % kCell == 0 && kStarterLines % kCell == 0 && kStarterPixels % 8 == 0);
  std::vector<std::byte> bits(static_cast<std::size_t>(kStarterPixels / 8) * kStarterLines);
  for (int y = 0; y < kStarterLines; ++y) {
    for (int x = 0; x < kStarterPixels; ++x) {
      const bool rising = (x + y) % kCell < 4;
      const bool falling = (x - y + kStarterLines) % kCell < 4;
      if (layer == 0 ? rising || falling : rising && falling) {
        const int at = y * (kStarterPixels / 8) + x / 8;
        bits[static_cast<std::size_t>(at)] |= static_cast<std::byte>(0x80U >> (x % 8));
      }
    }
  }
  return bits;
}

Result<void> write_starter(Mode mode, const fs::path& job, const fs::path& layers, std::vector<std::string>& written) {
  std::error_code failed;
  fs::create_directories(layers, failed);
  if (failed) {
    return Error{ErrorCode::io, layers.string() + ": cannot make the folder: " + failed.message()};
  }
  for (int layer = 0; layer < kStarterLayers; ++layer) {
    if (cancel_token().cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the job was complete; nothing was written"};
    }
    const std::string path = (layers / fmt::format("layer_{:03}.tif", layer)).string();
    BilevelTiffPage page;
    page.width = kStarterPixels;
    page.height = kStarterLines;
    GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(path, page));
    GRAVURE_CHECK(writer.append_rows(starter_picture(layer)));
    GRAVURE_CHECK(writer.commit());
    written.push_back(path);
  }
  GRAVURE_CHECK(write_file(job.string(), starter_job(mode)));
  written.insert(written.begin(), job.string());
  return {};
}

Result<int> run(const Options& options, const Command& command) {
  const fs::path job = fs::path(options.folder) / "job.toml";
  const fs::path layers = fs::path(options.folder) / "layers";
  std::error_code failed;
  for (const fs::path& taken : {job, layers}) {
    if (fs::exists(fs::symlink_status(taken, failed))) {  // also a link to nowhere
      return Error{ErrorCode::bad_argument, taken.string() + ": is there already; give another folder"};
    }
  }
  cancel_token();  // before there is a folder: from here on Ctrl-C takes it away again
  const bool made_folder = !fs::exists(fs::symlink_status(options.folder, failed));
  std::vector<std::string> written;
  if (Result<void> done = write_starter(kModes.at(options.mode), job, layers, written);
      !done) {  // so that it can be tried again
    fs::remove_all(made_folder ? fs::path(options.folder) : layers, failed);
    return done.error();
  }
  if (command.json) {
    print_json({{"written", written}});
  } else {
    for (const std::string& path : written) {
      print(path + "\n");
    }
    print(fmt::format("next: gravure verify {}\n", job.string()));
  }
  return kDone;
}

}  // namespace

void add_init(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "init", "Write a commented starter job that runs as it is");
  const auto options = std::make_shared<Options>();
  verb->add_option("--mode", options->mode, "Kind of job: rotary, helical or flat")
      ->required()
      ->check(CLI::IsMember({"rotary", "helical", "flat"}));
  verb->add_option("DIR", options->folder, "Folder to write to")->capture_default_str();
  verb->callback([&command, options] { command.run = [&command, options] { return run(*options, command); }; });
}

}  // namespace gravure::cli
