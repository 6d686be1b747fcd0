// SPDX-License-Identifier: Apache-2.0
// The engine as the server calls it, for calls and for jobs: on which threads it computes, for how
// long, and with which memory. It throws nothing.
//
// A light run would wait in the pool for heavy runs, longer than it takes itself. So it computes on
// the caller's thread, for kLightTime and with kLightBytes at most. If that is not enough, it is
// promoted to a heavy slot and begins again, in the pool. The same request gives the same chunks,
// so the sink gets only those that it does not have yet. Thus only light runs compute outside the
// pool, each for a moment.
//
// Thread-safety: several threads may call the engine at once, each with a run and a slot of its
// own.
#pragma once

#include <cstdint>
#include <functional>
#include <tl/expected.hpp>

#include "server/run/run_queue.h"
#include "server/wire/errors.h"
#include "weft/run.h"
#include "weft/weft.h"

namespace weft::server {

// weft::stream, or a test's replacement. Called on worker threads, several at once.
using EngineFn = std::function<Result<Summary>(const MeshRequest&, ChunkSink&, Run&)>;

struct EngineRun {
  Run& run;
  RunQueue::Slot& slot;
  std::uint64_t besides;  // bytes that the server holds: the request, and chunks that wait
  Run::Clock::time_point deadline;
  ThreadPool& pool;
  std::uint32_t threads;  // of the pool
};

// Frees the request when the run has ended. Errors: those of the engine; an exception becomes
// OUT_OF_MEMORY if it is std::bad_alloc, otherwise INTERNAL.
tl::expected<Summary, Failure> call_engine(const EngineFn& engine, MeshRequest request,
                                           ChunkSink& sink, const EngineRun& call) noexcept;

// The time in `seconds` from now; at most 30 years, so that the clock can represent it.
Run::Clock::time_point seconds_from_now(double seconds);

}  // namespace weft::server
