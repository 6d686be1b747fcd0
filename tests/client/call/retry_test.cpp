// SPDX-License-Identifier: Apache-2.0
#include "client/call/retry.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/client/support/fake_jobs.h"

namespace weft::client {
namespace {

using std::chrono::milliseconds;

const grpc::Status kAway(grpc::StatusCode::UNAVAILABLE, "gone");

// Waits by noting for how long.
class RetryRules : public ::testing::Test {
 protected:
  RetryOptions options(std::uint32_t attempts) {
    RetryOptions options;
    options.attempts = attempts;
    options.wait = [this](milliseconds time) {
      waits_.push_back(time.count());
      return true;
    };
    return options;
  }
  void expect_about(std::int64_t wait, std::int64_t expected) {
    EXPECT_GE(wait, expected * 3 / 4);
    EXPECT_LE(wait, expected * 5 / 4 + 1);
  }

  std::vector<std::int64_t> waits_;
};

TEST_F(RetryRules, TryAgainSoOftenAndNoMoreWhileTheServerIsAway) {
  Retry retry(options(3));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(retry.again(kAway));
  EXPECT_FALSE(retry.again(kAway));
  EXPECT_EQ(waits_.size(), 3u);
}

TEST_F(RetryRules, CountFromNothingWhenSomethingCame) {
  Retry retry(options(1));
  EXPECT_TRUE(retry.again(kAway));
  retry.restart();
  EXPECT_TRUE(retry.again(kAway));
  EXPECT_FALSE(retry.again(kAway));
}

TEST_F(RetryRules, TakeEveryOtherCodeForFinal) {
  Retry retry(options(3));
  EXPECT_FALSE(retry.again(grpc::Status::OK));
  for (int code = 1; code <= 16; ++code) {
    const bool away = code == grpc::StatusCode::UNAVAILABLE;
    EXPECT_EQ(retry.again({static_cast<grpc::StatusCode>(code), ""}), away) << code;
  }
}

TEST_F(RetryRules, WaitTwiceAsLongEachTimeUpToAMost) {
  RetryOptions some = options(40);
  some.first_wait = milliseconds(100);
  some.longest_wait = milliseconds(1000);
  Retry retry(some);
  for (int i = 0; i < 40; ++i) EXPECT_TRUE(retry.again(kAway));
  for (std::size_t i = 0; i < 4; ++i) expect_about(waits_[i], 100 << i);
  for (std::size_t i = 4; i < 40; ++i) expect_about(waits_[i], 1000);
}

TEST_F(RetryRules, WaitAsLongAsTheServerAsks) {
  Retry retry(options(3));
  EXPECT_TRUE(retry.again(queue_full(20'500)));
  EXPECT_GE(waits_[0], 20'500);
  EXPECT_LE(waits_[0], 25'626);
}

TEST_F(RetryRules, WaitNoLongerThanAServerMayAsk) {
  Retry retry(options(3));
  EXPECT_TRUE(retry.again(queue_full(std::int64_t{1} << 62)));
  EXPECT_LE(waits_[0], 75'000);
  EXPECT_TRUE(retry.again(queue_full(-(std::int64_t{1} << 62))));
  EXPECT_LE(waits_[1], 251);
}

TEST_F(RetryRules, GiveUpRatherThanWaitPastTheDeadline) {
  RetryOptions some = options(3);
  some.first_wait = some.longest_wait = std::chrono::hours(1);
  some.deadline = std::chrono::system_clock::now() + std::chrono::minutes(1);
  EXPECT_FALSE(Retry(some).again(kAway));
  EXPECT_TRUE(waits_.empty());
}

TEST_F(RetryRules, GiveUpWhenTheWaitIsCutShort) {
  RetryOptions some = options(3);
  some.wait = [](milliseconds) { return false; };
  EXPECT_FALSE(Retry(some).again(kAway));
}

TEST_F(RetryRules, TellOfTheFirstFailureInARowOnly) {
  RetryOptions some = options(5);
  std::vector<std::string> told;
  some.on_wait = [&told](const grpc::Status& status) { told.push_back(status.error_message()); };
  Retry retry(some);
  EXPECT_TRUE(retry.again(kAway));
  EXPECT_TRUE(retry.again(kAway));
  retry.restart();
  EXPECT_TRUE(retry.again({grpc::StatusCode::UNAVAILABLE, "gone again"}));
  EXPECT_EQ(told, (std::vector<std::string>{"gone", "gone again"}));
}

}  // namespace
}  // namespace weft::client
