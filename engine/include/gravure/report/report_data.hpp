#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gravure/core/job.hpp"
#include "gravure/core/program.hpp"
#include "gravure/report/layer_pictures.hpp"
#include "gravure/report/line_view.hpp"
#include "gravure/report/pulse_removal.hpp"
#include "gravure/twin/verify.hpp"

namespace gravure::report {

/// What is left of the surface after all layers, a value for each cell or pixel; depths in um, or pulses where the job
/// does not say what one removes.
struct Relief {
  bool in_um = false;
  std::vector<double> cells;  ///< mean over the area of a cell; empty where they were not asked for
  std::vector<double> seam;   ///< pixels about the seam, every crater of its own
  double deepest = 0;         ///< of the cells
  double mean = 0;            ///< over the whole picture
  double seam_deepest = 0;
};
enum class ReliefCells : std::uint8_t { kept, left_out };
Relief relief_of(const LayerPictures& pictures, const Plan& plan, const std::optional<PulseRemoval>& removal,
                 ReliefCells cells = ReliefCells::kept);

/// What is left of the surface in one cell after the other, as Relief::cells has it, without room for all of them.
class CellRelief {
 public:
  /// `pictures` must outlive it.
  CellRelief(const LayerPictures& pictures, const Plan& plan, const std::optional<PulseRemoval>& removal);
  double at(std::int64_t column, std::int64_t row) const;       ///< mean over the area of the cell
  double removed(std::int64_t column, std::int64_t row) const;  ///< times its pixels

 private:
  const LayerPictures& pictures_;
  std::vector<double> per_pulse_;     ///< um, or pulses, by the columns of cells along the line
  std::vector<std::int64_t> widths_;  ///< of cells, in pixels
  std::vector<std::int64_t> heights_;
};

/// The seam after a revolution, as the twin has it.
struct SeamPoint {
  std::int64_t revolution = 0;
  double drift_um = 0;
};

/// Seam error against revolution: some points of the twin's table, evenly, first and last among them, and the published
/// worst case of a counter of this increment, [B] eq. 10: 1 / (2 increment) of the way.
struct SeamSeries {
  std::vector<SeamPoint> points;
  double limit_um = 0;
  double bound_um_per_revolution = 0;
};
SeamSeries seam_series(const VerifyReport& verified, const Plan& plan, std::size_t most_points = 600);

/// Everything the report page shows.
struct ReportData {
  std::string generator;  ///< "gravure 0.1.0"
  std::string program;    ///< name of the file
  const ProgramHeader* header = nullptr;
  Job job;  ///< as the program carries it
  VerifyReport verified;
  SeamSeries seam;
  LayerPictures pictures;
  Relief relief;
  std::optional<PulseRemoval> removal;
  LineView line;
};

}  // namespace gravure::report
