// SPDX-License-Identifier: Apache-2.0
#include "engine/part_run.h"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace weft {

using Clock = ExecutionContext::Clock;

void PartRun::run(const Trace::GraphName& name, TaskGraph graph, std::uint32_t first,
                  std::uint32_t last, std::uint32_t (*task_of_part)(std::uint32_t),
                  const std::function<void(std::uint32_t)>& task) {
  Trace* const trace = context_.trace();
  const std::uint32_t ahead = parts_ahead(context_.threads());
  for (std::uint32_t part = first + ahead; part < last; ++part) graph.hold(task_of_part(part));
  parts_ = std::vector<Pending>(last);
  next_ = first;
  GraphRun run(graph, context_.arena(), context_.threads(),
               [&](std::uint32_t t) { run_task(t, task); });
  run_ = &run;
  if (trace) {
    trace->end_stage("graph building");
    trace->begin_graph(name, graph);
    for (std::uint32_t part = first; part < last; ++part) trace->add_part(task_of_part(part));
  }
  run.start();
  const auto ready = [&] { return next_ < last && parts_[next_].ready && !stopped_; };
  do {
    for (; ready(); ++next_) {
      if (next_ + ahead < last) run.release(task_of_part(next_ + ahead));
      send(parts_[next_], run);
    }
  } while (run.step() || ready());
  if (trace) trace->end_stage(name.stage);
  if (run.starved() && !stopped_)
    stop({ErrorCode::kOutOfMemory, "", "memory ran out: no thread could be started"});
}

void PartRun::run_task(std::uint32_t t, const std::function<void(std::uint32_t)>& task) {
  if (stopped()) return;
  try {
    if (Trace* const trace = context_.trace()) {
      trace->time(t, [&] { task(t); });
    } else {
      task(t);
    }
  } catch (const std::bad_alloc&) {
    stop({ErrorCode::kOutOfMemory, "", "memory ran out"});
  } catch (const std::exception& e) {
    stop({ErrorCode::kInternal, "", e.what()});
  }
}

void PartRun::send(Pending& pending, GraphRun& run) {
  const auto before = Clock::now();
  bytes_ -= pending.part.bytes();
  if (auto error = delivery_.send(std::move(pending.part))) stop(*error);
  pending.part = {};
  const auto after = Clock::now();
  const auto idle_since = std::max(before, run.idle_since().value_or(after));
  blocked_seconds_ += std::chrono::duration<double>(after - idle_since).count();
}

void PartRun::finish(std::uint32_t index, std::optional<Part>&& part) {
  if (!part) {
    if (auto error = context_.poll()) stop(*error);
    return;
  }
  const std::uint64_t waiting = bytes_ += part->bytes();
  for (std::uint64_t peak = peak_bytes_; peak < waiting;) {
    if (peak_bytes_.compare_exchange_weak(peak, waiting)) break;
  }
  parts_[index].part = std::move(*part);
  parts_[index].ready = true;
  if (index == next_) run_->notify();  // later ones are found ready
}

void PartRun::stop(const Error& error) {
  const std::lock_guard lock(mutex_);
  if (!error_) error_ = error;
  stopped_ = true;
}

}  // namespace weft
