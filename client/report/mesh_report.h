// SPDX-License-Identifier: Apache-2.0
// The report on a mesh that a server made, for people and for programs.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "client/formats/domains/region_values.h"
#include "client/geo/domain_projection.h"
#include "client/report/json_line.h"
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

// The figures of the mesh only.
Json summary_json(const v1::Summary& summary);

// These figures, and what the client measured.
Json mesh_json(const MeshReport& report, const MeshTimes& times);

// "943,075 triangles, 472,520 vertices, angles 20.04 to 139.72 degrees\n", a line for each reason
// why triangles miss a bound, and lines on what was merged.
std::string summary_text(const v1::Summary& summary);

// "WARNING: 12 triangles without excuse, 9 above the bound on their area and 3 below the minimum
// angle, because double precision ends; the first is at (1, 2)\n"; empty if there are none.
std::string unrefined_warning(const v1::Unrefined& unrefined);

// "merged within 0.001: 12 points moved, 3 segments bent, by 0.0007 at most, at (1, 2)\n2 faces of
// the input vanished, one at (1, 2)\n"; empty if nothing was merged.
std::string merging_text(const v1::Merging& merging);

// "region 1 = 0.35\n", one line per region.
std::string region_values_text(std::span<const RegionValue> values);
// {"1": 0.35}
Json region_values_json(std::span<const RegionValue> values);

// A warning if the mesh has more triangles than `max_triangles` of its budget, because the domain's
// own triangulation is never reduced; nullopt if it has not.
std::optional<std::string> budget_warning(const v1::Summary& summary,
                                          std::optional<std::uint64_t> max_triangles);

// summary_text, a line on where the time went, one on the projection if there is one, and one line
// per warning.
std::string mesh_text(const MeshReport& report, const MeshTimes& times);

}  // namespace weft::client
