// SPDX-License-Identifier: Apache-2.0
// Slots, and threads that call the store, that one client leaves to others.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "server/store/job_store.h"
#include "tests/server/faulty_store.h"
#include "tests/server/job_harness.h"

namespace weft::server::testing {
namespace {

// Jobs of clients, submitted to the store itself. Those that look light turn out heavy; each run
// waits in its slot until all may end.
class SlotShare : public ::testing::Test {
 protected:
  void serve(const ServiceOptions& service) {
    server_.emplace(
        [this](const auto&, ChunkSink& sink, weft::Run& run) -> Result<Summary> {
          while (run.context().arena() == nullptr) {  // in a light slot
            if (auto error = run.poll()) return tl::unexpected(*error);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
          ++runs_;
          EXPECT_TRUE(all_may_end_.wait());
          --runs_;
          return send_chunks(sink, 1);
        },
        quick_jobs(), service,
        [this](std::unique_ptr<JobStore> store) {
          store_ = store.get();
          return store;
        });
  }

  static constexpr std::uint64_t kLight = 1;
  static constexpr std::uint64_t kHeavy = std::uint64_t{1} << 30;

  void submit(const std::string& owner, int number, std::uint64_t estimate = kHeavy) {
    std::string key(32, 'k');
    key[0] = static_cast<char>(number);
    const auto submitted = store_->submit({.owner = owner,
                                           .key = key,
                                           .request = numbered_request(number).SerializeAsString(),
                                           .estimate = estimate});
    ASSERT_TRUE(submitted) << submitted.error().message;
  }

  // So many run, and no more begin.
  bool settles_at(int runs) {
    const bool begun = eventually([&] { return runs_ == runs; });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return begun && runs_ == runs;
  }

  void end_all() {
    all_may_end_.set();
    EXPECT_TRUE(eventually([&] {
      const auto stats = store_->stats();
      return stats && stats->queued + stats->running == 0;
    }));
  }

  JobStore* store_ = nullptr;
  std::atomic<int> runs_{0};
  Event all_may_end_;
  std::optional<JobServer> server_;
};

TEST_F(SlotShare, LeavesSlotsToOthers) {
  serve({.jobs = 4, .client_share = 0.75});
  for (int i = 0; i < 6; ++i) submit("ann", i);
  EXPECT_TRUE(settles_at(3));
  submit("bob", 6);
  EXPECT_TRUE(settles_at(4));
  end_all();
}

TEST_F(SlotShare, HoldsForJobsThatTurnOutHeavyAndHoldsUpNobodyElse) {
  serve({.jobs = 2, .light_jobs = 1, .client_share = 0.5});
  submit("ann", 0);
  EXPECT_TRUE(settles_at(1));
  submit("ann", 1, kLight);
  EXPECT_TRUE(settles_at(1));
  submit("bob", 2);
  EXPECT_TRUE(settles_at(2));
  end_all();
}

TEST_F(SlotShare, IsNobodysIfClientsAreNotToldApart) {
  serve({.jobs = 4, .client_share = 0.75});
  for (int i = 0; i < 6; ++i) submit("", i);
  EXPECT_TRUE(settles_at(4));
  end_all();
}

// Eight threads call the store.
TEST(StoreThreads, AreLeftToOtherClients) {
  std::atomic<int> at_work{0};
  Event all_may_end;
  JobServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 1); },
                   quick_jobs(), ServiceOptions{.jobs = 1, .client_share = 0.5},
                   [&](std::unique_ptr<JobStore> store) -> std::unique_ptr<JobStore> {
                     return std::make_unique<FaultyStore>(std::move(store),
                                                          [&](std::string_view call) {
                                                            if (call == "list") {
                                                              ++at_work;
                                                              EXPECT_TRUE(all_may_end.wait());
                                                            }
                                                            return std::optional<StoreError>();
                                                          });
                   });
  std::vector<std::future<grpc::Status>> calls;
  for (int i = 0; i < 12; ++i)
    calls.push_back(
        std::async(std::launch::async, [&] { return server.client().list({}).status; }));
  EXPECT_TRUE(eventually([&] { return at_work == 4; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(at_work, 4);
  all_may_end.set();
  for (auto& call : calls) {
    const grpc::Status status = call.get();
    EXPECT_TRUE(status.ok()) << status.error_message();
  }
}

}  // namespace
}  // namespace weft::server::testing
