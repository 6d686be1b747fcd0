// SPDX-License-Identifier: Apache-2.0
#include "server/mesh/engine_call.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>

#include "server/wire/translate.h"

namespace weft::server {

tl::expected<Summary, Failure> call_engine(const EngineFn& engine,
                                           std::unique_ptr<v1::GenerateMeshRequest> request,
                                           ChunkSink& sink, ExecutionContext& context) noexcept {
  try {
    const MeshRequest converted = to_engine(*request);
    request.reset();
    const Result<Summary> summary = engine(converted, sink, context);
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

ExecutionContext::Clock::time_point seconds_from_now(double seconds) {
  using Clock = ExecutionContext::Clock;
  constexpr double kDecades = 1e9;
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(std::min(seconds, kDecades)));
}

}  // namespace weft::server
