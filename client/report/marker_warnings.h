// SPDX-License-Identifier: Apache-2.0
// Warnings about markers that the user asked for, or that the input has, but that edges of the mesh
// do not carry; and about regions of the input that triangles do not.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "client/call/mesh_report.h"
#include "files/formats/derived/deep_boundary.h"
#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::client {

// The markers of the edges on input segments.
std::set<std::int32_t> markers_of(const MeshView& mesh);

// "no edge of the mesh carries marker 7 of --open-boundary", at most one line; empty if all are
// there.
std::vector<std::string> open_boundary_warnings(const std::set<std::int32_t>& in_mesh,
                                                std::span<const std::int32_t> open_boundaries);

// Of what `deep_boundary(mesh, deeper, ...)` opened: a line if it is nothing.
std::vector<std::string> deep_boundary_warnings(const DeepBoundary& deep, double deeper);

// "no edge of the mesh carries marker 7 of the input: ...", at most one line; 0 is not a marker. If
// segments overlap, the mesh's edges carry the marker of one of them.
std::vector<std::string> hidden_marker_warnings(const std::set<std::int32_t>& in_mesh,
                                                const Domain& domain);

// "no triangle of the mesh carries region 8 of the input: ...", at most one line; 0 is not a
// region. Of seeds in one face, and of polygons that overlap, one decides.
std::vector<std::string> hidden_region_warnings(const MeshView& mesh, const Domain& domain);

// "segments that lie on each other have different markers ...", at most one line, which names the
// first two segments. Lines have their markers before borders of polygons, so a line on a border is
// none. Ends early if very many segments are near each other.
std::vector<std::string> contradicting_marker_warnings(const Domain& domain);

// Sets the markers of the report, and adds all kinds of warning to it; those about the input only
// if there is a domain. `domain` may be null.
void add_marker_warnings(const MeshView& mesh, std::span<const std::int32_t> open_boundaries,
                         const Domain* domain, MeshReport& report);

}  // namespace weft::client
