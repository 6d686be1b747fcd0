// SPDX-License-Identifier: Apache-2.0
// What a client knows of a mesh that a server made, besides the mesh.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "client/base/files.h"
#include "files/geo/domain_projection.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// What came with a mesh.
struct MeshReport {
  v1::Accepted accepted;
  v1::Summary summary;
  double first_chunk_seconds = 0;  // from sending the request
  double stream_seconds = 0;       // from sending the request to the end of the stream
  std::uint64_t bytes_received = 0;
  std::set<std::int32_t> markers{};  // of the mesh's edges on input segments; empty without output
  std::vector<std::string> warnings{};                   // for people; each is one line
  std::shared_ptr<const DomainProjection> projection{};  // null: the domain was not projected
};

// When each step of a command was done.
struct MeshTimes {
  using Clock = std::chrono::steady_clock;

  Clock::time_point start = Clock::now();
  Clock::time_point read = start;       // the input
  Clock::time_point connected = start;  // to the server
  Clock::time_point received = start;   // the mesh
  Clock::time_point written = start;    // the files
};

// Adds the warnings that the report does not have yet.
void add_warnings(const std::vector<std::string>& warnings, MeshReport& report);

}  // namespace weft::client
