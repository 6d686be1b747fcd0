// SPDX-License-Identifier: Apache-2.0
// What tests put into a RunQueue.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/run/run_queue.h"
#include "tests/support/event.h"

namespace weft::server {

class Task final : public RunQueue::Item {
 public:
  explicit Task(std::function<void(RunQueue::Slot&)> work) : work_(std::move(work)) {}
  void run(RunQueue::Slot& slot) noexcept override { work_(slot); }

 private:
  std::function<void(RunQueue::Slot&)> work_;
};

inline std::shared_ptr<Task> make_task(std::function<void()> work) {
  return std::make_shared<Task>([work = std::move(work)](RunQueue::Slot&) { work(); });
}
inline std::shared_ptr<Task> make_slotted(std::function<void(RunQueue::Slot&)> work) {
  return std::make_shared<Task>(std::move(work));
}
inline bool pushed(RunQueue& queue, std::shared_ptr<Task> task, const char* client,
                   std::uint64_t estimate = 0) {
  return !queue.push(std::move(task), {.client = client, .estimate = estimate});
}
inline bool pushed(RunQueue& queue, std::shared_ptr<Task> task) {
  return pushed(queue, std::move(task), "");
}

// A slot that is busy until `release`, so that what is pushed meanwhile waits.
struct Busy {
  Event runs;
  Event release;
  void occupy(RunQueue& queue, const char* client = "", std::uint64_t estimate = 0) {
    ASSERT_TRUE(pushed(queue, make_task([this] {
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
  using Work = std::function<void(RunQueue::Slot&)>;

  explicit ListSource(RunQueue& queue) : queue_(queue) { queue_.attach(*this); }
  ~ListSource() override { queue_.detach(); }

  void add(const char* client, std::uint64_t estimate, Work work) {
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
    const Work work = std::move(found->second);
    runs_.erase(found);
    lock.unlock();
    work(slot);
  }

  int asked() const { return asked_; }

 private:
  RunQueue& queue_;
  std::mutex mutex_;
  std::vector<std::pair<RunQueue::Ticket, Work>> runs_;
  std::atomic<int> asked_{0};
};

}  // namespace weft::server
