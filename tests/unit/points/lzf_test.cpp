#include "lzf.hpp"

#include <gtest/gtest.h>

namespace gravure {
namespace {

using namespace std::string_literals;

TEST(Lzf, CopiesWhatWasWrittenBefore) {
  EXPECT_EQ(lzf_unpacked("\x02"s + "abc" + "\x80\x02"s, 9).value(), "abcabcabc");
  EXPECT_EQ(lzf_unpacked("\x00z"s + "\xE0\xFF\x00"s, 265).value(), std::string(265, 'z'));  // overlaps itself
  EXPECT_EQ(lzf_unpacked("", 0).value(), "");
}

TEST(Lzf, RefusesWhatReachesBeyondEitherEnd) {
  for (const std::string& bad : {"\x02"s + "ab", "\x20\x00"s, "\x00z\x20\x01"s, "\x00z\xE0"s, "\x00z\x20"s}) {
    EXPECT_FALSE(lzf_unpacked(bad, 9));
  }
  EXPECT_FALSE(lzf_unpacked("\x02"s + "abc", 2));
  EXPECT_FALSE(lzf_unpacked("\x02"s + "abc", 4));
  EXPECT_FALSE(lzf_unpacked("\x00z"s, std::size_t{1} << 40U));  // no memory is taken for it
}

}  // namespace
}  // namespace gravure
