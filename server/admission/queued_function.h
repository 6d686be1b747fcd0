// SPDX-License-Identifier: Apache-2.0
// A function as an item of a queue.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/admission/work_queue.h"
#include "server/wire/errors.h"

namespace weft::server {

// REQUIRES: the function does not throw.
class QueuedFunction final : public WorkQueue::Item {
 public:
  explicit QueuedFunction(std::function<void()> function) : function_(std::move(function)) {}
  void run(WorkQueue::Place&) noexcept override { function_(); }

 private:
  std::function<void()> function_;
};

// Why a queue of calls did not take an item; nothing if it did.
inline std::optional<Failure> refusal_of(WorkQueue::Pushed pushed, const WorkQueue& queue) {
  switch (pushed) {
    case WorkQueue::Pushed::kYes:
      break;
    case WorkQueue::Pushed::kQueueFull:
      return Failure{Reason::kQueueFull, "",
                     fmt::format("{} calls wait already; this server's limit is {}",
                                 queue.capacity(), queue.capacity())};
    case WorkQueue::Pushed::kClientFull:
      return Failure{
          Reason::kQueueFull, "",
          fmt::format("{} calls of yours wait already; this server's limit for one client is {}",
                      queue.capacity_of_client(), queue.capacity_of_client())};
  }
  return std::nullopt;
}

// In the client's turn.
inline std::optional<Failure> push(WorkQueue& queue, std::string client,
                                   std::function<void()> function) {
  return refusal_of(queue.push(std::make_shared<QueuedFunction>(std::move(function)),
                               {.client = std::move(client)}),
                    queue);
}

}  // namespace weft::server
