#include "byte_file.hpp"

#include <gtest/gtest.h>
#include <xxhash.h>

#include "codec.hpp"
#include "dice.hpp"
#include "grv_support.hpp"

namespace gravure::grv {
namespace {

using grv_test::Bytes;
using grv_test::Folder;

std::unique_ptr<ByteFile> new_file(const std::string& path) {
  std::ofstream(path).flush();
  return open_file(path, OpenFor::writing, path).value();
}

/// Bytes that tell where they belong.
Bytes some_bytes(test::Dice& dice, std::size_t count) {
  Bytes bytes(count);
  const auto start = static_cast<unsigned>(dice.between(0, 255));
  for (std::size_t i = 0; i < count; ++i) {
    bytes[i] = static_cast<std::byte>((start + i + i / 251) & 0xFFU);
  }
  return bytes;
}

TEST(ByteFile, HoldsWhatWasWrittenWhicheverWayItWent) {
  test::Dice dice;
  SCOPED_TRACE(test::Dice::note());
  const Folder folder;
  const std::string path = folder.file("f");
  Bytes wanted;
  const std::unique_ptr<ByteFile> file = new_file(path);
  const auto write = [&](std::size_t offset, const Bytes& bytes) {
    wanted.resize(std::max(wanted.size(), offset + bytes.size()));
    std::copy(bytes.begin(), bytes.end(), wanted.begin() + static_cast<std::ptrdiff_t>(offset));
    ASSERT_TRUE(file->write(offset, bytes));
    ASSERT_EQ(file->size().value(), wanted.size());
  };
  for (int i = 0; i < 60; ++i) {
    const auto size = static_cast<std::size_t>(dice.between(1, i % 5 == 0 ? 3 << 20 : 300'000));
    const bool append = dice.between(0, 9) < 7;
    const auto offset =
        append ? wanted.size() : static_cast<std::size_t>(dice.between(0, static_cast<std::int64_t>(wanted.size())));
    write(offset, some_bytes(dice, append ? size : size % 5000 + 1));
    const auto from = static_cast<std::size_t>(dice.between(0, static_cast<std::int64_t>(wanted.size())));
    Bytes seen(std::min<std::size_t>(wanted.size() - from, 100'000));
    ASSERT_TRUE(read_exactly(*file, from, seen));
    ASSERT_TRUE(std::equal(seen.begin(), seen.end(), wanted.begin() + static_cast<std::ptrdiff_t>(from))) << i;
  }
  ASSERT_TRUE(file->resize(wanted.size() - 1));
  wanted.pop_back();
  ASSERT_TRUE(file->flush());
  EXPECT_EQ(grv_test::load(path), wanted);
}

TEST(ByteFile, GivesTheSystemEverythingWhenItIsFlushed) {
  const Folder folder;
  const std::string path = folder.file("f");
  const std::unique_ptr<ByteFile> file = new_file(path);
  const Bytes bytes(10, std::byte{7});
  ASSERT_TRUE(file->write(5, bytes));
  ASSERT_TRUE(file->flush());
  EXPECT_EQ(grv_test::load(path).size(), 15U);
}

TEST(HashOf, IsThatOfTheLibraryAtAnyLength) {
  test::Dice dice;
  SCOPED_TRACE(test::Dice::note());
  const Bytes bytes = some_bytes(dice, 5000);
  for (std::size_t length = 0; length <= bytes.size(); length += length < 600 ? 1 : 97) {
    const std::span<const std::byte> part(bytes.data() + length % 7, length > 7 ? length - 7 : 0);
    ASSERT_EQ(hash_of(part), XXH3_64bits(part.data(), part.size())) << length;
  }
}

}  // namespace
}  // namespace gravure::grv
