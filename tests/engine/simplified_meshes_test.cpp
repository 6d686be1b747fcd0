// SPDX-License-Identifier: Apache-2.0
// The engine as a whole, on domains that it simplifies first: coasts, and random ones with islands
// that touch, judged by the checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"
#include "tests/support/generator.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

// The midpoints of a path are moved aside by up to `roughness` of its length, again and again.
void add_fractal(std::vector<Point>& path, Point a, Point b, int depth, double roughness,
                 Generator& random) {
  if (depth == 0) {
    path.push_back(a);
    return;
  }
  const double aside = roughness * (2 * random.unit() - 1);
  const Point m{(a.x + b.x) / 2 - aside * (b.y - a.y), (a.y + b.y) / 2 + aside * (b.x - a.x)};
  add_fractal(path, a, m, depth - 1, roughness, random);
  add_fractal(path, m, b, depth - 1, roughness, random);
}

std::vector<Point> fractal_ring(const std::vector<Point>& corners, int depth, double roughness,
                                Generator& random) {
  std::vector<Point> ring;
  for (std::size_t i = 0; i < corners.size(); ++i)
    add_fractal(ring, corners[i], corners[(i + 1) % corners.size()], depth, roughness, random);
  return ring;
}

// A sea of 100 by 100 with a fractal coast to the west, and islands that touch and overlap each
// other and the coast. Its lines may cross themselves. Open boundaries have markers of their own.
Pslg random_coast(std::uint32_t seed) {
  Generator random(seed);
  Pslg pslg;
  std::vector<Point> coast;
  add_fractal(coast, {20 + 20 * random.unit(), 100}, {20 + 20 * random.unit(), 0}, 7,
              0.15 + 0.3 * random.unit(), random);
  for (Point& p : coast) p.x = std::clamp(p.x, 0.5, 80.0), p.y = std::clamp(p.y, 0.0, 100.0);
  coast.erase(std::unique(coast.begin(), coast.end()), coast.end());
  std::vector<Point> ring{coast};
  ring.push_back({30, 0});
  ring.push_back({100, 0});
  ring.push_back({100, 100});
  add_ring(pslg, ring, 1);
  for (std::size_t i = coast.size(); i < pslg.segments.size(); ++i)
    pslg.segments[i].marker = 10 + static_cast<std::int32_t>(i - coast.size());
  add_area(pslg, 0, {});
  const int islands = random.below(12);
  for (int i = 0; i < islands; ++i) {
    const std::size_t first = pslg.segments.size();
    const double size = 0.3 + 12 * random.unit() * random.unit();
    const Point at{25 + 60 * random.unit(), 10 + 80 * random.unit()};
    const int corners = 3 + random.below(4);
    std::vector<Point> outline;
    for (int k = 0; k < corners; ++k) {
      const double angle = 6.283185307179586 * (k + 0.5 * random.unit()) / corners;
      outline.push_back({at.x + size * std::cos(angle), at.y + size * std::sin(angle)});
    }
    // Some touch a point of what is there already.
    if (random.below(3) == 0)
      outline[0] =
          pslg.points[static_cast<std::size_t>(random.below(static_cast<int>(pslg.points.size())))];
    add_ring(pslg, fractal_ring(outline, random.below(4), 0.3 * random.unit(), random),
             random.below(2) == 0 ? 2 : 3 + i);
    add_area(pslg, first, {.is_hole = true});
  }
  pslg.fill = Fill::kUnion;
  return pslg;
}

struct Meshed {
  CollectedMesh mesh;
  Summary summary;
};

testing::AssertionResult judge(const MeshRequest& request, Meshed& out) {
  ExecutionContext context;
  auto summary = generate_mesh(request, out.mesh, context);
  if (!summary)
    return testing::AssertionFailure() << summary.error().field << ": " << summary.error().message;
  out.summary = *summary;
  const std::string found = verdict(request, out.mesh, *summary);
  return found.empty() ? testing::AssertionSuccess() : testing::AssertionFailure() << found;
}

double shortest_edge(const check::Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const check::Vec2 p = mesh.vertices[t[k]], q = mesh.vertices[t[(k + 1) % 3]];
      shortest = std::min(shortest, std::hypot(p.x - q.x, p.y - q.y));
    }
  return shortest;
}

SizeSpec edges(SizeSpec::Value value) {
  SizeSpec size;
  size.value = std::move(value);
  size.measure = Measure::kEdge;
  return size;
}

// us-east-coast in metres, roughly; edges of 8 km.
MeshRequest coast_request() {
  MeshRequest request{.pslg = read_poly(model("us-east-coast.poly")), .size = edges(8000.0)};
  constexpr double kDegree = 111'195;
  constexpr double kCosine = 0.819;
  for (auto* points : {&request.pslg.points, &request.pslg.holes})
    for (Point& p : *points) p = {p.x * kDegree * kCosine, p.y * kDegree};
  return request;
}

TEST(SimplifiedMesh, OfACoastHasLongerEdges) {
  MeshRequest request = coast_request();
  Meshed before;
  ASSERT_TRUE(judge(request, before));
  request.simplify = 0.5;
  request.min_edge = 2000;
  Meshed after;
  ASSERT_TRUE(judge(request, after));
  EXPECT_GT(shortest_edge(after.mesh.mesh), 30 * shortest_edge(before.mesh.mesh));
  EXPECT_GT(after.summary.min_angle_deg, 20);
  const Simplification& changes = *after.summary.simplified;
  EXPECT_GT(changes.points, 2000u);
  EXPECT_GT(changes.channels, 10u);
  EXPECT_LE(changes.farthest, 4000);
}

TEST(SimplifiedMesh, IsTheSameOnAnyNumberOfThreads) {
  MeshRequest request = coast_request();
  request.simplify = 0.5;
  CollectedMesh one, four;
  ExecutionContext serial, parallel;
  Arena arena(4);
  parallel.set_arena(arena);
  const auto a = generate_mesh(request, one, serial);
  const auto b = generate_mesh(request, four, parallel);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->digest, b->digest);
}

TEST(SimplifiedMesh, NeedsASize) {
  MeshRequest request{.pslg = random_coast(1)};
  request.simplify = 0.5;
  CollectedMesh mesh;
  ExecutionContext context;
  const auto summary = generate_mesh(request, mesh, context);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kBadOption);
  EXPECT_EQ(summary.error().field, "simplify");
  request.simplify = -1;
  EXPECT_EQ(check_options(request)->field, "simplify");
}

TEST(SimplifiedMesh, MeetsAGradationWithinTheDomain) {
  MeshRequest request{.pslg = random_coast(3), .size = edges("max(0.5, 0.1 * x)")};
  request.size.gradation = 0.2;
  request.size.gradation_within = true;
  request.simplify = 0.5;
  request.allow_unrefined = true;
  Meshed meshed;
  EXPECT_TRUE(judge(request, meshed));
}

TEST(SimplifiedMesh, OfRandomCoastsHoldsAgainstTheOriginal) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const double edge = 1 + seed % 7;
    MeshRequest request{.pslg = random_coast(seed), .size = edges(edge)};
    request.simplify = 0.25 * (1 + seed % 4);
    request.allow_unrefined = true;
    Meshed meshed;
    EXPECT_TRUE(judge(request, meshed)) << "seed " << seed;
  }
}

TEST(SimplifiedMesh, OfASizeThatVariesHoldsAgainstTheOriginal) {
  for (std::uint32_t seed = 100; seed < 120; ++seed) {
    MeshRequest request{.pslg = random_coast(seed), .size = edges("0.5 + 0.1 * x")};
    request.simplify = 0.5;
    request.allow_unrefined = true;
    Meshed meshed;
    EXPECT_TRUE(judge(request, meshed)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace weft
