// SPDX-License-Identifier: Apache-2.0
// Layers of thin triangles along walls, and the columns that they are made of: lines of vertices
// from a wall to where the layers end, at heights that the request gives.
#pragma once

#include <cstdint>
#include <vector>

#include "checker/edges/half_edges.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"
#include "checker/mesh/chains.h"
#include "checker/report.h"

namespace weft::check {

// Rows along the edges with a marker, the first `first` high at most, each `ratio` times as high as
// the one before. All triangles with the region are theirs.
struct LayerRows {
  std::int32_t marker = 0;
  double first = 0;
  double ratio = 1;
  std::uint32_t rows = 1;
  std::int32_t region = 0;
};

// Adds violations of kLayers:
//   - a triangle at an edge with the marker is not of the region;
//   - a vertex of the region is in no column. A column leads from a vertex on the wall to one
//   beside
//     another region, by edges of the region's triangles; its vertices lie on a line, to 1e-9 of
//     its length and 2^-44 of the largest coordinate, at the rows' heights over their sum;
//   - a column reaches farther from the wall's edges than the sum of the heights.
// Returns whether each triangle is in layers. REQUIRES: structure and conformity hold.
std::vector<bool> judge_layers(const Mesh& mesh, const HalfEdges& half_edges,
                               const ListedEdges& listed, const std::vector<LayerRows>& layers,
                               Findings& findings);

// The mesh with the regions that the layers' triangles would have without them: those beyond the
// line where they end.
Mesh without_regions_of_layers(const Mesh& mesh, const HalfEdges& half_edges,
                               const ListedEdges& listed, std::vector<bool> is_layer);

// `listed`, and as if listed all edges of triangles in layers.
ListedEdges with_edges_of_layers(const HalfEdges& half_edges, ListedEdges listed,
                                 const std::vector<bool>& is_layer);

// Adds the straight parts of the line on which layers end, numbered after all segments. Sorted.
void add_lines_of_layers(const Mesh& mesh, const HalfEdges& half_edges,
                         const std::vector<bool>& is_layer, SegmentsOfVertices& segments);

}  // namespace weft::check
