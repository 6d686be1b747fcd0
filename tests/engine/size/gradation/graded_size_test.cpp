// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/graded_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/arena.h"
#include "engine/size/box_overlap.h"
#include "engine/size/constant_size.h"
#include "engine/size/edge_size.h"
#include "engine/size/expression/expression.h"
#include "engine/size/raster.h"
#include "tests/engine/domain/shapes.h"
#include "tests/engine/size/fields/field_laws.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

// A length of edges, limited over a domain.
struct Graded {
  Graded(const std::string& text, double gradation, const Pslg& pslg, int threads = 1)
      : expression(*Expression::parse(text)), edge(expression), arena(threads) {
    context.set_arena(arena);
    domain = *triangulate(pslg, context);
    size = std::make_unique<GradedSize>(*GradedSize::make(edge, gradation, domain, context));
  }

  double operator()(Point p) const { return SizeFunction::edge_of_area((*size)(p)); }

  Expression expression;
  EdgeSize edge;
  Arena arena;
  ExecutionContext context;
  Domain domain;
  std::unique_ptr<GradedSize> size;
};

Point random_in(const Domain& domain, std::mt19937_64& random) {
  // Triangles by their areas.
  std::vector<double> sums;
  double sum = 0;
  for (const auto& t : domain.triangles) {
    const Point a = domain.vertices[t.vertex[0]];
    const Point b = domain.vertices[t.vertex[1]];
    const Point c = domain.vertices[t.vertex[2]];
    sums.push_back(sum += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }
  const auto at = std::lower_bound(sums.begin(), sums.end(), sum * uniform(random)) - sums.begin();
  const auto& v = domain.triangles[static_cast<std::size_t>(at)].vertex;
  double s = uniform(random);
  double t = uniform(random);
  if (s + t > 1) s = 1 - s, t = 1 - t;
  const Point a = domain.vertices[v[0]];
  const Point b = domain.vertices[v[1]];
  const Point c = domain.vertices[v[2]];
  return {a.x + s * (b.x - a.x) + t * (c.x - a.x), a.y + s * (b.y - a.y) + t * (c.y - a.y)};
}

// Half of the points anywhere, half of them where edges are short: as the points of a mesh.
std::vector<Point> points_of(const Domain& domain, const SizeFunction& size, std::size_t count) {
  std::mt19937_64 random(5);
  std::vector<Point> points;
  while (points.size() < count) {
    Point best = random_in(domain, random);
    for (int i = 0; i < 8 && points.size() % 2 == 0; ++i) {
      const Point p = random_in(domain, random);
      if (size(p) < size(best)) best = p;
    }
    points.push_back(best);
  }
  return points;
}

// The limit at each point by brute force over the points of a grid and `extra` ones: never below
// the exact one, and above it by `coarse` at most if the size is flat around its lowest places.
struct Truth {
  Truth(const SizeFunction& size, const Domain& domain, double gradation, int across,
        const std::vector<Point>& extra)
      : gradation(gradation) {
    Box box;
    for (const Point p : domain.vertices) box.add(p);
    coarse = gradation * 0.71 * std::max(box.width(), box.height()) / across;
    const auto add = [&](Point p) {
      const double area = size(p);
      if (area > 0 && area < 1e300) samples.push_back({p, SizeFunction::edge_of_area(area)});
    };
    for (int j = 0; j <= across; ++j) {
      for (int i = 0; i <= across; ++i) {
        const Point p{box.min_x + box.width() * i / across, box.min_y + box.height() * j / across};
        if (in(domain, p)) add(p);
      }
    }
    for (const Point p : extra) add(p);
  }

  static bool in(const Domain& domain, Point p) {
    for (std::uint32_t t = 0; t < domain.triangles.size(); ++t) {
      const Corners c = corners_of(domain, t);
      bool all = true;
      for (unsigned k = 0; k < 3; ++k) {
        const Point a = c[k];
        const Point b = c[(k + 1) % 3];
        all = all && (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0;
      }
      if (all) return true;
    }
    return false;
  }

  double operator()(Point p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [q, edge] : samples)
      least = std::min(least, edge + gradation * std::sqrt(distance2(p, q)));
    return least;
  }

  double gradation;
  double coarse = 0;
  std::vector<std::pair<Point, double>> samples;
};

// `exact` is the limit in closed form, or null.
void expect_limit(const std::string& text, double gradation, const Pslg& pslg,
                  const std::function<double(Point)>& exact) {
  SCOPED_TRACE(text + " at " + std::to_string(gradation));
  const Graded graded(text, gradation, pslg);
  const auto points = points_of(graded.domain, *graded.size, exact ? 4000 : 300);
  const Truth truth(graded.edge, graded.domain, gradation, exact ? 1 : 400, points);
  std::vector<double> ratios;
  for (const Point p : points) {
    const double limit = exact ? exact(p) : truth(p);
    const double value = graded(p);
    ASSERT_LE(value, limit * (1 + 1e-9)) << p.x << " " << p.y;
    ratios.push_back(value / (exact ? limit : limit - truth.coarse));
  }
  std::sort(ratios.begin(), ratios.end());
  const double at_first_percentile = ratios[ratios.size() / 100];
  EXPECT_GE(at_first_percentile, 0.95);
  EXPECT_GE(ratios[ratios.size() / 2], 0.96);
  EXPECT_FALSE(graded.size->is_limited_already());
}

TEST(GradedSize, OfASpotIsACone) {
  for (const double gradation : {0.05, 0.15, 0.5, 2.0}) {
    expect_limit("hypot(x-3, y-4) < 0.1 ? 0.01 : 20", gradation, square(8), [&](Point p) {
      const double d = std::sqrt((p.x - 3) * (p.x - 3) + (p.y - 4) * (p.y - 4));
      return std::min(20.0, 0.01 + gradation * std::max(0.0, d - 0.1));
    });
  }
}

TEST(GradedSize, OfAStepGrowsFromItOnTheCoarseSideAlone) {
  for (const double gradation : {0.05, 0.15, 0.5, 2.0}) {
    expect_limit("x < 3 ? 0.05 : 1", gradation, square(8), [&](Point p) {
      return p.x < 3 ? 0.05 : std::min(1.0, 0.05 + gradation * (p.x - 3));
    });
  }
}

TEST(GradedSize, OfATooSteepConeIsAConeFromItsTop) {
  for (const double gradation : {0.05, 0.15, 0.5}) {
    expect_limit("0.02 + 0.6*hypot(x-3, y-4)", gradation, square(8), [&](Point p) {
      return 0.02 + gradation * std::sqrt((p.x - 3) * (p.x - 3) + (p.y - 4) * (p.y - 4));
    });
  }
}

TEST(GradedSize, OfASmoothSizeMeetsTheLimitByBruteForce) {
  Pslg ring = square(8);
  add_box(ring, {3, 3}, {5, 5});
  ring.holes.push_back({4, 4});
  for (const double gradation : {0.05, 0.15, 0.5, 2.0}) {
    expect_limit("0.1 + exp(0.8*x)/30 + (y-5)^2", gradation, ring, nullptr);
    expect_limit("0.3 + 0.2*sin(3*x)*cos(2*y)", std::min(gradation, 0.5), ring, nullptr);
  }
}

TEST(GradedSize, OfSteppedAnnuliMeetsTheLimitByBruteForce) {
  for (const double gradation : {0.05, 0.15, 0.5, 2.0})
    expect_limit("0.2 + 0.4*floor(4*abs(hypot(x-4, y-4) - 2))", gradation, square(8), nullptr);
}

TEST(GradedSize, HoldsFarFromTheOriginAndOverALargeRange) {
  expect_limit("hypot(x-3e6, y-3e6) < 20 ? 10 : 1e7", 0.15, square(8e6), [&](Point p) {
    const double d = std::sqrt((p.x - 3e6) * (p.x - 3e6) + (p.y - 3e6) * (p.y - 3e6));
    return 10 + 0.15 * std::max(0.0, d - 20);
  });
}

// Two arms, x < 3 and x > 5, joined below y = 1.
Pslg u_shape() {
  Pslg pslg;
  add_ring(pslg, {{0, 0}, {8, 0}, {8, 8}, {5, 8}, {5, 1}, {3, 1}, {3, 8}, {0, 8}});
  return pslg;
}

TEST(GradedSize, CrossesTheGapOfAUAsTheCrowFlies) {
  // The size grows steeply or jumps in the gap, and is lower there than anywhere.
  for (const char* gap : {"50", "0.00001", "sqrt(-1)", "abs(x-4)*100"}) {
    const std::string text =
        std::string("abs(x-4) < 1 && y > 1 ? ") + gap + " : hypot(x-1, y-7) < 0.25 ? 0.02 : 9";
    expect_limit(text, 0.15, u_shape(), [](Point p) {
      const double d = std::sqrt((p.x - 1) * (p.x - 1) + (p.y - 7) * (p.y - 7));
      return 0.02 + 0.15 * std::max(0.0, d - 0.25);
    });
  }
}

// The size grows gently within the arms, so that all sources lie on their walls.
TEST(GradedSize, StartsAtWallsIfAWalkCannotCrossTheGap) {
  expect_limit("abs(x-4) < 1 && y > 1 ? 50 : x < 3 ? 0.1 + 0.1*(3-x) : 5", 0.2, u_shape(), nullptr);
}

TEST(GradedSize, OfARasterMeetsTheLimitByBruteForce) {
  std::mt19937_64 random(3);
  Raster raster{{0, 0}, 0.5, 0.5, 17, 17, {}};
  for (int i = 0; i < 17 * 17; ++i)
    raster.values.push_back(0.01 * std::pow(10, 3 * uniform(random)));
  const RasterSize size = *RasterSize::make(raster);
  ExecutionContext context;
  const Domain domain = *triangulate(square(8), context);
  for (const double gradation : {0.05, 0.15, 0.5}) {
    const GradedSize graded = *GradedSize::make(size, gradation, domain, context);
    const auto points = points_of(domain, graded, 300);
    const Truth truth(size, domain, gradation, 800, points);
    std::vector<double> ratios;
    for (const Point p : points) {
      const double value = SizeFunction::edge_of_area(graded(p));
      ASSERT_LE(value, truth(p) * (1 + 1e-9));
      ratios.push_back(value / (truth(p) - truth.coarse));
    }
    std::sort(ratios.begin(), ratios.end());
    EXPECT_GE(ratios[3], 0.95);
  }
}

TEST(GradedSize, NeedsNoSourceIfTheSizeIsLimitedAlready) {
  for (const char* text : {"0.1 + 0.15*hypot(x-3, y-4)", "0.1 + 0.1*x + 0.11*y", "2",
                           "clamp(0.15*hypot(x, y-9), 0.01, 1)", "0.2 + 0.05*sin(3*x)"}) {
    const Graded graded(text, 0.15, square(8));
    EXPECT_TRUE(graded.size->is_limited_already()) << text;
    EXPECT_EQ(bits((*graded.size)({1, 2})), bits(graded.edge({1, 2})));
  }
}

// It jumps in the gap, away from both walls.
TEST(GradedSize, StartsAtWallsIfTheSizeJumpsBetweenThem) {
  expect_limit("x < 4.1 ? 0.1 + 0.1*max(0, 3-x) : 5", 0.2, u_shape(), nullptr);
}

// What happens where no walk from the domain and back comes by is no reason for sources.
TEST(GradedSize, NeedsNoSourceForWhatIsFarFromTheDomain) {
  Pslg ring = square(80);  // around a hole of 60, x and y from 10
  add_box(ring, {10, 10}, {70, 70});
  ring.holes.push_back({40, 40});
  const std::string rise = "1 + 0.1*abs(x-40) + 9*max(0, 10-hypot(x-40, y-40))";
  EXPECT_TRUE(Graded(rise, 0.15, ring).size->is_limited_already());
  EXPECT_FALSE(Graded(rise, 0.15, square(80)).size->is_limited_already());
  const std::string deep = "hypot(x-40, y-40) < 8 ? sqrt(-1) : 1 + 0.1*abs(x-40)";
  EXPECT_TRUE(Graded(deep, 0.15, ring).size->is_limited_already());
  // As far inland, but a cone comes back below the largest size.
  const std::string wide = "1 + 0.1*abs(x-40) + 9*max(0, 20-hypot(x-40, y-40))";
  EXPECT_FALSE(Graded(wide, 0.15, ring).size->is_limited_already());
}

TEST(GradedSize, NeedsNoSourceForWhatIsOutsideTheConvexHull) {
  Pslg slanted;
  add_ring(slanted, {{0, 0}, {8, 4}, {8, 8}, {0, 4}});
  const std::string corners = "y < 0.5*x-0.5 || y > 0.5*x+4.5 ? sqrt(-1) : 0.2 + 0.14*x";
  EXPECT_TRUE(Graded(corners, 0.15, slanted).size->is_limited_already());
}

TEST(GradedSize, StaysTheSizeWhereThatIsBelowTheLimit) {
  const Graded graded("x < 3 ? 0.1 : 0.1 + 0.05*y", 0.15, square(8));
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Point p{2.9 * uniform(random), 8 * uniform(random)};
    EXPECT_EQ(bits((*graded.size)(p)), bits(graded.edge(p)));
  }
}

TEST(GradedSize, BoundsHoldOverRandomBoxes) {
  for (const char* text : {"hypot(x-3, y-4) < 0.1 ? 0.01 : 20", "0.02 + 0.6*hypot(x-3, y-4)",
                           "0.3 + 0.2*sin(3*x)*cos(2*y)", "x < 3 ? 0.05 : y < 2 ? 1 : sqrt(y-3)"}) {
    SCOPED_TRACE(text);
    const Graded graded(text, 0.15, u_shape());
    expect_bounds_to_hold(*graded.size, {0, 0, 8, 8}, 0.5, 3000, true, 7);
    expect_same_bits_in_batches(*graded.size, {0, 0, 8, 8}, 8);
  }
}

TEST(GradedSize, BoundsOfAConeAreTight) {
  const Graded graded("hypot(x-3, y-4) < 0.1 ? 0.01 : 20", 0.15, square(8));
  const Interval bounds = graded.size->bounds({5, 4, 5.1, 4.1});
  EXPECT_LT(std::sqrt(bounds.hi / bounds.lo), 1.12);
}

TEST(GradedSize, HasTheSameBitsOnAnyNumberOfThreads) {
  const char* const text = "min(hypot(x-3, y-4) < 0.1 ? 0.003 : 9, 0.02 + 0.6*hypot(x-6, y-7))";
  const Graded alone(text, 0.15, u_shape());
  for (const int threads : {2, 3, 7}) {
    const Graded graded(text, 0.15, u_shape(), threads);
    EXPECT_EQ(graded.size->limit().nodes(), alone.size->limit().nodes());
    EXPECT_EQ(graded.size->limit().listed(), alone.size->limit().listed());
    std::mt19937_64 random(4);
    for (int i = 0; i < 20'000; ++i) {
      const Point p{8 * uniform(random), 8 * uniform(random)};
      ASSERT_EQ(bits((*graded.size)(p)), bits((*alone.size)(p)));
    }
  }
}

TEST(GradedSize, LeavesWhatIsNoSizeAsItIs) {
  const Graded graded("x < 1 ? -1 : x > 7 ? sqrt(-1) : y < 1 ? 0.02 : 4", 0.15, square(8));
  EXPECT_EQ(bits((*graded.size)({0.5, 4})), bits(graded.edge({0.5, 4})));
  EXPECT_LT((*graded.size)({0.5, 4}), 0);
  EXPECT_TRUE(std::isnan((*graded.size)({7.5, 4})));
  EXPECT_TRUE(graded.size->bounds({7.2, 4, 7.3, 5}).may_be_nan);
  EXPECT_LT(graded.size->bounds({0, 0, 8, 8}).lo, 0);
  EXPECT_NEAR(graded({4, 5}), 0.02 + 0.15 * 4, 0.04 * 0.62);
}

TEST(GradedSize, TakesAFewSecondsForHostileSizes) {
  for (const char* text :
       {"sqrt(-1) + x", "1e-300 + 0*x", "1e-300 + abs(x-3)", "0.001 + floor(x*1e9)*1e-10",
        "0.5*sin(1e9*x)", "hypot(x-3, y-4)", "x*y-3", "1/x", "exp(100*x)", "tan(9*x)"}) {
    SCOPED_TRACE(text);
    const double start = processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
    const Graded graded(text, 0.15, square(8), 2);
    const double seconds = processor_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    EXPECT_LT(seconds, 120 * slowdown());  // 2 as released, 23 under sanitizers
    EXPECT_LT(graded.size->bytes(), 300'000'000u);
  }
}

TEST(GradedSize, CanBeCancelled) {
  ExecutionContext context;
  const Domain domain = *triangulate(square(8), context);
  const Expression expression = *Expression::parse("x < 3 ? 0.05 : 1");
  context.cancel();
  const auto graded = GradedSize::make(expression, 0.15, domain, context);
  ASSERT_FALSE(graded.has_value());
  EXPECT_EQ(graded.error().code, ErrorCode::kCancelled);
}

TEST(GradedSize, StopsSoonAfterItsDeadline) {
  ExecutionContext context;
  const Domain domain = *triangulate(square(8), context);
  const Expression expression = *Expression::parse("0.001 + floor(x*1e9)*1e-10");
  const EdgeSize edge(expression);
  const double start = processor_seconds();
  context.set_deadline(ExecutionContext::Clock::now() + std::chrono::milliseconds(100));
  const auto graded = GradedSize::make(edge, 0.15, domain, context);
  const double seconds = processor_seconds() - start;
  ASSERT_FALSE(graded.has_value());
  EXPECT_EQ(graded.error().code, ErrorCode::kDeadlineExceeded);
  EXPECT_LT(seconds, 0.1 + 0.2 * slowdown());
}

}  // namespace
}  // namespace weft
