// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/scaling_bench.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench/list_schedule.h"
#include "bench/models.h"
#include "engine/engine.h"
#include "tests/support/poly.h"

namespace weft::bench {
namespace {

constexpr std::array kThreads = {2, 4, 8, 16, 32, 64, 128};

double milli(double seconds) {
  return 1e3 * seconds;
}

struct Recorded {
  std::uint64_t triangles = 0;
  Trace trace;
  double seconds() const {
    return std::accumulate(trace.stages.begin(), trace.stages.end(), 0.0,
                           [](double sum, const Trace::Stage& s) { return sum + s.seconds; });
  }
};

// The time of a graph's stage beside its tasks: sending, and the scheduler. It counts as serial.
double send_seconds(const Trace::Stage& stage) {
  const std::size_t fragments = stage.graph->fragment_tasks.size();
  const double beside = std::max(0.0, stage.seconds - work_of(*stage.graph));
  return fragments == 0 ? 0 : beside / static_cast<double>(fragments);
}

// The time of the loops of a stage, added up.
double loop_seconds(const Trace::Stage& stage, int threads) {
  return std::accumulate(
      stage.loops.begin(), stage.loops.end(), 0.0,
      [&](double sum, const auto& loop) { return sum + schedule(loop, threads); });
}

std::optional<Recorded> record(const MeshRequest& request) {
  Recorded result;
  Discard sink;
  ExecutionContext context;
  context.set_trace(result.trace);
  const auto summary = generate_mesh(request, sink, context);
  if (!summary) {
    std::fprintf(stderr, "%s\n", summary.error().message.c_str());
    return std::nullopt;
  }
  result.triangles = summary->triangles;
  return result;
}

// Seconds of the whole run, the median for each number of threads up to that of this machine.
std::optional<std::map<int, double>> measure(const MeshRequest& request, int runs) {
  std::map<int, double> result;
  const auto processors = static_cast<int>(std::thread::hardware_concurrency());
  for (int threads = 1; threads <= processors; threads *= 2) {
    Arena arena(threads);
    std::vector<double> seconds;
    for (int run = 0; run <= runs; ++run) {
      Discard sink;
      ExecutionContext context;
      context.set_arena(arena);
      const auto summary = generate_mesh(request, sink, context);
      if (!summary) return std::nullopt;
      if (run > 0) seconds.push_back(summary->engine_seconds);
    }
    result[threads] = median(seconds);
  }
  return result;
}

// The same run has the same stages and tasks each time. The fastest time of each is kept, so that a
// task does not count as slow because something else had the processor.
void keep_fastest(Trace& best, const Trace& other) {
  for (std::size_t s = 0; s < best.stages.size(); ++s) {
    Trace::Stage& stage = best.stages[s];
    const Trace::Stage& again = other.stages[s];
    if (!stage.graph) {
      if (again.seconds < stage.seconds) stage = again;
      continue;
    }
    const double beside =
        std::min(stage.seconds - work_of(*stage.graph), again.seconds - work_of(*again.graph));
    auto& tasks = stage.graph->seconds;
    std::transform(tasks.begin(), tasks.end(), again.graph->seconds.begin(), tasks.begin(),
                   [](double a, double b) { return std::min(a, b); });
    stage.seconds = work_of(*stage.graph) + beside;
  }
}

// The stages of a run; those with the same name are added up.
struct Stages {
  std::map<std::string, double> serial;
  double work = 0;                          // of the tasks
  std::map<int, double> parallel;           // per number of threads
  std::map<int, std::uint32_t> most_begun;  // leaves, of those stages that have any
  double serial_seconds() const {
    return std::accumulate(serial.begin(), serial.end(), 0.0,
                           [](double sum, const auto& s) { return sum + s.second; });
  }
  double one_thread() const { return serial_seconds() + work; }
  double on(int threads) const { return serial_seconds() + parallel.at(threads); }
};

Stages stages_of(const Recorded& run) {
  Stages result;
  for (const Trace::Stage& stage : run.trace.stages) {
    if (!stage.graph) {
      const double in_loops = loop_seconds(stage, 1);
      result.serial[stage.name] += stage.seconds - in_loops;
      result.work += in_loops;
      for (const int threads : kThreads) result.parallel[threads] += loop_seconds(stage, threads);
      continue;
    }
    result.work += stage.seconds;
    for (const int threads : kThreads) {
      const Schedule predicted = schedule(*stage.graph, threads, send_seconds(stage));
      result.parallel[threads] += predicted.seconds;
      auto& most = result.most_begun[threads];
      if (!stage.graph->needs.empty()) most = std::max(most, predicted.most_begun);
    }
  }
  return result;
}

void print_stages(const Recorded& run) {
  const double total = run.seconds();
  std::printf(
      "| stage | seconds | %% of the run | critical path | average parallelism |\n"
      "|---|---|---|---|---|\n");
  for (const Trace::Stage& stage : run.trace.stages) {
    std::printf("| %s | %.5f | %.2f |", stage.name, stage.seconds, 100 * stage.seconds / total);
    if (!stage.graph) {
      const double serial = stage.seconds - loop_seconds(stage, 1);
      const double path = serial + loop_seconds(stage, kUnboundedThreads);
      std::printf(" %.5f | %.1f |\n", path, stage.seconds / path);
      continue;
    }
    const Schedule path = schedule(*stage.graph, kUnboundedThreads, send_seconds(stage));
    std::printf(" %.5f | %.1f |\n", path.seconds, stage.seconds / path.seconds);
  }
}

void print_graphs(const Recorded& run) {
  std::printf(
      "\n| stage | kind of task | tasks | skipped | work s | longest ms | of the critical "
      "path, ms |\n|---|---|---|---|---|---|---|\n");
  for (const Trace::Stage& stage : run.trace.stages) {
    if (!stage.graph) continue;
    const Trace::Graph& graph = *stage.graph;
    const Schedule path = schedule(graph, kUnboundedThreads, 0);
    const auto on_path = seconds_by_kind(graph, path.chain);
    for (std::size_t kind = 0; kind < graph.name.period(); ++kind) {
      std::size_t tasks = 0;
      std::size_t skipped = 0;
      double work = 0;
      double longest = 0;
      for (std::size_t t = kind; t < graph.seconds.size(); t += graph.name.period()) {
        ++tasks;
        if (graph.skipped_by[t] != Trace::kNone) ++skipped;
        work += graph.seconds[t];
        longest = std::max(longest, graph.seconds[t]);
      }
      const auto found = on_path.find(graph.name.kinds[kind]);
      std::printf("| %s | %s | %zu | %zu | %.4f | %.2f | %.2f |\n", stage.name,
                  graph.name.kinds[kind], tasks, skipped, work, milli(longest),
                  found == on_path.end() ? 0 : milli(found->second));
    }
    std::printf("| %s | scheduling and sending | | | %.4f | | |\n", stage.name,
                std::max(0.0, stage.seconds - work_of(graph)));
  }
}

// `measured`: seconds per number of threads, where they could be measured.
void print_speed_up(const Stages& stages, const std::map<int, double>& measured) {
  std::printf(
      "\n| threads | serial ms | tasks ms | threads busy | whole run ms "
      "| simulated speed-up | leaves begun at most | measured here, ms | measured speed-up |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  const auto print_measured = [&](int threads) {
    if (const auto found = measured.find(threads); found != measured.end()) {
      std::printf(" %.2f | %.2f |\n", milli(found->second), measured.at(1) / found->second);
    } else {
      std::printf(" | |\n");
    }
  };
  const double serial = stages.serial_seconds();
  std::printf("| 1, recorded | %.2f | %.2f | | %.2f | 1 | |", milli(serial), milli(stages.work),
              milli(stages.one_thread()));
  print_measured(1);
  for (const int threads : kThreads) {
    const double parallel = stages.parallel.at(threads);
    std::printf("| %d | %.2f | %.2f | %.0f %% | %.2f | %.1f |", threads, milli(serial),
                milli(parallel), 100 * stages.work / (parallel * threads),
                milli(stages.on(threads)), stages.one_thread() / stages.on(threads));
    const auto begun = stages.most_begun.find(threads);
    if (begun == stages.most_begun.end()) {
      std::printf(" |");
    } else {
      std::printf(" %u |", begun->second);
    }
    print_measured(threads);
  }
}

// Extrapolates a quantity from two smaller meshes to a larger one, as a power of n.
double extrapolate(double t0, double t1, double n0, double n1, double n) {
  if (t0 <= 0 || t1 <= 0) return t1;
  const double power = std::max(0.0, std::log(t1 / t0) / std::log(n1 / n0));
  return t1 * std::pow(n / n1, power);
}

Stages extrapolate(const Recorded& small, const Recorded& large, double triangles) {
  const Stages s = stages_of(small);
  const Stages l = stages_of(large);
  const auto n0 = static_cast<double>(small.triangles);
  const auto n1 = static_cast<double>(large.triangles);
  Stages result;
  for (const auto& [name, seconds] : l.serial) {
    const auto before = s.serial.find(name);
    result.serial[name] =
        extrapolate(before == s.serial.end() ? 0 : before->second, seconds, n0, n1, triangles);
  }
  result.work = extrapolate(s.work, l.work, n0, n1, triangles);
  for (const int threads : kThreads)
    result.parallel[threads] = l.parallel.at(threads) * result.work / l.work;
  return result;
}

}  // namespace

int run_scaling_bench(const ScalingBenchOptions& options) {
  MeshRequest request{.pslg = read_poly(options.models + "/cylinder.poly")};
  std::vector<Recorded> recorded;
  for (const double triangles : options.triangles) {
    request.size = cylinder_size(triangles);
    std::optional<Recorded> best;
    for (int run = 0; run <= options.runs; ++run) {
      auto result = record(request);
      if (!result) return 1;
      if (run == 0) continue;
      if (best) {
        keep_fastest(best->trace, result->trace);
      } else {
        best = std::move(result);
      }
    }
    std::printf(
        "\n### cylinder, %llu triangles: recorded on one thread, each task's fastest of %d "
        "runs\n\n",
        static_cast<unsigned long long>(best->triangles), options.runs);
    print_stages(*best);
    print_graphs(*best);
    std::printf(
        "\nSimulated from these task times by list scheduling; the serial stages as "
        "measured. Not seen: what threads do to each other's memory and clocks.\n");
    const auto measured = measure(request, options.runs);
    if (!measured) return 1;
    print_speed_up(stages_of(*best), *measured);
    std::fflush(stdout);
    recorded.push_back(std::move(*best));
  }
  if (options.extrapolate_to > 0 && recorded.size() >= 2) {
    const Recorded& small = recorded[recorded.size() - 2];
    const Recorded& large = recorded.back();
    std::printf(
        "\n### cylinder, %.3g triangles: extrapolated\n\n"
        "Each serial stage and the work of all tasks as the power of the triangles by which "
        "they grew from %llu to %llu; the threads as busy as there.\n",
        options.extrapolate_to, static_cast<unsigned long long>(small.triangles),
        static_cast<unsigned long long>(large.triangles));
    print_speed_up(extrapolate(small, large, options.extrapolate_to), {});
  }
  return 0;
}

}  // namespace weft::bench
