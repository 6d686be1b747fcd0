// SPDX-License-Identifier: Apache-2.0
// Calls and stored jobs run in the same slots.
#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/store/job_store.h"
#include "tests/server/faulty_store.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

// Each run waits in its slot until it may end. Even numbers are calls, odd ones jobs.
class SharedSlots : public ::testing::Test {
 protected:
  void serve(
      std::uint32_t slots, const JobServer::Wrap& wrap = [](auto store) { return store; }) {
    server_.emplace(
        [this](const auto&, ChunkSink& sink, auto&) {
          const int now = ++running_;
          int most = most_;
          while (most < now && !most_.compare_exchange_weak(most, now)) continue;
          EXPECT_TRUE(may_end_.wait());
          --running_;
          ++ended_;
          return send_chunks(sink, 1);
        },
        quick_jobs(), ServiceOptions{.jobs = slots, .light_jobs = 0}, wrap);
  }

  void call(int number) {
    calls_.push_back(std::async(std::launch::async, [this, number] {
      return testing::call(*v1::MeshService::NewStub(server_->channel()), numbered_request(number))
          .status;
    }));
  }
  void submit(int number) { jobs_.push_back(server_->client().submit(numbered_request(number))); }

  void end_all() {
    may_end_.set();
    for (auto& call : calls_) {
      const grpc::Status status = call.get();
      EXPECT_TRUE(status.ok()) << status.error_message();
    }
    for (const std::string& job : jobs_)
      EXPECT_EQ(server_->client().wait(job).state(), v1::JOB_STATE_SUCCEEDED);
  }

  std::atomic<int> running_{0};
  std::atomic<int> most_{0};
  std::atomic<int> ended_{0};
  Event may_end_;
  std::optional<JobServer> server_;
  std::vector<std::future<grpc::Status>> calls_;
  std::vector<std::string> jobs_;
};

TEST_F(SharedSlots, AreNoMoreForBothThanForOne) {
  serve(2);
  for (int i = 0; i < 4; ++i) {
    submit(2 * i + 1);
    call(2 * i);
  }
  EXPECT_TRUE(eventually([&] { return running_ == 2; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(running_, 2);
  EXPECT_EQ(server_->metric("weft_running_jobs{queue=\"calls\"}") +
                server_->metric("weft_running_jobs{queue=\"jobs\"}"),
            2);
  end_all();
  EXPECT_EQ(most_, 2);
  EXPECT_EQ(ended_, 8);
}

TEST_F(SharedSlots, AreLeftToCallsByAStoreThatDoesNotAnswer) {
  std::atomic<bool> hangs{false};
  Event goes_on;
  serve(1, [&](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
    return std::make_unique<FaultyStore>(std::move(store), [&](std::string_view call) {
      if (call == "claim" && hangs) EXPECT_TRUE(goes_on.wait());
      return std::optional<StoreError>();
    });
  });
  call(0);
  EXPECT_TRUE(eventually([&] { return running_ == 1; }));
  submit(1);
  hangs = true;
  call(2);
  may_end_.set();
  EXPECT_TRUE(eventually([&] { return ended_ == 2; }));  // both calls
  hangs = false;
  goes_on.set();
  end_all();
}

}  // namespace
}  // namespace weft::server::testing
