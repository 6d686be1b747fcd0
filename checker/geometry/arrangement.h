// SPDX-License-Identifier: Apache-2.0
// The exact arrangement of line segments: vertices, edges, faces. Segments may cross, overlap,
// repeat and dangle; components may be nested. Nothing is rounded: crossing points are rational,
// and every decision is made by exact predicates.
//
//   Arrangement arrangement(points, segments, find_contacts(points, segments, limit));
//   Arrangement::Place place = arrangement.locate(seed);
//
// Half-edge 2e runs along edge e from its lexicographically smaller end, 2e + 1 back. The face of a
// half-edge is on its left. Face 0 is the unbounded one. Memory and time are O(n log n) for n
// segments and contacts. Immutable after construction, thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "checker/domain.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/contacts.h"
#include "checker/geometry/vertex_order.h"

namespace weft::check {

class Arrangement {
 public:
  // A maximal piece of a segment without a vertex inside.
  struct Edge {
    std::uint32_t u, v;  // vertices, u < v
    Vec2 from, to;       // ends of a segment that it is part of, directed as u -> v
    std::uint32_t first_cover, end_cover;
  };
  struct Face {
    double area = 0;       // of the unbounded face: minus that of all others
    double perimeter = 0;  // an edge with the face on both sides counts twice
  };
  // A face's inside, or an edge that the point lies on.
  struct Place {
    std::uint32_t face = 0;
    std::optional<std::uint32_t> edge;
  };

  // The segments from number `links` on are links: they bound faces, but cover nothing.
  // REQUIRES: as find_contacts, which must be complete.
  Arrangement(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
              const Contacts& contacts, std::size_t links);
  Arrangement(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
              const Contacts& contacts)
      : Arrangement(points, segments, contacts, segments.size()) {}

  const VertexOrder& vertices() const { return vertices_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Face>& faces() const { return faces_; }
  std::uint32_t face(std::uint32_t half_edge) const { return face_[half_edge]; }
  // The segments that an edge is part of, ascending; empty if it is part of links only.
  std::span<const std::uint32_t> covers(std::uint32_t edge) const {
    return {covers_.data() + edges_[edge].first_cover, covers_.data() + edges_[edge].end_cover};
  }
  // The edges of a segment, in lexicographic order along it.
  std::span<const std::uint32_t> edges_of(std::uint32_t segment) const {
    return {segment_edges_.data() + first_edge_[segment],
            segment_edges_.data() + first_edge_[segment + 1]};
  }
  // The half-edges that start at a vertex, counter-clockwise from the direction of x.
  std::span<const std::uint32_t> half_edges_at(std::uint32_t vertex) const {
    return {outgoing_.data() + first_outgoing_[vertex],
            outgoing_.data() + first_outgoing_[vertex + 1]};
  }

  Place locate(Vec2 p) const;

 private:
  void split(std::span<const Vec2> points, std::span<const SegmentEnds> segments,
             const Contacts& contacts, std::size_t links);
  void sort_around_vertices();
  void trace_faces();
  void measure_faces();
  std::uint32_t start(std::uint32_t half_edge) const;
  bool points_up(std::uint32_t half_edge) const;
  bool turns_before(std::uint32_t h, std::uint32_t g) const;
  bool farther_right(std::uint32_t e, std::uint32_t f, double y) const;

  VertexOrder vertices_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> covers_;
  std::vector<std::uint32_t> segment_edges_, first_edge_;
  std::vector<std::uint32_t> outgoing_, first_outgoing_;
  std::vector<std::uint32_t> face_;  // per half-edge
  std::vector<Face> faces_;
  BoxTree tree_;  // of the edges
};

}  // namespace weft::check
