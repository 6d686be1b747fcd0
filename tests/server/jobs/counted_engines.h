// SPDX-License-Identifier: Apache-2.0
// Engines that count their runs.
#pragma once

#include <atomic>
#include <cstdint>

#include "tests/server/job_harness.h"

namespace weft::server::testing {

// Makes meshes of so many chunks, and counts them.
inline EngineFn counting_engine(std::atomic<int>& runs, std::uint32_t chunks = 3) {
  return [&runs, chunks](const auto&, ChunkSink& sink, auto&) {
    ++runs;
    return send_chunks(sink, chunks);
  };
}

// Waits for the event before it makes a mesh.
inline EngineFn held_engine(std::atomic<int>& runs, Event& begun, Event& release) {
  return [&](const auto&, ChunkSink& sink, auto&) {
    ++runs;
    begun.set();
    release.wait();
    return send_chunks(sink, 1);
  };
}

}  // namespace weft::server::testing
