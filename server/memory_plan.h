// SPDX-License-Identifier: Apache-2.0
// How --memory is divided, so that the whole process stays within it.
#pragma once

#include <cstdint>

#include "server/server.h"

namespace weft::server {

struct MemoryPlan {
  // Messages that are being received; those of the console once more. Those that wait to be parsed,
  // and requests that wait for their run, have as much of `runs`.
  std::uint64_t received = 0;
  std::uint64_t kept = 0;  // pages that runs which have ended leave for later ones
  std::uint64_t runs = 0;  // and for requests that wait for theirs; the rest
};

// The process itself, and what the allocator has of pages that are used in part: an idle server has
// 29 MiB.
inline constexpr std::uint64_t kBytesOfProcess = std::uint64_t{32} << 20;
// The least for runs: one that is light.
inline constexpr std::uint64_t kLeastBytesOfRuns = std::uint64_t{32} << 20;

// Its `runs` are 0 if there is not enough for all else.
MemoryPlan plan_memory(const ServerOptions& options);

}  // namespace weft::server
