// SPDX-License-Identifier: Apache-2.0
#include "server/run/engine_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "server/run/memory_estimate.h"
#include "server/run/run_memory.h"

namespace weft::server {
namespace {

using Clock = Run::Clock;

// Passes each chunk of a run that begins again on once.
class ChunksOnce final : public ChunkSink {
 public:
  explicit ChunksOnce(ChunkSink& sink) : sink_(sink) {}

  bool accept(Chunk&& chunk) override {
    if (chunk.index < taken_) return true;
    ++taken_;
    return sink_.accept(std::move(chunk));
  }

 private:
  ChunkSink& sink_;
  std::uint32_t taken_ = 0;
};

// Runs on this thread. Returns nullopt if the run is not light.
std::optional<Result<Summary>> try_as_light(const EngineFn& engine, const MeshRequest& request,
                                            ChunkSink& sink, const EngineRun& call,
                                            RunMemory& memory) {
  const Clock::time_point end = std::min(call.deadline, Clock::now() + kLightTime);
  call.run.set_deadline(end);
  memory.limit_to(kLightBytes);
  call.run.set_memory(memory, memory.granted());
  Result<Summary> summary = engine(request, sink, call.run);
  const bool took_long =
      !summary && summary.error().code == ErrorCode::kDeadlineExceeded && end < call.deadline;
  if (took_long || memory.limit_was_reached()) return std::nullopt;
  return summary;
}

Result<Summary> run_engine(const EngineFn& engine, const MeshRequest& request, ChunkSink& sink,
                           const EngineRun& call) {
  ChunksOnce chunks_once(sink);
  RunMemory memory(call.slot.memory(), call.besides);
  if (call.slot.is_light()) {
    if (auto summary = try_as_light(engine, request, chunks_once, call, memory)) return *summary;
    call.run.begin_again();
    memory.begin_again();
  }
  call.run.set_deadline(call.deadline);
  call.slot.promote([&call] { return call.run.poll().has_value(); });
  call.run.set_threads(call.pool, static_cast<int>(call.threads));
  call.run.set_memory(memory, memory.granted());
  return engine(request, chunks_once, call.run);
}

}  // namespace

tl::expected<Summary, Failure> call_engine(const EngineFn& engine, MeshRequest request,
                                           ChunkSink& sink, const EngineRun& call) noexcept {
  try {
    const Result<Summary> summary = run_engine(engine, request, sink, call);
    if (!summary) return tl::unexpected(failure_of(summary.error()));
    return *summary;
  } catch (const std::bad_alloc&) {
    return tl::unexpected(Failure{Reason::kOutOfMemory, "", "the server is out of memory"});
  } catch (const std::exception& error) {
    return tl::unexpected(
        Failure{Reason::kInternal, "", fmt::format("the engine failed: {}", error.what())});
  } catch (...) {
    return tl::unexpected(Failure{Reason::kInternal, "", "the engine failed"});
  }
}

Run::Clock::time_point seconds_from_now(double seconds) {
  constexpr double kDecades = 1e9;
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, kDecades)));
}

}  // namespace weft::server
