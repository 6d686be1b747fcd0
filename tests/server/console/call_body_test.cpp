// SPDX-License-Identifier: Apache-2.0
#include "server/console/call_body.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/console/frames.h"
#include "tests/server/console/web_client.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

constexpr std::uint64_t kMax = 1000;

// All messages of a body that comes in pieces; each is passed on before the next.
std::vector<std::string> messages_of(CallBody& body, const std::string& bytes, std::size_t piece) {
  std::vector<std::string> messages;
  for (std::size_t start = 0; start < bytes.size(); start += piece) {
    const std::string part = bytes.substr(start, piece);
    EXPECT_FALSE(body.add(part));
    for (auto message = body.next(); message && *message; message = body.next()) {
      messages.push_back(to_string(**message));
      body.passed_on();
    }
  }
  return messages;
}

TEST(CallBody, IsTheSameInAnyPiecesAndInBase64) {
  const std::string bytes = framed("one") + framed("") + framed("three");
  std::string in_base64 = to_base64(bytes);
  in_base64.append((4 - in_base64.size() % 4) % 4, '=');
  const std::vector<std::string> wanted{"one", "", "three"};
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    ByteBudget budget(kMax);
    CallBody body(false, kMax, budget, "ann");
    EXPECT_EQ(messages_of(body, bytes, piece), wanted) << piece;
    EXPECT_FALSE(body.end());
    CallBody text(true, kMax, budget, "ann");
    EXPECT_EQ(messages_of(text, in_base64, piece), wanted) << piece;
    EXPECT_FALSE(text.end());
  }
}

TEST(CallBody, GivesBackWhatWasPassedOn) {
  ByteBudget budget(8);
  CallBody body(false, kMax, budget, "ann");
  EXPECT_EQ(messages_of(body, framed("12345678") + framed("12345678"), 100).size(), 2u);
}

TEST(CallBody, ThatEndsWithinAMessageIsMalformed) {
  ByteBudget budget(kMax);
  CallBody body(false, kMax, budget, "ann");
  EXPECT_TRUE(messages_of(body, framed("one").substr(0, 6), 100).empty());
  ASSERT_TRUE(body.end());
  EXPECT_EQ(body.end()->reason, Reason::kMalformedRequest);
}

TEST(CallBody, ThatIsNoBase64IsMalformed) {
  ByteBudget budget(kMax);
  CallBody body(true, kMax, budget, "ann");
  const auto failure = body.add("****");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->reason, Reason::kMalformedRequest);
}

TEST(CallBody, LargerThanTheLargestMessageIsRefused) {
  ByteBudget budget(kMax);
  CallBody body(false, kMax, budget, "ann");
  const std::string empty_frames((kMax + 4096) / 5 * 5 + 5, '\0');
  const auto failure = body.add(empty_frames);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->reason, Reason::kLimitExceeded);
}

}  // namespace
}  // namespace weft::server::testing
