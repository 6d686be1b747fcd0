// SPDX-License-Identifier: Apache-2.0
// Where segments are split (engine/refine/lens.h), and what small input angles cost
// (engine/refine/acute_corners.h). Every mesh is judged by the independent checker. The bounds on
// the numbers of triangles leave room for the last bit of the C library's sines, and for little
// else.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/refine/cavity.h"
#include "engine/refine/lens.h"
#include "engine/refine/quality_bounds.h"
#include "engine/refine/steiner_point.h"
#include "engine/refine/storage/mesh_store.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/random_pslg.h"
#include "tests/support/collected_mesh.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180;

// What the checker accepts, with all that was not exempt within its bounds.
Summary mesh(const Pslg& pslg, double min_angle_deg, const SizeSpec& size = {}) {
  const MeshRequest request{.pslg = pslg, .size = size, .min_angle_deg = min_angle_deg};
  CollectedMesh collected;
  ExecutionContext context({.triangle_limit = 1'000'000});
  const auto summary = generate_mesh(request, collected, context);
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return {};
  }
  EXPECT_EQ(verdict(request, collected, *summary), "");
  EXPECT_EQ(summary->unrefined.total(), summary->unrefined.small_input_angle);
  return *summary;
}

// The end of an arm from `corner`.
Point arm(Point corner, double angle, double length) {
  return {corner.x + length * std::cos(angle), corner.y + length * std::sin(angle)};
}

// Two segments from one point, amid a square of twice the first's length.
Pslg wedge_in_square(double angle, double first, double second, Point corner = {0, 0}) {
  Pslg pslg;
  add_box(pslg, {corner.x - first, corner.y - first}, {corner.x + 2 * first, corner.y + 2 * first});
  add_segment(pslg, corner, arm(corner, 0, first));
  add_segment(pslg, corner, arm(corner, angle, second));
  return pslg;
}

TEST(Lens, IsAsWideAsItsProofNeeds) {
  for (double degrees = 0.5; degrees < 20.7; degrees += 0.1) {
    const double sine = std::sin(degrees * kRadians);
    const double sine2 = (1 - std::sqrt(lens_for(sine))) / 2;  // of phi
    EXPECT_GE(std::sqrt(sine2), 2 * sine * (1 - 1e-9)) << degrees;
    EXPECT_GE(sine2, sine * (1 - 1e-9)) << degrees;
    EXPECT_LE(sine2, 0.5) << degrees;
  }
}

TEST(Lens, BeyondTheProofIsThatOfTheBound) {
  for (const double degrees : {21.0, 25.0, 34.0}) {
    const double cosine = std::cos(2 * degrees * kRadians);
    EXPECT_NEAR(lens_for(std::sin(degrees * kRadians)), cosine * cosine, 1e-12);
  }
}

TEST(Lens, HoldsWhatSeesThePieceAtTheAngleOrMore) {
  const double lens = lens_for(std::sin(25 * kRadians));  // 130 degrees
  const auto seen_at = [&](double degrees) {
    const double half = degrees / 2 * kRadians;
    return in_lens(-std::sin(half), -std::cos(half), 3 * std::sin(half), -3 * std::cos(half), lens);
  };
  EXPECT_TRUE(seen_at(130.01));
  EXPECT_FALSE(seen_at(129.99));
  EXPECT_FALSE(seen_at(10));
}

double side(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

TEST(Lens, OfASegmentBehindAnotherIsNotAsked) {
  const QualityBounds quality = QualityBounds::from(20, 0, 1e-9);
  std::size_t hidden = 0;
  for (const Kind& kind : kinds()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Random random(seed);
      ExecutionContext context;
      const auto domain = triangulate(kind.generate(random), context);
      if (!domain) continue;  // a tangle that encloses nothing
      const MeshStore mesh = *MeshStore::from(*domain, 1'000'000, 0, context);
      Cavity<OwnsAll> cavity(mesh);
      cavity.begin(OwnsAll{}, 0);
      for (std::uint32_t t = 0; t < domain->triangles.size(); ++t) {
        const auto& v = domain->triangles[t].vertex;
        const Point a = domain->vertices[v[0]];
        const Point b = domain->vertices[v[1]];
        const Point c = domain->vertices[v[2]];
        const Point p = steiner_point(a, b, c, quality);
        const Point from = centroid(a, b, c);
        if (cavity.grow_from_triangle(t, p, quality.lens) != Cavity<OwnsAll>::Growth::kEncroaches) {
          continue;
        }
        for (const SegmentEdge& s : cavity.encroached()) {
          const Point start = domain->vertices[s.a];
          const Point end = domain->vertices[s.b];
          constexpr double kClear = 1e-12;  // of what rounding may turn
          const bool hides = side(from, p, start) * side(from, p, end) < -kClear &&
                             side(start, end, from) * side(start, end, p) < -kClear;
          hidden += hides ? 1 : 0;
          if (hides) {
            EXPECT_EQ(cavity.encroached().size(), 1u) << kind.name << ' ' << seed;
          }
        }
      }
    }
  }
  EXPECT_GT(hidden, 100u);
}

class BoundOfZero : public testing::TestWithParam<const char*> {};

TEST_P(BoundOfZero, InsertsNoSteinerPoint) {
  const Summary summary = mesh(read_poly(model(GetParam())), 0);
  EXPECT_EQ(summary.insertions, 0u);
  EXPECT_GT(summary.triangles, 0u);
}

INSTANTIATE_TEST_SUITE_P(Of, BoundOfZero,
                         testing::Values("us-east-coast.poly", "cylinder.poly", "key.poly",
                                         "pipe.poly"),
                         [](const auto& info) {
                           const std::string name = info.param;
                           return name.substr(name.find_last_of('-') + 1,
                                              name.find('.') - name.find_last_of('-') - 1);
                         });

TEST(BoundOfZero, InsertsWhatASizeAsksForAlone) {
  Pslg pslg = square();
  add_segment(pslg, {0.25, 0.25}, {0.75, 0.25});
  add_segment(pslg, {0.25, 0.25 + 1e-6}, {0.75, 0.25 + 1e-6});
  EXPECT_EQ(mesh(pslg, 0, 1.0).insertions, 0u);
  // A triangle has 0.64 of the size on average.
  EXPECT_LT(mesh(pslg, 0, 1e-3).triangles, 2'000u);
}

struct Coast {
  double min_angle_deg;
  double triangle;  // triangles that Triangle 1.6 makes
  double at_most;   // of these
};

void PrintTo(const Coast& c, std::ostream* out) {
  *out << c.min_angle_deg;
}

class OfTheCoast : public testing::TestWithParam<Coast> {};

TEST_P(OfTheCoast, TrianglesAreFew) {
  const Coast& c = GetParam();
  const Summary summary = mesh(read_poly(model("us-east-coast.poly")), c.min_angle_deg);
  EXPECT_LE(static_cast<double>(summary.triangles), c.at_most * c.triangle);
}

INSTANTIATE_TEST_SUITE_P(Quality, OfTheCoast,
                         testing::Values(Coast{20, 17'802, 0.88}, Coast{25, 23'074, 0.81},
                                         Coast{30, 33'309, 0.72}, Coast{33, 45'260, 0.65}),
                         [](const auto& info) {
                           return std::to_string(static_cast<int>(info.param.min_angle_deg));
                         });

class Wedge : public testing::TestWithParam<double> {};

TEST_P(Wedge, OfUnequalArmsTakesFewTrianglesHoweverSharp) {
  const double angle = GetParam();
  for (const double length : {0.9371, 0.7, 0.5, 0.3137, 0.05}) {
    const Point end = arm({0, 0}, angle, length);
    const Summary inside = mesh(wedge_in_square(angle, 1, length), 20);
    EXPECT_LE(inside.triangles, 60u) << length;
    // What stays is as narrow as the wedge, but not flat.
    EXPECT_LE(inside.max_angle_deg, 140) << length;

    Pslg sliver;
    add_ring(sliver, {{0, 0}, {1, 0}, end});
    EXPECT_LE(mesh(sliver, 20).triangles, 20u) << length;

    Pslg outside;  // of the wedge, and the wedge a hole
    add_box(outside, {-1, -1}, {2, 2});
    add_ring(outside, {{0, 0}, {1, 0}, end});
    outside.holes.push_back({end.x / 2, end.y / 4});
    EXPECT_LE(mesh(outside, 20).triangles, 150u) << length;

    Pslg quadrilateral;
    add_ring(quadrilateral, {{0, 0}, {1, 0}, {1, 1}, end});
    EXPECT_LE(mesh(quadrilateral, 20).triangles, 300u) << length;
  }
}

TEST_P(Wedge, OfEqualArmsTakesTrianglesByTheLogarithmOfItsAngle) {
  const double decades = -std::log10(GetParam());
  EXPECT_LE(static_cast<double>(mesh(wedge_in_square(GetParam(), 1, 1), 20).triangles),
            50 * decades);
}

TEST_P(Wedge, FarFromTheOriginIsTheSame) {
  const double angle = GetParam();
  if (angle < 1e-6) return;  // its width is near the precision there
  EXPECT_LE(mesh(wedge_in_square(angle, 100, 70, {1e5, -2e5}), 20).triangles, 60u);
}

TEST_P(Wedge, AtEachEndOfOneSegmentTakesFewTriangles) {
  // The distances from one corner match none from the other.
  Pslg pslg;
  add_box(pslg, {-1, -1}, {2, 2});
  const Point p{0, 0};
  const Point q{0.913704, 0};
  add_segment(pslg, p, q);
  add_segment(pslg, p, arm(p, GetParam(), 0.7));
  add_segment(pslg, q, arm(q, 180 * kRadians + GetParam(), 0.6));
  EXPECT_LE(mesh(pslg, 20).triangles, 300u);
}

TEST_P(Wedge, ThatEndsOnAThirdSegmentTakesFewTriangles) {
  struct Place {
    Point corner;
    double end;
  };
  for (const auto& [corner, end] : {Place{{0.1, 0.1}, 9},
                                    {{5.267881354549644, 0.19148719047755264}, 6.555440798619096},
                                    {{7.470879147465335, 2.8653566962959807}, 8.478717316844126},
                                    {{1.2883892751215147, 2.607071650378749}, 4.180056885907814}}) {
    Pslg pslg;
    add_ring(pslg,
             {corner, {end, 10}, {end - 10 * GetParam(), 10}, {0, 10}, {0, 0}, {10, 0}, {10, 9}});
    pslg.segments.push_back({0, 2});
    for (const double degrees : {25.0, 30.0, 30.5, 33.0, 34.0})
      EXPECT_LE(mesh(pslg, degrees).triangles, 2000u) << degrees << " " << corner.x;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Wedge, testing::Values(1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9),
                         [](const auto& info) {
                           return "1e" + std::to_string(-std::lround(std::log10(info.param)));
                         });

TEST(Wedge, WithALongerArmBetweenOthersIsMatchedByEach) {
  Pslg pslg;
  add_box(pslg, {-1, -1}, {2, 2});
  const double lengths[] = {0.31, 1, 0.53, 0.77, 0.9, 0.12};
  for (int i = 0; i < 6; ++i) add_segment(pslg, {0, 0}, arm({0, 0}, i * 1e-6, lengths[i]));
  EXPECT_LE(mesh(pslg, 20).triangles, 300u);
}

TEST(Wedge, BetweenEndsAtNearlyTheSameDistanceIsExemptByNeither) {
  // The arm between is split at the distance of one; the other's is off by 6e-7 of it.
  Pslg pslg;
  add_box(pslg, {-1, -1}, {2, 2});
  const double lengths[] = {0.5, 1, 0.5000003};
  for (int i = 0; i < 3; ++i) add_segment(pslg, {0, 0}, arm({0, 0}, i * 1e-5, lengths[i]));
  EXPECT_LE(mesh(pslg, 20).triangles, 300u);
}

TEST(NearlyCoincident, AVertexBesideASegmentDoesNotExplode) {
  // 5e-8 from a segment of 5e-3 that it shares an end with. It made 129,000 vertices.
  Pslg pslg = square();
  add_segment(pslg, {0.5, 0.5}, {0.505, 0.5});
  add_segment(pslg, {0.5025, 0.5 + 5e-8}, {0.505, 0.5});
  EXPECT_EQ(mesh(pslg, 0).insertions, 0u);
  EXPECT_LE(mesh(pslg, 20).triangles, 100u);
  EXPECT_LE(mesh(pslg, 30).triangles, 200u);
}

TEST(NearlyCoincident, AFreePointBesideASegmentGrowsByTheLogarithm) {
  for (int decades = 3; decades <= 10; ++decades) {
    Pslg pslg = square();
    add_segment(pslg, {0.25, 0.5}, {0.75, 0.5});
    pslg.points.push_back({0.4, 0.5 + std::pow(10.0, -decades)});
    EXPECT_LE(mesh(pslg, 20).triangles, 50u * static_cast<unsigned>(decades)) << decades;
  }
}

// Rays from the middle of a square of side 8, of equal lengths or not.
Pslg star(int rays, bool equal) {
  Pslg pslg = square(8);
  for (int i = 0; i < rays; ++i) {
    const double length = equal ? 3 : 1 + 2.0 * (37 * i % rays) / rays;
    add_segment(pslg, {4, 4}, arm({4, 4}, 360.0 * i / rays * kRadians, length));
  }
  return pslg;
}

TEST(Star, OfThirtySixRaysEndsAtEveryAngle) {
  for (const double angle : {20.0, 25.0, 30.0, 33.0, 34.0, 36.0}) {
    EXPECT_LE(mesh(star(36, true), angle).triangles, 500u) << angle;
    EXPECT_LE(mesh(star(36, false), angle).triangles, 2'000u) << angle;
  }
}

TEST(Star, OfHundredsOfRaysEndsAtEveryAngle) {
  for (const double angle : {20.0, 30.0, 34.0, 36.0})
    EXPECT_LE(mesh(star(360, true), angle).triangles, 7'000u) << angle;
  for (const double angle : {20.0, 30.0, 34.0})
    EXPECT_LE(mesh(star(360, false), angle).triangles, 60'000u) << angle;
}

}  // namespace
}  // namespace weft
