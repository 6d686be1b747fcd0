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
// A task becomes ready when all that it waits for are done; of the ready ones the one with the
// lowest number runs first. There is no barrier: a slow or preempted task holds back only what
// depends on it.
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

#include "engine/arena.h"

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

  struct Edge {
    std::uint32_t before, after;
  };
  std::uint32_t size() const { return static_cast<std::uint32_t>(waits_for_.size()); }
  const std::vector<Edge>& edges() const { return edges_; }

 private:
  friend class GraphRun;

  std::vector<std::uint32_t> waits_for_;
  std::vector<Edge> edges_;
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

  // One thing less that `task` waits for. Thread-safe.
  void release(std::uint32_t task);

  // Drops a task for which there is nothing to do: what waits for it waits no longer, though others
  // that it would have waited for may not be done. To be called by a task that `task` waits for;
  // of several that wait for one another, the last first.
  void skip(std::uint32_t task);

  // Goes on until something was done, or `notify` was called: without an arena, runs a task. False
  // once all tasks are done, or nothing runs that could make another one ready.
  bool step();
  // Whether ready tasks were given up because no thread could be started for them.
  bool starved() const { return starved_; }
  // Since when no thread works, if none does; always, without an arena.
  std::optional<std::chrono::steady_clock::time_point> idle_since();
  // Makes `step` return, when the slice of a thread at work ends. To be called by a task.
  void notify();

 private:
  using Ready = std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>>;
  static constexpr std::chrono::milliseconds kSlice{2};

  void start_threads(std::unique_lock<std::mutex>& lock);
  void start_thread();
  void end_thread();
  void work();
  void run(std::uint32_t task);
  void finish(std::uint32_t task);
  bool satisfied(std::uint32_t task) {
    return waits_for_[task].fetch_sub(1, std::memory_order_acq_rel) == 1;
  }

  Arena* const arena_;
  const int threads_;
  const Task task_;
  std::vector<std::uint32_t> first_successor_;  // per task, and one more: into successors_
  std::vector<std::uint32_t> successors_;
  std::vector<std::atomic<std::uint32_t>> waits_for_;
  std::vector<char> skipped_;  // per task, written before the task can become ready

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  Ready ready_;
  int running_ = 0;  // threads that work, or are queued for
  std::chrono::steady_clock::time_point idle_since_;
  bool starved_ = false;
  bool notified_ = false;
  bool stopping_ = false;
};

}  // namespace weft
