// SPDX-License-Identifier: Apache-2.0
// What passes, and at which frame exactly a connection must be closed.
#include "server/front/connection_rules.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/server/front/frame_bytes.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = ConnectionRules::Clock;

constexpr std::uint8_t kWhole = kFlagEndHeaders;
constexpr auto kUnknown = static_cast<FrameType>(0x42);

class Rules : public ::testing::Test {
 protected:
  // The cause of the violation; empty if there is none.
  std::string take(const std::string& bytes) {
    const auto received = rules_.received(bytes, passed_, now_, [this] { return may_begin_; });
    rest_ = received.rest;
    waits_ = received.waits;
    return received.violation ? received.violation->cause : "";
  }
  std::string take(FrameType type, std::uint8_t flags, std::uint32_t stream,
                   const std::string& payload) {
    return take(frame_bytes(type, flags, stream, payload));
  }
  std::string begin(std::uint32_t stream) { return take(FrameType::kHeaders, kWhole, stream, "h"); }
  std::string reset(std::uint32_t stream) { return take(FrameType::kReset, 0, stream, "1234"); }
  void answer(std::uint32_t stream) {
    rules_.sent(frame_bytes(FrameType::kHeaders, kWhole, stream, "h"));
    rules_.sent(frame_bytes(FrameType::kData, 0, stream, "d"));
    rules_.sent(frame_bytes(FrameType::kHeaders, kWhole | kFlagEndStream, stream, "t"));
  }
  // How many of these frames pass before the connection must be closed.
  int count_until_closed(const std::string& frame) {
    int count = 0;
    while (take(frame).empty() && count < 100'000) ++count;
    return count;
  }

  Clock::time_point now_{seconds(1000)};
  ConnectionRules rules_{{.max_resets = 10}, now_};
  std::string passed_;
  bool may_begin_ = true;
  bool waits_ = false;
  std::string rest_;
};

TEST_F(Rules, PassWhatAnHonestClientSends) {
  const std::string bytes = frame_bytes(FrameType::kSettings, 0, 0, std::string(18, 's')) +
                            frame_bytes(FrameType::kHeaders, 0, 1, "h") +
                            frame_bytes(FrameType::kContinuation, kWhole, 1, "c") +
                            frame_bytes(FrameType::kData, kFlagEndStream, 1, std::string(90, 'd')) +
                            frame_bytes(FrameType::kWindowUpdate, 0, 0, "1234") +
                            frame_bytes(FrameType::kPing, kFlagAck, 0, "12345678");
  EXPECT_EQ(take(bytes), "");
  EXPECT_EQ(passed_, bytes);
  EXPECT_EQ(rules_.open_streams(), 1u);
  answer(1);
  EXPECT_EQ(rules_.open_streams(), 0u);
  EXPECT_EQ(rules_.answered(), 1u);
}

TEST_F(Rules, KeepWhatReceiversIgnoreFromPassing) {
  EXPECT_EQ(take(FrameType::kPriority, 0, 1, "12345"), "");
  EXPECT_EQ(take(kUnknown, 0, 1, std::string(1000, 'u')), "");
  EXPECT_EQ(passed_, "");
  EXPECT_EQ(begin(1), "");
  EXPECT_EQ(passed_, frame_bytes(FrameType::kHeaders, kWhole, 1, "h"));
}

TEST_F(Rules, BoundPingsThatWaitForTheirAnswers) {
  const std::string ping = frame_bytes(FrameType::kPing, 0, 0, "12345678");
  const std::string answer = frame_bytes(FrameType::kPing, kFlagAck, 0, "12345678");
  for (std::uint32_t i = 0; i < 2 * ConnectionRules::kMaxPings; ++i) {
    ASSERT_EQ(take(ping), "");
    rules_.sent(answer);
  }
  EXPECT_EQ(count_until_closed(ping), static_cast<int>(ConnectionRules::kMaxPings));
}

TEST_F(Rules, BoundTheFramesOfAHeaderBlock) {
  EXPECT_EQ(take(FrameType::kHeaders, 0, 1, "h"), "");
  for (std::uint32_t i = 0; i < ConnectionRules::kMaxContinuations; ++i)
    ASSERT_EQ(take(FrameType::kContinuation, 0, 1, "c"), "");
  EXPECT_EQ(take(FrameType::kContinuation, kWhole, 1, "c"), "continuations");
}

TEST_F(Rules, BoundTheBytesOfAHeaderBlock) {
  EXPECT_EQ(take(FrameType::kHeaders, 0, 1, std::string(16'384, 'h')), "");
  EXPECT_EQ(take(FrameType::kContinuation, 0, 1, std::string(16'384, 'c')), "");
  EXPECT_EQ(take(FrameType::kContinuation, kWhole, 1, "c"), "header_block");
}

TEST_F(Rules, BoundTheBytesOfHeadersInOneFrame) {
  EXPECT_EQ(
      take(FrameType::kHeaders, kWhole, 1, std::string(ConnectionRules::kMaxHeaderBytes + 1, 'h')),
      "header_block");
}

TEST_F(Rules, LetNothingIntoAHeaderBlock) {
  EXPECT_EQ(take(FrameType::kHeaders, 0, 1, "h"), "");
  EXPECT_EQ(take(FrameType::kData, 0, 1, "d"), "unexpected_frame");
}

TEST_F(Rules, ExpectNoFramesThatOnlyServersSend) {
  EXPECT_EQ(ConnectionRules(rules_)
                .received(frame_bytes(FrameType::kPushPromise, 0, 1, "p"), passed_, now_,
                          [] { return true; })
                .violation->cause,
            std::string("unexpected_frame"));
  EXPECT_EQ(begin(2), "unexpected_frame");
}

TEST_F(Rules, HoldACallUntilItMayBegin) {
  const std::string before = frame_bytes(FrameType::kWindowUpdate, 0, 0, "1234");
  const std::string call = frame_bytes(FrameType::kHeaders, kWhole, 1, "h");
  const std::string after = frame_bytes(FrameType::kData, kFlagEndStream, 1, "d");
  may_begin_ = false;
  EXPECT_EQ(take(before + call + after), "");
  EXPECT_TRUE(waits_);
  EXPECT_EQ(passed_, before);
  EXPECT_EQ(rules_.open_streams(), 0u);
  const std::string rest = rest_;
  EXPECT_EQ(take(rest), "");
  EXPECT_TRUE(waits_);
  EXPECT_EQ(rest_, rest);
  may_begin_ = true;
  EXPECT_EQ(take(rest), "");
  EXPECT_FALSE(waits_);
  EXPECT_EQ(passed_, before + call + after);
}

TEST_F(Rules, BoundStreamsThatDoNotEnd) {
  std::uint32_t stream = 1;
  for (std::size_t i = 0; i < ConnectionRules::kMaxOpen; ++i, stream += 2)
    ASSERT_EQ(begin(stream), "") << i;
  answer(1);
  EXPECT_EQ(begin(stream), "");
  EXPECT_EQ(begin(stream + 2), "calls_without_end");
}

TEST_F(Rules, BoundResetsInASecond) {
  std::uint32_t stream = 1;
  const auto reset_ten = [&] {
    for (int i = 0; i < 10; ++i, stream += 2) {
      ASSERT_EQ(begin(stream), "");
      ASSERT_EQ(reset(stream), "");
    }
  };
  reset_ten();
  EXPECT_EQ(rules_.resets(), 10u);
  now_ += seconds(1);
  reset_ten();
  now_ += milliseconds(999);
  EXPECT_EQ(begin(stream), "");
  EXPECT_EQ(reset(stream), "resets");
}

TEST_F(Rules, ForgetResetsOfAPastSecond) {
  EXPECT_EQ(begin(1), "");
  EXPECT_EQ(reset(1), "");
  rules_.pass_time(now_ + milliseconds(999));
  EXPECT_EQ(rules_.resets(), 1u);
  rules_.pass_time(now_ + seconds(1));
  EXPECT_EQ(rules_.resets(), 0u);
}

TEST_F(Rules, BoundNeitherResetsNorStreamsAtZero) {
  ConnectionRules lenient({.max_resets = 0}, now_);
  const auto receive = [&](const std::string& bytes) {
    return lenient.received(bytes, passed_, now_, [] { return true; }).violation;
  };
  for (std::uint32_t stream = 1; stream < 8 * ConnectionRules::kMaxOpen; stream += 2) {
    ASSERT_FALSE(receive(frame_bytes(FrameType::kHeaders, kWhole, stream, "h")));
    if (stream % 4 != 1) continue;
    ASSERT_FALSE(receive(frame_bytes(FrameType::kReset, 0, stream, "1234")));
  }
}

TEST_F(Rules, BoundFramesThatCostTheirSenderLess) {
  const auto credit = static_cast<int>(ConnectionRules::kMaxCredit);
  EXPECT_EQ(count_until_closed(frame_bytes(FrameType::kWindowUpdate, 0, 0, "1234")), credit);
}

TEST_F(Rules, BoundSettingsMore) {
  EXPECT_LE(count_until_closed(frame_bytes(FrameType::kSettings, 0, 0, "")), 512);
}

TEST_F(Rules, BoundEmptyData) {
  EXPECT_EQ(begin(1), "");
  EXPECT_LE(count_until_closed(frame_bytes(FrameType::kData, 0, 1, "")), 8192);
}

TEST_F(Rules, BoundResetsOfNoStream) {
  EXPECT_LE(count_until_closed(frame_bytes(FrameType::kReset, 0, 1, "1234")), 8192);
}

TEST_F(Rules, LetAClientAnswerDataWithWindowUpdates) {
  const std::string update = frame_bytes(FrameType::kWindowUpdate, 0, 0, "1234");
  const std::string data = frame_bytes(FrameType::kData, 0, 1, std::string(16'384, 'd'));
  for (int i = 0; i < 20'000; ++i) {
    rules_.sent(data);
    ASSERT_EQ(take(update + update), "") << i;
  }
}

TEST_F(Rules, GiveCreditWithTime) {
  const std::string update = frame_bytes(FrameType::kWindowUpdate, 0, 0, "1234");
  for (int i = 0; i < 20'000; ++i) {
    now_ += milliseconds(1);
    ASSERT_EQ(take(update), "") << i;
  }
}

TEST_F(Rules, KnowWhetherAFrameOfTheServerIsCut) {
  const std::string data = frame_bytes(FrameType::kData, 0, 1, "dd");
  rules_.sent(data.substr(0, 10));
  EXPECT_FALSE(rules_.sent_whole_frames());
  rules_.sent(data.substr(10));
  EXPECT_TRUE(rules_.sent_whole_frames());
}

}  // namespace
}  // namespace weft::server::testing
