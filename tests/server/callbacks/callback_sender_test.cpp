// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callback_sender.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <optional>
#include <set>

#include "server/callbacks/webhook_signature.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/callbacks/receiver.h"
#include "tests/support/event.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;
using testing::answer_of;
using testing::Received;
using testing::Receiver;

constexpr const char* kSecret = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";

// No test waits for the pauses of real life.
SenderOptions quick() {
  return {.first_delay = milliseconds(1), .limits = {.total = std::chrono::hours(1)}};
}

class CallbackSenderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "secrets") << "* " << kSecret << "\n";
    auto opened = Callbacks::open({.clients = (folder_ / "secrets").string(),
                                   .allowed = {Network::parse("127.0.0.0/8").value()}},
                                  make_logger("off"));
    ASSERT_TRUE(opened) << opened.error();
    callbacks_ = std::move(*opened);
    open_store();
  }

  void open_store() {
    auto opened = SqliteStore::open({.folder = (folder_ / "store").string()});
    ASSERT_TRUE(opened) << opened.error().message;
    store_ = std::move(*opened);
  }
  void start(const SenderOptions& options = quick()) {
    sender_.emplace(CallbackSender::Parts{*callbacks_, *store_, make_logger("off"),
                                          [this](const char* outcome) { count(outcome); }},
                    options);
  }

  // A job that was cancelled, which is an end as good as any.
  std::string ended_job(const std::string& owner, const std::string& url) {
    const auto callback = callbacks_->accept(owner, url);
    EXPECT_TRUE(callback) << callback.error();
    const auto submitted =
        store_->submit({.owner = owner, .key = std::string(32, 'k'), .callback = *callback});
    EXPECT_TRUE(store_->cancel(owner, submitted->job.id)->has_value());
    if (sender_) sender_->wake();
    return submitted->job.id;
  }
  Callback callback_of(const std::string& owner, const std::string& id) {
    return store_->get(owner, id)->value().callback;
  }
  // The callback in its final state.
  Callback wait(const std::string& owner, const std::string& id) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      const Callback callback = callback_of(owner, id);
      if (callback.state == CallbackState::kDelivered || callback.state == CallbackState::kFailed)
        return callback;
      std::this_thread::sleep_for(milliseconds(2));
    }
    ADD_FAILURE() << "the callback is not settled";
    return {};
  }

  void count(const std::string& outcome) {
    const std::lock_guard lock(mutex_);
    ++outcomes_[outcome];
  }

  const files::TempFolder folder_;
  std::unique_ptr<Callbacks> callbacks_;
  std::unique_ptr<JobStore> store_;
  std::mutex mutex_;  // guards the one below
  std::map<std::string, int> outcomes_;
  std::optional<CallbackSender> sender_;
};

TEST_F(CallbackSenderTest, TellsOfAJobWithItsSignature) {
  const Receiver receiver([](const Received&) { return answer_of(200); });
  start();
  const std::string id = ended_job("ann", receiver.url());
  const Callback callback = wait("ann", id);
  EXPECT_EQ(callback.state, CallbackState::kDelivered);
  EXPECT_EQ(callback.error, "");
  ASSERT_EQ(receiver.all().size(), 1U);
  const Received request = receiver.all().front();
  EXPECT_EQ(request.headers.at("webhook-id"), id);
  EXPECT_EQ(request.headers.at("webhook-signature"),
            webhook_signature(*webhook_key(kSecret), id, request.headers.at("webhook-timestamp"),
                              request.body));
  EXPECT_NE(request.body.find("\"state\": \"JOB_STATE_CANCELLED\""), std::string::npos)
      << request.body;
  EXPECT_NE(request.body.find("\"" + id + "\""), std::string::npos);
  EXPECT_EQ(request.body.find("\"callback\""), std::string::npos);
}

TEST_F(CallbackSenderTest, TriesAgainUntilTheAnswerIsSuccess) {
  std::atomic<int> asked{0};
  const Receiver receiver([&](const Received&) {
    const int status[] = {500, 302, 404, 200};
    return answer_of(status[std::min(asked++, 3)]);
  });
  start();
  const std::string id = ended_job("ann", receiver.url());
  const Callback callback = wait("ann", id);
  EXPECT_EQ(callback.state, CallbackState::kDelivered);
  EXPECT_EQ(callback.attempts, 4U);
  std::set<std::string> ids;
  for (const Received& request : receiver.all()) ids.insert(request.headers.at("webhook-id"));
  EXPECT_EQ(ids, std::set<std::string>{id});
  sender_->stop();
  EXPECT_EQ(outcomes_, (std::map<std::string, int>{{"delivered", 1}, {"put_off", 3}}));
}

TEST_F(CallbackSenderTest, GivesUpWhatIsGoneAndWhatItMayNotReach) {
  const Receiver gone([](const Received&) { return answer_of(410); });
  start();
  const Callback at_gone = wait("ann", ended_job("ann", gone.url()));
  EXPECT_EQ(at_gone.state, CallbackState::kFailed);
  EXPECT_EQ(at_gone.error, "the answer has status 410");
  const auto forbidden = store_->submit({.owner = "ann",
                                         .key = std::string(32, 'k'),
                                         .callback = {.url = "http://10.1.2.3/", .place = "p"}});
  ASSERT_TRUE(*store_->cancel("ann", forbidden->job.id));
  sender_->wake();
  const Callback refused = wait("ann", forbidden->job.id);
  EXPECT_EQ(refused.state, CallbackState::kFailed);
  EXPECT_EQ(refused.attempts, 1U);
}

TEST_F(CallbackSenderTest, GivesUpAfterTheLastAttempt) {
  const Receiver receiver([](const Received&) { return answer_of(500); });
  const std::string id = ended_job("ann", receiver.url());
  for (std::uint32_t i = 1; i < kMaxCallbackAttempts; ++i) {
    const auto claimed = store_->claim_callback(milliseconds(1000), {}, {});
    ASSERT_TRUE(claimed && *claimed);
    ASSERT_TRUE(store_->settle_callback(**claimed, CallbackState::kPending, "", milliseconds(0)));
  }
  start();
  const Callback callback = wait("ann", id);
  EXPECT_EQ(callback.state, CallbackState::kFailed);
  EXPECT_EQ(callback.attempts, kMaxCallbackAttempts);
  EXPECT_EQ(callback.error, "the answer has status 500");
}

TEST_F(CallbackSenderTest, AReceiverThatNeverAnswersHoldsBackNobodyElse) {
  const Receiver silent([](const Received&) { return ""; });
  const Receiver quick_one([](const Received&) { return answer_of(200); });
  start();
  std::vector<std::string> stuck;
  for (int i = 0; i < 20; ++i) stuck.push_back(ended_job("ann", silent.url()));
  ASSERT_TRUE(silent.wait_for(4));
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(wait("ann", ended_job("ann", quick_one.url())).state, CallbackState::kDelivered);
  EXPECT_EQ(silent.all().size(), 4U);
  for (const std::string& id : stuck)
    EXPECT_NE(callback_of("ann", id).state, CallbackState::kDelivered);
}

TEST_F(CallbackSenderTest, AClientWhoseReceiversNeverAnswerHoldsBackNoOtherClient) {
  std::vector<std::unique_ptr<Receiver>> silent;
  for (int i = 0; i < 8; ++i)
    silent.push_back(std::make_unique<Receiver>([](const Received&) { return ""; }));
  const Receiver quick_one([](const Received&) { return answer_of(200); });
  SenderOptions options = quick();
  options.at_once = 8;
  options.of_place = 1;
  options.of_client = 6;
  start(options);
  for (const auto& each : silent) ended_job("eve", each->url());
  EXPECT_EQ(wait("ann", ended_job("ann", quick_one.url())).state, CallbackState::kDelivered);
}

TEST_F(CallbackSenderTest, WhatWasBeingSentWhenItStoppedIsSentByTheNext) {
  std::atomic<bool> answers{false};
  const Receiver receiver([&](const Received&) { return answers ? answer_of(200) : ""; });
  start();
  const std::string id = ended_job("ann", receiver.url());
  ASSERT_TRUE(receiver.wait_for(1));
  sender_.reset();
  EXPECT_EQ(callback_of("ann", id).state, CallbackState::kPending);
  answers = true;
  start();
  EXPECT_EQ(wait("ann", id).state, CallbackState::kDelivered);
  EXPECT_EQ(receiver.all().size(), 2U);
}

TEST(CallbackDelay, GrowsToAnHourAndVariesByHalf) {
  using std::chrono::seconds;
  EXPECT_EQ(callback_delay(seconds(1), 1, 1), seconds(1));
  EXPECT_EQ(callback_delay(seconds(1), 1, 0), milliseconds(500));
  EXPECT_EQ(callback_delay(seconds(1), 5, 1), seconds(16));
  EXPECT_EQ(callback_delay(seconds(1), 12, 1), seconds(2048));
  EXPECT_EQ(callback_delay(seconds(1), 13, 1), kLongestCallbackDelay);
  EXPECT_EQ(callback_delay(seconds(1), 4'000'000'000, 0), kLongestCallbackDelay / 2);
  milliseconds least{0};
  milliseconds most{0};
  for (std::uint32_t attempt = 1; attempt < kMaxCallbackAttempts; ++attempt) {
    least += callback_delay(seconds(1), attempt, 0);
    most += callback_delay(seconds(1), attempt, 1);
  }
  EXPECT_GT(least, std::chrono::hours(11));
  EXPECT_LT(most, std::chrono::hours(25));
}

}  // namespace
}  // namespace weft::server
