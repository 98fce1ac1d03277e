#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <random>

#include "gravure/formats/image_files.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

using Names = std::vector<std::string>;

/// What the patterns give, without the folder.
Names expand(const TempFolder& folder, const Names& patterns) {
  auto files = expand_patterns(folder.path(), patterns);
  EXPECT_TRUE(files) << files.error().message;
  Names names;
  for (const std::string& file : files ? files.value() : Names()) {
    names.push_back(std::filesystem::relative(file, folder.path()).string());
  }
  return names;
}

TEST(NaturalOrder, ComparesRunsOfDigitsAsNumbers) {
  EXPECT_TRUE(natural_less("layer_2.tif", "layer_10.tif"));
  EXPECT_FALSE(natural_less("layer_10.tif", "layer_2.tif"));
  EXPECT_TRUE(natural_less("a9b1", "a10b0"));
  EXPECT_TRUE(natural_less("a1b2", "a1b10"));
  EXPECT_TRUE(natural_less("a", "a0"));
  EXPECT_TRUE(natural_less("a0", "b"));
  EXPECT_TRUE(natural_less("99999999999999999999998", "99999999999999999999999")) << "beyond 64 bits";
  EXPECT_TRUE(natural_less("a01", "a1") != natural_less("a1", "a01")) << "leading zeros still order";
  EXPECT_FALSE(natural_less("same", "same"));
}

TEST(NaturalOrder, IsAStrictOrderOfRandomNames) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  Names names;
  for (int i = 0; i < 60; ++i) {
    std::string name;
    for (auto length = rng() % 5; length > 0; --length) {
      name += "019ab"[rng() % 5];
    }
    names.push_back(name);
  }
  for (const std::string& a : names) {
    for (const std::string& b : names) {
      ASSERT_EQ(natural_less(a, b) || natural_less(b, a), a != b) << a << " " << b;
      for (const std::string& c : names) {
        ASSERT_FALSE(natural_less(a, b) && natural_less(b, c) && !natural_less(a, c)) << a << " " << b << " " << c;
      }
    }
  }
}

TEST(PathPatterns, GiveFilesInNaturalOrderEachOnce) {
  const TempFolder folder;
  std::filesystem::create_directories(folder / "layers/sub");
  for (const char* const name : {"layer_10.tif", "layer_2.tif", "layer_1.tif", "other.png", ".hidden.tif"}) {
    put_file(folder / ("layers/" + std::string(name)), "x");
  }
  EXPECT_EQ(expand(folder, {"layers/*.tif"}),
            (Names{"layers/layer_1.tif", "layers/layer_2.tif", "layers/layer_10.tif"}));
  EXPECT_EQ(expand(folder, {"layers/layer_?.tif"}), (Names{"layers/layer_1.tif", "layers/layer_2.tif"}));
  EXPECT_EQ(expand(folder, {"layers/layer_[2-9].tif"}), (Names{"layers/layer_2.tif"}));
  EXPECT_EQ(expand(folder, {"*/other.png"}), (Names{"layers/other.png"}));
  EXPECT_EQ(expand(folder, {"layers/*"}).size(), 4U) << "folders and hidden files never match";
  EXPECT_EQ(expand(folder, {"layers/layer_10.tif", "layers/*.tif"}),
            (Names{"layers/layer_10.tif", "layers/layer_1.tif", "layers/layer_2.tif"}))
      << "the order of the patterns comes first, and a file comes once";
}

TEST(PathPatterns, TakeAnAbsolutePathAndAnEmptyFolder) {
  const TempFolder folder;
  put_file(folder / "a.tif", "x");
  EXPECT_EQ(expand_patterns("/nowhere", {folder / "*.tif"}).value(), (Names{folder / "a.tif"}));
  EXPECT_EQ(expand_patterns("", {folder / "a.tif"}).value(), (Names{folder / "a.tif"}));
}

TEST(PathPatterns, TreatTheFolderAndExistingNamesLiterally) {
  const TempFolder folder;
  const std::string odd = folder / "job [1] *";
  std::filesystem::create_directories(odd);
  put_file(odd + "/a1.tif", "x");
  put_file(odd + "/a[1].tif", "x");
  EXPECT_EQ(expand_patterns(odd, {"*.tif"}).value(), (Names{odd + "/a1.tif", odd + "/a[1].tif"}));
  EXPECT_EQ(expand_patterns(odd, {"a[1].tif"}).value(), (Names{odd + "/a[1].tif"})) << "the file of that very name";
}

TEST(PathPatterns, NameEachPatternThatMatchesNothing) {
  const TempFolder folder;
  put_file(folder / "a.tif", "x");
  const auto files = expand_patterns(folder.path(), {"*.png", "a.tif", "none/*.tif"});
  ASSERT_FALSE(files);
  EXPECT_EQ(files.error().code, ErrorCode::bad_file);
  EXPECT_NE(files.error().message.find("\"*.png\""), std::string::npos) << files.error().message;
  EXPECT_NE(files.error().message.find("\"none/*.tif\""), std::string::npos) << files.error().message;
  EXPECT_EQ(files.error().message.find("a.tif\""), std::string::npos) << files.error().message;
}

TEST(PathPatterns, TakeOneFileOnceHoweverItsPathIsWritten) {
  const TempFolder folder;
  put_file(folder / "a.tif", "x");
  std::filesystem::create_symlink("a.tif", folder / "b.tif");
  EXPECT_EQ(expand_patterns(folder.path(), {"a.tif", "./a.tif", "*.tif"}).value(),
            (Names{folder / "a.tif", folder / "b.tif"}))
      << "a link is an entry of its own: so one mask stands for several layers";
}

TEST(PathPatterns, SayWhichFolderCannotBeListed) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "root may list every folder";
  }
  const TempFolder folder;
  std::filesystem::create_directories(folder / "open");
  std::filesystem::create_directories(folder / "closed");
  put_file(folder / "open/a.tif", "x");
  put_file(folder / "closed/b.tif", "x");
  std::filesystem::permissions(folder / "closed", std::filesystem::perms::none);
  const auto files = expand_patterns(folder.path(), {"*/*.tif"});
  std::filesystem::permissions(folder / "closed", std::filesystem::perms::owner_all);
  ASSERT_FALSE(files) << "a layer would be left out of the cut";
  EXPECT_NE(files.error().message.find("closed: Permission denied"), std::string::npos) << files.error().message;
}

TEST(PathPatterns, SayWhenAPatternMatchesOnlyFolders) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "layers");
  const auto files = expand_patterns(folder.path(), {"lay*"});
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message.find("only folders"), std::string::npos) << files.error().message;
}

TEST(PathPatterns, GiveUpOnAPatternThatWalksTheWholeDisk) {
  const TempFolder folder;
  // Each link leads back to the folder, so every "*" multiplies what is walked by 64: 64^4 names.
  for (int i = 0; i < 64; ++i) {
    std::filesystem::create_directory_symlink(".", folder / ("loop" + std::to_string(i)));
  }
  const auto files = expand_patterns(folder.path(), {"*/*/*/*/*.tif"});
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message.find("more than 1000000 names"), std::string::npos) << files.error().message;
}

}  // namespace
}  // namespace gravure::test
