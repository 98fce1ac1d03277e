#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/report_page.hpp"
#include "program/program_files.hpp"
#include "program/program_trajectory.hpp"
#include "report/report_command.hpp"
#include "report/report_writer.hpp"

namespace gravure::cli {
namespace {

struct ReportArguments {
  ReportRequest request;
  std::string images;
};

std::string verdict_text(const std::string& page, std::int64_t bytes, const char* without,
                         const std::vector<std::string>& violations) {
  std::string text = fmt::format("{}: {:.2f} MB{}\n", page, static_cast<double>(bytes) / 1e6, without);
  for (const std::string& violation : violations) {
    text += "violation: " + violation + "\n";
  }
  return text + (violations.empty() ? "within limits\n" : "NOT within limits\n");
}

/// Before the work of verifying: is there such a line?
Result<void> check_line(const ReportRequest& request, const ProgramHeader& header) {
  GRAVURE_CHECK(check_drawable(header, request.program));
  const Plan& plan = header.plan;
  GRAVURE_CHECK(check_index("--revolution", request.revolution, plan.job.revolutions));
  return check_index("--line", request.line.value_or(0), plan.rotary.lines_per_revolution);
}

/// The page of a program that follows a path.
Result<int> run_path_report(LineSource& program, const ReportArguments& options, const Command& command) {
  const ReportRequest& request = options.request;
  if (request.line || request.revolution != 0) {
    return Error{ErrorCode::bad_argument,
                 request.program +
                     ": follows a path: it has no revolutions and lines to show; leave --revolution and "
                     "--line out"};
  }
  GRAVURE_TRY(const WrittenPathReport written, write_path_report(request, program, options.images));
  const std::vector<std::string>& violations = written.verified.violations;
  if (command.json) {
    print_json({{"page", request.output},
                {"bytes", written.bytes},
                {"within_limits", violations.empty()},
                {"violations", violations},
                {"revolution", nullptr},
                {"line", nullptr},
                {"shown_layers", nullptr},
                {"view_3d", report_has_3d()}});
  } else {
    print(verdict_text(request.output, written.bytes, "", violations));
  }
  return violations.empty() ? kDone : kLimitViolated;
}

Result<int> run_report(const ReportArguments& options, const Command& command) {
  const ReportRequest& request = options.request;
  GRAVURE_TRY(GrvProgram program, GrvProgram::open(request.program, command.memory_bytes()));
  GRAVURE_CHECK(refuse_overwrite(request.output, inputs_of_program(request.program, program.header())));
  if (program.header().plan.path) {
    return run_path_report(*program.reader(), options, command);
  }
  GRAVURE_CHECK(check_line(request, program.header()));
  GRAVURE_TRY(VerifiedProgram verified,
              verify_program_file(std::move(program), request.program, options.images, command));
  const std::vector<std::string> violations = verified.report.violations;
  GRAVURE_TRY(const WrittenReport written, write_report(request, std::move(verified), command));
  if (command.json) {
    print_json({{"page", request.output},
                {"bytes", written.bytes},
                {"within_limits", violations.empty()},
                {"violations", violations},
                {"revolution", request.revolution},
                {"line", written.line},
                {"shown_layers", written.shown_layers},
                {"view_3d", written.view_3d}});
  } else {
    print(verdict_text(request.output, written.bytes,
                       written.view_3d ? "" : ", without the 3-D view (built without Node)", violations));
  }
  return violations.empty() ? kDone : kLimitViolated;
}

}  // namespace

void add_report(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "report", "Verify a program and write one page to look at before cutting");
  const auto options = std::make_shared<ReportArguments>();
  verb->add_option("PROGRAM", options->request.program, "Program file (.grv)")->required();
  verb->add_option("-o,--output", options->request.output, "HTML file to write")->required();
  verb->add_option("--images", options->images, "Folder with the images, where they are not at the job's paths");
  add_integer(*verb, "--revolution", options->request.revolution, "Revolution (pass) of the line whose timing is shown",
              0, kMostIndex);
  verb->add_option("--line", options->request.line, "That line; else the first of the revolution that fires")
      ->check(integer_from(0, kMostIndex));
  add_work_options(*verb, command);
  verb->callback([&command, options] {
    options->request.name = std::filesystem::path(options->request.program).filename().string();
    command.run = [&command, options] { return run_report(*options, command); };
  });
}

}  // namespace gravure::cli
