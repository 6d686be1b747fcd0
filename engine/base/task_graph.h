// SPDX-License-Identifier: Apache-2.0
// Tasks that wait for one another, and their execution on an arena.
//
//   TaskGraph graph(3);
//   graph.add_dependency(0, 2);
//   graph.add_dependency(1, 2);
//   GraphRun run(std::move(graph), arena, 4, [](std::uint32_t task) { ... });
//   run.start();
//   while (run.step()) {}
//
// A task becomes ready when all that it waits for are done; of the ready ones the one that is
// needed first runs first (TaskGraph::set_needs), and of equal ones the one with the lowest number.
// There is no barrier: a slow or preempted task holds back only what depends on it.
//
// The hold (`begin_up_to`): what makes parts that leave in order keeps its results in memory until
// they have left. So a task that is needed by parts far ahead of the next one does not begin while
// the caller of `step` does something else, sends a part, say: a reader who stalls stops the tasks.
// While the caller waits in `step`, tasks may begin further ahead, but there is a bound, too:
// otherwise many threads would begin whatever is ready. Beyond it the first ready task begins only
// if no other one is at work. So tasks cannot wait for ever: if the caller waits in `step`, either
// a task is at work, or none is ready, and then all are done, or held, or wait for one another.
//
// Fairness: a thread gives the arena's slot back after kSlice and queues for the next, so the jobs
// of an arena take turns. It wakes who waits in `step` then, and not in between: waking it for each
// part of a mesh took two threads 1.5 % of their time at 1 M triangles.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "engine/base/arena.h"

namespace weft {

class TaskGraph {
 public:
  explicit TaskGraph(std::uint32_t tasks) : waits_for_(tasks, 0) {}

  // `after` runs once `before` is done.
  void add_dependency(std::uint32_t before, std::uint32_t after) {
    edges_.push_back({before, after});
    ++waits_for_[after];
  }
  // `task` also waits for a call of GraphRun::release.
  void hold(std::uint32_t task) { ++waits_for_[task]; }
  // Per task, the first part that needs it, for tasks that make parts of something that leaves in
  // order. DEFAULT: all are needed by the first one.
  void set_needs(std::vector<std::uint32_t> needs) { needs_ = std::move(needs); }

  struct Edge {
    std::uint32_t before, after;
  };
  std::uint32_t size() const { return static_cast<std::uint32_t>(waits_for_.size()); }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& needs() const { return needs_; }  // none if not set

 private:
  friend class GraphRun;

  std::vector<std::uint32_t> waits_for_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> needs_;
};

// Runs the tasks of a graph, on at most `threads` threads of an arena; without one, on the caller's
// own thread, in `step`.
class GraphRun {
 public:
  // The task must not throw.
  using Task = std::function<void(std::uint32_t)>;

  GraphRun(const TaskGraph& graph, Arena* arena, int threads, Task task);
  // Waits for the tasks that run; those that have not begun are dropped.
  ~GraphRun();
  GraphRun(const GraphRun&) = delete;
  GraphRun& operator=(const GraphRun&) = delete;

  // Call once.
  void start();

  // The last parts whose tasks may begin: while the caller is not in `step`, and while it waits
  // there. Neither falls. DEFAULT: the first. Thread-safe.
  void begin_up_to(std::uint32_t while_away, std::uint32_t while_waiting);

  // No task begins any more. Thread-safe.
  void stop();

  // One thing less that `task` waits for. Thread-safe.
  void release(std::uint32_t task);

  // Drops a task for which there is nothing to do: what waits for it waits no longer, though others
  // that it would have waited for may not be done. To be called by a task that `task` waits for;
  // of several that wait for one another, the last first.
  void skip(std::uint32_t task);

  // Goes on until something was done, or `notify` was called: without an arena, runs a task. False
  // once all tasks are done, or nothing runs that could make another one ready, or after `stop`.
  bool step();
  std::uint64_t bytes() const;
  // Whether ready tasks were given up because no thread could be started for them.
  bool starved() const { return starved_; }
  // Since when no thread works, if none does; always, without an arena.
  std::optional<std::chrono::steady_clock::time_point> idle_since();
  // Makes `step` return, when the slice of a thread at work ends. To be called by a task.
  void notify();

 private:
  // Of pairs in one word: the first part that needs a task, and the task.
  using Ready = std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>>;
  static constexpr std::chrono::milliseconds kSlice{2};

  void start_threads(std::unique_lock<std::mutex>& lock, std::size_t most);
  void start_thread();
  void end_thread();
  void work();
  void run(std::uint32_t task);
  void finish(std::uint32_t task);
  std::uint64_t keyed(std::uint32_t task) const {
    return needs_.empty() ? task : std::uint64_t{needs_[task]} << 32 | task;
  }
  bool may_begin(int others) const;
  std::uint32_t take_ready();
  bool satisfied(std::uint32_t task) {
    return waits_for_[task].fetch_sub(1, std::memory_order_acq_rel) == 1;
  }

  Arena* const arena_;
  const int threads_;
  const Task task_;
  std::vector<std::uint32_t> first_successor_;  // per task, and one more: into successors_
  std::vector<std::uint32_t> successors_;
  std::vector<std::atomic<std::uint32_t>> waits_for_;
  const std::vector<std::uint32_t> needs_;
  std::vector<char> skipped_;  // per task, written before the task can become ready

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  Ready ready_;
  int running_ = 0;  // threads that work, or are queued for
  std::chrono::steady_clock::time_point idle_since_;
  bool starved_ = false;
  std::uint32_t while_away_ = 0;
  std::uint32_t while_waiting_ = 0;
  bool waiting_ = false;  // the caller, in `step`
  bool notified_ = false;
  bool stopping_ = false;
};

}  // namespace weft
