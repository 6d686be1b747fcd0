// SPDX-License-Identifier: Apache-2.0
// What the house-keeping of every store has in common: what may be much is done in steps, each a
// transaction of its own, so that others write between.
#pragma once

#include <cstdint>
#include <utility>

#include "server/store/job_store.h"

namespace weft::server {

// At most, in a step.
inline constexpr int kJobsAtOnce = 500;
inline constexpr int kMeshesAtOnce = 20;
inline constexpr int kChunksAtOnce = 50;

// A task whose lease ran out, or that has no attempt left.
struct LostTask {
  std::int64_t task = 0;
  std::int64_t tries = 0;
};

// Repeats a step, which tells what it collected, until that is nothing; adds all to `all`.
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
