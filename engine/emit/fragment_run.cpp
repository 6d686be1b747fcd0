// SPDX-License-Identifier: Apache-2.0
#include "engine/emit/fragment_run.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include "engine/base/failure.h"

namespace weft {

using Clock = ExecutionContext::Clock;

void FragmentRun::run(const Trace::GraphName& name, TaskGraph graph, std::uint32_t first,
                      std::uint32_t last, std::uint32_t (*task_of_fragment)(std::uint32_t),
                      const std::function<void(std::uint32_t)>& task) {
  Trace* const trace = context_.trace();
  const std::uint32_t ahead = fragments_ahead(context_.threads());
  for (std::uint32_t fragment = first + ahead; fragment < last; ++fragment)
    graph.hold(task_of_fragment(fragment));
  fragments_ = std::vector<Pending>(last);
  next_ = first;
  GraphRun run(graph, context_.arena(), context_.threads(),
               [&](std::uint32_t t) { run_task(t, task); });
  run_ = &run;
  if (trace) {
    trace->end_stage("graph building");
    trace->begin_graph(name, graph.size(), graph.edges(), graph.needs(), graph.costs());
    for (std::uint32_t fragment = first; fragment < last; ++fragment)
      trace->add_fragment(task_of_fragment(fragment));
  }
  graph = TaskGraph(0);  // the run has read what it needs
  const std::uint64_t graph_bytes = run.bytes() + fragments_.capacity() * sizeof(Pending);
  graph_bytes_ = std::max(graph_bytes_, graph_bytes);
  const HeldBytes::Scope held(context_.held_bytes(), graph_bytes);
  const std::uint32_t begun = fragments_begun(last - first, context_.threads());
  run.begin_up_to(first + ahead, first + begun);
  run.start();
  const auto ready = [&] { return next_ < last && fragments_[next_].ready && !stopped_; };
  do {
    for (; ready(); ++next_) {
      if (next_ + ahead < last) run.release(task_of_fragment(next_ + ahead));
      run.begin_up_to(next_ + ahead, next_ + begun);
      send(fragments_[next_], run);
    }
  } while (run.step() || ready());
  if (trace) trace->end_stage(name.stage);
  run_ = nullptr;
  if (run.starved() && !stopped_)
    stop({ErrorCode::kOutOfMemory, "", "memory ran out: no thread could be started"});
}

void FragmentRun::run_task(std::uint32_t t, const std::function<void(std::uint32_t)>& task) {
  if (stopped()) return;
  try {
    if (Trace* const trace = context_.trace()) {
      trace->time(t, [&] { task(t); });
    } else {
      task(t);
    }
  } catch (const Failure& failure) {
    stop(failure.error());
  } catch (const std::bad_alloc&) {
    stop({ErrorCode::kOutOfMemory, "", "memory ran out"});
  } catch (const std::exception& e) {
    stop({ErrorCode::kInternal, "", e.what()});
  }
}

void FragmentRun::send(Pending& pending, GraphRun& run) {
  const auto before = Clock::now();
  waiting_.remove(pending.fragment->bytes());
  context_.held_bytes().remove(pending.fragment->bytes());
  if (auto error = delivery_.send(std::move(*pending.fragment))) stop(*error);
  pending.fragment.reset();
  const auto after = Clock::now();
  const auto idle_since = std::max(before, run.idle_since().value_or(after));
  blocked_seconds_ += std::chrono::duration<double>(after - idle_since).count();
}

void FragmentRun::finish(std::uint32_t index, std::optional<Fragment>&& fragment) {
  if (!fragment) {
    if (auto error = context_.poll()) stop(*error);
    return;
  }
  waiting_.add(fragment->bytes());
  context_.held_bytes().add(fragment->bytes());
  fragments_[index].fragment = std::make_unique<Fragment>(std::move(*fragment));
  fragments_[index].ready = true;
  if (index == next_) run_->notify();  // later ones are seen to be ready when their turn comes
}

void FragmentRun::end_hold() {
  constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();
  run_->begin_up_to(kAll, kAll);
}

void FragmentRun::stop(const Error& error) {
  const std::lock_guard lock(mutex_);
  if (!error_) error_ = error;
  stopped_ = true;
  if (run_) run_->stop();
}

}  // namespace weft
