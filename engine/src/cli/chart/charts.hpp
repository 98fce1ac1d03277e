#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "chart/chart_job.hpp"
#include "chart/chart_picture.hpp"
#include "gravure/core/error.hpp"
#include "gravure/core/plan.hpp"

namespace gravure::cli {

struct ChartOptions {
  std::int64_t offset_ticks = 0;                     ///< bidirectional: the one that is tried
  std::vector<std::int64_t> speeds = {100, 50, 25};  ///< bidirectional: percent of the job's scan speed
  std::int64_t revolutions = 100;                    ///< seam
  std::int64_t most_pulses = 16;                     ///< dots
  std::int64_t columns = 9;                          ///< field: marks along U
  std::int64_t rows = 9;                             ///< field: marks along V
};

/// The machine and workpiece that a chart is made for.
struct ChartBase {
  Plan plan;  ///< of the job whose machine it is, for a picture of one pixel a line
  double field_mm = 0;
};

struct ChartFile {
  std::string name;
  std::string text;
};
struct ChartPages {
  std::string name;                 ///< "layers/dots.tif"
  std::vector<ChartPicture> pages;  ///< each with a layer
};
struct ChartJobFile {
  std::string name;  ///< "job.toml"
  ChartJob job;
};

/// All that a chart consists of.
struct Chart {
  std::vector<ChartPages> pictures;
  std::vector<ChartJobFile> jobs;
  std::vector<ChartFile> texts;
};

/// What to look at is in docs/charts/, a page for each. All fail with out_of_range where the chart does not fit on the
/// workpiece, naming what would.
Result<Chart> bidirectional_chart(const ChartBase& base, const ChartOptions& options);
Result<Chart> seam_chart(const ChartBase& base, const ChartOptions& options);
Result<Chart> dots_chart(const ChartBase& base, const ChartOptions& options);
Result<Chart> field_chart(const ChartBase& base, const ChartOptions& options);

}  // namespace gravure::cli
