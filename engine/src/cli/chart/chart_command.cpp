#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <regex>

#include "chart/charts.hpp"
#include "folder_output.hpp"
#include "gravure/core/file_output.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/job_file.hpp"
#include "job/job_loader.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

namespace fs = std::filesystem;

using MakeChart = Result<Chart> (*)(const ChartBase&, const ChartOptions&);

struct ChartArguments {
  std::string job;
  std::string folder;
  std::string field_mm;
  ChartOptions chart;
};

/// The job whose machine is taken: where it lies, and its text, with paths that are right from the chart's folder.
struct BaseJob {
  std::string path;
  std::string text;
  std::map<std::pair<std::string, std::string>, std::string> keys;
};

Result<BaseJob> read_base(const ChartArguments& options) {
  BaseJob base{"the starter job", starter_job(Mode::rotary), {}};
  if (!options.job.empty()) {
    base.path = options.job;
    GRAVURE_TRY(base.text, read_file(options.job, kMaxJobBytes));
  }
  GRAVURE_TRY(const Job job, parse_job(base.text, base.path));
  std::error_code ignored;
  const auto moved = [&](const std::string& file) {
    const fs::path there = fs::absolute(fs::path(options.job).parent_path() / file, ignored).lexically_normal();
    return "\"" + there.lexically_relative(fs::absolute(options.folder, ignored).lexically_normal()).string() + "\"";
  };
  if (job.machine.file) {
    base.keys[{"machine", "file"}] = moved(*job.machine.file);
  }
  if (job.scanner.field_grid) {
    base.keys[{"scanner", "field_grid"}] = moved(*job.scanner.field_grid);
  }
  if (!options.field_mm.empty()) {
    GRAVURE_TRY(const Rational field_mm, decimal_option("--field-mm", options.field_mm));
    base.keys[{"scanner", "field_mm"}] = to_decimal_string(field_mm);
  }
  return base;
}

std::string job_text(const BaseJob& base, ChartJob job) {
  job.keys.insert(base.keys.begin(), base.keys.end());  // the chart's own come first
  return chart_job_text(base.text, job);
}

/// Loads a job of the chart where it is written; errors name the place where it will be.
Result<LoadedJob> load_written(const FolderOutput& folder, const ChartArguments& options, const std::string& name,
                               bool need_images) {
  const ImageFiles files;
  Result<LoadedJob> loaded = load_job(folder.file(name).string(), files, need_images);
  if (loaded) {
    LoadedJob made = std::move(loaded).value();
    made.job.path = (fs::path(options.folder) / name).string();
    return made;
  }
  std::string message = loaded.error().message;
  const std::string here = folder.file("").string();
  for (std::size_t at = message.find(here); at != std::string::npos; at = message.find(here, at)) {
    message.replace(at, here.size(), options.folder + "/");
  }
  if (name == "base.toml") {  // it is not kept: its places say nothing
    message = std::regex_replace(message, std::regex("[^ \n]*base\\.toml:[0-9:]* "), "");
  }
  const std::string from = options.job.empty() ? "" : "made from " + options.job + ": ";
  return Error{loaded.error().code, from + message};
}

/// Machine and workpiece of the job, as a plan of one pixel a line.
Result<ChartBase> plan_base(const FolderOutput& folder, const ChartArguments& options, const BaseJob& base) {
  GRAVURE_TRY(const Job job, parse_job(base.text, base.path));
  const ChartJob bare{"chart",
                      job.mode == Mode::flat ? "flat" : "rotary",
                      "pixels_per_line = 1\nrevolutions = 1\nfires = \"white\"\n",
                      {}};
  GRAVURE_CHECK(write_file(folder.file("base.toml").string(), job_text(base, bare)));
  GRAVURE_TRY(const LoadedJob loaded, load_written(folder, options, "base.toml", false));
  std::error_code ignored;
  fs::remove(folder.file("base.toml"), ignored);
  constexpr double kUsual_mm = 30;
  return ChartBase{loaded.plan, loaded.plan.scanner ? to_double(loaded.plan.scanner->field_mm) : kUsual_mm};
}

Result<void> write_pictures(const FolderOutput& folder, const std::vector<ChartPages>& pictures) {
  for (const ChartPages& picture : pictures) {
    GRAVURE_TRY(BilevelTiffWriter writer,
                BilevelTiffWriter::create(folder.file(picture.name).string(), picture.pages.front().page(),
                                          static_cast<std::int64_t>(picture.pages.size())));
    for (std::size_t page = 0; page < picture.pages.size(); ++page) {
      if (page > 0) {
        GRAVURE_CHECK(writer.begin_page(picture.pages[page].page()));
      }
      GRAVURE_CHECK(picture.pages[page].append_to(writer));
    }
    GRAVURE_CHECK(writer.commit());
  }
  return {};
}

Result<int> run_chart(MakeChart make, const ChartArguments& options, const Command& command) {
  cancel_token();  // before there is a folder: from here on Ctrl-C takes it away again
  GRAVURE_TRY(const BaseJob base, read_base(options));
  GRAVURE_TRY(FolderOutput folder, FolderOutput::create(options.folder));
  GRAVURE_TRY(const ChartBase planned, plan_base(folder, options, base));
  ChartOptions wanted = options.chart;
  wanted.speeds.insert(wanted.speeds.begin(), 100);  // job.toml
  wanted.speeds.erase(std::unique(wanted.speeds.begin(), wanted.speeds.end()), wanted.speeds.end());
  GRAVURE_TRY(const Chart chart, make(planned, wanted));
  std::error_code failed;
  fs::create_directories(folder.file("layers"), failed);
  GRAVURE_CHECK(write_pictures(folder, chart.pictures));
  std::vector<std::string> written;
  for (const ChartJobFile& job : chart.jobs) {
    GRAVURE_CHECK(write_file(folder.file(job.name).string(), job_text(base, job.job)));
    GRAVURE_TRY(const LoadedJob loaded, load_written(folder, options, job.name, true));
    if (&job == &chart.jobs.front()) {
      warn_of(loaded);
    }
    written.push_back((fs::path(options.folder) / job.name).string());
  }
  for (const ChartFile& text : chart.texts) {
    GRAVURE_CHECK(write_file(folder.file(text.name).string(), text.text));
    written.push_back((fs::path(options.folder) / text.name).string());
  }
  for (const ChartPages& picture : chart.pictures) {
    written.push_back((fs::path(options.folder) / picture.name).string());
  }
  GRAVURE_CHECK(folder.commit());
  if (command.json) {
    print_json({{"written", written}});
    return kDone;
  }
  for (const std::string& path : written) {
    print(path + "\n");
  }
  print(fmt::format("next: read {}\n", (fs::path(options.folder) / "README.md").string()));
  return kDone;
}

std::shared_ptr<ChartArguments> add_chart(CLI::App& charts, Command& command, const std::string& name,
                                          const std::string& description, MakeChart make) {
  CLI::App* verb = add_verb(charts, command, name, description);
  auto options = std::make_shared<ChartArguments>();
  verb->add_option("-o,--output", options->folder, "Folder for the job and its images: new, or empty")->required();
  verb->add_option("--job", options->job,
                   "Job whose machine and workpiece are taken; without it those of the starter job");
  verb->callback([&command, options, make] {
    command.run = [&command, options, make] { return run_chart(make, *options, command); };
  });
  return options;
}

}  // namespace

void add_chart_command(CLI::App& app, Command& command) {
  CLI::App* charts = app.add_subcommand("chart", "Test jobs that are ready to cut, each with how to read it");
  charts->require_subcommand(1);

  const auto bidirectional =
      add_chart(*charts, command, "bidirectional",
                "How far lines running back lie beside the others, at several scan speeds", bidirectional_chart);
  CLI::App* verb = charts->get_subcommand("bidirectional");
  add_integer(*verb, "--offset-ticks", bidirectional->chart.offset_ticks, "Bidirectional offset to try, in FPGA ticks",
              -1'000'000'000, 1'000'000'000);
  verb->add_option(
          "--speed-percent", bidirectional->chart.speeds,
          "Scan speeds, each a job of its own, in percent of the job's; 100 is always there (default 100 50 25)")
      ->check(integer_from(1, 1000));

  const auto seam =
      add_chart(*charts, command, "seam", "Whether the seam closes, up to the last of N revolutions", seam_chart);
  charts->get_subcommand("seam")
      ->add_option("--revolutions", seam->chart.revolutions, "Revolutions of the job")
      ->check(integer_from(1, 2000))
      ->capture_default_str();

  const auto dots = add_chart(*charts, command, "dots",
                              "Dots and bars of 1 to 6 pixels, with 1, 2, 4 ... pulses on a place", dots_chart);
  charts->get_subcommand("dots")
      ->add_option("--pulses", dots->chart.most_pulses, "Most pulses on a place")
      ->check(integer_from(1, 1024))
      ->capture_default_str();

  const auto field =
      add_chart(*charts, command, "field", "Crosses all over the scan field, for `gravure calibrate`", field_chart);
  verb = charts->get_subcommand("field");
  verb->add_option("--field-mm", field->field_mm, "Side of the scan field (default: that of the job, or 30)");
  add_integer(*verb, "--columns", field->chart.columns, "Marks along U", 2, 33);
  add_integer(*verb, "--rows", field->chart.rows, "Marks along V", 2, 33);
}

}  // namespace gravure::cli
