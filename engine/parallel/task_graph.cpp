// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/task_graph.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace weft {
namespace {

// Per task, the cost of the most costly chain of tasks that begins with it.
std::vector<std::uint32_t> chains_from(std::size_t tasks, const std::vector<TaskEdge>& edges,
                                       std::span<const std::uint8_t> costs) {
  std::vector<std::uint32_t> first(tasks + 1, 0);  // per task, and one more: into `before`
  std::vector<std::uint32_t> afters(tasks, 0);
  for (const TaskEdge& e : edges) {
    ++first[e.after + 1];
    ++afters[e.before];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> before(edges.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const TaskEdge& e : edges) before[next[e.after]++] = e.before;

  std::vector<std::uint32_t> chain(tasks, 0);  // at first without the task itself
  std::vector<std::uint32_t> last;             // tasks all of whose chains are known
  for (std::uint32_t t = 0; t < tasks; ++t) {
    if (afters[t] == 0) last.push_back(t);
  }
  while (!last.empty()) {
    const std::uint32_t t = last.back();
    last.pop_back();
    chain[t] += costs[t % costs.size()];
    for (std::uint32_t i = first[t]; i < first[t + 1]; ++i) {
      const std::uint32_t b = before[i];
      chain[b] = std::max(chain[b], chain[t]);
      if (--afters[b] == 0) last.push_back(b);
    }
  }
  return chain;
}

}  // namespace

TaskRanks rank_tasks(std::size_t tasks, const std::vector<TaskEdge>& edges,
                     const std::vector<std::uint32_t>& needs, std::span<const std::uint8_t> costs,
                     int threads) {
  if (costs.empty() || threads == 1) return {needs};
  const std::uint32_t last = needs.empty() ? 0 : *std::max_element(needs.begin(), needs.end());
  if (last >= fragments_begun(last + 1, threads)) return {needs};
  std::vector<std::uint32_t> ranks = chains_from(tasks, edges, costs);
  const std::uint32_t longest = ranks.empty() ? 0 : *std::max_element(ranks.begin(), ranks.end());
  for (std::uint32_t& rank : ranks) rank = longest - rank;
  return {std::move(ranks), false};
}

GraphRun::GraphRun(const TaskGraph& graph, Arena* arena, int threads, Task task)
    : arena_(arena),
      threads_(threads),
      task_(std::move(task)),
      first_successor_(graph.size() + 1, 0),
      successors_(graph.edges_.size()),
      waits_for_(graph.size()),
      ranks_(rank_tasks(graph.size(), graph.edges_, graph.needs_, graph.costs_, threads)),
      skipped_(graph.size(), 0) {
  for (const auto& e : graph.edges_) ++first_successor_[e.before + 1];
  std::partial_sum(first_successor_.begin(), first_successor_.end(), first_successor_.begin());
  std::vector<std::uint32_t> next(first_successor_.begin(), first_successor_.end() - 1);
  for (const auto& e : graph.edges_) successors_[next[e.before]++] = e.after;
  std::vector<std::uint64_t> ready;
  ready.reserve(graph.size());  // so that nothing is allocated while tasks run
  for (std::uint32_t t = 0; t < graph.size(); ++t) {
    waits_for_[t].store(graph.waits_for_[t], std::memory_order_relaxed);
    if (graph.waits_for_[t] == 0) ready.push_back(keyed(t));
  }
  ready_ = Ready(std::greater<>(), std::move(ready));
}

std::uint64_t GraphRun::bytes() const {
  return (first_successor_.capacity() + successors_.capacity() + ranks_.of.capacity()) *
             sizeof(std::uint32_t) +
         waits_for_.capacity() * sizeof(waits_for_[0]) + skipped_.capacity() +
         first_successor_.capacity() * sizeof(Ready::value_type);
}

void GraphRun::start() {
  std::unique_lock lock(mutex_);
  start_threads(lock, ready_.size());
}

GraphRun::~GraphRun() {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  changed_.wait(lock, [&] { return running_ == 0; });
}

void GraphRun::release(std::uint32_t task) {
  if (!satisfied(task)) return;
  std::unique_lock lock(mutex_);
  ready_.push(keyed(task));
  start_threads(lock, 1);
}

void GraphRun::begin_up_to(std::uint32_t while_away, std::uint32_t while_waiting) {
  std::unique_lock lock(mutex_);
  while_away_ = std::max(while_away_, while_away);
  while_waiting_ = std::max(while_waiting_, while_waiting);
  start_threads(lock, ready_.size());
}

void GraphRun::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
}

void GraphRun::notify() {
  const std::lock_guard lock(mutex_);
  notified_ = true;
}

bool GraphRun::step() {
  std::unique_lock lock(mutex_);
  if (arena_) {
    waiting_ = true;
    start_threads(lock, ready_.size());
    changed_.wait(lock, [&] { return notified_ || running_ == 0; });
    waiting_ = false;
    return std::exchange(notified_, false) || running_ != 0;
  }
  if (ready_.empty() || stopping_) return std::exchange(notified_, false);
  const std::uint32_t task = take_ready();
  lock.unlock();
  run(task);
  return true;
}

// Whether the first ready task may begin while `others` threads are at work. REQUIRES: the mutex is
// held.
bool GraphRun::may_begin(int others) const {
  if (ready_.empty() || stopping_) return false;
  if (!ranks_.hold) return true;
  const std::uint64_t fragment = ready_.top() >> 32;
  if (!waiting_ || notified_) return fragment <= while_away_;
  return fragment <= while_waiting_ || others == 0;
}

// REQUIRES: the mutex is held, and a task is ready.
std::uint32_t GraphRun::take_ready() {
  const auto task = static_cast<std::uint32_t>(ready_.top());
  ready_.pop();
  return task;
}

// Queues one slice for each task that may begin now, and at most `most`.
void GraphRun::start_threads(std::unique_lock<std::mutex>& lock, std::size_t most) {
  if (!arena_ || !may_begin(running_)) return;
  most = std::min(most, ready_.size());
  std::size_t wanted = 0;
  while (running_ < threads_ && wanted < most) {
    ++running_;
    ++wanted;
  }
  lock.unlock();
  for (; wanted > 0; --wanted) start_thread();
  lock.lock();
}

// Nothing else here can run out of memory.
void GraphRun::start_thread() {
  try {
    arena_->start([this] { work(); });
  } catch (...) {
    const std::lock_guard lock(mutex_);
    starved_ = true;
    end_thread();
  }
}

// REQUIRES: the mutex is held.
void GraphRun::end_thread() {
  if (--running_ == 0) idle_since_ = std::chrono::steady_clock::now();
  if (running_ == 0 || notified_) changed_.notify_all();
}

std::optional<std::chrono::steady_clock::time_point> GraphRun::idle_since() {
  const std::lock_guard lock(mutex_);
  return running_ == 0 ? std::optional(idle_since_) : std::nullopt;
}

// The slice of one thread.
void GraphRun::work() {
  const auto end = std::chrono::steady_clock::now() + kSlice;
  do {
    std::unique_lock lock(mutex_);
    if (!may_begin(running_ - 1)) {
      end_thread();
      return;
    }
    const std::uint32_t task = take_ready();
    lock.unlock();
    run(task);
  } while (std::chrono::steady_clock::now() < end);
  std::unique_lock lock(mutex_);
  const bool wake = notified_;
  lock.unlock();
  if (wake) changed_.notify_all();
  start_thread();
}

void GraphRun::skip(std::uint32_t task) {
  skipped_[task] = 1;
  finish(task);
}

void GraphRun::run(std::uint32_t task) {
  task_(task);
  finish(task);
}

void GraphRun::finish(std::uint32_t task) {
  std::unique_lock lock(mutex_, std::defer_lock);
  std::size_t pushed = 0;
  for (std::uint32_t i = first_successor_[task]; i < first_successor_[task + 1]; ++i) {
    const std::uint32_t next = successors_[i];
    if (!satisfied(next) || skipped_[next]) continue;
    if (!lock.owns_lock()) lock.lock();
    ready_.push(keyed(next));
    ++pushed;
  }
  if (pushed > 0) start_threads(lock, pushed);
}

}  // namespace weft
