// SPDX-License-Identifier: GPL-3.0-or-later
// How the recorded tasks of a stage would go on other numbers of threads.
//
// The rules are those of GraphRun (engine/parallel/task_graph.h): a task is ready when all that it
// waits for are done; a free thread takes the ready task that is needed first, or the one with the
// most costly chain after it, and of equal ones the one with the lowest number; what waits for a
// skipped task waits for the one that skipped it; fragments wait for room as fragments_ahead says,
// and tasks that later fragments need as fragments_begun says, for a reader who takes fragments at
// once. A task takes the seconds that were recorded, so what threads do to each other (memory
// bandwidth, caches, clock rates, the scheduler's lock) is not seen.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "engine/base/trace.h"

namespace weft::bench {

// As many as there is work for.
inline constexpr int kUnboundedThreads = std::numeric_limits<int>::max();

struct Schedule {
  double seconds = 0;  // until the last task is done and the last fragment sent
  // A chain of tasks, each begun when the one before ended, that ends with the last task: with
  // unbounded threads, the critical path.
  std::vector<std::uint32_t> chain;
  // The most groups of tasks, one of each kind, of which one had begun while not all were done: of
  // a graph of leaves, those in memory.
  std::uint32_t most_begun = 0;
};

// `send_seconds` go by between a fragment's being next and its having been sent, on a thread of its
// own. REQUIRES: threads >= 1.
Schedule schedule(const Trace::Graph& graph, int threads, double send_seconds);

// Seconds of a loop whose steps go to the next free thread in order.
double schedule(const std::vector<double>& loop, int threads);

// The seconds of all tasks.
double work_of(const Trace::Graph& graph);

// The seconds of tasks, by kind.
std::map<std::string, double> seconds_by_kind(const Trace::Graph& graph,
                                              const std::vector<std::uint32_t>& tasks);

}  // namespace weft::bench
