#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gravure/core/file_output.hpp"
#include "gravure/formats/contours.hpp"
#include "gravure/formats/freeform_job.hpp"
#include "gravure/formats/job_file.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/formats/zones_job.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

struct InitArguments {
  std::string mode;
  std::string folder = ".";
};

const std::map<std::string, Mode> kModes = {{"rotary", Mode::rotary},
                                            {"helical", Mode::helical},
                                            {"flat", Mode::flat},
                                            {"freeform", Mode::freeform},
                                            {"zones", Mode::zones}};

/// A diamond lattice that closes round the circumference; the second layer keeps only its crossings.
std::vector<std::byte> starter_picture(int layer, int pixels, int lines) {
  constexpr int kCell = 16;  // pixels and lines; divides both sides
  static_assert(kStarterPixels % kCell == 0 && kStarterLines % kCell == 0 && kStarterPixels % 8 == 0);
  static_assert(kStarterTexturePixels % kCell == 0 && kStarterTextureLines % kCell == 0);
  std::vector<std::byte> bits(static_cast<std::size_t>(pixels / 8) * static_cast<std::size_t>(lines));
  for (int y = 0; y < lines; ++y) {
    for (int x = 0; x < pixels; ++x) {
      const bool rising = (x + y) % kCell < 4;
      const bool falling = (x - y + lines) % kCell < 4;
      if (layer == 0 ? rising || falling : rising && falling) {
        const int at = y * (pixels / 8) + x / 8;
        bits[static_cast<std::size_t>(at)] |= static_cast<std::byte>(0x80U >> (x % 8));
      }
    }
  }
  return bits;
}

Result<void> write_picture(const std::string& path, int layer, int pixels, int lines,
                           std::vector<std::string>& written) {
  BilevelTiffPage page;
  page.width = pixels;
  page.height = lines;
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(path, page));
  GRAVURE_CHECK(writer.append_rows(starter_picture(layer, pixels, lines)));
  GRAVURE_CHECK(writer.commit());
  written.push_back(path);
  return {};
}

/// Pictures or contours into `inputs`, the job that names them beside it.
Result<void> write_starter(Mode mode, const fs::path& job, const fs::path& inputs, std::vector<std::string>& written) {
  const bool in_folder = mode != Mode::freeform && mode != Mode::zones;
  std::error_code failed;
  fs::create_directories(in_folder ? inputs : job.parent_path(), failed);
  if (failed) {
    return Error{ErrorCode::io, inputs.string() + ": cannot make the folder: " + failed.message()};
  }
  if (mode == Mode::freeform) {
    GRAVURE_CHECK(write_picture(inputs.string(), 0, kStarterTexturePixels, kStarterTextureLines, written));
  }
  if (mode == Mode::zones) {
    GRAVURE_CHECK(write_file(inputs.string(), formats::contours_to_json(starter_contours())));
    written.push_back(inputs.string());
  }
  for (int layer = 0; in_folder && layer < kStarterLayers; ++layer) {
    if (cancel_token().cancelled()) {
      return Error{ErrorCode::cancelled, "stopped before the job was complete; nothing was written"};
    }
    GRAVURE_CHECK(write_picture((inputs / fmt::format("layer_{:03}.tif", layer)).string(), layer, kStarterPixels,
                                kStarterLines, written));
  }
  GRAVURE_CHECK(write_file(job.string(), mode == Mode::freeform ? freeform_starter_job()
                                         : mode == Mode::zones  ? starter_zones_job()
                                                                : starter_job(mode)));
  written.insert(written.begin(), job.string());
  return {};
}

const char* starter_inputs(Mode mode) {
  return mode == Mode::freeform ? "texture.tif" : mode == Mode::zones ? "contours.json" : "layers";
}

Result<int> run_init(const InitArguments& options, const Command& command) {
  const fs::path job = fs::path(options.folder) / "job.toml";
  const Mode mode = kModes.at(options.mode);
  const fs::path inputs = fs::path(options.folder) / starter_inputs(mode);
  std::error_code failed;
  for (const fs::path& taken : {job, inputs}) {
    if (fs::exists(fs::symlink_status(taken, failed))) {  // also a link to nowhere
      return Error{ErrorCode::bad_argument, taken.string() + ": is there already; give another folder"};
    }
  }
  cancel_token();  // before there is a folder: from here on Ctrl-C takes it away again
  const bool made_folder = !fs::exists(fs::symlink_status(options.folder, failed));
  std::vector<std::string> written;
  if (Result<void> done = write_starter(mode, job, inputs, written); !done) {  // so that it can be tried again
    fs::remove_all(made_folder ? fs::path(options.folder) : inputs, failed);
    return done.error();
  }
  if (command.json) {
    print_json({{"written", written}});
  } else {
    for (const std::string& path : written) {
      print(path + "\n");
    }
    print(mode == Mode::zones ? fmt::format("next: gravure zones compile {} -o {}\n", job.string(),
                                            fs::path(job).replace_extension(".grv").string())
                              : fmt::format("next: gravure verify {}\n", job.string()));
  }
  return kDone;
}

}  // namespace

void add_init(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "init", "Write a commented starter job that runs as it is");
  const auto options = std::make_shared<InitArguments>();
  verb->add_option("--mode", options->mode, "Kind of job: rotary, helical, flat, freeform or zones")
      ->required()
      ->check(CLI::IsMember({"rotary", "helical", "flat", "freeform", "zones"}));
  verb->add_option("DIR", options->folder, "Folder to write to")->capture_default_str();
  set_run(*verb, command, options, run_init);
}

}  // namespace gravure::cli
