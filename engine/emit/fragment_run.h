// SPDX-License-Identifier: Apache-2.0
// Runs graphs of tasks that build fragments of the mesh, and sends the fragments in their order on
// the caller's thread while the tasks go on. Tasks run no further ahead of the next fragment than
// fragments_ahead and fragments_begun allow (parallel/task_graph.h).
//
//   FragmentRun fragments(delivery, context);
//   fragments.run(name, std::move(graph), 0, n, task_of_fragment, [&](std::uint32_t task) {
//     ... fragments.finish(index, build_fragment()) or fragments.stop(error) ...
//   });
//   if (fragments.error()) return *fragments.error();
//
// Errors: the first one ends the run, be it of a task, of the sink or what a task throws; tasks
// that have not begun are skipped. kOutOfMemory also if no thread could be started.
//
// Thread-safety: `finish`, `skip`, `end_hold`, `stop` and `stopped` may be called from tasks, the
// rest only between runs.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/held_bytes.h"
#include "engine/base/trace.h"
#include "engine/emit/delivery.h"
#include "engine/emit/fragment.h"
#include "engine/parallel/task_graph.h"
#include "weft/error.h"

namespace weft {

class FragmentRun {
 public:
  FragmentRun(Delivery& delivery, ExecutionContext& context)
      : delivery_(delivery), context_(context) {}

  // Runs all tasks, and sends fragments `first` to `last` - 1. `task_of_fragment` returns the task
  // that makes a fragment: tasks far ahead of the next fragment are held back.
  void run(const Trace::GraphName& name, TaskGraph graph, std::uint32_t first, std::uint32_t last,
           std::uint32_t (*task_of_fragment)(std::uint32_t),
           const std::function<void(std::uint32_t)>& task);

  // Gives a fragment to be sent; nullopt if the context stopped the run.
  void finish(std::uint32_t index, std::optional<Fragment>&& fragment);
  // As GraphRun::skip, for the running graph.
  void skip(std::uint32_t task) { run_->skip(task); }
  // Lets tasks begin however far ahead they are: for now, no fragment is sent beyond those whose
  // tasks have begun.
  void end_hold();
  void stop(const Error& error);

  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  const std::optional<Error>& error() const { return error_; }
  // Time in the sink while there was nothing else to do.
  double blocked_seconds() const { return blocked_seconds_; }
  // Of fragments that waited to be sent, and of the running graph.
  std::uint64_t peak_bytes() const { return waiting_.peak() + graph_bytes_; }

 private:
  struct Pending {
    std::atomic<bool> ready{false};
    std::unique_ptr<Fragment> fragment;  // from when it is ready until it is sent
  };

  void run_task(std::uint32_t t, const std::function<void(std::uint32_t)>& task);
  void send(Pending& pending, GraphRun& run);

  Delivery& delivery_;
  ExecutionContext& context_;
  std::vector<Pending> fragments_;
  std::atomic<std::uint32_t> next_{0};  // to be sent
  HeldBytes waiting_;
  std::uint64_t graph_bytes_ = 0;
  double blocked_seconds_ = 0;
  GraphRun* run_ = nullptr;  // the one at work

  std::atomic<bool> stopped_{false};
  std::mutex mutex_;  // guards the one below
  std::optional<Error> error_;
};

}  // namespace weft
