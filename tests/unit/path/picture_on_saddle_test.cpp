#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "dice.hpp"
#include "gravure/emulator/emulated_device.hpp"
#include "gravure/formats/grv.hpp"
#include "gravure/kinematics/machines.hpp"
#include "gravure/texture/best_sigma.hpp"
#include "gravure/texture/picture_path.hpp"
#include "gravure/twin/verify_path.hpp"
#include "grv_support.hpp"
#include "path_support.hpp"

namespace gravure {
namespace {

using grv_test::Folder;
using test::Dice;

constexpr texture::PictureGrid kGrid{
    .columns = 40, .rows = 24, .pixel_mm = 0.05, .line_mm = 0.06, .run_out_mm = 0.3, .step_mm = 0.1};

/// A picture in memory, a byte a pixel.
class Noise final : public LayerLines {
 public:
  explicit Noise(Dice& dice) : fires_(static_cast<std::size_t>(kGrid.columns * kGrid.rows)) {
    for (std::uint8_t& each : fires_) {
      each = dice.coin() ? 1 : 0;
    }
  }
  const std::vector<std::uint8_t>& fires() const { return fires_; }
  Result<bool> read_lines(std::int64_t /*layer*/, std::int64_t first, std::int64_t count,
                          std::span<std::byte> out) override {
    static_assert(kGrid.columns % 8 == 0);
    std::fill(out.begin(), out.end(), std::byte{0});
    for (std::int64_t i = 0; i < count * kGrid.columns; ++i) {
      if (fires_[static_cast<std::size_t>(first * kGrid.columns + i)] != 0) {
        out[static_cast<std::size_t>(i / 8)] |= std::byte{0x80} >> static_cast<int>(i % 8);
      }
    }
    return false;
  }

 private:
  std::vector<std::uint8_t> fires_;
};

struct Marked {
  PathReport report;
  std::vector<std::uint8_t> pixels;  ///< how often each was hit
  double worst_um = 0;               ///< of a pulse from the middle of its pixel, seen along z
};

/// The picture on z = 0.03 x y, split, timed, proved, compiled, run on the emulated board and projected back along z.
Result<Marked> mark(Noise& picture) {
  GRAVURE_TRY(const auto surface, texture::expression_surface("0.03*x*y"));
  GRAVURE_TRY(const texture::TexturePath path, texture::picture_path(kGrid, 100'000));
  GRAVURE_TRY(const PathPulses pulses, texture::picture_pulses(kGrid, picture, CancelToken()));
  GRAVURE_TRY(texture::Split split, texture::split_path(*surface, path, {.sigma_mm = 3}));
  texture::PathMachine machine;
  machine.machine = kinematics::xyzac_machine(kinematics::XyzacSigns::texturing, kinematics::Vector3(1, -2, 3), {});
  machine.limits = texture::published_limits();
  GRAVURE_TRY(const texture::TimedSplit timed, texture::time_split(std::move(split), path, machine, CancelToken()));
  GRAVURE_TRY(const texture::ProvenPath proven, texture::prove_seven_axes(timed.request(machine, path), CancelToken()));
  std::vector<PathTarget> targets;
  for (std::size_t i = 0; i < timed.pulse_mm.size(); ++i) {
    const auto& [p, n] = timed.split.targets[i];
    targets.push_back({timed.pulse_mm[i], {p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  }
  PathPlanRequest request = path_test::request(50);
  request.path.rotary_centre_mm = {Rational(1), Rational(-2), Rational(3)};
  request.path.max_landing_um = Rational(1);
  ProgramHeader header;
  GRAVURE_TRY(header.plan, make_path_plan(request, proven.path.motion->instants(), pulses.count,
                                          static_cast<std::int64_t>(targets.size())));
  const Folder folder;
  GRAVURE_TRY(const auto sink,
              create_grv(folder.file("p.grv"), 1, header.plan.rotary.lines_per_revolution, header.line_bytes(), {}));
  GRAVURE_CHECK(compile_path(header, *proven.path.motion, pulses, targets, *sink));
  GRAVURE_TRY(const auto program, open_grv(folder.file("p.grv")));
  Marked marked;
  marked.pixels.resize(picture.fires().size());
  VerifyPathOptions options;
  options.wanted = &pulses;
  options.landed = [&marked](const LandedPulse& landed) -> Result<void> {
    const auto& at = landed.spot.position_mm;
    const auto column = static_cast<std::int64_t>(std::floor(at.x() / kGrid.pixel_mm + kGrid.columns / 2.0));
    const auto row = static_cast<std::int64_t>(std::floor(kGrid.rows / 2.0 - at.y() / kGrid.line_mm));
    if (column < 0 || column >= kGrid.columns || row < 0 || row >= kGrid.rows) {
      return Error{ErrorCode::out_of_range, "a pulse beside the picture"};
    }
    ++marked.pixels[static_cast<std::size_t>(row * kGrid.columns + column)];
    const texture::Vector2 middle = texture::pixel_mm(kGrid, {row, column});
    marked.worst_um = std::max(marked.worst_um, (at.head<2>() - middle).norm() * 1000);
    return {};
  };
  const DeviceFactory devices = [](PinObserver& observer) {
    return std::make_unique<emulator::EmulatedDevice>(&observer);
  };
  GRAVURE_TRY(marked.report, verify_path(*program, devices, options));
  return marked;
}

TEST(PictureOnASaddle, IsTheBitmapAgainWhenProjectedBack) {
  SCOPED_TRACE(Dice::note());
  Dice dice;
  Noise picture(dice);
  const Result<Marked> marked = mark(picture);
  ASSERT_TRUE(marked) << marked.error().message;
  EXPECT_EQ(marked.value().pixels, picture.fires());
  EXPECT_EQ(marked.value().report.violations, std::vector<std::string>());
  EXPECT_LT(marked.value().report.focus_offset_um.max, 20);
  EXPECT_LT(marked.value().worst_um, 1) << "half a slot and what the focus offset leans, of pixels of 50 um";
}

}  // namespace
}  // namespace gravure
