// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/list_schedule.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

#include "engine/parallel/task_graph.h"

namespace weft::bench {
namespace {

constexpr std::uint32_t kNone = Trace::kNone;

class ListScheduling {
 public:
  ListScheduling(const Trace::Graph& graph, int threads, double send_seconds)
      : graph_(graph),
        threads_(threads),
        send_seconds_(send_seconds),
        successors_(graph.seconds.size()),
        skips_(graph.seconds.size()),
        fragment_of_(graph.seconds.size(), kNone),
        waits_for_(graph.seconds.size(), 0),
        released_by_(graph.seconds.size(), kNone),
        done_(graph.seconds.size(), 0) {
    for (const auto& e : graph.edges) {
      successors_[e.before].push_back(e.after);
      ++waits_for_[e.after];
    }
    for (std::uint32_t t = 0; t < size(); ++t) {
      if (graph.skipped_by[t] != kNone) skips_[graph.skipped_by[t]].push_back(t);
    }
    // With more threads than this, the window limits nothing.
    const auto fragments = static_cast<std::uint32_t>(graph.fragment_tasks.size());
    const int most_threads = std::min(threads, 1 << 20);
    ahead_ = fragments_ahead(most_threads);
    begun_ahead_ = fragments_begun(fragments, most_threads);
    ranks_ = rank_tasks(size(), graph.edges, graph.needs, graph.costs, most_threads);
    const auto period = static_cast<std::uint32_t>(graph.name.period());
    undone_.resize(size() / period + 1, period);
    has_begun_.resize(undone_.size(), 0);
    for (std::uint32_t fragment = 0; fragment < fragments; ++fragment)
      fragment_of_[graph.fragment_tasks[fragment]] = fragment;
    for (std::uint32_t fragment = ahead_; fragment < fragments; ++fragment)
      ++waits_for_[graph.fragment_tasks[fragment]];
  }

  Schedule run() {
    for (std::uint32_t t = 0; t < size(); ++t) {
      if (waits_for_[t] == 0 && !skipped(t)) ready_.push(keyed(t));
    }
    std::uint32_t last = kNone;
    start_tasks();
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.time;
      if (event.is_sent) {
        sent();
      } else {
        --running_;
        last = event.task;
        finish(event.task, event.task);
        for (const std::uint32_t t : skips_[event.task]) finish(t, event.task);
        if (fragment_of_[event.task] != kNone) send_next();
      }
      start_tasks();
    }
    Schedule result{now_, {}, most_begun_};
    for (std::uint32_t t = last; t != kNone; t = released_by_[t]) result.chain.push_back(t);
    std::reverse(result.chain.begin(), result.chain.end());
    return result;
  }

 private:
  struct Event {
    double time;
    std::uint32_t task;
    bool is_sent;  // the next fragment was sent, instead of the end of a task
    bool operator>(const Event& other) const {
      return std::pair(time, task) > std::pair(other.time, other.task);
    }
  };

  std::uint32_t size() const { return static_cast<std::uint32_t>(graph_.seconds.size()); }
  bool skipped(std::uint32_t task) const { return graph_.skipped_by[task] != kNone; }

  std::uint64_t keyed(std::uint32_t task) const {
    return ranks_.of.empty() ? task : std::uint64_t{ranks_.of[task]} << 32 | task;
  }

  bool may_begin() const {
    if (ready_.empty()) return false;
    return running_ == 0 || !ranks_.hold ||
           ready_.top() >> 32 <= std::uint64_t{next_fragment_} + begun_ahead_;
  }
  std::size_t group_of(std::uint32_t task) const { return task / graph_.name.period(); }

  void start_tasks() {
    for (; running_ < threads_ && may_begin(); ++running_) {
      const auto task = static_cast<std::uint32_t>(ready_.top());
      if (!std::exchange(has_begun_[group_of(task)], 1))
        most_begun_ = std::max(most_begun_, ++begun_);
      events_.push({now_ + graph_.seconds[task], task, false});
      ready_.pop();
    }
  }

  void finish(std::uint32_t task, std::uint32_t by) {
    done_[task] = 1;
    if (--undone_[group_of(task)] == 0) --begun_;
    for (const std::uint32_t next : successors_[task]) release(next, by);
  }

  void release(std::uint32_t task, std::uint32_t by) {
    if (--waits_for_[task] > 0 || skipped(task)) return;
    released_by_[task] = by;
    ready_.push(keyed(task));
  }

  void send_next() {
    if (sending_ || next_fragment_ >= graph_.fragment_tasks.size()) return;
    if (!done_[graph_.fragment_tasks[next_fragment_]]) return;
    sending_ = true;
    events_.push({now_ + send_seconds_, graph_.fragment_tasks[next_fragment_], true});
  }

  void sent() {
    sending_ = false;
    const std::uint32_t by = graph_.fragment_tasks[next_fragment_++];
    const std::size_t freed = next_fragment_ - 1 + std::size_t{ahead_};
    if (freed < graph_.fragment_tasks.size()) release(graph_.fragment_tasks[freed], by);
    send_next();
  }

  const Trace::Graph& graph_;
  const int threads_;
  const double send_seconds_;
  std::vector<std::vector<std::uint32_t>> successors_;
  std::vector<std::vector<std::uint32_t>> skips_;
  std::vector<std::uint32_t> fragment_of_;
  std::vector<std::uint32_t> waits_for_;
  std::vector<std::uint32_t> released_by_;
  std::vector<char> done_;
  std::uint32_t ahead_ = 0;
  std::uint32_t begun_ahead_ = 0;
  TaskRanks ranks_;
  std::vector<std::uint32_t> undone_;  // tasks, per group
  std::vector<char> has_begun_;        // per group
  std::uint32_t begun_ = 0;            // groups that are not done
  std::uint32_t most_begun_ = 0;

  double now_ = 0;
  int running_ = 0;
  std::uint32_t next_fragment_ = 0;
  bool sending_ = false;
  std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> ready_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
};

}  // namespace

Schedule schedule(const Trace::Graph& graph, int threads, double send_seconds) {
  return ListScheduling(graph, threads, send_seconds).run();
}

double schedule(const std::vector<double>& loop, int threads) {
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  double end = 0;
  for (const double seconds : loop) {
    double start = 0;
    if (free_at.size() == static_cast<std::size_t>(threads)) {
      start = free_at.top();
      free_at.pop();
    }
    free_at.push(start + seconds);
    end = std::max(end, start + seconds);
  }
  return end;
}

double work_of(const Trace::Graph& graph) {
  return std::accumulate(graph.seconds.begin(), graph.seconds.end(), 0.0);
}

std::map<std::string, double> seconds_by_kind(const Trace::Graph& graph,
                                              const std::vector<std::uint32_t>& tasks) {
  std::map<std::string, double> result;
  for (const std::uint32_t t : tasks)
    result[graph.name.kinds[t % graph.name.period()]] += graph.seconds[t];
  return result;
}

}  // namespace weft::bench
