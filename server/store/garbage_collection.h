// SPDX-License-Identifier: Apache-2.0
// Common to the house-keeping of every store: work that may be large is done in steps, each in its
// own transaction, so that others can write in between.
#pragma once

#include <cstdint>
#include <utility>

#include "server/store/job_store.h"

namespace weft::server {

// Maximum jobs per step.
inline constexpr int kJobsAtOnce = 500;
inline constexpr int kMeshesAtOnce = 20;
inline constexpr int kChunksAtOnce = 50;

// A task whose lease ran out, or that has no attempts left.
struct LostTask {
  std::int64_t task = 0;
  std::int64_t tries = 0;
};

// What the meshes of one owner may take.
inline std::int64_t bytes_of_owner(const KeepPolicy& policy) {
  return static_cast<std::int64_t>(policy.share_of_owner * static_cast<double>(policy.bytes));
}

// Repeats a step, which returns what it collected, until that is nothing; adds it up in `all`.
template <class Step>
StoreResult<void> collect_in_steps(Collected& all, Step&& step) {
  while (true) {
    const StoreResult<Collected> some = step();
    if (!some) return tl::unexpected(some.error());
    if (*some == Collected{}) return {};
    all.jobs += some->jobs;
    all.meshes += some->meshes;
    all.chunks += some->chunks;
    all.bytes += some->bytes;
  }
}

}  // namespace weft::server
