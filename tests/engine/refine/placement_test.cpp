// SPDX-License-Identifier: Apache-2.0
// Where Steiner points go: how many triangles that makes, and that nothing else changes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/size/lattice/lattice.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/sound.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

MeshRequest sized_square(const std::string& expression, double min_angle_deg = 20) {
  return {.pslg = square(10), .size = expression, .min_angle_deg = min_angle_deg};
}

MeshRequest sized_square(const std::function<double(double, double)>& size, std::uint32_t nodes) {
  Raster raster{{0, 0}, 10.0 / (nodes - 1), 10.0 / (nodes - 1), nodes, nodes, {}};
  for (std::uint32_t j = 0; j < nodes; ++j) {
    for (std::uint32_t i = 0; i < nodes; ++i)
      raster.values.push_back(size(i * raster.dx, j * raster.dy));
  }
  return {.pslg = square(10), .size = raster};
}

struct Case {
  const char* name;
  MeshRequest request;
  double most;     // of ideal_ratio
  double quality;  // at least
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Placements : public testing::TestWithParam<Case> {};

TEST_P(Placements, OnALatticeMakeAThirdFewerTriangles) {
  const Case& c = GetParam();
  const Summary lattice = sound(c.request).summary;
  EXPECT_LE(lattice.ideal_ratio, c.most);
  EXPECT_GE(lattice.mean_quality, c.quality);
  MeshRequest request = c.request;
  request.placement = Placement::kCircumcentre;
  const Summary circumcentres = sound(request).summary;
  EXPECT_NEAR(circumcentres.ideal_ratio, 1.48, 0.08);
  EXPECT_EQ(circumcentres.lattice_share, 0);
  EXPECT_LT(lattice.triangles, 0.8 * static_cast<double>(circumcentres.triangles));
}

INSTANTIATE_TEST_SUITE_P(
    Of, Placements,
    testing::Values(
        Case{"Constant", {.pslg = square(10), .size = 2e-3}, 1.03, 0.99},
        Case{"Stepped", sized_square("hypot(x-5,y-5)<3 ? 1e-3 : 1e-2"), 1.06, 0.985},
        Case{"Smooth", sized_square("1e-3*(1+hypot(x-12,y-5))"), 1.05, 0.985},
        Case{"Exponential", sized_square("5e-4*exp(0.4*x)"), 1.03, 0.99},
        Case{"NotHarmonic", sized_square("1e-3*(1.5+sin(x)*cos(y))"), 1.10, 0.97},
        Case{"Gauss", sized_square("1e-3+9e-3*(1-exp(-((x-5)^2+(y-4)^2)/8))"), 1.13, 0.965},
        Case{"Raster",
             sized_square([](double x, double y) { return 1e-3 * (1.5 + 0.5 * std::sin(x + y)); },
                          40),
             1.10, 0.97}),
    [](const auto& info) { return info.param.name; });

TEST(Placement, FollowsTheBoundsOfRegions) {
  MeshRequest request{.pslg = square(10)};
  add_segment(request.pslg, {5, 0}, {5, 10}, 1);
  add_segment(request.pslg, {0, 3}, {10, 3}, 1);
  request.pslg.regions = {{{1, 1}, 1, 1e-3}, {{6, 1}, 2, 3e-3}, {{1, 6}, 3, 2e-3}};
  request.pslg.regions.push_back({{6, 6}, 4, 5e-3});
  const Summary by_regions = sound(request).summary;
  EXPECT_LE(by_regions.ideal_ratio, 1.04);
  EXPECT_EQ(by_regions.lattice_share, 1);
  // Below and above the size of the function.
  for (const char* size : {"2.5e-3", "1.5e-3*(1+0.1*x)", "1e-2*(1.2+sin(20*x)*sin(20*y))"}) {
    request.size = size;
    EXPECT_LE(sound(request).summary.ideal_ratio, size[3] == '-' && size[4] == '2' ? 1.3 : 1.08)
        << size;
  }
}

TEST(Placement, TellsHowMuchLiesOnALattice) {
  EXPECT_EQ(sound({.pslg = square(10), .size = 1e-2}).summary.lattice_share, 1);
  EXPECT_LT(sound(sized_square("1e-2*(1.2+sin(30*x)*sin(30*y))")).summary.lattice_share, 0.01);
  EXPECT_EQ(sound({.pslg = square(10)}).summary.lattice_share, 0);
  EXPECT_EQ(sound({.pslg = square(10)}).summary.ideal_ratio, 0);
  const double stepped = sound(sized_square("x < 3.3 ? 1e-3 : 1e-2")).summary.lattice_share;
  EXPECT_GT(stepped, 0.7);
  EXPECT_LT(stepped, 1);
}

TEST(Placement, OfEdgesThatGrowFromLinesIsMostlyOnLattices) {
  // No lattice follows the distance from a line for more than a few rows.
  MeshRequest request{.pslg = square(10)};
  request.size = SizeSpec("0.01+0.15*min(abs(y-2-0.3*x), abs(x-8))");
  request.size.measure = Measure::kEdge;
  const Summary summary = sound(request).summary;
  EXPECT_GT(summary.lattice_share, 0.9);
  EXPECT_LE(summary.ideal_ratio, 1.35);
}

// Amid a perfect lattice a vertex too much would start a cascade at 30 degrees.
TEST(Placement, DoesNotFeedACascadeAt30Degrees) {
  for (const double angle : {29.5, 29.9, 30.0, 30.5, 31.0, 31.5}) {
    MeshRequest request{.pslg = square(10), .size = 2e-3, .min_angle_deg = angle};
    add_segment(request.pslg, {3.1, 4.1}, {3.12, 4.11}, 1);  // far shorter than the lattice's edges
    EXPECT_LE(sound(request).summary.ideal_ratio, angle <= 30 ? 1.1 : 1.38) << angle;
  }
}

TEST(Placement, AboveTheLatticesLastAngleIsTheCircumcentre) {
  MeshRequest request{.pslg = square(10), .size = 5e-3, .min_angle_deg = 33};
  const Summary lattice = sound(request).summary;
  request.placement = Placement::kCircumcentre;
  EXPECT_EQ(outcome(lattice), outcome(mesh_on(nullptr, request)));
}

TEST(Placement, OfALatticePointThatIsTooCloseIsTheCircumcentre) {
  // Every edge is to be longer than the lattice's.
  MeshRequest request{.pslg = square(10), .size = 1e-2, .min_edge = 0.08};
  const Summary coarse = sound(request).summary;
  request.placement = Placement::kCircumcentre;
  EXPECT_LE(coarse.triangles, sound(request).summary.triangles);
}

// A lattice through the origin whose points lie exactly on segments and on the borders of leaves,
// and which is all ties.
TEST(Placement, OnALatticeInLineWithTheSegmentsNeedsFewExactPredicates) {
  constexpr double kEdge = 0.0625;
  const double bound = kEdge * kEdge * kEquilateral / LatticeShape::for_angle(20).area_ratio;
  MeshRequest request{.pslg = square(16), .size = bound, .leaf_triangles = 2000};
  add_segment(request.pslg, {0, 4}, {16, 4}, 1);
  add_segment(request.pslg, {4, 4}, {4, 16}, 1);
  const Summary summary = sound(request).summary;
  EXPECT_GT(summary.triangles, 100'000u);
  EXPECT_LE(summary.ideal_ratio, 1.04);
  EXPECT_LT(1000 * summary.exact_predicates, summary.insertions);
}

TEST(Placement, OfHostileSizesEndsWithASoundMeshOrATypedError) {
  for (const char* size :
       {"0/0", "x < 4 ? 0/0 : 1e-1", "1/0", "-1", "1e-300", "1e300", "1e-2+abs(sin(1e9*x*y))",
        "hypot(x-3,y-3) < 1e-6 ? 1e-13 : 1", "exp(20*x)/1e3", "1e-1*(1+floor(3*x))", "x*y+1e-2",
        "abs(x-4)+1e-2", "x < 5 ? 1e-2 : 1e300", "1e-2*(1+(x>2)+(y>3)*(x<7)+(x+y>9))",
        "abs(x-5)<1e-3 ? 1e-4 : 0.1", "max(1e-2,(x-5)^3)"}) {
    CollectedMesh mesh;
    ExecutionContext context({.triangle_limit = 1'000'000});
    MeshRequest request = sized_square(size);
    request.leaf_triangles = 1000;
    const auto summary = generate_mesh(request, mesh, context);
    if (summary) {
      EXPECT_EQ(verdict(request, mesh, *summary), "") << size;
    } else {
      EXPECT_TRUE(summary.error().code == ErrorCode::kBadSizeValue ||
                  summary.error().code == ErrorCode::kLimitExceeded)
          << size << ": " << summary.error().message;
    }
  }
}

// A millionth of a lattice cell is less there than the distance of two coordinates.
TEST(Placement, EndsFarFromTheOrigin) {
  MeshRequest request;
  add_ring(request.pslg, {{499999.9, 4649999.9},
                          {499999.90081289806, 4649999.9},
                          {499999.90081289806, 4649999.900484917},
                          {499999.9, 4649999.900812899}});
  request.size = "1.6257960545553545e-05 + 0.05*hypot(x-499999.9007186544, y-4649999.900133713)";
  request.size.measure = Measure::kEdge;
  EXPECT_GT(sound(request).summary.triangles, 500u);
}

TEST(Placement, IsTheSameAtEveryNumberOfThreads) {
  std::vector<MeshRequest> requests{sized_square("1e-3*(1.5+sin(x)*cos(y))", 30),
                                    sized_square("hypot(x-5,y-5)<3 ? 1e-3 : 1e-2"),
                                    sized_square("1e-3*(1+hypot(x-12,y-5))", 25),
                                    {.pslg = square(10), .size = 2e-3}};
  requests.push_back(sized_square([](double x, double y) { return 2e-3 * (1 + 0.1 * x * y); }, 9));
  for (MeshRequest& request : requests) {
    request.leaf_triangles = 500;
    const std::string one = outcome(mesh_on(nullptr, request));
    for (const int threads : {1, 2, 3, 7}) {
      Arena arena(threads);
      EXPECT_EQ(outcome(mesh_on(&arena, request)), one) << threads;
    }
  }
}

TEST(Placement, GivesTheSameMeshOfHundredsOfComponentsInTinyLeaves) {
  MeshRequest request{.size = "1e-3*(1+0.3*x)", .leaf_triangles = 300};
  for (int i = 0; i < 15; ++i) {
    for (int j = 0; j < 15; ++j) add_box(request.pslg, {i + 0.0, j + 0.0}, {i + 0.71, j + 0.63});
  }
  const Summary summary = sound(request).summary;
  EXPECT_LE(summary.ideal_ratio, 1.3);
  Arena arena(3);
  EXPECT_EQ(outcome(mesh_on(&arena, request)), outcome(summary));
}

}  // namespace
}  // namespace weft
