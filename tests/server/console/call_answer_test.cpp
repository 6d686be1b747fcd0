// SPDX-License-Identifier: Apache-2.0
#include "server/console/call_answer.h"

#include <gtest/gtest.h>

#include <string>

#include "server/console/frames.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

std::string next_of(CallAnswer& answer, const std::string& head) {
  std::string bytes;
  for (const boost::asio::const_buffer& buffer : answer.next(head))
    bytes.append(static_cast<const char*>(buffer.data()), buffer.size());
  return bytes;
}

TEST(CallAnswer, SendsEachMessageInAChunkAndTheTrailersLast) {
  CallAnswer answer(false);
  EXPECT_FALSE(answer.has_next());
  answer.add(to_buffer("abc"));
  answer.add(to_buffer(""));
  EXPECT_EQ(answer.waiting(), 2u);
  EXPECT_FALSE(answer.begun());
  using namespace std::string_literals;
  EXPECT_EQ(next_of(answer, "head;"), "head;8\r\n\0\0\0\0\3abc\r\n"s);
  EXPECT_TRUE(answer.begun());
  EXPECT_EQ(next_of(answer, ""), "5\r\n\0\0\0\0\0\r\n"s);
  EXPECT_FALSE(answer.has_next());
  answer.end("t");
  EXPECT_FALSE(answer.over());
  EXPECT_EQ(next_of(answer, ""), "6\r\n\x80\0\0\0\1t\r\n0\r\n\r\n"s);
  EXPECT_TRUE(answer.over());
  EXPECT_FALSE(answer.has_next());
}

TEST(CallAnswer, OfTextIsInBase64WithPadding) {
  CallAnswer answer(true);
  answer.add(to_buffer("abc"));
  EXPECT_EQ(next_of(answer, ""), "c\r\nAAAAAANhYmM=\r\n");
}

}  // namespace
}  // namespace weft::server::testing
