#include "gravure/core/file_output.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

#include "../tiff/temp_folder.hpp"

namespace gravure {
namespace {

using test::file_bytes;
using test::put_file;
using test::TempFolder;

std::size_t files_in(const std::string& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator(folder)) {
    ++count;
  }
  return count;
}

unsigned permissions(const std::string& path) {
  struct stat status = {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 0777U;
}

TEST(FileOutput, ShowsNothingBeforeCommitAndEverythingAfter) {
  const TempFolder folder;
  const std::string path = folder / "out.grv";
  put_file(path, "before");
  Result<FileOutput> output = FileOutput::create(path);
  ASSERT_TRUE(output);
  EXPECT_NE(output.value().temporary_path(), path);
  EXPECT_EQ(std::filesystem::path(output.value().temporary_path()).parent_path(), folder.path());
  std::ofstream(output.value().temporary_path()) << "after";
  EXPECT_EQ(file_bytes(path), "before");
  ASSERT_TRUE(output.value().commit());
  EXPECT_EQ(file_bytes(path), "after");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(FileOutput, LeavesNothingWhenDestroyedBeforeCommit) {
  const TempFolder folder;
  {
    Result<FileOutput> output = FileOutput::create(folder / "out.grv");
    ASSERT_TRUE(output);
    std::ofstream(output.value().temporary_path()) << "half";
    EXPECT_EQ(files_in(folder.path()), 1U);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(FileOutput, SaysWhetherTheProcessHasAnyOnTheWayOrInItsPlace) {
  const TempFolder folder;
  const bool before = FileOutput::any_begun();  // other tests may have run in this process
  EXPECT_FALSE(FileOutput::create(folder / "missing/a"));
  EXPECT_EQ(FileOutput::any_begun(), before);
  {
    const FileOutput output = FileOutput::create(folder / "a").value();
    EXPECT_TRUE(FileOutput::any_begun());
  }
  EXPECT_EQ(FileOutput::any_begun(), before) << "nothing is left";
  ASSERT_TRUE(write_file(folder / "b", "b"));
  EXPECT_TRUE(FileOutput::any_begun());
}

TEST(FileOutput, CanBeMovedAndStillOwnsOneFile) {
  const TempFolder folder;
  {
    FileOutput first = FileOutput::create(folder / "a").value();
    FileOutput second = FileOutput::create(folder / "b").value();
    EXPECT_EQ(files_in(folder.path()), 2U);
    first = std::move(second);
    EXPECT_EQ(files_in(folder.path()), 1U) << "what it held before is gone";
    const FileOutput third(std::move(first));
    EXPECT_EQ(third.path(), folder / "b");
    EXPECT_EQ(files_in(folder.path()), 1U);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(FileOutput, GivesTwoWritersOfOnePathTwoTemporaryFiles) {
  const TempFolder folder;
  const FileOutput first = FileOutput::create(folder / "a").value();
  const FileOutput second = FileOutput::create(folder / "a").value();
  EXPECT_NE(first.temporary_path(), second.temporary_path());
}

TEST(FileOutput, PassesOverNamesACrashLeftBehind) {
  const TempFolder folder;
  std::string next;
  {
    const FileOutput output = FileOutput::create(folder / "a").value();
    next = output.temporary_path();
  }
  const std::size_t dash = next.rfind('-');
  for (int i = 1; i <= 3; ++i) {
    put_file(next.substr(0, dash + 1) + std::to_string(std::stoi(next.substr(dash + 1)) + i), "left behind");
  }
  ASSERT_TRUE(write_file(folder / "a", "new"));
  EXPECT_EQ(file_bytes(folder / "a"), "new");
  EXPECT_EQ(files_in(folder.path()), 4U) << "what others left is not ours to touch";
}

TEST(FileOutput, FollowsTheUmask) {
  const TempFolder folder;
  for (const mode_t mask : {mode_t{022}, mode_t{027}, mode_t{077}, mode_t{0}}) {
    const mode_t before = ::umask(mask);
    const Result<void> written = write_file(folder / "file", "x");
    const mode_t during = ::umask(before);
    ASSERT_TRUE(written);
    EXPECT_EQ(during, mask) << "the umask is the process's, not ours to change";
    EXPECT_EQ(permissions(folder / "file"), 0666U & ~mask);
  }
}

void expect_io(const Result<void>& result, const std::string& part) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::io);
  EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
}

TEST(FileOutput, RefusesAFolderThatIsMissing) {
  const TempFolder folder;
  expect_io(write_file(folder / "missing/out", "x"), "missing/out: cannot create the output: No such file");
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(FileOutput, RefusesATargetThatIsAFolder) {
  const TempFolder folder;
  expect_io(write_file(folder.path(), "x"), "is a folder");
  expect_io(write_file(folder / "", "x"), "is a folder");
  expect_io(write_file("", "x"), "is a folder");
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(FileOutput, RefusesATargetThatBecomesAFolderMeanwhile) {
  const TempFolder folder;
  {
    FileOutput output = FileOutput::create(folder / "out").value();
    std::filesystem::create_directory(folder / "out");
    put_file(folder / "out/inside", "kept");
    expect_io(output.commit(), "out: cannot put the finished file in its place");
  }
  EXPECT_EQ(files_in(folder.path()), 1U);
  EXPECT_EQ(file_bytes(folder / "out/inside"), "kept");
}

TEST(FileOutput, RefusesAFileInPlaceOfAFolder) {
  const TempFolder folder;
  put_file(folder / "file", "x");
  expect_io(write_file(folder / "file/out", "y"), "Not a directory");
}

TEST(FileOutput, KeepsTheOldFileWhenTheDiskTakesNoMore) {
  // A full disk, without one: the process may write no file longer than a page.
  const TempFolder folder;
  put_file(folder / "out", "old");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  struct rlimit tight = before;
  tight.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  const Result<void> written = write_file(folder / "out", std::string(100'000, 'x'));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  expect_io(written, "out: cannot write: File too large");
  EXPECT_EQ(file_bytes(folder / "out"), "old");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(FileOutput, CommitsOnlyOnce) {
  const TempFolder folder;
  FileOutput output = FileOutput::create(folder / "out").value();
  ASSERT_TRUE(output.commit());
  EXPECT_FALSE(output.commit());
  EXPECT_TRUE(std::filesystem::exists(folder / "out"));
}

TEST(WriteFile, WritesAnyBytesAndNone) {
  const TempFolder folder;
  const std::string bytes("\0\xFF\n\r\0", 5);
  ASSERT_TRUE(write_file(folder / "a", bytes));
  EXPECT_EQ(file_bytes(folder / "a"), bytes);
  ASSERT_TRUE(write_file(folder / "a", ""));
  EXPECT_EQ(file_bytes(folder / "a"), "");
}

TEST(ReadFile, TakesWhatTheLimitAllowsAndNotAByteMore) {
  const TempFolder folder;
  const std::string content(70'000, 'g');
  put_file(folder / "a", content);
  EXPECT_EQ(read_file(folder / "a", content.size()).value(), content);
  const Result<std::string> more = read_file(folder / "a", content.size() - 1);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, ErrorCode::bad_file);
  EXPECT_NE(more.error().message.find("larger than the 69999 bytes"), std::string::npos);
  put_file(folder / "empty", "");
  EXPECT_EQ(read_file(folder / "empty", 0).value(), "");
}

TEST(ReadFile, StopsOnAFileWithoutEnd) {
  const Result<std::string> zeros = read_file("/dev/zero", 1'000'000);
  ASSERT_FALSE(zeros);
  EXPECT_EQ(zeros.error().code, ErrorCode::bad_file);
}

TEST(ReadFile, RefusesFoldersPipesAndWhatIsNotThere) {
  const TempFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::string& path : {folder.path(), folder / "pipe", folder / "missing", std::string()}) {
    const Result<std::string> got = read_file(path, 10);
    ASSERT_FALSE(got) << path;
    EXPECT_EQ(got.error().code, ErrorCode::bad_file);
  }
}

}  // namespace
}  // namespace gravure
