// SPDX-License-Identifier: Apache-2.0
// The report on a mesh that a server made, for people and for programs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "client/call/mesh_report.h"
#include "client/report/json_line.h"
#include "files/formats/domains/region_values.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// The figures of the mesh only.
Json summary_json(const v1::Summary& summary);

// These figures, and what the client measured.
Json mesh_json(const MeshReport& report, const MeshTimes& times);

// "943,075 triangles, 472,520 vertices, angles 20.04 to 139.72 degrees\n", a line for each reason
// why triangles miss a bound, and lines on what was merged.
std::string summary_text(const v1::Summary& summary);

// A line for each of the warnings of a summary, such as "WARNING: the size does not name the field
// 'd'\n".
std::string warnings_text(const v1::Summary& summary);

// "9 segments lie outside of what is meshed, the first at (1, 0); ..."; empty if none do.
std::string outside_warning(const v1::Summary& summary);

// "WARNING: 12 triangles without exemption, 9 above the bound on their area and 3 below the minimum
// angle, because double precision ends; the first is at (1, 2)\n"; empty if there are none.
std::string unrefined_warning(const v1::Unrefined& unrefined);

// "merged within 0.001: 12 points moved, 3 segments bent, by 0.0007 at most, at (1, 2)\n2 faces of
// the input vanished, one at (1, 2)\n"; empty if nothing was merged.
std::string merging_text(const v1::Merging& merging);
// "simplified: 2,710 points, 10 islands and 9 waters dropped, 38 channels cut, 7 waters behind them
// dropped, 1 strait kept, area +3.73e+08, no line moved by more than 1e+03\n"; empty if the domain
// was not to be simplified.
std::string simplification_text(const v1::Summary& summary);
// How many triangles are in layers, and where they are thinner than they should be; empty without.
std::string layers_text(const v1::Summary& summary);
// How many polygons overlap on how large an area; empty if it is no more than rounding makes.
std::string overlap_text(const v1::Summary& summary);
// Which two segments cost many triangles, and what merges them; empty if none do.
std::string narrow_text(const v1::Summary& summary);

// "region 1 = 0.35\n", one line per region.
std::string region_values_text(std::span<const RegionValue> values);
// {"1": 0.35}
Json region_values_json(std::span<const RegionValue> values);

// A warning if the mesh has more triangles than `max_triangles` of its budget, because the domain's
// own triangulation is never reduced; nullopt if it has not. 0: no budget.
std::optional<std::string> budget_warning(const v1::Summary& summary, std::uint64_t max_triangles);

// summary_text, a line on where the time went, one on the projection if there is one, and one line
// per warning.
std::string mesh_text(const MeshReport& report, const MeshTimes& times);

}  // namespace weft::client
