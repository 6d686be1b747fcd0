// SPDX-License-Identifier: Apache-2.0
// A triangle mesh as in files. Vertices are numbered from 0; triangles are counter-clockwise.
//
// Writers take a MeshView: spans over arrays that the caller owns (vectors, or files mapped
// into memory), so a mesh larger than memory can be written. For that they go through its arrays by
// `up_to` and `in_pieces`, in their order or nearly, and keep data that grows with the mesh in
// ScratchArrays of its `pages`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/base/paged_memory.h"
#include "files/formats/names.h"
#include "files/formats/warning.h"

namespace weft::files {

// A number at each vertex, such as the depth of the water, and its name in files.
struct VertexValues {
  std::string name;
  std::span<const double> values;
};

enum class CoordinateUnit { kUnknown, kMetres, kDegrees };  // degrees: longitude and latitude

inline const Names kNoNames{};

struct MeshView {
  std::span<const double> coordinates;         // x0, y0, x1, y1, ...
  std::span<const std::uint32_t> triangles;    // three vertices each
  std::span<const std::int32_t> regions;       // one per triangle
  std::span<const std::uint32_t> edges;        // two vertices each: the edges on input segments
  std::span<const std::int32_t> edge_markers;  // one per edge
  // (vertex, index of the input point) for the vertices that are input points, and the markers of
  // the input points; either may be empty.
  std::span<const std::uint32_t> input_points;
  std::span<const std::int32_t> input_point_markers;
  // 2: a node in the middle of every side, after the corners; see second_order.h.
  std::size_t order = 1;
  PagedMemory* pages = nullptr;  // of arrays in mapped files; null: all of it is in memory
  std::span<const VertexValues> vertex_values{};  // of order 2: one number per node
  std::span<const std::int32_t> parts{};          // one per triangle, from 0; empty: not divided
  // Of each edge, the bulge (Domain::Arc) of the arc from its first vertex to its second that it is
  // a chord of; edges after the last of these are straight.
  std::span<const double> edge_bulges{};
  CoordinateUnit unit = CoordinateUnit::kUnknown;
  const Names* names = &kNoNames;  // of markers and regions; never null

  // 0, 1, ... count - 1, with steps of the pages in between.
  Numbers up_to(std::size_t count) const { return {pages, count}; }

  std::size_t triangle_nodes() const { return 3 * order; }
  std::size_t edge_nodes() const { return 1 + order; }
  std::size_t vertex_count() const { return coordinates.size() / 2; }
  std::size_t triangle_count() const { return triangles.size() / triangle_nodes(); }
  std::size_t edge_count() const { return edges.size() / edge_nodes(); }
};

// Faces of any number of corners.
struct Faces {
  std::vector<std::uint32_t> corners;  // of all, one after the other
  std::vector<std::size_t> ends;       // of each face in `corners`
  std::vector<std::int32_t> regions;   // of each face
  std::vector<std::int32_t> parts{};   // of each face, or empty

  void add(std::span<const std::uint32_t> more, std::int32_t region) {
    corners.insert(corners.end(), more.begin(), more.end());
    ends.push_back(corners.size());
    regions.push_back(region);
  }
  std::size_t size() const { return ends.size(); }
  std::span<const std::uint32_t> of(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : ends[i - 1];
    return std::span(corners).subspan(first, ends[i] - first);
  }
  friend bool operator==(const Faces&, const Faces&) = default;
};

struct Mesh {
  std::vector<double> coordinates;
  std::vector<std::uint32_t> triangles;
  std::vector<std::int32_t> regions;
  std::vector<std::uint32_t> edges;
  std::vector<std::int32_t> edge_markers;
  Names names{};                             // of markers and regions
  std::vector<std::int32_t> parts{};         // one per triangle, from 0; empty: not divided
  std::vector<Warning> warnings{};           // about the file
  std::vector<double> edge_bulges{};         // one per edge, or empty: all are straight
  std::vector<std::int32_t> open_markers{};  // of boundaries that the file calls open
  Faces faces{};  // while it is read: those that are no triangles (faces.h)
  // While it is read: both ends of sides of triangles and of edges, and the node in their middle
  // (middles.h); then of each vertex the node in a file of second order, or empty.
  std::vector<std::array<std::uint32_t, 3>> middles{};
  std::vector<std::uint32_t> nodes{};
  std::size_t cut_faces = 0;  // of these, those that became several triangles

  // REQUIRES: the mesh outlives the view.
  MeshView view() const {
    MeshView view{coordinates, triangles, regions, edges, edge_markers, {}, {}, 1};
    view.parts = parts;
    view.edge_bulges = edge_bulges;
    view.names = &names;
    return view;
  }
  friend bool operator==(const Mesh&, const Mesh&) = default;
};

}  // namespace weft::files
