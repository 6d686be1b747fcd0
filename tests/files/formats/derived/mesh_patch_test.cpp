// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

using ::testing::Test;

Domain box(double x0, double y0, double x1, double y1) {
  Domain domain;
  domain.points = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  return domain;
}

// A mesh of the domain of a patch that fans out from a point inside, the centre of its points: of
// patches that are seen from there.
struct Fan {
  explicit Fan(const MeshPatch& patch) {
    const Domain& domain = patch.domain;
    for (const Point p : domain.points) {
      mesh.coordinates.insert(mesh.coordinates.end(), {p.x, p.y});
      centre.x += p.x / static_cast<double>(domain.points.size());
      centre.y += p.y / static_cast<double>(domain.points.size());
    }
    const auto middle = static_cast<std::uint32_t>(domain.points.size());
    mesh.coordinates.insert(mesh.coordinates.end(), {centre.x, centre.y});
    for (std::uint32_t p = 0; p < middle; ++p) input_points.insert(input_points.end(), {p, p});
    std::set<std::pair<std::uint32_t, std::uint32_t>> seen;  // inner segments are listed twice
    for (const Domain::Segment& s : domain.segments) {
      if (!seen.insert(std::minmax(s.a, s.b)).second) continue;
      mesh.edges.insert(mesh.edges.end(), {s.a, s.b});
      mesh.edge_markers.push_back(s.marker);
      const Point a = domain.points[s.a], b = domain.points[s.b];
      const bool left = (b.x - a.x) * (centre.y - a.y) - (b.y - a.y) * (centre.x - a.x) > 0;
      mesh.triangles.insert(mesh.triangles.end(), {left ? s.a : s.b, left ? s.b : s.a, middle});
      mesh.regions.push_back(5);
    }
  }
  MeshView view() const {
    MeshView view = mesh.view();
    view.input_points = input_points;
    return view;
  }

  Mesh mesh;
  Point centre;
  std::vector<std::uint32_t> input_points;
};

double area_of(const Mesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) {
      const std::size_t v = mesh.triangles[t + k];
      return Point{mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]};
    };
    const Point a = at(0), b = at(1), c = at(2);
    area += ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
  }
  return area;
}

Point same(Point p) {
  return p;
}

TEST(MeshPatch, HasTheTrianglesWithAllCornersInside) {
  const Mesh mesh = square_mesh(4);
  const auto within = triangles_within(mesh.view(), box(0.5, 0.5, 3.5, 3.5));
  EXPECT_EQ(std::count(within.begin(), within.end(), true), 8);
  Domain ring = box(-1, -1, 5, 5);
  for (const Point p : box(0.5, 0.5, 3.5, 3.5).points) ring.points.push_back(p);
  ring.segments.insert(ring.segments.end(), {{4, 5}, {5, 6}, {6, 7}, {7, 4}});
  const auto around = triangles_within(mesh.view(), ring);
  EXPECT_EQ(std::count(around.begin(), around.end(), true), 2) << "two corners of the square";
}

TEST(MeshPatch, KeepsItsOutlineUnderAMarkerOfItsOwn) {
  Mesh mesh = square_mesh(4);
  mesh.names.markers = {{5, "wall"}};
  const auto patch =
      cut_patch("old", mesh, triangles_within(mesh.view(), box(-0.5, 0.5, 3.5, 3.5)));
  ASSERT_TRUE(patch) << patch.error().message;
  EXPECT_EQ(patch->outline, 6) << "1 to 4 are used, 5 has a name";
  EXPECT_EQ(patch->sides, 8u);
  const auto& segments = patch->domain.segments;
  EXPECT_EQ(
      std::count_if(segments.begin(), segments.end(), [](const auto& s) { return s.marker == 6; }),
      8);
  EXPECT_EQ(
      std::count_if(segments.begin(), segments.end(), [](const auto& s) { return s.marker == 4; }),
      2)
      << "the left side";
}

TEST(MeshPatch, IsPutBackBesideWhatStays) {
  const Mesh mesh = square_mesh(4);
  const auto patch =
      cut_patch("old", mesh, triangles_within(mesh.view(), box(-0.5, 0.5, 1.5, 3.5)));
  ASSERT_TRUE(patch);
  const Fan fan(*patch);
  const auto joined = put_back(mesh, *patch, fan.view(), same);
  ASSERT_TRUE(joined) << joined.error().message;
  const Mesh& made = joined->mesh;
  EXPECT_DOUBLE_EQ(area_of(made), 16);
  EXPECT_EQ(made.triangles.size() / 3, 32u - 4u + fan.mesh.triangles.size() / 3);
  // The only vertex inside, (0, 2), is on the left side of the square, and no longer there: the
  // middle of the fan takes its number.
  std::size_t added = 0;
  for (std::size_t v = 0; v < joined->old_vertex.size(); ++v) {
    if (joined->old_vertex[v] == PatchedMesh::kNew) {
      ++added;
      continue;
    }
    EXPECT_EQ(joined->old_vertex[v], v);
    EXPECT_EQ(made.coordinates[2 * v], mesh.coordinates[2 * v]);
    EXPECT_EQ(made.coordinates[2 * v + 1], mesh.coordinates[2 * v + 1]);
  }
  EXPECT_EQ(made.coordinates.size() / 2, joined->old_vertex.size());
  EXPECT_GE(added, 1u);
  EXPECT_EQ(std::count(made.edge_markers.begin(), made.edge_markers.end(), patch->outline), 0);
  for (const std::int32_t side : {1, 2, 3, 4})
    EXPECT_EQ(std::count(made.edge_markers.begin(), made.edge_markers.end(), side), 4) << side;
}

TEST(MeshPatch, CarriesValuesLinearlyInside) {
  const Mesh mesh = square_mesh(4);
  std::vector<double> values;
  for (std::size_t v = 0; v < mesh.coordinates.size(); v += 2)
    values.push_back(3 * mesh.coordinates[v] - mesh.coordinates[v + 1] + 0.5);
  const auto patch = cut_patch("old", mesh, triangles_within(mesh.view(), box(0.5, 0.5, 3.5, 2.5)));
  ASSERT_TRUE(patch);
  const auto joined = put_back(mesh, *patch, Fan(*patch).view(), same);
  ASSERT_TRUE(joined) << joined.error().message;
  const std::vector<double> carried = joined->carried(mesh, *patch, values);
  const Mesh& made = joined->mesh;
  ASSERT_EQ(carried.size(), made.coordinates.size() / 2);
  for (std::size_t v = 0; v < carried.size(); ++v)
    EXPECT_NEAR(carried[v], 3 * made.coordinates[2 * v] - made.coordinates[2 * v + 1] + 0.5, 1e-12);
}

TEST(MeshPatch, AnOutlineThatDidNotStayIsNamed) {
  const Mesh mesh = square_mesh(4);
  const auto patch = cut_patch("old", mesh, triangles_within(mesh.view(), box(0.5, 0.5, 3.5, 3.5)));
  ASSERT_TRUE(patch);
  Fan fan(*patch);
  const std::uint32_t corner = fan.mesh.edges[0];
  std::erase_if(fan.input_points, [corner](std::uint32_t i) { return i == corner; });
  const auto split = put_back(mesh, *patch, fan.view(), same);
  ASSERT_FALSE(split);
  EXPECT_NE(split.error().message.find("the outline of the patch did not stay: the edge from ("),
            std::string::npos)
      << split.error().message;
  EXPECT_TRUE(split.error().message.ends_with(" is new")) << split.error().message;
  Fan gap(*patch);
  gap.mesh.edges.resize(gap.mesh.edges.size() - 2);
  gap.mesh.edge_markers.pop_back();
  EXPECT_TRUE(put_back(mesh, *patch, gap.view(), same).error().message.ends_with(" is gone"));
}

TEST(MeshPatch, MustBeAPart) {
  const Mesh mesh = square_mesh(2);
  EXPECT_EQ(cut_patch("old", mesh, triangles_within(mesh.view(), box(8, 8, 9, 9))).error().message,
            "old: no triangle is within the polygon");
  EXPECT_EQ(
      cut_patch("old", mesh, triangles_within(mesh.view(), box(-1, -1, 9, 9))).error().message,
      "old: all triangles are within the polygon");
}

}  // namespace
}  // namespace weft::files
