#include "error_model.hpp"

#include "figure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

namespace gravure {
namespace {

Interval operator+(const Interval& a, const Interval& b) noexcept {
  return {a.least + b.least, a.most + b.most};
}

Interval at(double value) noexcept {
  return {value, value};
}

Interval between(double a, double b) noexcept {
  return {std::min(a, b), std::max(a, b)};
}

Interval product(const Interval& a, const Interval& b) noexcept {
  const auto [least, most] = std::minmax({a.least * b.least, a.least * b.most, a.most * b.least, a.most * b.most});
  return {least, most};
}

bool is_set(std::span<const std::byte> bits, std::int64_t index) noexcept {
  return (std::to_integer<unsigned>(bits[static_cast<std::size_t>(index / 8)]) >> (7U - (index & 7))) & 1U;
}

/// With a lag that is not made up for, the first pulses of a helical line come while U still goes from one fraction of
/// a column to the next, by 10 x^3 - 15 x^4 + 6 x^5 of it at most, x the share of the turn that is left.
double shift_left_um(const scan::LineTrajectory& trajectory, double column_um) {
  const scan::LinePath& path = trajectory.path;
  const scan::LineTiming& timing = path.timing();
  const double lag_slots = to_double(path.geometry().machine.head.lag_us) * 1e-6 / timing.slot_s() -
                           static_cast<double>(trajectory.lag_ticks) / static_cast<double>(timing.ticks_per_slot);
  double most_um = 0;
  for (const scan::Direction here : {scan::Direction::forward, scan::Direction::reverse}) {
    const bool turned = timing.bidirectional && here == scan::Direction::forward;
    const scan::Direction before = turned ? scan::Direction::reverse : scan::Direction::forward;
    const double begin = path.marking(here).begin;
    const double turn = static_cast<double>(timing.slots) - path.marking(before).end + begin;
    // Between set-points the mirrors go straight: the one before counts.
    const double first = timing.pulse_at(here, timing.first_slot(here)) - lag_slots -
                         (lag_slots > 0 ? static_cast<double>(timing.slots_per_microvector) : 0);
    const double left = std::clamp((begin - first) / turn, 0.0, 1.0);
    most_um = std::max(most_um, column_um * std::min(1.0, 10 * left * left * left));
  }
  return most_um;
}

AxisTerms axis_terms(const TwinSettings& twin) {
  return {twin.drift, twin.ab_step, twin.servo.enabled, to_double(twin.servo.bandwidth_hz),
          to_double(twin.servo.damping)};
}

}  // namespace

void PulseSums::merge(const PulseSums& other) {
  pulses += other.pulses;
  squares_um2 += other.squares_um2;
  const auto order = [](const PulsePlace& place) { return std::tie(place.revolution, place.line, place.slot); };
  if (other.worst_um2 > worst_um2 || (other.worst_um2 == worst_um2 && order(other.worst) < order(worst))) {
    worst_um2 = other.worst_um2;
    worst = other.worst;
  }
}

/// What the pulses of a line have in common.
struct ErrorModel::Line {
  const LineErrors* errors = nullptr;
  bool reverse = false;
  std::int64_t first_slot = 0;
  std::int64_t first_tick = 0;            ///< of the first pulse
  std::optional<ShiftedSurface> surface;  ///< none: where the job has it
  double onwards_um = 0;                  ///< of a panel's line, by growth
  double first_column_um = 0;             ///< of pixel 0
  std::vector<double> rounded_off_um;     ///< helical: what rounding does to each order to U
  AxisMotion::Start axis_start;
  double axis_drift_um = 0;  ///< at the first pulse
  AxisMotion::Start carriage_start;
  double carriage_drift_um = 0;
};

Result<ErrorModel> ErrorModel::make(const Plan& plan, const scan::LineTrajectory* trajectory, const TwinSettings& twin,
                                    const scan::LineTrajectory* back) {
  ErrorModel model(plan);
  GRAVURE_TRY(model.axis_, AxisMotion::make(plan, axis_terms(twin)));
  if (plan.carriage) {
    GRAVURE_TRY(model.carriage_, AxisMotion::make_carriage(plan, axis_terms(twin)));
    model.columns_per_line_ =
        to_double(Rational(plan.carriage->feed_pixels / Rational(plan.rotary.lines_per_revolution)));
  }
  model.column_um_ = to_double(plan.line.pixel_pitch_um);
  if (trajectory != nullptr) {
    ScannerTerms terms{twin.galvo_resolution, twin.microvectors, twin.cross_scan, twin.lag, plan.carriage.has_value()};
    model.scanner_ = scanner_errors(*trajectory, terms);
    if (back != nullptr) {
      terms.backwards = true;
      model.scanner_back_ = scanner_errors(*back, terms);
    }
    model.count_um_ = trajectory->resolution_mm * 1000;
    if (plan.carriage && twin.lag) {
      model.late_shift_um_ = shift_left_um(*trajectory, to_double(plan.line.pixel_pitch_um));
    }
    model.set_rounding_range();
  }
  model.radius_um_ = to_double(plan.rotary.circumference_um) / (2 * std::numbers::pi);
  if (twin.run_out.enabled && plan.mode != Mode::flat) {
    model.run_out_ =
        RunOut{to_double(twin.run_out.eccentricity_um), to_double(twin.run_out.angle_deg) * std::numbers::pi / 180};
  }
  if (twin.thermal.enabled) {
    model.growth_ = to_double(Rational(twin.thermal.temperature_change_k * twin.thermal.expansion_um_per_m_k)) * 1e-6;
  }
  GRAVURE_CHECK(model.check_light());
  return model;
}

/// Does every beam still meet the workpiece, wherever it has turned? The worst place is where it has gone straight out
/// of the light, at a right angle to the beam.
Result<void> ErrorModel::check_light() const {
  const double moved_um = run_out_ ? run_out_->eccentricity_um : 0;
  const double radius_um = radius_um_ * (1 + growth_);
  if (plan_.mode == Mode::flat || (moved_um == 0 && growth_ == 0)) {
    return {};
  }
  double farthest_um = 0;  // of a beam from the axis
  for (const LineErrors& errors : scanner_) {
    for (const double slope : {errors.slope_across_range.least, errors.slope_across_range.most}) {
      farthest_um = std::max(farthest_um, radius_um_ * std::abs(slope) / std::hypot(1.0, slope) +
                                              errors.across.magnitude() / std::hypot(1.0, slope));
    }
  }
  if (farthest_um + moved_um < radius_um) {
    return {};
  }
  return Error{
      ErrorCode::out_of_range,
      "twin.run_out.eccentricity_um and twin.thermal bring the workpiece out of the light: beams pass its axis "
      "at up to " +
          figure(farthest_um) + " um, moved by " + figure(moved_um) + " um, and its radius is " + figure(radius_um) +
          " um; less eccentricity or scanner.offset_deg would fit"};
}

/// How the workpiece lies at a line against where the job has it.
ShiftedSurface ErrorModel::surface_at(std::int64_t line) const {
  ShiftedSurface surface{radius_um_, growth_ * radius_um_, 0, 0};
  if (run_out_) {
    const double from_high_spot =
        2 * std::numbers::pi * static_cast<double>(line) / static_cast<double>(plan_.rotary.lines_per_revolution) -
        run_out_->angle_rad;
    surface.outwards_um = run_out_->eccentricity_um * std::cos(from_high_spot);
    surface.onwards_um = -run_out_->eccentricity_um * std::sin(from_high_spot);
  }
  return surface;
}

/// A panel grows away from line 0 of the image.
double ErrorModel::flat_growth_um(std::int64_t revolution, std::int64_t line) const {
  const double from_fixed_um =
      static_cast<double>(map_.image_line(revolution, line)) * to_double(plan_.rotary.line_pitch_um);
  return growth_ * from_fixed_um * (map_.runs_backwards(revolution) ? -1 : 1);
}

const LineErrors& ErrorModel::errors_of(std::int64_t revolution, bool reverse) const noexcept {
  const ScannerErrors& both = scanner_back_ && map_.runs_backwards(revolution) ? *scanner_back_ : scanner_;
  return both[reverse ? 1 : 0];
}

/// How far U stands back for a helical line that starts on a fraction of a column.
double ErrorModel::column_shift_um(std::int64_t revolution, std::int64_t line) const {
  const std::int64_t steps = (revolution - plan_.carriage->layers) * plan_.rotary.lines_per_revolution + line;
  return (static_cast<double>(map_.column_after(steps)) - columns_per_line_ * static_cast<double>(steps)) * column_um_;
}

/// The fractions are all multiples of one over the denominator of the columns a line.
void ErrorModel::set_rounding_range() {
  constexpr std::int64_t kMostOrders = 10'000'000;
  if (scanner_[0].rounded.order_um.empty()) {
    return;
  }
  const Integer fractions =
      denominator_of(Rational(plan_.carriage->feed_pixels / Rational(plan_.rotary.lines_per_revolution)));
  if (fractions * Integer(scanner_[0].rounded.order_um.size()) > kMostOrders) {
    rounding_range_ = {-count_um_ / 2, count_um_ / 2};
    return;
  }
  const auto count = static_cast<std::int64_t>(fractions);
  for (const LineErrors& errors : scanner_) {
    const auto [first, last] =
        std::minmax_element(errors.rounded.order_before.begin(), errors.rounded.order_before.end());
    for (std::int64_t i = 0; i < count; ++i) {
      const double shift_um = -static_cast<double>(i) / static_cast<double>(count) * column_um_;
      const std::vector<double> off = errors.rounded.rounded_off_um(shift_um, count_um_);
      for (std::size_t order = *first; order <= *last + 1; ++order) {
        rounding_range_.see(off[order]);
        if (std::abs(off[order]) > count_um_ * 0.499999) {  // half way: it may go to either side
          rounding_range_.see(-off[order]);
        }
      }
    }
  }
}

ErrorModel::Line ErrorModel::line_at(std::int64_t revolution, std::int64_t line) const {
  const bool reverse = line_is_reverse(plan_, revolution, line);
  Line result;
  result.errors = &errors_of(revolution, reverse);
  result.reverse = reverse;
  result.first_slot = reverse ? plan_.line.reverse_first_slot : plan_.line.forward_first_slot;
  result.first_tick = (revolution * plan_.rotary.lines_per_revolution + line) * plan_.line.ticks +
                      result.first_slot * plan_.clock.ticks_per_slot +
                      (reverse ? plan_.line.offset_remainder_ticks : 0);
  if (plan_.mode == Mode::flat) {
    result.onwards_um = flat_growth_um(revolution, line);
  } else if (run_out_ || growth_ != 0) {
    result.surface = surface_at(line);
  }
  const std::int64_t column =
      plan_.carriage
          ? map_.column_after((revolution - plan_.carriage->layers) * plan_.rotary.lines_per_revolution + line)
          : revolution / revolutions_per_band(plan_) * plan_.line.pixels;
  result.first_column_um = static_cast<double>(column) * column_um_;
  if (!result.errors->rounded.order_um.empty()) {
    result.rounded_off_um = result.errors->rounded.rounded_off_um(column_shift_um(revolution, line), count_um_);
  }
  result.axis_start = axis_->start_of(revolution);
  result.axis_drift_um = axis_->drift_um(result.axis_start, result.first_tick);
  if (carriage_) {
    result.carriage_start = carriage_->start_of(revolution);
    result.carriage_drift_um = carriage_->drift_um(result.carriage_start, result.first_tick);
  }
  return result;
}

/// Landing minus target. An axis that leads brings places beyond the target under the beam; a surface that is shifted
/// takes its target along, and where it rises the beam meets it earlier, nearer to the head.
inline PulseError ErrorModel::landed(const Line& line, std::int64_t index, const AxisMotion::Phase& axis,
                                     const AxisMotion::Phase& carriage) const {
  const LineErrors& errors = *line.errors;
  const auto i = static_cast<std::size_t>(index);
  const auto slots = static_cast<double>(index);
  const double pixel = line.reverse ? static_cast<double>(plan_.line.pixels - 1) - slots : slots;
  const auto of = [&errors, i](const std::vector<double>& values) { return errors.is_none() ? 0.0 : values[i]; };
  const double slope_across = of(errors.slope_across);
  const double slope_along = of(errors.slope_along);
  ShiftedSurface::Hit hit{of(errors.across_um), 0};
  if (line.surface) {
    hit = line.surface->hit(hit.across_um, slope_across);
  }
  PulseError error;
  error.across_um = hit.across_um + axis_->off_um(line.axis_start, axis) + line.axis_drift_um +
                    axis_->drift_um_per_slot() * slots - line.onwards_um;
  error.along_um =
      of(errors.along_um) - growth_ * (line.first_column_um + pixel * column_um_) + hit.rise_um * slope_along;
  if (!line.rounded_off_um.empty()) {
    const RoundedOrders& orders = errors.rounded;
    const std::size_t before = orders.order_before[i];
    const double share = orders.share_of_next[i];
    error.along_um += line.rounded_off_um[before] * (1 - share) + line.rounded_off_um[before + 1] * share;
  }
  if (carriage_) {
    error.along_um += carriage_->off_um(line.carriage_start, carriage) + line.carriage_drift_um +
                      carriage_->drift_um_per_slot() * slots;
  }
  // Along the beam it is as much further to a surface that rises as the beam leans.
  error.defocus_um =
      of(errors.defocus_um) + hit.rise_um * std::sqrt(1 + slope_across * slope_across + slope_along * slope_along);
  return error;
}

PulseError ErrorModel::pulse_error(std::int64_t revolution, std::int64_t line, std::int64_t pixel) const {
  const Line here = line_at(revolution, line);
  const std::int64_t index = here.reverse ? plan_.line.pixels - 1 - pixel : pixel;
  const std::int64_t tick = here.first_tick + index * plan_.clock.ticks_per_slot;
  const PulseError error = landed(here, index, axis_->phase_at(here.axis_start, tick),
                                  carriage_ ? carriage_->phase_at(here.carriage_start, tick) : AxisMotion::Phase{});
  return {-error.along_um, -error.across_um, error.defocus_um};
}

void ErrorModel::simulate(std::int64_t revolution, std::int64_t line, std::span<const std::byte> fired,
                          PulseSums& sums) const {
  const Line here = line_at(revolution, line);
  AxisMotion::Phase axis = axis_->phase_at(here.axis_start, here.first_tick);
  AxisMotion::Phase carriage =
      carriage_ ? carriage_->phase_at(here.carriage_start, here.first_tick) : AxisMotion::Phase{};
  double squares = 0;
  double worst = -1;
  std::int64_t worst_index = 0;
  for (std::int64_t i = 0; i < plan_.line.pixels; ++i) {
    if (fired.empty() || is_set(fired, i)) {
      const PulseError error = landed(here, i, axis, carriage);
      const double square = error.along_um * error.along_um + error.across_um * error.across_um;
      squares += square;
      ++sums.pulses;
      if (square > worst) {
        worst = square;
        worst_index = i;
      }
    }
    axis_->advance(axis);
    if (carriage_) {
      carriage_->advance(carriage);
    }
  }
  sums.squares_um2 += squares;
  if (worst > sums.worst_um2) {
    sums.worst_um2 = worst;
    sums.worst = {revolution, line, here.first_slot + worst_index};
  }
}

ErrorModel::Bound ErrorModel::line_bound(std::int64_t revolution, std::int64_t line) const {
  const Line here = line_at(revolution, line);
  const LineErrors& errors = *here.errors;
  const auto last = static_cast<double>(plan_.line.pixels - 1);
  const auto moving = [last](const AxisMotion& axis, double drift_um) {
    return Interval{axis.range().least_um, axis.range().most_um} +
           between(drift_um, drift_um + axis.drift_um_per_slot() * last);
  };
  ShiftedSurface::Range hits{errors.across, {}};
  if (here.surface) {
    hits = here.surface->range(errors.across, errors.slope_across_range);
  }
  const Interval across = hits.across_um + moving(*axis_, here.axis_drift_um) + at(-here.onwards_um);
  // Columns grow apart from column 0, wherever in the image the line lies.
  const double farthest_um = static_cast<double>(image_columns(plan_) - 1) * column_um_;
  Interval along = errors.along + between(0, -growth_ * farthest_um) + product(hits.rise_um, errors.slope_along_range) +
                   rounding_range_ + Interval{-late_shift_um_, late_shift_um_};
  if (carriage_) {
    along = along + moving(*carriage_, here.carriage_drift_um);
  }
  const double leaning = std::sqrt(1 + std::pow(errors.slope_across_range.magnitude(), 2) +
                                   std::pow(errors.slope_along_range.magnitude(), 2));
  return {std::hypot(across.magnitude(), along.magnitude()),
          (errors.defocus + product(hits.rise_um, {1, leaning})).magnitude()};
}

ErrorModel::JobBound ErrorModel::job_bound() const {
  const std::int64_t revolutions = plan_.job.revolutions;
  const std::int64_t lines = plan_.rotary.lines_per_revolution;
  std::set<std::int64_t> ends = {0, 1, revolutions - 2, revolutions - 1};
  JobBound worst;
  const auto see = [&](std::int64_t revolution, std::int64_t line) {
    const Bound bound = line_bound(revolution, line);
    if (bound.landing_um > worst.bound.landing_um) {
      worst.bound.landing_um = bound.landing_um;
      worst.revolution = revolution;
      worst.line = line;
    }
    worst.bound.defocus_um = std::max(worst.bound.defocus_um, bound.defocus_um);
  };
  for (const std::int64_t revolution : ends) {
    if (revolution < 0 || revolution >= revolutions) {
      continue;
    }
    if (run_out_) {
      for (std::int64_t line = 0; line < lines; ++line) {
        see(revolution, line);
      }
      continue;
    }
    for (const std::int64_t line : std::set<std::int64_t>{0, 1, lines - 2, lines - 1}) {
      if (line >= 0 && line < lines) {
        see(revolution, line);
      }
    }
  }
  return worst;
}

}  // namespace gravure
