// SPDX-License-Identifier: Apache-2.0
// Records what a run does and for how long: the stages in order, and the tasks of stages that are
// task graphs. From the trace of a run on one thread, `weft-bench scaling` computes how it would go
// on many.
//
// A context without a trace costs one test of a pointer per stage and task.
//
//   Trace trace;
//   ExecutionContext context;
//   context.set_trace(trace);
//   generate_mesh(request, sink, context);
//   for (const Trace::Stage& stage : trace.stages) print(stage.name, stage.seconds);
//
// Thread-safety: `time` and `skip` may be called at the same time for different tasks; only the
// thread of the run may call the rest.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace weft {

// Task `after` waits until task `before` is done.
struct TaskEdge {
  std::uint32_t before, after;
};

struct Trace {
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  // The name of a stage that is a graph, and the kinds of its tasks, which repeat with the tasks'
  // numbers.
  struct GraphName {
    static constexpr std::size_t kMaxKinds = 10;
    const char* stage;
    std::array<const char*, kMaxKinds> kinds;  // ends at the first nullptr
    constexpr std::size_t period() const {
      return static_cast<std::size_t>(std::find(kinds.begin(), kinds.end(), nullptr) -
                                      kinds.begin());
    }
  };

  struct Graph {
    GraphName name;
    std::vector<double> seconds;  // per task; 0 if it was skipped
    // Per task, the task that skipped it, or kNone. Tasks that wait for the skipped one waited for
    // that task instead.
    std::vector<std::uint32_t> skipped_by;
    std::vector<TaskEdge> edges;
    // The tasks that build the fragments, in the order in which fragments are sent. Each waits
    // until the fragment fragments_ahead(threads) before its own has been sent.
    std::vector<std::uint32_t> fragment_tasks;
    std::vector<std::uint32_t> needs = {};     // of TaskGraph::set_needs
    std::span<const std::uint8_t> costs = {};  // of TaskGraph::set_costs
  };

  struct Stage {
    const char* name;
    double seconds;              // of wall time
    std::optional<Graph> graph;  // nullopt if the stage has no tasks
    // The seconds of the steps of each loop that may run on many threads, from a run on one.
    std::vector<std::vector<double>> loops = {};
  };

  // In the order in which they ended.
  std::vector<Stage> stages;

  // The next stage begins now.
  void start() { last_ = Clock::now(); }
  // Names what was done since the last stage ended.
  void end_stage(const char* name) {
    const auto now = Clock::now();
    stages.push_back({name, std::chrono::duration<double>(now - std::exchange(last_, now)).count(),
                      std::exchange(graph_, std::nullopt), std::exchange(loops_, {})});
  }

  // Times a loop of the current stage; f(i) does one step.
  template <class F>
  void time_loop(std::size_t n, F&& f) {
    std::vector<double>& seconds = loops_.emplace_back(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto start = Clock::now();
      f(i);
      seconds[i] = std::chrono::duration<double>(Clock::now() - start).count();
    }
  }

  // Begins a stage that is a graph. The time that the trace itself takes here is left out.
  void begin_graph(const GraphName& name, std::size_t tasks, const std::vector<TaskEdge>& edges,
                   const std::vector<std::uint32_t>& needs, std::span<const std::uint8_t> costs) {
    graph_ = Graph{name,
                   std::vector<double>(tasks, 0.0),
                   std::vector<std::uint32_t>(tasks, kNone),
                   edges,
                   {},
                   needs,
                   costs};
    start();
  }
  void add_fragment(std::uint32_t task) { graph_->fragment_tasks.push_back(task); }
  template <class F>
  void time(std::uint32_t task, F&& f) {
    const auto start = Clock::now();
    f();
    graph_->seconds[task] = std::chrono::duration<double>(Clock::now() - start).count();
  }
  void skip(std::uint32_t task, std::uint32_t by) { graph_->skipped_by[task] = by; }

 private:
  Clock::time_point last_ = Clock::now();
  std::vector<std::vector<double>> loops_;
  std::optional<Graph> graph_;
};

}  // namespace weft
