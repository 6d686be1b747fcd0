// SPDX-License-Identifier: Apache-2.0
// What tests put into a RunQueue.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/run/run_queue.h"
#include "tests/support/event.h"

namespace weft::server {

// A run that does not look at its slot.
inline RunQueue::Work plain(std::function<void()> work) {
  return [work = std::move(work)](RunQueue::Slot&) { work(); };
}
inline bool pushed(RunQueue& queue, RunQueue::Work work, const char* client = "",
                   std::uint64_t estimate = 0) {
  return !queue.push({.client = client, .estimate = estimate}, std::move(work));
}

// A slot that is busy until `release`, so that what is pushed meanwhile waits.
struct Busy {
  Event runs;
  Event release;
  void occupy(RunQueue& queue, const char* client = "", std::uint64_t estimate = 0) {
    ASSERT_TRUE(pushed(queue, plain([this] {
                         runs.set();
                         EXPECT_TRUE(release.wait());
                       }),
                       client, estimate));
    ASSERT_TRUE(runs.wait());
  }
};

// Runs that wait in a list, the first first.
class ListSource final : public RunQueue::Source {
 public:
  explicit ListSource(RunQueue& queue) : queue_(queue) { queue_.attach(*this); }
  ~ListSource() override { queue_.detach(); }

  void add(const char* client, std::uint64_t estimate, RunQueue::Work work) {
    {
      std::lock_guard lock(mutex_);
      runs_.push_back({{client, estimate}, std::move(work)});
    }
    queue_.wake();
  }

  void run_next(RunQueue::Slot& slot) noexcept override {
    const std::vector<std::string> full = slot.full_clients();
    std::unique_lock lock(mutex_);
    ++asked_;
    const auto found = std::ranges::find_if(runs_, [&](const auto& run) {
      return run.first.estimate <= slot.max_estimate() &&
             std::ranges::find(full, run.first.client) == full.end();
    });
    if (found == runs_.end()) return;
    if (!slot.admit(found->first)) return;
    const RunQueue::Work work = std::move(found->second);
    runs_.erase(found);
    lock.unlock();
    work(slot);
  }

  int asked() const { return asked_; }

 private:
  RunQueue& queue_;
  std::mutex mutex_;
  std::vector<std::pair<RunQueue::Ticket, RunQueue::Work>> runs_;
  std::atomic<int> asked_{0};
};

}  // namespace weft::server
