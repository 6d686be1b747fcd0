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
// A task becomes ready when all tasks that it waits for are done. Among ready tasks, the one that
// is needed first runs first (TaskGraph::set_needs), then the one with the lowest number. There is
// no barrier: a slow or preempted task holds back only what depends on it.
//
// The chains (`set_costs`): if so many threads may work that the hold would let all tasks begin,
// the task with the most costly chain of tasks after it runs first instead, and nothing is held.
// Which tasks are done in which order does not change their results.
//
// The hold (`begin_up_to`): tasks that make fragments which leave in order keep their results in
// memory until these have left. So a task that is needed only by fragments far ahead of the next
// one does not begin while the caller of `step` does something else, such as sending a fragment: a
// reader that stalls stops the tasks. While the caller waits in `step`, tasks may begin further
// ahead, but only up to another bound, because otherwise many threads would begin whatever is
// ready. Beyond that bound, the first ready task begins only if no other task runs. So tasks cannot
// wait for ever: if the caller waits in `step`, either a task runs, or none is ready, and then all
// are done, or held, or wait for one another.
//
// Fairness: a thread gives the arena's slot back after kSlice and queues for the next, so the runs
// of an arena take turns. Only then does it wake the caller that waits in `step`: waking it for
// each fragment costs more.
//
// Errors: none; `starved` says whether no thread could be started. Thread-safety: a graph is built
// by one thread; the functions of a run say which may be called from tasks, the rest is the
// caller's.
#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/arena.h"
#include "engine/base/trace.h"

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
  // Per task, the first fragment that needs it, if the tasks make fragments that leave in order.
  // DEFAULT: the first fragment needs all tasks.
  void set_needs(std::vector<std::uint32_t> needs) { needs_ = std::move(needs); }
  // About how long each kind of task takes, at least 1; kinds repeat with the tasks' numbers. For
  // few tasks only, whose results may all be in memory. DEFAULT: chains do not matter.
  void set_costs(std::span<const std::uint8_t> costs) { costs_ = costs; }

  std::uint32_t size() const { return static_cast<std::uint32_t>(waits_for_.size()); }
  const std::vector<TaskEdge>& edges() const { return edges_; }
  const std::vector<std::uint32_t>& needs() const { return needs_; }  // empty if not set
  std::span<const std::uint8_t> costs() const { return costs_; }      // likewise

 private:
  friend class GraphRun;

  std::vector<std::uint32_t> waits_for_;
  std::vector<TaskEdge> edges_;
  std::vector<std::uint32_t> needs_;
  std::span<const std::uint8_t> costs_;
};

// In which order ready tasks run.
struct TaskRanks {
  std::vector<std::uint32_t> of;  // per task: the lowest first; empty if all are equal
  bool hold = true;               // ranks are fragments, which may be too far ahead
};
TaskRanks rank_tasks(std::size_t tasks, const std::vector<TaskEdge>& edges,
                     const std::vector<std::uint32_t>& needs, std::span<const std::uint8_t> costs,
                     int threads);

// Runs the tasks of a graph on at most `threads` threads of an arena; without an arena, on the
// caller's thread, in `step`.
class GraphRun {
 public:
  // The task must not throw.
  using Task = std::function<void(std::uint32_t)>;

  GraphRun(const TaskGraph& graph, Arena* arena, int threads, Task task);
  // Waits for the running tasks; drops those that have not begun.
  ~GraphRun();
  GraphRun(const GraphRun&) = delete;
  GraphRun& operator=(const GraphRun&) = delete;

  // Call once.
  void start();

  // The last fragments whose tasks may begin: while the caller is not in `step`, and while it waits
  // there. Neither falls. DEFAULT: the first. Thread-safe.
  void begin_up_to(std::uint32_t while_away, std::uint32_t while_waiting);

  // No task begins any more. Thread-safe.
  void stop();

  // Ends one hold of `task`. Thread-safe.
  void release(std::uint32_t task);

  // Drops a task that has nothing to do: tasks that wait for it wait no longer, even if tasks that
  // it would have waited for are not done. Must be called by a task that `task` waits for. If
  // several of the dropped tasks wait for one another, drop the last one first.
  void skip(std::uint32_t task);

  // Waits until a task calls `notify` or no thread works any more; without an arena, runs a task.
  // Returns false once all tasks are done, or no running task could make another one ready, or
  // after `stop`.
  bool step();
  std::uint64_t bytes() const;
  // Whether ready tasks were dropped because no thread could be started for them.
  bool starved() const { return starved_; }
  // Since when no thread works; nullopt if one does. Without an arena, none ever does.
  std::optional<std::chrono::steady_clock::time_point> idle_since();
  // Makes `step` return when the slice of a working thread ends. Must be called by a task.
  void notify();

 private:
  // Each entry is a pair in one word: the rank of a task, and the task.
  using Ready = std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>>;
  static constexpr std::chrono::milliseconds kSlice{2};

  void start_threads(std::unique_lock<std::mutex>& lock, std::size_t most);
  void start_thread();
  void end_thread();
  void work();
  void run(std::uint32_t task);
  void finish(std::uint32_t task);
  std::uint64_t keyed(std::uint32_t task) const {
    return ranks_.of.empty() ? task : std::uint64_t{ranks_.of[task]} << 32 | task;
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
  const TaskRanks ranks_;
  std::vector<char> skipped_;  // per task, written before the task can become ready

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  Ready ready_;
  int running_ = 0;  // threads that work or are queued
  std::chrono::steady_clock::time_point idle_since_;
  bool starved_ = false;
  std::uint32_t while_away_ = 0;
  std::uint32_t while_waiting_ = 0;
  bool waiting_ = false;  // whether the caller waits in `step`
  bool notified_ = false;
  bool stopping_ = false;
};

// How many fragments may be built ahead of the one to be sent next, so that a slow reader holds
// back no more than these. While a fragment is being sent, tasks that only later fragments need do
// not begin.
inline std::uint32_t fragments_ahead(int threads) {
  return 32 + 4 * static_cast<std::uint32_t>(threads);
}

// How many fragments ahead of the next one tasks may begin while the caller waits for that one, if
// the mesh has `fragments` fragments: two columns of the leaves, and some work for each thread. So
// the front between fragments that are sent and fragments that are not begun is bounded at any
// number of threads (bench/README.md).
inline std::uint32_t fragments_begun(std::uint32_t fragments, int threads) {
  return 2 * static_cast<std::uint32_t>(std::sqrt(fragments)) +
         32 * static_cast<std::uint32_t>(threads);
}

}  // namespace weft
