#include "job/source_hashes.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gravure/formats/image_files.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

namespace fs = std::filesystem;
using cli::SourceHashes;
using Begin = SourceHashes::Begin;

class Watched final : public Progress {
 public:
  void update(std::int64_t done, std::int64_t total) override { seen.emplace_back(done, total); }
  std::vector<std::pair<std::int64_t, std::int64_t>> seen;
};

class SourceHashesTest : public testing::TestWithParam<Begin> {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// Takes minutes to hash, and no room.
  std::string write_huge(const std::string& name) {
    write(name, "");
    fs::resize_file(folder_ / name, std::uintmax_t{1} << 40);
    return folder_ / name;
  }
  Result<std::vector<std::string>> wait(SourceHashes& hashes) { return hashes.wait(progress_); }

  TempFolder folder_;
  CancelToken cancel_;
  Watched progress_;
};

TEST_P(SourceHashesTest, AreThoseOfTheFilesInTheirOrder) {
  const std::string a = write("a", "abc");
  const std::string b = write("b", "");
  SourceHashes hashes({b, a, b, a}, GetParam(), cancel_);
  const auto found = wait(hashes);
  ASSERT_TRUE(found) << found.error().message;
  const std::string of_a = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  const std::string of_b = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
  EXPECT_EQ(found.value(), (std::vector<std::string>{of_b, of_a, of_b, of_a}));
  EXPECT_TRUE(hashes.check_unchanged());
}

TEST_P(SourceHashesTest, TellHowFarTheyAreWhileSomebodyWaits) {
  const std::string a = write("a", std::string(30'000'000, 'a'));
  const std::string b = write("b", std::string(20'000'000, 'b'));
  SourceHashes hashes({a, b, a}, GetParam(), cancel_);
  ASSERT_TRUE(wait(hashes));
  if (GetParam() == Begin::in_step) {  // a thread may be done before anybody waits
    ASSERT_EQ(progress_.seen.back(), std::pair(std::int64_t{50}, std::int64_t{50})) << "MB, each file once";
  }
  for (std::size_t i = 0; i < progress_.seen.size(); ++i) {
    const auto [done, total] = progress_.seen[i];
    EXPECT_GE(done, i == 0 ? 0 : progress_.seen[i - 1].first);
    EXPECT_EQ(total, progress_.seen[0].second) << "of what is still to be read when the waiting begins";
  }
}

TEST_P(SourceHashesTest, GoOnInStepWithTheWork) {
  const std::string a = write("a", std::string(30'000'000, 'a'));
  const std::string b = write("b", std::string(20'000'000, 'b'));
  SourceHashes alone({a, b}, GetParam(), cancel_);
  const auto expected = wait(alone);
  progress_.seen.clear();
  SourceHashes hashes({a, b}, GetParam(), cancel_);
  hashes.go_on(0, 0);
  hashes.go_on(1, 5);
  hashes.go_on(4, 5);
  const auto found = wait(hashes);
  ASSERT_TRUE(found);
  EXPECT_EQ(found.value(), expected.value());
  if (GetParam() == Begin::in_step) {
    ASSERT_FALSE(progress_.seen.empty());
    EXPECT_LE(progress_.seen[0].second, 10) << "MB are left";
    EXPECT_GE(progress_.seen[0].second, 9);
  }
}

TEST_P(SourceHashesTest, RefuseAFileThatGrowsMeanwhile) {
  const std::string a = write("a", "abc");
  const std::string b = write("b", "abc");
  SourceHashes hashes({a, b}, GetParam(), cancel_);
  write("b", "abcd");
  const auto found = wait(hashes);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::bad_file);
  EXPECT_EQ(found.error().message, b + ": changed while it was compiled (written to, replaced or removed): the program "
                                       "need not be what its SHA-256 says; compile again when the file is done");
}

TEST_P(SourceHashesTest, RefuseAFileOfTheSameSizeThatIsWrittenAnew) {
  const std::string a = write("a", "abc");
  fs::last_write_time(a, fs::last_write_time(a) - std::chrono::seconds(2));
  SourceHashes hashes({a}, GetParam(), cancel_);
  write("a", "xyz");
  EXPECT_EQ(wait(hashes).error().code, ErrorCode::bad_file);
}

TEST_P(SourceHashesTest, RefuseAFileWhoseTimeOfWritingIsSetBack) {
  const std::string a = write("a", "abc");
  const fs::file_time_type written = fs::last_write_time(a);
  SourceHashes hashes({a}, GetParam(), cancel_);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // clocks of files tick every few milliseconds
  write("a", "xyz");
  fs::last_write_time(a, written);
  EXPECT_EQ(wait(hashes).error().code, ErrorCode::bad_file);
}

TEST_P(SourceHashesTest, RefuseAFileThatChangesOrGoesAfterItsHashIsKnown) {
  const std::string a = write("a", "abc");
  SourceHashes hashes({a}, GetParam(), cancel_);
  ASSERT_TRUE(wait(hashes));
  write("a", "abcd");
  EXPECT_EQ(hashes.check_unchanged().error().code, ErrorCode::bad_file);
  fs::remove(a);
  EXPECT_EQ(hashes.check_unchanged().error().code, ErrorCode::bad_file);
}

TEST_P(SourceHashesTest, SayWhichFileIsNotThere) {
  const std::string a = write("a", "abc");
  SourceHashes hashes({a, folder_ / "gone"}, GetParam(), cancel_);
  const auto found = wait(hashes);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::bad_file);
  EXPECT_EQ(found.error().message, (folder_ / "gone") + ": is no file that exists: nothing to hash");
}

TEST_P(SourceHashesTest, StopOnRequestInTheMiddleOfAFile) {
  const std::string huge = write_huge("a");
  SourceHashes hashes({huge}, GetParam(), cancel_);
  cancel_.cancel();
  const auto found = wait(hashes);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::cancelled);
}

TEST_P(SourceHashesTest, StopWhenNobodyWantsThemAnyMore) {
  const std::string huge = write_huge("a");
  const auto before = std::chrono::steady_clock::now();
  { const SourceHashes hashes({huge}, GetParam(), cancel_); }
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::minutes(1));
}

INSTANTIATE_TEST_SUITE_P(Begin, SourceHashesTest, testing::Values(Begin::now, Begin::in_step),
                         [](const auto& each) { return each.param == Begin::now ? "Now" : "InStep"; });

}  // namespace
}  // namespace gravure::test
