// SPDX-License-Identifier: Apache-2.0
#include "server/http/byte_range.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace weft::server {
namespace {

// "first+bytes" of a file of 10 bytes.
std::string asked(std::string_view header, std::uint64_t size = 10) {
  const auto range = range_of(header, size);
  return range ? std::to_string(range->first) + "+" + std::to_string(range->bytes) : "nothing";
}

TEST(ByteRange, IsWhatTheHeaderAsksFor) {
  EXPECT_EQ(asked("bytes=3-"), "3+7");
  EXPECT_EQ(asked("bytes=3-3"), "3+1");
  EXPECT_EQ(asked("bytes=0-99"), "0+10");
  EXPECT_EQ(asked("bytes=-4"), "6+4");
  EXPECT_EQ(asked("bytes=-99"), "0+10");
  EXPECT_EQ(asked("bytes=0-18446744073709551615"), "0+10");
}

TEST(ByteRange, MayHaveNothingOfTheFile) {
  EXPECT_EQ(asked("bytes=10-"), "nothing");
  EXPECT_EQ(asked("bytes=-0"), "nothing");
  EXPECT_EQ(asked("bytes=0-", 0), "nothing");
}

TEST(ByteRange, IsAllOfItForAnythingElse) {
  for (const char* header : {"", "bytes", "bytes=", "bytes=-", "bytes=a-", "bytes=4-3", "lines=1-2",
                             "bytes=1-2,4-5", "bytes=-1-2", "bytes=99999999999999999999-"})
    EXPECT_EQ(asked(header), "0+10") << header;
}

}  // namespace
}  // namespace weft::server
