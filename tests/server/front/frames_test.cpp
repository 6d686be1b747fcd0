// SPDX-License-Identifier: Apache-2.0
#include "server/front/frames.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/server/front/frame_bytes.h"

namespace weft::server::testing {
namespace {

struct Seen {
  std::vector<FrameHeader> headers;
  std::string bytes;  // headers and payloads, in order
};

void split(FrameSplitter& splitter, std::string_view bytes, Seen& seen) {
  splitter.split(
      bytes,
      [&](const FrameHeader& frame, std::string_view head) {
        seen.headers.push_back(frame);
        seen.bytes += head;
        return true;
      },
      [&](std::string_view payload) { seen.bytes += payload; });
}

TEST(FrameSplitter, FindsTheSameFramesHoweverTheBytesAreCut) {
  const std::string bytes = frame_bytes(FrameType::kHeaders, kFlagEndHeaders, 5, "abc") +
                            frame_bytes(FrameType::kData, kFlagEndStream, 5, "") +
                            frame_bytes(FrameType::kPing, 0, 0, "12345678");
  for (std::size_t step = 1; step <= bytes.size(); ++step) {
    FrameSplitter splitter;
    Seen seen;
    for (std::size_t from = 0; from < bytes.size(); from += step)
      split(splitter, std::string_view(bytes).substr(from, step), seen);
    EXPECT_EQ(seen.bytes, bytes);
    ASSERT_EQ(seen.headers.size(), 3u);
    EXPECT_EQ(seen.headers[0].type, FrameType::kHeaders);
    EXPECT_EQ(seen.headers[0].length, 3u);
    EXPECT_EQ(seen.headers[0].stream, 5u);
    EXPECT_TRUE(seen.headers[1].has(kFlagEndStream));
    EXPECT_EQ(seen.headers[2].stream, 0u);
    EXPECT_TRUE(splitter.between_frames());
  }
}

TEST(FrameSplitter, IsWithinAFrameUntilItsLastByte) {
  const std::string bytes = frame_bytes(FrameType::kData, 0, 1, "ab");
  FrameSplitter splitter;
  Seen seen;
  for (const char& byte : bytes) {
    split(splitter, {&byte, 1}, seen);
    EXPECT_EQ(splitter.between_frames(), &byte == &bytes.back());
  }
}

TEST(CalmDown, IsAGoAwayThatSaysWhy) {
  FrameSplitter splitter;
  Seen seen;
  split(splitter, calm_down("resets"), seen);
  ASSERT_EQ(seen.headers.size(), 1u);
  EXPECT_EQ(seen.headers[0].type, FrameType::kGoAway);
  EXPECT_EQ(seen.bytes.substr(9), std::string("\x7f\xff\xff\xff\0\0\0\x0b", 8) + "resets");
  EXPECT_TRUE(splitter.between_frames());
}

}  // namespace
}  // namespace weft::server::testing
