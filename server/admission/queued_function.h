// SPDX-License-Identifier: Apache-2.0
// A function as an item of a queue.
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "server/admission/work_queue.h"

namespace weft::server {

// REQUIRES: the function does not throw.
class QueuedFunction final : public WorkQueue::Item {
 public:
  explicit QueuedFunction(std::function<void()> function) : function_(std::move(function)) {}
  void run(WorkQueue::Place&) noexcept override { function_(); }

 private:
  std::function<void()> function_;
};

inline bool push(WorkQueue& queue, std::function<void()> function) {
  return queue.push(std::make_shared<QueuedFunction>(std::move(function)));
}

}  // namespace weft::server
