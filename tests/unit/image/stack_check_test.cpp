#include <gtest/gtest.h>

#include "gravure/formats/image_stack.hpp"

namespace gravure::test {
namespace {

/// 28 mm by 2 pi 35 mm at 8 um: 3500 pixels a line, 27489 lines.
class StackCheck : public testing::Test {
 protected:
  StackCheck() {
    job_.scanner.pixel_pitch_um = 8;
    job_.rotary.diameter_mm = Rational(70);
    job_.rotary.line_pitch_um = Rational(8);
    plan_.line.pixels = 3500;
    plan_.line.pixel_pitch_um = 8;
    plan_.rotary.lines_per_revolution = 27489;
    plan_.rotary.circumference_um = pi() * 70000;
    plan_.rotary.line_pitch_um = plan_.rotary.circumference_um / 27489;
    plan_.job.revolutions = 1;
    set_size(3500, 27489);
  }
  void set_size(std::int64_t width, std::int64_t height) {
    stack_.images.resize(1);
    stack_.images[0].path = "a.tif";
    stack_.images[0].info.width = width;
    stack_.images[0].info.height = height;
    stack_.layers = 1;
  }
  std::string refusal(ErrorCode code = ErrorCode::bad_file) {
    const auto checked = check_stack(plan_, job_, stack_);
    EXPECT_FALSE(checked);
    EXPECT_TRUE(checked || checked.error().code == code);
    return checked ? "" : checked.error().message;
  }
  std::vector<std::string> warnings() {
    const auto checked = check_stack(plan_, job_, stack_);
    EXPECT_TRUE(checked) << checked.error().message;
    return checked ? checked.value() : std::vector<std::string>();
  }

  Plan plan_;
  Job job_;
  ImageStack stack_;
};

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST_F(StackCheck, PassesWhatFits) {
  EXPECT_TRUE(warnings().empty());
  job_.image.lines_along = LinesAlong::columns;
  set_size(27489, 3500);
  EXPECT_TRUE(warnings().empty());
}

TEST_F(StackCheck, SaysWhichNumbersWouldFitTheLines) {
  set_size(3500, 27500);
  const std::string message = refusal();
  EXPECT_TRUE(has(message, "a.tif: page 0: 3500 x 27500 pixels")) << message;
  EXPECT_TRUE(has(message, "27489 lines a revolution of 3500 pixels")) << message;
  EXPECT_TRUE(has(message, "an image of 3500 x 27489 pixels")) << message;
  EXPECT_TRUE(has(message, "lines_per_revolution = 27500 (or line_pitch_um = 7.9967")) << message;
  EXPECT_TRUE(has(message, "diameter_mm = 70.028")) << message;
  EXPECT_FALSE(has(message, "pixels_per_line")) << "the pixels fit: " << message;
  job_.rotary.diameter_mm.reset();
  job_.rotary.circumference_mm = Rational(220);
  EXPECT_TRUE(has(refusal(), "circumference_mm = 220 at line_pitch_um = 8"));
}

TEST_F(StackCheck, SaysWhichNumbersWouldFitThePixels) {
  set_size(3499, 27489);
  const std::string message = refusal();
  EXPECT_TRUE(has(message, "pixels_per_line = 3499")) << message;
  EXPECT_FALSE(has(message, "[rotary]")) << message;
}

TEST_F(StackCheck, SaysWhenTheImageOnlyLiesTheOtherWay) {
  set_size(27489, 3500);
  EXPECT_TRUE(has(refusal(), "[image] lines_along = \"columns\""));
  job_.image.lines_along = LinesAlong::columns;
  set_size(3500, 27489);
  EXPECT_TRUE(has(refusal(), "[image] lines_along = \"rows\""));
}

TEST_F(StackCheck, CountsEveryTileOfARepeatedImage) {
  job_.repeat.around = 11;
  job_.repeat.along = 4;
  set_size(875, 2499);
  stack_.images[0].info.x_dots_per_mm = stack_.images[0].info.y_dots_per_mm = 125;
  EXPECT_TRUE(warnings().empty()) << "the size tags are those of a tile";
  job_.image.lines_along = LinesAlong::columns;
  set_size(2499, 875);
  EXPECT_TRUE(warnings().empty());
}

TEST_F(StackCheck, SaysWhichTilesWouldFit) {
  job_.repeat.around = 10;
  set_size(3500, 2499);
  const std::string message = refusal();
  EXPECT_TRUE(has(message, "and [repeat] around = 10, along = 1 makes them 24990 lines of 3500")) << message;
  EXPECT_TRUE(has(message, "an image of 3500 x 3927 pixels with [repeat] around = 7")) << message;
  EXPECT_TRUE(has(message, "an image of 3500 x 2499 pixels with [repeat] around = 11")) << message;
  EXPECT_TRUE(has(message, "\n  [repeat] around = 11\n")) << message;
  EXPECT_TRUE(has(message, "lines_per_revolution = 24990 ")) << message;
  job_.repeat.around = 11;
  set_size(3500, 2500);
  EXPECT_TRUE(has(refusal(), "\n  an image of 3500 x 2499 pixels\n  [rotary] lines_per_revolution = 27500 "));
}

TEST_F(StackCheck, StartsAtTheKeyOfTheTiles) {
  job_.path = "job.toml";
  job_.places["repeat.around"] = {30, 3};
  job_.repeat.around = 2;
  EXPECT_EQ(refusal().rfind("job.toml:30:3: ", 0), 0U) << refusal();
}

TEST_F(StackCheck, RefusesMoreTilesThanALineHolds) {
  job_.repeat.along = 300'000;
  const auto columns = picture_columns(job_, 3500);
  ASSERT_FALSE(columns);
  EXPECT_EQ(columns.error().code, ErrorCode::out_of_range);
  EXPECT_TRUE(has(columns.error().message, "[repeat] along = 300000")) << columns.error().message;
  EXPECT_TRUE(has(columns.error().message, "at most 285714 fit")) << columns.error().message;
  job_.repeat.along = 285'714;
  ASSERT_TRUE(picture_columns(job_, 3500));
  EXPECT_EQ(picture_columns(job_, 3500).value(), 999'999'000);
}

TEST_F(StackCheck, WarnsOfSizeTagsBeyondATenthOfAPercent) {
  stack_.images[0].info.x_dots_per_mm = 125.12;  // 0.096 % off 125
  stack_.images[0].info.y_dots_per_mm = 125;     // 0.0004 % off
  EXPECT_TRUE(warnings().empty());
  stack_.images[0].info.x_dots_per_mm = 125.13;  // 0.104 %
  auto found = warnings();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(has(found[0], "27.9709 mm along the line, the job makes it 28 mm")) << found[0];
  stack_.images[0].info.y_dots_per_mm = 72 / 25.4;
  found = warnings();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(has(found[1], "round the workpiece, the job makes it 219.911 mm")) << found[1];
}

TEST_F(StackCheck, TurnsSizeTagsWithTheImage) {
  job_.image.lines_along = LinesAlong::columns;
  plan_.line.pixel_pitch_um = 4;
  set_size(27489, 3500);
  stack_.images[0].info.x_dots_per_mm = 125;
  stack_.images[0].info.y_dots_per_mm = 250;
  EXPECT_TRUE(warnings().empty());
}

TEST_F(StackCheck, WarnsOnceADirectionHoweverManyLayers) {
  stack_.images.resize(5, stack_.images[0]);
  stack_.layers = plan_.job.revolutions = 5;
  for (StackImage& image : stack_.images) {
    image.info.x_dots_per_mm = 3;
  }
  EXPECT_EQ(warnings().size(), 1U);
}

TEST_F(StackCheck, WantsOneLayerARevolutionInSequence) {
  plan_.job.revolutions = 2;
  const std::string message = refusal(ErrorCode::bad_argument);
  EXPECT_TRUE(has(message, "revolutions = 2 but there are 1 layers")) << message;
  job_.image.order = LayerOrder::hold;
  EXPECT_TRUE(warnings().empty());
  job_.image.order = LayerOrder::cycle;
  stack_.layers = 3;
  const auto found = warnings();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(has(found[0], "the last 1 of 3 layers are never cut")) << found[0];
}

}  // namespace
}  // namespace gravure::test
