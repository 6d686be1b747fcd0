// SPDX-License-Identifier: Apache-2.0
// The limit within the domain against closed forms, and against shortest paths through a graph of
// all corners that see each other.
#include "engine/gradation_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/arena.h"
#include "engine/engine.h"
#include "engine/size/box_overlap.h"
#include "engine/size/gradation/within_size.h"
#include "engine/size/size_spec.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/sound.h"
#include "tests/engine/size/fields/field_laws.h"
#include "tests/support/collected_mesh.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double apart(Point p, Point q) {
  return std::sqrt(distance2(p, q));
}

// Two arms, x < 3 and x > 5, joined below y = 1.
Pslg u_shape() {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {8, 0}, {8, 8}, {5, 8}, {5, 1}, {3, 1}, {3, 8}, {0, 8}});
  return pslg;
}

// A square of 8, of which a wall from the top leaves a way open at the bottom.
Pslg walled(double thickness) {
  Pslg pslg = square(8);
  add_ring(pslg, {{4, 1}, {4 + thickness, 1}, {4 + thickness, 7.99}, {4, 7.99}});
  pslg.holes.push_back({4 + thickness / 2, 4});
  add_ring(pslg, {{3.9, 7.98}, {4.1, 7.98}, {4.1, 8}, {3.9, 8}});
  pslg.holes.push_back({4.05, 7.995});
  return pslg;
}

// A length of edges limited within a domain, as the engine does it.
struct Within {
  Within(SizeSpec of, Pslg domain_of, int threads = 1) : arena(threads) {
    request.pslg = std::move(domain_of);
    request.size = std::move(of);
    request.size.measure = Measure::kEdge;
    context.set_arena(arena);
    domain = *triangulate(request.pslg, context);
    size.emplace(*make_size(request.size, request.pslg, domain, context));
    const SizeFunction* const unlimited = size->limited_across_land();
    if (unlimited == nullptr) return;
    Box box;
    for (const Point p : domain.vertices) box.add(p);
    auto limit = limit_within(request, domain, domain, box, size->function(), *unlimited, context);
    EXPECT_TRUE(limit.has_value());
    size->add(std::make_unique<WithinSize>(size->function(), *unlimited, std::move(*limit)));
  }

  double operator()(Point p) const { return SizeFunction::edge_of_area(size->function()(p)); }

  MeshRequest request;
  Arena arena;
  ExecutionContext context;
  Domain domain;
  std::optional<Size> size;
};

SizeSpec graded(const std::string& edge, double gradation) {
  SizeSpec spec(edge);
  spec.measure = Measure::kEdge;
  spec.gradation = gradation;
  return spec;
}

bool in(const Domain& domain, Point p) {
  for (std::uint32_t t = 0; t < domain.triangles.size(); ++t) {
    const Corners c = corners_of(domain, t);
    bool all = true;
    for (unsigned k = 0; k < 3; ++k) {
      const Point a = c[k];
      const Point b = c[(k + 1) % 3];
      all = all && (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= -1e-12;
    }
    if (all) return true;
  }
  return false;
}

std::vector<Point> points_in(const Domain& domain, std::size_t count) {
  Box box;
  for (const Point p : domain.vertices) box.add(p);
  std::mt19937_64 random(5);
  std::vector<Point> points;
  while (points.size() < count) {
    const Point p{box.min_x + box.width() * uniform(random),
                  box.min_y + box.height() * uniform(random)};
    if (in(domain, p)) points.push_back(p);
  }
  return points;
}

// Never below the exact limit: the least over `sources`, along paths that turn at corners.
class Paths {
 public:
  using Sources = std::vector<std::pair<Point, double>>;

  Paths(const Domain& domain, double gradation, Sources sources)
      : domain_(domain), gradation_(gradation), items_(std::move(sources)) {
    for (const auto& t : domain.triangles)
      for (unsigned k = 0; k < 3; ++k)
        if (t.neighbor[k] == kNone)
          border_.push_back(
              {domain.vertices[t.vertex[(k + 1) % 3]], domain.vertices[t.vertex[(k + 2) % 3]]});
    std::vector<std::pair<Point, double>> corners;
    for (const Point p : domain.vertices) corners.emplace_back(p, kInfinity);
    std::vector<bool> done(corners.size(), false);
    for (auto& [p, value] : corners) value = least(p);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      std::size_t next = corners.size();
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (!done[k] && (next == corners.size() || corners[k].second < corners[next].second))
          next = k;
      done[next] = true;
      const auto [p, value] = corners[next];
      for (auto& [q, other] : corners) {
        const double way = value + gradation_ * apart(p, q);
        if (way < other && sees(p, q)) other = way;
      }
    }
    items_.insert(items_.end(), corners.begin(), corners.end());
  }

  double operator()(Point p) const { return least(p); }

 private:
  double least(Point p) const {
    double found = kInfinity;
    for (const auto& [q, value] : items_) {
      const double way = value + gradation_ * apart(p, q);
      if (way < found && sees(p, q)) found = way;
    }
    return found;
  }

  // Whether the way is free: it crosses no side, and its middle is not in land, as that between two
  // corners might be.
  bool sees(Point p, Point q) const {
    const auto turn = [](Point a, Point b, Point c) {
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    for (const auto& [a, b] : border_) {
      if (turn(p, q, a) * turn(p, q, b) < -1e-12 && turn(a, b, p) * turn(a, b, q) < -1e-12)
        return false;
    }
    return in(domain_, {0.5 * (p.x + q.x), 0.5 * (p.y + q.y)});
  }

  const Domain& domain_;
  const double gradation_;
  Sources items_;
  std::vector<std::array<Point, 2>> border_;
};

// Nowhere above the exact limit, and hardly below.
void expect_near(const Within& within, const std::function<double(Point)>& exact) {
  std::vector<double> shares;
  for (const Point p : points_in(within.domain, 4000)) {
    const double limit = exact(p);
    shares.push_back(within(p) / limit);
    ASSERT_LE(within(p), limit * (1 + 1e-9)) << p.x << " " << p.y;
  }
  std::sort(shares.begin(), shares.end());
  EXPECT_GE(shares[shares.size() / 100], 0.95);
  EXPECT_GE(shares[shares.size() / 2], 0.96);
}

// Points around a disk from which edges grow.
Paths::Sources around(Point middle, double radius, double edge) {
  Paths::Sources sources;
  for (int i = 0; i < 256; ++i)
    sources.push_back({{middle.x + radius * std::cos(i * 0.024543692606170259),
                        middle.y + radius * std::sin(i * 0.024543692606170259)},
                       edge});
  return sources;
}

TEST(GradationMesh, OfASpotInAUIsAConeAroundTheBend) {
  const auto exact = [](double gradation) {
    return [gradation](Point p) {
      const Point spot{1, 7};
      const Point first{3, 1};
      const Point second{5, 1};
      double d = apart(p, spot);
      if (p.x > 3 && (p.y - 1) * (3 - 1) > (1 - 7) * (p.x - 3))  // beyond the line of sight
        d = p.x > 5 && p.y > 1 ? apart(spot, first) + 2 + apart(second, p)
                               : apart(spot, first) + apart(first, p);
      return std::min(20.0, 0.02 + gradation * std::max(0.0, d - 0.25));
    };
  };
  for (const double gradation : {0.05, 0.15, 0.5}) {
    SCOPED_TRACE(gradation);
    expect_near({graded("hypot(x-1, y-7) < 0.25 ? 0.02 : 20", gradation), u_shape()},
                exact(gradation));
  }
}

TEST(GradationMesh, GoesAroundAThinWall) {
  for (const double gradation : {0.05, 0.15, 0.5}) {
    SCOPED_TRACE(gradation);
    const Within within(graded("hypot(x-3.5, y-4) < 0.1 ? 0.01 : 20", gradation), walled(0.001));
    const Paths paths(within.domain, gradation, around({3.5, 4}, 0.1, 0.01));
    expect_near(within, [&](Point p) {
      return apart(p, {3.5, 4}) <= 0.1 ? 0.01 : std::min(20.0, paths(p));
    });
  }
}

TEST(GradationMesh, GoesAroundIslands) {
  Pslg pslg = square(16);
  std::mt19937_64 random(3);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Point at{1 + 4.0 * i + uniform(random), 1 + 4.0 * j + uniform(random)};
      std::vector<Point> ring;
      for (int k = 0; k < 9; ++k) {
        const double r = 0.8 + 0.6 * uniform(random);
        ring.push_back({at.x + 1 + r * std::cos(k * 0.698), at.y + 1 + r * std::sin(k * 0.698)});
      }
      add_ring(pslg, ring);
      pslg.holes.push_back({at.x + 1, at.y + 1});
    }
  }
  for (const double gradation : {0.05, 0.15, 0.5}) {
    SCOPED_TRACE(gradation);
    const Within within(graded("hypot(x-0.5, y-0.5) < 0.1 ? 0.05 : 20", gradation), pslg);
    const Paths paths(within.domain, gradation, around({0.5, 0.5}, 0.1, 0.05));
    expect_near(within, [&](Point p) {
      return apart(p, {0.5, 0.5}) <= 0.1 ? 0.05 : std::min(20.0, paths(p));
    });
  }
}

// The left wall of the left arm has the marker 1, the bottom of the right one is a region.
Pslg u_with_parts() {
  Pslg pslg = u_shape();
  pslg.segments.back().marker = 1;
  add_segment(pslg, {5, 1}, {8, 1});
  pslg.regions.push_back({{6, 0.5}, 4, std::nullopt});
  return pslg;
}

TEST(GradationMesh, GrowsFromSegmentsWithASizeOfTheirOwn) {
  SizeSpec spec = graded("20", 0.2);
  spec.at.push_back({1, 0.1});
  const Within within(spec, u_with_parts());
  expect_near(within, [](Point p) {
    double d = p.x;
    if (p.x > 3 && p.y > 1) d = apart({3, 1}, {5, 1}) + 3 + apart({5, 1}, p);
    return 0.1 + 0.2 * d;
  });
}

TEST(GradationMesh, GrowsFromRegionsWithABoundOfTheirOwn) {
  Pslg pslg = u_with_parts();
  add_segment(pslg, {0, 7}, {3, 7});
  pslg.regions.push_back({{1, 7.5}, 5, area_of_edge(0.1)});
  const Within within(graded("20", 0.2), pslg);
  expect_near(within, [&](Point p) {
    if (p.y > 7 && p.x < 3) return within(p);  // where the region itself bounds areas
    double d = 7 - p.y;
    if (p.x > 3) d = p.y > 1 && p.x > 5 ? 6 + 2 + apart({5, 1}, p) : 6 + apart({3, 1}, p);
    return 0.1 + 0.2 * d;
  });
}

MeshRequest spot_in_a_u() {
  MeshRequest request{.pslg = u_shape(),
                      .size = graded("hypot(x-1, y-7) < 0.25 ? 0.02 : 20", 0.15)};
  request.size.gradation_within = true;
  return request;
}

// The mesh and its digest, whatever the checker says of it.
struct Made {
  explicit Made(const MeshRequest& request, int threads = 1) : arena(threads) {
    context.set_arena(arena);
    summary = generate_mesh(request, mesh, context);
    EXPECT_TRUE(summary.has_value());
    if (!summary) return;
    EXPECT_EQ(verdict(request, mesh, *summary), "");
    digest = summary->digest;
  }
  std::size_t in_right_arm() const {
    return static_cast<std::size_t>(
        std::count_if(mesh.mesh.vertices.begin(), mesh.mesh.vertices.end(),
                      [](check::Vec2 p) { return p.x > 5 && p.y > 1.5; }));
  }

  Arena arena;
  ExecutionContext context;
  CollectedMesh mesh;
  Result<Summary> summary;
  Digest digest{};
};

TEST(GradationMesh, MakesFewerTrianglesBeyondLand) {
  MeshRequest request = spot_in_a_u();
  const Made within(request);
  request.size.gradation_within = false;
  const Made across(request);
  EXPECT_LT(2 * within.in_right_arm(), across.in_right_arm());
  EXPECT_NE(verdict(request, within.mesh, *within.summary), "");
}

TEST(GradationMesh, GivesTheSameMeshOnAnyNumberOfThreads) {
  const MeshRequest request = spot_in_a_u();
  const Made alone(request);
  for (const int threads : {2, 3, 7}) EXPECT_EQ(Made(request, threads).digest, alone.digest);
}

// Then the straight way is in the domain.
TEST(GradationMesh, ChangesNothingIfNoLandLiesBetween) {
  for (const char* edge : {"0.1 + 0.1*x", "0.05 + 0.5*d"}) {
    MeshRequest request{.pslg = u_shape(), .size = graded(edge, 0.15)};
    request.size.fields.push_back({"d", DistanceSpec{}});
    const Made across(request);
    request.size.gradation_within = true;
    EXPECT_EQ(Made(request).digest, across.digest);
  }
}

TEST(GradationMesh, LimitsNothingInAPartThatNoLimitReaches) {
  MeshRequest request{.pslg = square()};
  request.pslg.segments[0].marker = 2;
  add_box(request.pslg, {2, 0}, {3, 1});
  request.size.at = {{2, 0.02}};
  request.size.gradation = 0.1;
  request.size.gradation_within = true;
  const Summary summary = sound(request).summary;
  EXPECT_GT(summary.triangles, 500u);
  const auto& bounded = summary.size_histogram;
  EXPECT_LT(std::accumulate(bounded.begin(), bounded.end(), std::uint64_t{0}), summary.triangles);
}

TEST(GradationMesh, IsCancelledWithTheRunAroundIt) {
  ExecutionContext context;
  ExecutionContext inside(context, Budget{});
  EXPECT_FALSE(inside.poll());
  context.cancel();
  ASSERT_TRUE(inside.poll());
  EXPECT_EQ(inside.poll()->code, ErrorCode::kCancelled);
}

// The mesh that it is measured on takes more than the mesh that is asked for.
TEST(GradationMesh, KeepsToTheBudgetOfMemory) {
  MeshRequest request = spot_in_a_u();
  const auto error = [&](std::uint64_t bytes) {
    ExecutionContext context(Budget{.max_bytes = bytes});
    CollectedMesh mesh;
    const auto summary = generate_mesh(request, mesh, context);
    return summary ? std::nullopt : std::optional(summary.error());
  };
  request.size.gradation_within = false;
  std::uint64_t enough = 1 << 16;
  while (error(enough)) enough += enough / 8;
  request.size.gradation_within = true;
  ASSERT_TRUE(error(enough));
  EXPECT_EQ(error(enough)->code, ErrorCode::kBudgetExceeded);
}

}  // namespace
}  // namespace weft
