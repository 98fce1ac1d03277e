#include "gravure/formats/image_stack.hpp"

#include <gtest/gtest.h>

#include "fake_images.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

/// A job beside empty files of the given names, whose headers come from `images`.
class ImageStackTest : public testing::Test {
 protected:
  void add(const std::string& name, std::int64_t width, std::int64_t height, SampleType samples = SampleType::bit) {
    put_file(folder_ / name, "x");
    images_.add(name, width, height, samples);
  }
  Job job(const std::vector<std::string>& files) const {
    Job made;
    made.path = folder_ / "job.toml";
    made.image.files = files;
    return made;
  }
  void expect_refused(const Job& refused, ErrorCode code, const std::string& words) {
    const auto stack = scan_stack(refused, images_);
    ASSERT_FALSE(stack) << words;
    EXPECT_EQ(stack.error().code, code);
    EXPECT_NE(stack.error().message.find(words), std::string::npos) << stack.error().message;
  }

  TempFolder folder_;
  FakeImages images_;
};

TEST_F(ImageStackTest, TakesFilesInNaturalOrderAndPagesInOrder) {
  add("l_10.tif", 8, 4);
  add("l_2.tif", 8, 4);
  add("l_2.tif", 8, 4);
  const auto stack = scan_stack(job({"l_*.tif"}), images_);
  ASSERT_TRUE(stack) << stack.error().message;
  ASSERT_EQ(stack.value().images.size(), 3U);
  EXPECT_EQ(stack.value().images[0].path, folder_ / "l_2.tif");
  EXPECT_EQ(stack.value().images[1].page, 1);
  EXPECT_EQ(stack.value().images[2].path, folder_ / "l_10.tif");
  EXPECT_EQ(stack.value().layers, 3);
  EXPECT_EQ(stack.value().width(), 8);
  EXPECT_EQ(stack.value().height(), 4);
  EXPECT_FALSE(stack.value().depth_map);
  EXPECT_TRUE(stack.value().warnings.empty());
}

TEST_F(ImageStackTest, NamesTheFirstLayerThatDiffersInSize) {
  add("a_1.tif", 8, 4);
  add("a_2.tif", 8, 4);
  add("a_3.tif", 8, 5);
  add("a_4.tif", 9, 4);
  expect_refused(job({"a_*.tif"}), ErrorCode::bad_file, "a_3.tif: page 0: is 8 x 5 pixels, the first layer");
}

TEST_F(ImageStackTest, NamesTheFirstLayerThatDiffersInKind) {
  add("a_1.tif", 8, 4);
  add("a_2.png", 8, 4, SampleType::u8);
  expect_refused(job({"a_*"}), ErrorCode::bad_file, "a_2.png: page 0: has 8-bit grey samples");
}

TEST_F(ImageStackTest, WantsAThresholdForGreyLayersAndSuggestsOne) {
  add("a.png", 8, 4, SampleType::u8);
  add("b.png", 8, 4, SampleType::u16);
  expect_refused(job({"a.png"}), ErrorCode::bad_argument, "the middle is 128");
  expect_refused(job({"b.png"}), ErrorCode::bad_argument, "the middle is 32768");
  Job with = job({"a.png"});
  with.image.threshold = 128;
  EXPECT_TRUE(scan_stack(with, images_));
  for (const std::int64_t beyond : {std::int64_t{-1}, std::int64_t{0}, std::int64_t{256}}) {
    with.image.threshold = beyond;
    expect_refused(with, ErrorCode::out_of_range, "1 to 255");
  }
  with = job({"b.png"});
  with.image.threshold = 65535;
  EXPECT_TRUE(scan_stack(with, images_));
}

TEST_F(ImageStackTest, WarnsOfAThresholdForBilevelLayers) {
  add("a.tif", 8, 4);
  Job with = job({"a.tif"});
  with.image.threshold = 128;
  const auto stack = scan_stack(with, images_);
  ASSERT_TRUE(stack) << stack.error().message;
  ASSERT_EQ(stack.value().warnings.size(), 1U);
  EXPECT_NE(stack.value().warnings[0].find("threshold = 128"), std::string::npos);
}

TEST_F(ImageStackTest, WarnsOnceOfFaxDataLargerThanTheBits) {
  for (const char* const name : {"a.tif", "b.tif", "c.tif", "d.tif"}) {
    add(name, 8, 4);
  }
  EXPECT_TRUE(scan_stack(job({"*.tif"}), images_).value().warnings.empty());
  images_.files.at("b.tif").front().fax_larger_than_raw = true;
  images_.files.at("d.tif").front().fax_larger_than_raw = true;
  const auto stack = scan_stack(job({"*.tif"}), images_);
  ASSERT_TRUE(stack) << stack.error().message;
  ASSERT_EQ(stack.value().warnings.size(), 1U);
  EXPECT_EQ(stack.value().warnings[0].rfind(folder_ / "b.tif: page 0: its G3 or G4 data are larger", 0), 0U);
  EXPECT_NE(stack.value().warnings[0].find("(and 1 more)"), std::string::npos);
}

TEST_F(ImageStackTest, RefusesFloatingPointLayers) {
  add("a.exr", 8, 4, SampleType::f32);
  Job with = job({"a.exr"});
  with.image.threshold = 1;
  expect_refused(with, ErrorCode::bad_argument, "floating-point");
}

TEST_F(ImageStackTest, TakesADepthMapAsOneImageOfManyLayers) {
  add("map.tif", 8, 4, SampleType::u16);
  Job with = job({});
  with.image.depth_map = "map.tif";
  with.image.levels = 100;
  const auto stack = scan_stack(with, images_);
  ASSERT_TRUE(stack) << stack.error().message;
  EXPECT_TRUE(stack.value().depth_map);
  EXPECT_EQ(stack.value().images.size(), 1U);
  EXPECT_EQ(stack.value().layers, 100);
}

TEST_F(ImageStackTest, RefusesDepthMapsWithoutLevelsWithPagesOrWithoutDepth) {
  add("map.tif", 8, 4, SampleType::u8);
  add("pages.tif", 8, 4, SampleType::u8);
  add("pages.tif", 8, 4, SampleType::u8);
  add("flat.tif", 8, 4);
  Job with = job({});
  with.image.depth_map = "map.tif";
  expect_refused(with, ErrorCode::bad_argument, "[image] levels");
  with.image.levels = 0;
  expect_refused(with, ErrorCode::bad_argument, "[image] levels");
  with.image.levels = 4;
  with.image.depth_map = "pages.tif";
  expect_refused(with, ErrorCode::bad_argument, "has 2 pages");
  with.image.depth_map = "flat.tif";
  expect_refused(with, ErrorCode::bad_argument, "is bilevel");
}

TEST_F(ImageStackTest, RefusesNoImagesAndPatternsWithoutMatch) {
  expect_refused(job({}), ErrorCode::bad_argument, "no image given");
  expect_refused(job({"none_*.tif"}), ErrorCode::bad_file, "\"none_*.tif\" matches no file");
}

}  // namespace
}  // namespace gravure::test
