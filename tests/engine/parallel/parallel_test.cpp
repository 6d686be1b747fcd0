// SPDX-License-Identifier: Apache-2.0
// One request, one mesh, bit for bit, at every number of threads and without an arena. Leaves are
// small, so that borders dominate. Each mesh is judged once, because equal meshes need no second
// judgement.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tests/engine/domain/arcs/arc_shapes.h"
#include "tests/engine/parallel/parallel.h"
#include "tests/engine/refine/random_pslg.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

constexpr int kThreads[] = {1, 2, 3, 4, 7, 16};

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

// Requests and what they gave without an arena.
class Cases {
 public:
  // Meshes without an arena and judges.
  Result<Summary> add(MeshRequest request, const std::string& name) {
    SCOPED_TRACE(name);
    request.allow_unrefined = true;  // above 30 degrees, precision may end the refinement
    CollectedMesh mesh;
    auto summary = mesh_on(nullptr, request, mesh);
    if (summary) {
      EXPECT_EQ(verdict(request, mesh, *summary), "");
      EXPECT_EQ(summary->unrefined.streaming, 0u) << "left by the clean-up";
      EXPECT_EQ(summary->unrefined.budget, 0u) << "left unrefined, without a cap";
    }
    cases_.push_back({request, name, outcome(summary)});
    return summary;
  }

  // Meshes each again on arenas of several numbers of threads.
  void expect_the_same_on_threads() const {
    for (const int threads : kThreads) {
      Arena arena(threads);
      for (const Case& c : cases_) {
        ASSERT_EQ(outcome(mesh_on(&arena, c.request)), c.outcome)
            << c.name << ", " << threads << " threads";
      }
    }
  }

 private:
  struct Case {
    MeshRequest request;
    std::string name;
    std::string outcome;
  };
  std::vector<Case> cases_;
};

Result<Summary> expect_one_mesh(const MeshRequest& request) {
  Cases cases;
  auto summary = cases.add(request, "");
  if (!summary) {
    ADD_FAILURE() << summary.error().message;
    return summary;
  }
  cases.expect_the_same_on_threads();
  return summary;
}

struct Model {
  const char* name;
  const char* file;
  std::string size;
  double min_angle_deg;
  double leaf_triangles;
  std::size_t least_leaves;
};
void PrintTo(const Model& m, std::ostream* out) {
  *out << m.name;
}

class ParallelModels : public testing::TestWithParam<Model> {};

TEST_P(ParallelModels, GiveOneMeshAtEveryNumberOfThreads) {
  const Model& m = GetParam();
  MeshRequest request{.pslg = read_poly(model(m.file)),
                      .min_angle_deg = m.min_angle_deg,
                      .leaf_triangles = m.leaf_triangles};
  if (!m.size.empty()) request.size = (kSanitized ? "9*(" : "(") + m.size + ")";
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), kSanitized ? m.least_leaves / 15 : m.least_leaves);
}

INSTANTIATE_TEST_SUITE_P(
    Of, ParallelModels,
    testing::Values(
        Model{"Pipe", "pipe.poly", "0.4*sqrt((x-200)^2+(y-200)^2)+1", 20, 110, 30},
        Model{"Key", "key.poly", "0.02*abs(y-46)+0.1", 30, 200, 60},
        Model{"Cylinder", "cylinder.poly",
              "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2", 20, 2000, 600},
        Model{"Coast", "us-east-coast.poly", "", 20, 500, 0},
        Model{"CoastGraded", "us-east-coast.poly", "1e-2*(1.5+sin(x)*cos(y))", 28, 500, 100}),
    [](const auto& info) { return info.param.name; });

TEST(Parallel, ArcsGiveOneMeshAtEveryNumberOfThreads) {
  const auto summary = expect_one_mesh({.pslg = plate_with_holes(kSanitized ? 3 : 6),
                                        .size = kSanitized ? 2e-3 : 2e-4,
                                        .leaf_triangles = kSanitized ? 100.0 : 3000.0});
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), 20u);
}

Box box_of(const Pslg& pslg) {
  Box box;
  for (const Point p : pslg.points) box.add(p);
  return box;
}

// A grading function on the box of a domain, with finest triangles for which there is a reason.
std::string graded_size(const Box& box, Random& random) {
  const std::string x = text(box.min_x + random.unit() * box.width());
  const std::string y = text(box.min_y + random.unit() * box.height());
  const double area = box.width() * box.height();
  const double fine = area / (500 + 4000 * random.unit());
  switch (random.below(4)) {
    case 0:
      return text(fine);
    case 1:
      return text(0.1 * fine) + "+0.02*((x-" + x + ")^2+(y-" + y + ")^2)";
    case 2:
      return "x < " + x + " ? " + text(fine) + " : " + text(area * random.unit());
    default:
      return "(x-" + x + ")^2+(y-" + y + ")^2 < " + text(0.003 * area) + " ? " + text(0.01 * fine) +
             " : " + text(10 * fine);
  }
}

class ParallelPslgs : public testing::TestWithParam<Kind> {};

TEST_P(ParallelPslgs, GiveOneMeshAtEveryNumberOfThreads) {
  constexpr std::uint64_t kSeeds = kSanitized ? 4 : 40;
  constexpr double kAngles[] = {0, 15, 20, 25, 30, 33};
  Cases cases;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Random random(1000 + seed);
    MeshRequest request;
    request.pslg = GetParam().generate(random);
    request.size = graded_size(box_of(request.pslg), random);
    request.min_angle_deg = kAngles[random.below(std::size(kAngles))];
    request.leaf_triangles = 50 * std::pow(40, random.unit());
    request.sweeps = static_cast<std::uint32_t>(seed % 4);
    cases.add(request, "seed " + std::to_string(seed));
  }
  cases.expect_the_same_on_threads();
}

INSTANTIATE_TEST_SUITE_P(Of, ParallelPslgs, testing::ValuesIn(kinds().begin(), kinds().end()),
                         [](const auto& info) { return info.param.name; });

TEST(Parallel, LeavesOfFiftyTrianglesGiveOneMesh) {
  const auto summary = expect_one_mesh(busy_square(20'000, 50));
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), 256u);
}

TEST(Parallel, RunsOfOneRequestGiveOneMeshEachTime) {
  const MeshRequest request = busy_square(20'000, 100);
  const std::string first = outcome(mesh_on(nullptr, request));
  Arena arena(4);
  for (int i = 0; i < (kSanitized ? 3 : 20); ++i)
    ASSERT_EQ(outcome(mesh_on(&arena, request)), first);
}

// The corners of leaves inside the domain that a request gives.
std::vector<Point> leaf_corners(const MeshRequest& request) {
  const auto summary = mesh_on(nullptr, request);
  std::vector<Point> corners;
  if (!summary) return corners;
  for (const Box& leaf : summary->leaves) {
    if (leaf.min_x > summary->box.min_x && leaf.min_y > summary->box.min_y)
      corners.push_back({leaf.min_x, leaf.min_y});
  }
  return corners;
}

std::size_t shared(const std::vector<Point>& points, const std::vector<Box>& leaves) {
  return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](Point p) {
    return std::any_of(leaves.begin(), leaves.end(),
                       [&](const Box& leaf) { return leaf.min_x == p.x && leaf.min_y == p.y; });
  }));
}

TEST(Parallel, InputPointsOnLeafCornersAndBordersGiveOneMesh) {
  MeshRequest request = busy_square(10'000, 100);
  const std::vector<Point> corners = leaf_corners(request);
  for (std::size_t i = 0; i < corners.size(); i += 2) {
    request.pslg.points.push_back(corners[i]);
    // And a little along the border.
    request.pslg.points.push_back({corners[i].x, corners[i].y + 1e-3});
  }
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GE(shared(corners, summary->leaves), 20u);
}

TEST(Parallel, AcuteCornersOnLeafCornersGiveOneMesh) {
  MeshRequest request = busy_square(10'000, 100);
  const std::vector<Point> corners = leaf_corners(request);
  ASSERT_GE(corners.size(), 20u);
  std::vector<Point> used;
  for (std::size_t i = 0; i < corners.size(); i += 7) {
    const Point c = corners[i];
    used.push_back(c);
    // Three spokes within 15 degrees, that cross into other leaves.
    const double length = 0.04;
    for (const double slope : {0.1, 0.2, 0.35})
      add_segment(request.pslg, c, {c.x - length, c.y - slope * length});
  }
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->unrefined.small_input_angle, 0u);
  EXPECT_GE(shared(used, summary->leaves), 5u);
}

TEST(Parallel, ASizeThatJumpsAMillionfoldAtALeafBorderGivesOneMesh) {
  // The border through the middle of the square stays where it is for any size.
  const std::vector<Point> corners = leaf_corners(busy_square(10'000, 100));
  const auto middle = std::find_if(corners.begin(), corners.end(), [](Point p) {
    return std::fabs(p.x - 0.5) < 1e-4 && std::fabs(p.y - 0.5) < 1e-4;
  });
  ASSERT_NE(middle, corners.end());
  MeshRequest request{.pslg = square(), .leaf_triangles = 50};
  const std::string x = text(middle->x);
  const std::string y = text(middle->y);
  request.size = "x < " + x + " && y < " + y + " && x > 0.45 && y > 0.45 ? 1e-6 : 1";
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->triangles, 2'500u);
  EXPECT_TRUE(std::any_of(summary->leaves.begin(), summary->leaves.end(),
                          [&](const Box& leaf) { return leaf.max_x == middle->x; }));
}

TEST(Parallel, SegmentsThatCrossManyLeavesGiveOneMesh) {
  MeshRequest request = busy_square(20'000, 100);
  for (int i = 1; i < 8; ++i) {
    const double at = i / 8.0;
    add_segment(request.pslg, {0.01, at}, {0.99, 1 - at}, i);
    add_segment(request.pslg, {at, 0.01}, {at + 0.001, 0.99}, -i);
  }
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), 64u);
}

TEST(Parallel, ManySmallComponentsGiveOneMesh) {
  MeshRequest request{.size = 0.003, .leaf_triangles = 100};
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j)
      add_box(request.pslg, {1.0 * i, 1.0 * j}, {i + 0.3 + 0.03 * j, j + 0.2}, i);
  }
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), 64u);
}

TEST(Parallel, RegionsGiveOneMesh) {
  MeshRequest request = busy_square(2'000, 100);
  for (int i = 1; i < 10; ++i) add_segment(request.pslg, {i / 10.0, 0}, {i / 10.0 + 0.03, 1}, i);
  for (int i = 0; i < 10; ++i) {
    RegionSeed seed{{i / 10.0 + 0.06, 0.5}, i + 1, {}};
    if (i % 3 == 0) seed.max_area = 1e-4;
    request.pslg.regions.push_back(seed);
  }
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), 32u);
}

// Two segments side by side in a square of side 100: the bound on angles makes the mesh.
MeshRequest parallel_segments(double gap, double shift) {
  MeshRequest request{.pslg = square(100), .leaf_triangles = kSanitized ? 1'000.0 : 4'000.0};
  add_segment(request.pslg, {10, 50}, {90, 50});
  add_segment(request.pslg, {10 + shift, 50 + gap}, {90 + shift, 50 + gap});
  return request;
}

class ParallelSegments : public testing::TestWithParam<SizeSpec> {};

TEST_P(ParallelSegments, HaveLeavesThatHardlyWaitForEachOther) {
  for (const double shift : {0.0, 0.0013}) {
    MeshRequest request = parallel_segments(kSanitized ? 0.02 : 0.0023, shift);
    request.size = GetParam();
    const auto summary = expect_one_mesh(request);
    ASSERT_TRUE(summary);
    EXPECT_GE(summary->leaves.size(), kSanitized ? 20u : 60u);
    if (kSanitized) continue;
    EXPECT_LT(100 * summary->deferred, summary->insertions);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ParallelSegments, testing::Values(SizeSpec{}, SizeSpec{8.0}),
                         [](const auto& info) {
                           return info.param.value.index() != 0 ? "ASize" : "NoSize";
                         });

// How many triangles leaves add to those of one leaf: 1.02 is 2 %.
double cost_of_leaves(MeshRequest request, std::size_t* leaves) {
  const auto many = mesh_on(nullptr, request);
  request.leaf_triangles = std::numeric_limits<double>::infinity();
  const auto one = mesh_on(nullptr, request);
  EXPECT_TRUE(many && one);
  if (!many || !one) return 0;
  *leaves = many->leaves.size();
  return static_cast<double>(many->triangles) / static_cast<double>(one->triangles);
}

TEST(Leaves, AddNoTrianglesAroundAFineSpot) {
  for (const double angle : {0, 20}) {
    std::size_t leaves = 0;
    EXPECT_LT(cost_of_leaves({.pslg = square(1000),
                              .size = "hypot(x-333.3,y-411.7)<1 ? 1.3e-4 : 1e9",
                              .min_angle_deg = angle},
                             &leaves),
              1.02);
    EXPECT_GT(leaves, 10u);
  }
}

// What is cleaned up around leaves with large triangles needs room far around: nothing may have
// left.
TEST(Leaves, ThatAreNotDenseKeepTheGuarantee) {
  MeshRequest request{.pslg = square(1000), .size = "hypot(x-333.3,y-411.7)<1 ? 1.3e-4 : 1e9"};
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->leaves.size(), 64u);
  EXPECT_EQ(summary->unrefined.without_exemption(), 0u);
}

TEST(Leaves, AreSmallerThanAMillionthOfTheDomainWhereASpotIs) {
  std::size_t leaves = 0;
  EXPECT_LT(cost_of_leaves(
                {.pslg = square(), .size = "hypot(x-0.3333,y-0.4117)<3e-8 ? 9e-20 : 1e9"}, &leaves),
            1.02);
  EXPECT_GT(leaves, 10u);
}

// How much of the work was done when the first chunk with triangles left.
struct FirstTriangles : ChunkSink {
  explicit FirstTriangles(const ExecutionContext& context) : context(context) {}
  bool accept(Chunk&& chunk) override {
    if (fraction < 0 && !chunk.triangles.empty()) fraction = context.progress().fraction;
    return true;
  }
  const ExecutionContext& context;
  double fraction = -1;
};

double fraction_at_first_triangles(const MeshRequest& request, std::size_t* leaves) {
  ExecutionContext context;
  FirstTriangles sink(context);
  const auto summary = generate_mesh(request, sink, context);
  EXPECT_TRUE(summary);
  if (summary) *leaves = summary->leaves.size();
  return sink.fraction;
}

TEST(StreamingOfThreads, OfManyLeavesBeginsLongBeforeTheEnd) {
  std::size_t leaves = 0;
  EXPECT_LT(fraction_at_first_triangles(busy_square(60'000, 200), &leaves), 0.25);
  EXPECT_GE(leaves, 64u);
}

TEST(StreamingOfThreads, OfFewLeavesBeginsAfterTheCleanUp) {
  std::size_t leaves = 0;
  EXPECT_GE(fraction_at_first_triangles(busy_square(3'000, 200), &leaves), 0.6);
  EXPECT_GT(leaves, 1u);
  EXPECT_LT(leaves, 64u);
}

TEST(Parallel, OfARasterIsOneMesh) {
  Raster raster{{0, 0}, 5, 5, 79, 79, {}};
  for (int j = 0; j < 79; ++j)
    for (int i = 0; i < 79; ++i) raster.values.push_back(0.2 + (i * 37 + j * 11) % 10 * 0.2);
  MeshRequest request{.pslg = read_poly(model("pipe.poly"))};
  request.size = raster;
  request.leaf_triangles = 2'000;
  const auto summary = expect_one_mesh(request);
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->leaves.size(), 10u);
}

}  // namespace
}  // namespace weft
