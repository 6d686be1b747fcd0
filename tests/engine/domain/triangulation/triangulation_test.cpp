// SPDX-License-Identifier: Apache-2.0
// The laws of engine/domain/triangulation/triangulation.h, by exact predicates.
#include "engine/domain/triangulation/triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/domain/arrangement/line_probe.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

using Vertex = Triangulation::Vertex;
using Edge = Triangulation::Edge;
using At = Triangulation::At;

struct Built {
  explicit Built(std::vector<Point> input) : points(std::move(input)) {
    const Span span = spanning_points(points, poller);
    t.build(points, span.point[0], span.point[1], span.point[2]);
  }

  // The vertex of the point with this number.
  Vertex operator[](std::uint32_t point) const { return t.vertex_of(point); }

  const std::vector<Point> points;
  const ExecutionContext context;
  StopPoller poller{context};
  Triangulation t{poller};
};

// The first law that is broken; empty if none is.
std::optional<std::string> broken_law(const Triangulation& t) {
  std::size_t vertices = 0;
  for (Vertex v = 0; v < t.vertices(); ++v) {
    if (!t.exists(v)) continue;
    ++vertices;
    if (t.vertex(t.face_at(v), t.index(t.face_at(v), v)) != v)
      return "a face_at without its vertex";
  }
  if (t.faces() != 2 * vertices - 2) return "not as many faces as Euler asks for";
  for (std::uint32_t f = 0; f < t.faces(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const Edge e{f, i}, m = t.mirror(e);
      if (t.mirror(m) != e) return "a neighbour that does not name its neighbour";
      if (t.right(e) != t.left(m) || t.left(e) != t.right(m))
        return "neighbours without their edge";
      if (t.constraint(e) != t.constraint(m)) return "an edge with two constraints";
    }
    if (t.is_infinite(f)) {
      const Edge hull{f, t.index(f, Triangulation::kInfinite)};
      const Edge inside = t.mirror(hull);
      if (t.is_infinite(inside.face)) return "a hull edge without a triangle";
      // The other infinite face at the hull edge's first vertex: the hull does not turn outwards.
      const Edge beside = t.mirror({f, Triangulation::cw(hull.i)});
      const int infinite = t.index(beside.face, Triangulation::kInfinite);
      const Vertex next = t.right({beside.face, infinite});
      if (orientation_exact(t.at(t.right(hull)), t.at(t.left(hull)), t.at(next)) > 0)
        return "a hull that is not convex";
      continue;
    }
    const Point a = t.at(t.vertex(f, 0)), b = t.at(t.vertex(f, 1)), c = t.at(t.vertex(f, 2));
    if (orientation_exact(a, b, c) <= 0) return "a face that is not counter-clockwise";
    for (int i = 0; i < 3; ++i) {
      const Edge m = t.mirror({f, i});
      if (t.constraint(m) != kNone || t.is_infinite(m.face)) continue;
      if (in_circle_exact(a, b, c, t.at(t.apex(m)))) return "an edge that is not Delaunay";
    }
  }
  return std::nullopt;
}

// All finite faces, each from its least corner on.
using Corner = std::pair<double, double>;
std::set<std::array<Corner, 3>> faces_of(const Triangulation& t) {
  std::set<std::array<Corner, 3>> faces;
  for (std::uint32_t f = 0; f < t.faces(); ++f) {
    if (t.is_infinite(f)) continue;
    std::array<Corner, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const Point p = t.at(t.vertex(f, i));
      corners[static_cast<std::size_t>(i)] = {p.x, p.y};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.insert(corners);
  }
  return faces;
}

double uniform(std::mt19937& random) {
  return random() / 4294967296.0;
}

std::vector<Point> random_points(int n, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::vector<Point> points;
  for (int i = 0; i < n; ++i) {
    const double x = uniform(random);
    points.push_back({x, uniform(random)});
  }
  return points;
}

std::vector<Point> grid(int n, Point corner = {0, 0}, double step = 1) {
  std::vector<Point> points;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) points.push_back({corner.x + x * step, corner.y + y * step});
  return points;
}

// The 324 points of whole coordinates on the circle of radius 5 * 13 * 17 * 29 = 32,045, and its
// centre.
std::vector<Point> cocircular_points() {
  constexpr int kRadius = 32045;
  std::vector<Point> points{{0, 0}};
  for (int x = -kRadius; x <= kRadius; ++x) {
    const auto y2 = static_cast<double>(std::int64_t{kRadius} * kRadius - std::int64_t{x} * x);
    const double y = std::sqrt(y2);
    if (y != std::floor(y)) continue;
    points.push_back({static_cast<double>(x), y});
    if (y > 0) points.push_back({static_cast<double>(x), -y});
  }
  return points;
}

std::vector<Point> shuffled(std::vector<Point> points, unsigned seed) {
  std::mt19937 random(seed);
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random() % i]);
  return points;
}

void expect_same_in_any_order(const std::vector<Point>& points) {
  const Built built(points);
  ASSERT_EQ(broken_law(built.t), std::nullopt);
  const auto faces = faces_of(built.t);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Built other(shuffled(points, seed));
    ASSERT_EQ(broken_law(other.t), std::nullopt);
    EXPECT_TRUE(faces_of(other.t) == faces) << seed;
  }
}

// Leads a constrained edge from u to v. Returns false, and changes nothing, if a vertex or another
// constrained edge is in the way.
bool lead(Triangulation& t, Vertex u, Vertex v, std::uint32_t constraint) {
  if (const Edge e = t.find_edge(u, v); e.face != kNone) {
    t.constrain(e, constraint);
    return true;
  }
  LineProbe probe(t, u, v);
  LineProbe::Sees sees = LineProbe::Sees::kNothingYet;
  while (sees == LineProbe::Sees::kNothingYet) sees = probe.turn();
  if (sees != LineProbe::Sees::kCrossing) return false;
  for (Edge e = probe.edge();;) {
    if (t.constraint(e) != kNone) return false;
    const Edge next = t.mirror(e);
    const Vertex w = t.apex(next);
    if (w == v) break;
    const int side = orientation_exact(t.at(u), t.at(v), t.at(w));
    if (side == 0) return false;
    const Vertex replaced = side > 0 ? t.left(e) : t.right(e);
    e = {next.face, t.index(next.face, replaced)};
  }
  const Edge made = t.insert_edge(u, v, probe.edge());
  EXPECT_EQ(std::minmax(t.right(made), t.left(made)), std::minmax(u, v));
  t.constrain(made, constraint);
  return true;
}

TEST(Triangulation, OfThreePointsIsOneFaceAndThreeAroundIt) {
  for (const std::vector<Point>& points :
       {std::vector<Point>{{0, 0}, {1, 0}, {0, 1}}, std::vector<Point>{{0, 0}, {0, 1}, {1, 0}}}) {
    const Built built(points);
    EXPECT_EQ(built.t.faces(), 4u);
    EXPECT_EQ(broken_law(built.t), std::nullopt);
  }
}

TEST(Triangulation, OfRandomPointsIsDelaunay) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Built built(random_points(3 + static_cast<int>(seed * seed), seed));
    ASSERT_EQ(broken_law(built.t), std::nullopt) << seed;
  }
}

TEST(Triangulation, OfAHundredThousandPointsIsDelaunay) {
  const Built built(random_points(100'000));
  EXPECT_EQ(broken_law(built.t), std::nullopt);
}

TEST(Triangulation, OfAGridDependsOnThePointsAlone) {
  expect_same_in_any_order(grid(30));
  expect_same_in_any_order(grid(12, {1e15, -1e15}, 0.125));
  expect_same_in_any_order(grid(12, {1e-100, 1e-100}, 1e-100));
}

TEST(Triangulation, OfCocircularPointsDependsOnThePointsAlone) {
  const std::vector<Point> points = cocircular_points();
  ASSERT_EQ(points.size(), 325u);
  expect_same_in_any_order(points);
  expect_same_in_any_order({points.begin() + 1, points.end()});
}

TEST(Triangulation, OfASquareTakesTheDiagonalThatAvoidsTheLastCorner) {
  // (1, 1) comes last in lexicographic order, so it is raised most.
  const Built built({{0, 0}, {1, 0}, {0, 1}, {1, 1}});
  EXPECT_NE(built.t.find_edge(built[1], built[2]).face, kNone);
  EXPECT_EQ(built.t.find_edge(built[0], built[3]).face, kNone);
}

TEST(Triangulation, MakesOneVertexOfCoincidentPoints) {
  std::vector<Point> points = random_points(500);
  std::mt19937 random(5);
  while (points.size() < 3000) points.push_back(points[random() % 500]);
  points.push_back({0.0, 0.0});
  points.push_back({-0.0, 0.0});
  points = shuffled(points, 1);
  const Built built(points);
  ASSERT_EQ(broken_law(built.t), std::nullopt);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    ASSERT_TRUE(built.t.exists(built[i]));
    ASSERT_EQ(built.t.at(built[i]), points[i]);
    const auto lowest = std::find(points.begin(), points.end(), points[i]) - points.begin();
    ASSERT_EQ(built.t.id(built[i]), lowest);
  }
  std::size_t vertices = 0;
  for (Vertex v = 0; v < built.t.vertices(); ++v) vertices += built.t.exists(v);
  EXPECT_EQ(vertices, 501u);
}

TEST(Triangulation, TakesCollinearRuns) {
  for (const Point off : {Point{3, 4}, Point{-5, -4}, Point{5000, 1}}) {
    std::vector<Point> points{off};
    for (int i = 0; i < 1000; ++i) points.push_back({i * 1.0, i * 0.5});
    expect_same_in_any_order(points);
  }
  std::vector<Point> cross{{0, 0}};
  for (int i = 1; i < 200; ++i)
    for (const double side : {-1.0, 1.0}) {
      cross.push_back({side * i, 0});
      cross.push_back({0, side * i});
    }
  expect_same_in_any_order(cross);
}

TEST(Triangulation, TakesHostileCoordinates) {
  std::mt19937 random(9);
  const auto any_magnitude = [&] {
    const double magnitude = std::pow(10, -100 + 150 * uniform(random));
    return random() % 8 == 0 ? 0 : random() % 2 == 0 ? magnitude : -magnitude;
  };
  for (int round = 0; round < 20; ++round) {
    std::vector<Point> points;
    for (int i = 0; i < 300; ++i) {
      const double x = any_magnitude();
      points.push_back({x, any_magnitude()});
    }
    expect_same_in_any_order(points);
  }
  // All in two cells of the Hilbert curve's first grid.
  std::vector<Point> points = grid(40, {-2e-100, 1e-100}, 1e-100);
  for (const Point p : grid(20, {1, 1}, 0x1p-52)) points.push_back(p);
  points.push_back({1e50, 1e50});
  expect_same_in_any_order(points);
}

TEST(Triangulation, TakesALargeOffset) {
  // On the grid of doubles near 1e15, where most circles pass through other points.
  std::vector<Point> points;
  for (const Point p : random_points(2000)) points.push_back({1e15 + 40 * p.x, 3e15 + 40 * p.y});
  expect_same_in_any_order(points);
}

TEST(Triangulation, FindsTheEdgesOfAHub) {
  std::vector<Point> points{{0, 0}};
  for (int i = 0; i < 5000; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / 5000;
    points.push_back({std::cos(angle), std::sin(angle)});
  }
  Built built(points);
  ASSERT_EQ(broken_law(built.t), std::nullopt);
  for (std::uint32_t i = 1; i <= 5000; ++i) {
    const Edge e = built.t.find_edge(built[0], built[i]);
    ASSERT_NE(e.face, kNone);
    EXPECT_EQ(std::minmax(built.t.right(e), built.t.left(e)), std::minmax(built[0], built[i]));
    built.t.constrain(e, i);
  }
  EXPECT_EQ(built.t.find_edge(built[1], built[2500]).face, kNone);
  EXPECT_EQ(built.t.constraint(built.t.find_edge(built[77], built[0])), 77u);
  EXPECT_EQ(broken_law(built.t), std::nullopt);
}

TEST(Triangulation, LeadsAnEdgeThroughManyFaces) {
  // A corridor of two jagged rows, whose short sides all cross the edge.
  std::mt19937 random(2);
  std::vector<Point> points{{0, 0}, {1002, 0}};
  for (int i = 1; i <= 1000; ++i) {
    points.push_back({i + 0.4 * uniform(random), 0.1 + uniform(random)});
    points.push_back({i + 0.4 * uniform(random), -0.1 - uniform(random)});
  }
  for (const bool backward : {false, true}) {
    Built built(points);
    const auto before = faces_of(built.t);
    ASSERT_TRUE(lead(built.t, built[backward], built[!backward], 6));
    EXPECT_EQ(broken_law(built.t), std::nullopt);
    EXPECT_EQ(built.t.constraint(built.t.find_edge(built[0], built[1])), 6u);
    EXPECT_FALSE(faces_of(built.t) == before);
    built.t.unconstrain(built.t.find_edge(built[0], built[1]));
    EXPECT_EQ(broken_law(built.t), std::nullopt);
    EXPECT_TRUE(faces_of(built.t) == before);
  }
}

// Leads as many edges as do not cross, in two orders.
void expect_edges_in_any_order(const std::vector<Point>& points, unsigned seed) {
  std::mt19937 random(seed);
  const auto n = static_cast<std::uint32_t>(points.size());
  Built built(points);
  const auto delaunay = faces_of(built.t);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = random() % n, b = random() % n;
    if (points[a] != points[b] && lead(built.t, built[a], built[b], i)) edges.push_back({b, a});
  }
  ASSERT_EQ(broken_law(built.t), std::nullopt);
  Built other(shuffled(points, 1));
  std::reverse(edges.begin(), edges.end());
  for (const auto& [a, b] : edges) {
    const auto at = [&](std::uint32_t i) {
      return other[static_cast<std::uint32_t>(
          std::find(other.points.begin(), other.points.end(), points[i]) - other.points.begin())];
    };
    ASSERT_TRUE(lead(other.t, at(a), at(b), 0));
  }
  ASSERT_EQ(broken_law(other.t), std::nullopt);
  EXPECT_TRUE(faces_of(other.t) == faces_of(built.t));
  for (const auto& [a, b] : edges) {
    // An edge that was led twice may be gone.
    if (const Edge e = built.t.find_edge(built[a], built[b]); e.face != kNone)
      built.t.unconstrain(e);
  }
  ASSERT_EQ(broken_law(built.t), std::nullopt);
  EXPECT_TRUE(faces_of(built.t) == delaunay);
}

TEST(Triangulation, WithEdgesDependsOnPointsAndEdgesAlone) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    expect_edges_in_any_order(random_points(10 + static_cast<int>(10 * seed), seed), seed);
    expect_edges_in_any_order(grid(3 + static_cast<int>(seed) / 2), seed);
    expect_edges_in_any_order(cocircular_points(), seed);
  }
}

TEST(Triangulation, LocatesPoints) {
  const Built built({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 3}});
  const Triangulation& t = built.t;
  for (std::uint32_t start = 0; start < t.faces(); ++start) {
    const auto vertex = t.locate({1, 3}, start);
    EXPECT_EQ(vertex.at, At::kVertex);
    EXPECT_EQ(t.apex(vertex.edge), built[4]);
    const auto edge = t.locate({3, 0}, start);
    EXPECT_EQ(edge.at, At::kEdge);
    EXPECT_EQ(std::minmax(t.right(edge.edge), t.left(edge.edge)), std::minmax(built[0], built[1]));
    const auto face = t.locate({0.5, 2.75}, start);
    EXPECT_EQ(face.at, At::kFace);
    EXPECT_FALSE(t.is_infinite(face.edge.face));
    for (int i = 0; i < 3; ++i)
      EXPECT_GT(orientation_exact(t.at(t.right({face.edge.face, i})),
                                  t.at(t.left({face.edge.face, i})), {0.5, 2.75}),
                0);
    const auto outside = t.locate({9, 2}, start);
    EXPECT_EQ(outside.at, At::kOutside);
    EXPECT_TRUE(t.is_infinite(outside.edge.face));
  }
}

TEST(Triangulation, InsertsToTheSameFacesAsBuilding) {
  // In faces, on edges and vertices, outside, level with hull edges: halves of a grid's step.
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    std::vector<Point> points = grid(6);
    Built built(points);
    for (int k = 0; k < 10; ++k) {
      const Point p{0.5 * (random() % 18) - 2, 0.5 * (random() % 18) - 2};
      const auto place = built.t.locate(p, random() % built.t.faces());
      const bool known = std::find(points.begin(), points.end(), p) != points.end();
      ASSERT_EQ(place.at == At::kVertex, known);
      if (known) continue;
      const Vertex v = built.t.insert(p, 1000, place);
      EXPECT_EQ(built.t.id(v), 1000u);
      points.push_back(p);
      ASSERT_EQ(broken_law(built.t), std::nullopt) << p.x << " " << p.y;
      ASSERT_TRUE(faces_of(built.t) == faces_of(Built(points).t)) << p.x << " " << p.y;
    }
  }
}

TEST(Triangulation, KeepsTheConstraintOfAnEdgeThatIsSplit) {
  for (const bool on_hull : {false, true}) {
    Built built({{0, 0}, {4, 0}, {4, 4}, {0, 4}});
    const Vertex u = built[on_hull ? 0 : 1], v = built[on_hull ? 1 : 3];
    ASSERT_TRUE(lead(built.t, u, v, 5));
    const Point middle = on_hull ? Point{2, 0} : Point{2, 2};
    const Vertex w = built.t.insert(middle, 4, {At::kEdge, built.t.find_edge(u, v)});
    EXPECT_EQ(broken_law(built.t), std::nullopt);
    EXPECT_EQ(built.t.constraint(built.t.find_edge(u, w)), 5u);
    EXPECT_EQ(built.t.constraint(built.t.find_edge(w, v)), 5u);
    EXPECT_EQ(built.t.find_edge(u, v).face, kNone);
  }
}

}  // namespace
}  // namespace weft
