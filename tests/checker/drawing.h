// SPDX-License-Identifier: Apache-2.0
// Hand-made meshes of domains with arcs: lines and arcs are drawn with the vertices that they pass,
// and triangulated by brute force.
//
//   Drawing drawing;
//   drawing.arc({0, 0}, 1, 0, 180, 6).arc({0, 0}, 1, 180, 360, 6);
//   Problem problem = drawing.mesh([](Vec2) { return true; });
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/checker/lattice.h"

namespace weft::check::testing {

// A point of a circle, at an angle in degrees.
Vec2 on_circle(Vec2 centre, double radius, double degrees);

class Drawing {
 public:
  // A segment, through places. Ends and places that are nearer than 1e-9 to what was drawn before
  // are the same.
  Drawing& line(const std::vector<Vec2>& through, std::int32_t marker = 0);
  // An arc from one angle to another, in degrees; to the right if the second is smaller. Its chain
  // is that many equal edges; 0: the mesh has none.
  Drawing& arc(Vec2 centre, double radius, double from, double to, int pieces,
               std::int32_t marker = 0);
  // The same through places at the given angles.
  Drawing& arc(Vec2 centre, double radius, const std::vector<double>& degrees,
               std::int32_t marker = 0);
  // A segment that the mesh lacks.
  Drawing& unmeshed_line(Vec2 from, Vec2 to);
  // A vertex of the mesh that no segment names.
  Drawing& vertex(Vec2 at);
  Drawing& hole(Vec2 at);
  Drawing& region(Vec2 at, std::int32_t id);
  Drawing& fill(Fill fill);

  // A constrained Delaunay triangulation of the vertices, with the triangles whose centroids are
  // kept, and the regions that `region` says.
  Problem mesh(const std::function<bool(Vec2)>& keep,
               const std::function<std::int32_t(Vec2)>& region = {}) const;

 private:
  std::uint32_t point_at(Vec2 at);
  std::uint32_t vertex_at(Vec2 at);
  void segment(Vec2 from, Vec2 to, std::int32_t marker);

  Domain domain_;
  Mesh mesh_;
};

// Flips edges that are not listed until none is left that is not Delaunay.
void make_delaunay(Mesh& mesh);

// The index of a mesh vertex nearer than 1e-6 to a place.
std::uint32_t vertex_near(const Mesh& mesh, Vec2 p);

// What a report says of a rule, all sentences of it.
std::string sentences(const Report& report, Rule rule);

}  // namespace weft::check::testing
