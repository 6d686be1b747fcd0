// SPDX-License-Identifier: Apache-2.0
// A function as a job of a queue.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "server/job_queue.h"

namespace weft::server {

// REQUIRES: the function does not throw.
class Work final : public JobQueue::Job {
 public:
  explicit Work(std::function<void()> function) : function_(std::move(function)) {}
  void run(JobQueue::Lane) noexcept override { function_(); }

 private:
  std::function<void()> function_;
};

inline bool push(JobQueue& queue, std::function<void()> function) {
  return queue.push(std::make_shared<Work>(std::move(function)));
}

}  // namespace weft::server
