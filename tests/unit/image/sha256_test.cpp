#include "sha256.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gravure/formats/image_files.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

/// FIPS 180-4 examples (one block, two blocks, a million times "a") and the empty message.
TEST(Sha256, GivesThePublishedVectors) {
  const std::pair<std::string, const char*> vectors[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
       "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {std::string(1'000'000, 'a'), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"},
  };
  for (const auto& [message, digest] : vectors) {
    EXPECT_EQ(sha256_text(message), digest);
    EXPECT_EQ(sha256_text_portable(message), digest);
  }
}

TEST(Sha256, IsTheSameWithAndWithoutShaInstructionsAtEveryLength) {
  const std::uint32_t seed = image_test_seed();
  SCOPED_TRACE(testing::Message() << "rerun with GRAVURE_TEST_SEED=" << seed);
  std::mt19937 rng(seed);
  std::string message;
  for (int length = 0; length < 300; ++length) {
    ASSERT_EQ(sha256_text(message), sha256_text_portable(message)) << length;
    message += static_cast<char>(rng());
  }
}

TEST(Sha256, HashesFilesOfAnySizeAsTheirBytes) {
  const TempFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{262'144}, std::size_t{700'001}}) {
    const std::string bytes(size, 'z');
    put_file(folder / "f", bytes);
    EXPECT_EQ(sha256_file(folder / "f").value(), sha256_text(bytes));
  }
}

TEST(Sha256, StopsWhenAskedTo) {
  const TempFolder folder;
  put_file(folder / "f", "long enough");
  CancelToken cancel;
  EXPECT_EQ(sha256_file(folder / "f", &cancel).value(), sha256_text("long enough"));
  cancel.cancel();
  EXPECT_EQ(sha256_file(folder / "f", &cancel).error().code, ErrorCode::cancelled);
}

TEST(Sha256, RefusesWhatIsNoFile) {
  const TempFolder folder;
  EXPECT_EQ(sha256_file(folder / "none").error().code, ErrorCode::bad_file);
  EXPECT_EQ(sha256_file(folder.path()).error().code, ErrorCode::bad_file);
}

}  // namespace
}  // namespace gravure::test
