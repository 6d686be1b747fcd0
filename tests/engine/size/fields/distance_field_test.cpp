// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/processor_time.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Box kUnit{0, 0, 1, 1};

// From 0 to 1.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

DistanceField distance_to(std::vector<Line> lines, const Box& box = kUnit) {
  const ExecutionContext context;
  return *DistanceField::make(std::move(lines), box, context);
}

// In a box, of a length that leaves room around them; every tenth a point.
std::vector<Line> random_lines(std::size_t n, const Box& box, std::mt19937_64& random) {
  std::vector<Line> lines;
  const double length = 0.5 / std::sqrt(static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const Point a{box.min_x + box.width() * uniform(random),
                  box.min_y + box.height() * uniform(random)};
    const Point b{a.x + box.width() * length * (2 * uniform(random) - 1),
                  a.y + box.height() * length * (2 * uniform(random) - 1)};
    lines.push_back({a, i % 10 == 0 ? a : b});
  }
  return lines;
}

Point random_point(const Box& box, std::mt19937_64& random) {
  return {box.min_x + box.width() * uniform(random), box.min_y + box.height() * uniform(random)};
}

// Some sides of the box larger on each side.
Box grown(const Box& box, double sides) {
  return {box.min_x - sides * box.width(), box.min_y - sides * box.height(),
          box.max_x + sides * box.width(), box.max_y + sides * box.height()};
}

// By the definition, in long double.
double true_distance(const std::vector<Line>& lines, Point p) {
  long double least = kInfinity;
  for (const Line& line : lines) {
    const long double ux = static_cast<long double>(line.b.x) - line.a.x;
    const long double uy = static_cast<long double>(line.b.y) - line.a.y;
    const long double wx = static_cast<long double>(p.x) - line.a.x;
    const long double wy = static_cast<long double>(p.y) - line.a.y;
    const long double square = ux * ux + uy * uy;
    const long double t =
        square > 0 ? std::clamp<long double>((wx * ux + wy * uy) / square, 0, 1) : 0;
    least =
        std::min(least, std::sqrt((wx - t * ux) * (wx - t * ux) + (wy - t * uy) * (wy - t * uy)));
  }
  return static_cast<double>(least);
}

// The law of distance_field.h: the least of the values with one line each.
class BruteForce {
 public:
  BruteForce(const std::vector<Line>& lines, const Box& box) {
    for (const Line& line : lines) fields_.push_back(distance_to({line}, box));
  }
  double operator()(Point p) const {
    double least = kInfinity;
    for (const DistanceField& field : fields_) least = std::min(least, field(p));
    return least;
  }

 private:
  std::vector<DistanceField> fields_;
};

// What is the same for any number of them.
struct Hostile {
  const char* name;
  std::function<std::vector<Line>(std::size_t n)> lines;
};

Point on_circle(double radius, std::size_t i, std::size_t n) {
  const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
  return {0.5 + radius * std::cos(angle), 0.5 + radius * std::sin(angle)};
}

std::vector<Line> lines_of(std::size_t n, const std::function<Line(std::size_t)>& line) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < n; ++i) lines.push_back(line(i));
  return lines;
}

std::vector<Line> points_on_circle(std::size_t n, double radius) {
  return lines_of(n, [&](std::size_t i) {
    return Line{on_circle(radius, i, n), on_circle(radius, i, n)};
  });
}

std::vector<Line> random_around(std::size_t n, Point middle, double extent) {
  std::mt19937_64 random(7);
  const auto near = [&] {
    return Point{middle.x + extent * uniform(random), middle.y + extent * uniform(random)};
  };
  return lines_of(n, [&](std::size_t) {
    const Point a = near();
    return Line{a, near()};
  });
}

const Hostile kHostile[] = {
    {"pieces of a straight line",
     [](std::size_t n) {
       const auto at = [n](std::size_t i) {
         const double t = static_cast<double>(i) / static_cast<double>(n);
         return Point{0.1 + 0.8 * t, 0.3 + 0.1 * t};
       };
       return lines_of(n, [&](std::size_t i) { return Line{at(i), at(i + 1)}; });
     }},
    {"pieces of a circle",
     [](std::size_t n) {
       return lines_of(n, [n](std::size_t i) {
         return Line{on_circle(0.45, i, n), on_circle(0.45, i + 1, n)};
       });
     }},
    {"points on a circle around", [](std::size_t n) { return points_on_circle(n, 2); }},
    {"points on a large circle around", [](std::size_t n) { return points_on_circle(n, 1e6); }},
    {"one line, in both directions",
     [](std::size_t n) {
       return lines_of(n, [](std::size_t i) {
         const Line line{{0.2, 0.3}, {0.7, 0.8}};
         return i % 2 == 0 ? line : Line{line.b, line.a};
       });
     }},
    {"one point",
     [](std::size_t n) {
       return std::vector<Line>(n, Line{{0.2, 0.3}, {0.2, 0.3}});
     }},
    {"a star",
     [](std::size_t n) {
       return lines_of(n, [n](std::size_t i) {
         const Point a = on_circle(0.5, i, 2 * n);
         return Line{a, {1 - a.x, 1 - a.y}};
       });
     }},
    {"a star of rays",
     [](std::size_t n) {
       return lines_of(n, [n](std::size_t i) { return Line{{0.5, 0.5}, on_circle(0.5, i, n)}; });
     }},
    {"a comb",
     [](std::size_t n) {
       return lines_of(n, [n](std::size_t i) {
         const double x = static_cast<double>(i) / static_cast<double>(n);
         return Line{{x, 0}, {x, 1}};
       });
     }},
    {"far away",
     [](std::size_t n) {
       return random_around(n, {1e3, 1e3}, 1);
     }},
    {"very far away",
     [](std::size_t n) {
       return random_around(n, {1e9, -1e9}, 1e3);
     }},
    {"in a tiny part",
     [](std::size_t n) {
       return random_around(n, {0.3, 0.6}, 1e-9);
     }},
    {"points of one height",
     [](std::size_t n) {
       return lines_of(n, [n](std::size_t i) {
         const Point p{static_cast<double>(i) / static_cast<double>(n), 0.5};
         return Line{p, p};
       });
     }},
    {"points on a parabola",
     [](std::size_t n) {
       return lines_of(n, [n](std::size_t i) {
         const double x = static_cast<double>(i) / static_cast<double>(n);
         return Line{{x, x * x}, {x, x * x}};
       });
     }},
    {"long crossing ones",
     [](std::size_t n) {
       return random_around(n, {0, 0}, 1);
     }},
};

TEST(DistanceField, CostsLittleWhereNothingHasLists) {
  const ExecutionContext context;
  std::mt19937_64 random(1);
  const auto field = DistanceField::make(random_lines(100, kUnit, random),
                                         DomainCover::nothing_of(kUnit), context);
  ASSERT_TRUE(field);
  EXPECT_LT(field->operations(), 1000u);
}

TEST(DistanceField, IsExactToOneLineAndOnePoint) {
  const DistanceField to_line = distance_to({{{0, 0}, {1, 0}}});
  EXPECT_EQ(to_line({0.5, 0.25}), 0.25);
  EXPECT_EQ(to_line({0.25, 0}), 0);
  EXPECT_EQ(to_line({1, 0}), 0);
  EXPECT_EQ(to_line({4, 4}), 5);
  EXPECT_EQ(to_line({-3, -4}), 5);
  const DistanceField to_point = distance_to({{{0.5, 0.5}, {0.5, 0.5}}});
  EXPECT_EQ(to_point({0.5, 0.5}), 0);
  EXPECT_EQ(to_point({3.5, 4.5}), 5);
}

TEST(DistanceField, OfACircleOfSegmentsIsTheDistanceToTheCircle) {
  constexpr std::size_t kPieces = 20'000;
  const DistanceField field = distance_to(kHostile[1].lines(kPieces));
  const double sagitta = 0.45 * std::pow(3.15 / kPieces, 2);
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const Point p = random_point(grown(kUnit, 0.5), random);
    const double from_middle = std::sqrt(distance2(p, {0.5, 0.5}));
    ASSERT_NEAR(field(p), std::fabs(from_middle - 0.45), sagitta);
  }
}

TEST(DistanceField, IsThatOfTheDefinitionButForRounding) {
  std::mt19937_64 random(2);
  for (const Box& box :
       {kUnit, Box{1e6, -1e6, 1e6 + 1, -1e6 + 1}, Box{0, 0, 1e-3, 2e-3}, Box{-1e6, 3e6, 1e6, 4e6},
        Box{-1e50, -1e50, 1e50, 1e50}, Box{0, 0, 1e-50, 1e-50}}) {
    const std::vector<Line> lines = random_lines(300, box, random);
    const DistanceField field = distance_to(lines, box);
    const double side = std::max(box.width(), box.height());
    for (int i = 0; i < 500; ++i) {
      const Point p = random_point(grown(box, i % 2 == 0 ? 0 : 2), random);
      const double truth = true_distance(lines, p);
      ASSERT_NEAR(field(p), truth, 0x1p-48 * (truth + side)) << side;
    }
  }
}

TEST(DistanceField, HasTheBitsOfBruteForce) {
  std::mt19937_64 random(3);
  for (const Box& box : {kUnit, Box{1e6, -1e6, 1e6 + 1, -1e6 + 1}, Box{0, 0, 1e-3, 1e-4},
                         Box{-1e6, 3e6, 1e6, 4e6}}) {
    for (const double spread : {0.0, 3.0}) {  // lines in the box, and mostly outside
      const std::vector<Line> lines = random_lines(400, grown(box, spread), random);
      const DistanceField field = distance_to(lines, box);
      const BruteForce brute(lines, box);
      for (int i = 0; i < 400; ++i) {
        const Point p = random_point(grown(box, i % 4 == 0 ? 1 : 0), random);
        ASSERT_EQ(field(p), brute(p)) << p.x << " " << p.y;
      }
    }
  }
}

TEST(DistanceField, HasTheBitsOfBruteForceToHostileLines) {
  for (const Hostile& hostile : kHostile) {
    // So many that lists stay long and the tree is asked.
    const std::vector<Line> lines = hostile.lines(3'000);
    const DistanceField field = distance_to(lines);
    const BruteForce brute(lines, kUnit);
    std::mt19937_64 random(4);
    for (int i = 0; i < 60; ++i) {
      Point p = random_point(i % 6 == 0 ? grown(kUnit, 1) : kUnit, random);
      if (i % 6 == 1) p = {0.5 + 1e-4 * uniform(random), 0.5};
      ASSERT_EQ(field(p), brute(p)) << hostile.name << ": " << p.x << " " << p.y;
    }
  }
}

TEST(DistanceField, BuildsHostileLinesInTimeAndMemory) {
  constexpr std::size_t kLines = 100'000;
  for (const Hostile& hostile : kHostile) {
    std::vector<Line> lines = hostile.lines(kLines);
    const double start = processor_seconds(CLOCK_PROCESS_CPUTIME_ID);
    const DistanceField field = distance_to(std::move(lines));
    const double seconds = processor_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    EXPECT_LT(seconds, 20 * slowdown()) << hostile.name;  // under sanitizers; else half a second
    EXPECT_LT(field.bytes(), 200 * kLines) << hostile.name;
    std::mt19937_64 random(5);
    for (int i = 0; i < 100; ++i) {
      const double value = field(random_point(kUnit, random));
      ASSERT_TRUE(value >= 0 && value < kInfinity) << hostile.name;
    }
    EXPECT_LT(field.operations(), 200'000u) << hostile.name;
  }
}

TEST(DistanceField, CountsNearDuplicatesAsFew) {
  std::mt19937_64 random(6);
  const auto lines = lines_of(50'000, [&](std::size_t) {
    const auto off = [&] { return 1e-14 * uniform(random); };
    return Line{{0.2 + off(), 0.3 + off()}, {0.7 + off(), 0.8 + off()}};
  });
  const DistanceField field = distance_to(lines);
  EXPECT_LT(field.operations(), 1'000u);
  EXPECT_NEAR(field({0.7, 0.3}), 0.5 * std::sqrt(0.5), 1e-12);
}

TEST(DistanceField, HoldsItsBoundsOverEveryBox) {
  std::mt19937_64 random(7);
  for (const Box& box : {kUnit, Box{1e6, -1e6, 1e6 + 1, -1e6 + 1}, Box{0, 0, 1e-3, 1e-4}}) {
    const DistanceField field = distance_to(random_lines(500, box, random), box);
    for (int i = 0; i < 20'000; ++i) {
      // Inside, outside and across the border; from 1e-9 of the box to 3 of it; some degenerate.
      const double size = 3 * std::pow(10, -9 * uniform(random));
      const Point low = random_point(grown(box, i % 3 == 0 ? 3 : 0.1), random);
      Box asked{low.x, low.y, low.x + box.width() * size * uniform(random),
                low.y + box.height() * size * uniform(random)};
      if (i % 5 == 0) asked.max_x = asked.min_x;
      if (i % 7 == 0) asked.max_y = asked.min_y;
      const Interval bounds = field.bounds(asked);
      ASSERT_FALSE(bounds.may_be_nan);
      ASSERT_GE(bounds.lo, 0);
      for (int k = 0; k < 8; ++k) {
        const auto along = [&](double low, double high, int corner) {
          return k < 4 ? (corner != 0 ? high : low)
                       : std::min(high, low + (high - low) * uniform(random));
        };
        const Point p{along(asked.min_x, asked.max_x, k & 1),
                      along(asked.min_y, asked.max_y, k & 2)};
        const double value = field(p);
        ASSERT_LE(bounds.lo, value);
        ASSERT_GE(bounds.hi, value);
      }
    }
  }
}

TEST(DistanceField, HasTightBoundsOverABoxThatIsSmallBesideItsDistance) {
  const DistanceField field = distance_to({{{0, 0}, {0, 1}}});
  const Interval bounds = field.bounds({0.5, 0.5, 0.5 + 3e-9, 0.5 + 4e-9});
  EXPECT_NEAR(bounds.lo, 0.5 - 1e-9, 1e-12);
  EXPECT_NEAR(bounds.hi, 0.5 + 4e-9, 1e-12);
  const Interval of_point = field.bounds({0.5, 0.5, 0.5, 0.5});
  EXPECT_LT(of_point.hi - of_point.lo, 1e-12);
}

TEST(DistanceField, ChangesNoFasterThanItSays) {
  std::mt19937_64 random(8);
  const DistanceField field = distance_to(random_lines(500, kUnit, random));
  EXPECT_GE(field.steepness(kUnit), 1);
  EXPECT_LE(field.steepness(kUnit), 1 + 1e-9);
  for (int i = 0; i < 50'000; ++i) {
    const double apart = std::pow(10, -8 * uniform(random));
    const Point p = random_point(grown(kUnit, i % 2), random);
    const Point q{p.x + apart * (uniform(random) - 0.5), p.y + apart * (uniform(random) - 0.5)};
    ASSERT_LE(std::fabs(field(p) - field(q)),
              field.steepness(kUnit) * std::sqrt(distance2(p, q)) + 1e-14);
  }
}

TEST(DistanceField, HasASlopeOfOne) {
  const auto slope = distance_to({{{0, 0}, {1, 1}}}).slope();
  ASSERT_NE(slope, nullptr);
  EXPECT_EQ((*slope)({0.3, 0.9}), 1);
  EXPECT_EQ(slope->bounds(kUnit).hi, 1);
}

TEST(DistanceField, GivesAPointTheSameBitsInEveryBatch) {
  std::mt19937_64 random(9);
  for (const std::size_t kind : {0u, 6u, 12u}) {  // by lists and by the tree
    const DistanceField field = distance_to(kHostile[kind].lines(5'000));
    alignas(64) double x[64], y[64], out[64];
    for (int batch = 0; batch < 100; ++batch) {
      const double extent = std::pow(10, -4 * uniform(random));
      const Point low = random_point(grown(kUnit, 0.1), random);
      for (int i = 0; i < 64; ++i) {
        x[i] = low.x + extent * uniform(random);
        y[i] = low.y + extent * uniform(random);
      }
      x[3] = std::nan("");
      y[12] = 1e300;
      field.evaluate(64, x, y, out);
      for (int i = 0; i < 64; ++i)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(out[i]),
                  std::bit_cast<std::uint64_t>(field({x[i], y[i]})));
    }
  }
}

TEST(DistanceField, IsDefinedEverywhereButAtNaN) {
  const DistanceField field = distance_to({{{0, 0}, {1, 1}}});
  EXPECT_NEAR(field({3e50, 4e50}) / 1e50, 5, 1e-12);
  EXPECT_EQ(field({1e200, 0}), kInfinity);
  EXPECT_EQ(field({0, -kInfinity}), kInfinity);
  EXPECT_TRUE(std::isnan(field({std::nan(""), 0})));
  EXPECT_TRUE(std::isnan(field({0, std::nan("")})));
  EXPECT_EQ(field.bounds({0, 0, 1e200, 1}).hi, kInfinity);
  EXPECT_EQ(field.bounds({-kInfinity, 0, kInfinity, 1}).hi, kInfinity);
}

TEST(DistanceField, IsDefinedForABoxWithoutArea) {
  std::mt19937_64 random(10);
  for (const Box& box :
       {Box{0.5, 0.5, 0.5, 0.5}, Box{0, 0, 0, 0}, Box{0, 0.5, 1, 0.5}, Box{1e50, 0, 1e50, 0}}) {
    const std::vector<Line> lines = random_lines(200, kUnit, random);
    const DistanceField field = distance_to(lines, box);
    for (int i = 0; i < 100; ++i) {
      const Point p = random_point(kUnit, random);
      const double rounding = 0x1p-48 * (2 + std::fabs(box.min_x));
      ASSERT_NEAR(field(p), true_distance(lines, p), rounding);
    }
  }
}

TEST(DistanceField, IsTheSameOnAnyNumberOfThreads) {
  std::mt19937_64 random(11);
  std::vector<std::vector<Line>> inputs{random_lines(30'000, kUnit, random)};
  inputs.push_back(kHostile[0].lines(20'000));
  inputs.push_back(kHostile[6].lines(20'000));
  for (const std::vector<Line>& lines : inputs) {
    const DistanceField alone = distance_to(lines);
    for (const int threads : {1, 2, 3, 7}) {
      Arena arena(threads);
      ExecutionContext context;
      context.set_arena(arena);
      const auto field = DistanceField::make(lines, kUnit, context);
      ASSERT_TRUE(field);
      EXPECT_EQ(field->bytes(), alone.bytes()) << threads;
      EXPECT_EQ(field->operations(), alone.operations()) << threads;
      for (int i = 0; i < 2'000; ++i) {
        const Point p = random_point(grown(kUnit, 0.1), random);
        ASSERT_EQ((*field)(p), alone(p)) << threads;
      }
    }
  }
}

TEST(DistanceField, StopsWhereverTheRunIsCancelledOrLate) {
  std::mt19937_64 random(12);
  const std::vector<Line> lines = random_lines(60'000, kUnit, random);
  ExecutionContext whole;
  ASSERT_TRUE(DistanceField::make(lines, kUnit, whole));
  const std::uint64_t polls = whole.pulse();
  EXPECT_GT(polls, 1'000u);
  {
    ExecutionContext context;
    context.cancel();
    const auto field = DistanceField::make(lines, kUnit, context);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, ErrorCode::kCancelled);
    EXPECT_LT(context.pulse(), 4u);
  }
  for (const int threads : {1, 2}) {
    Arena arena(threads);
    // A machine that is done before the deadline has half the time for the next one.
    for (std::chrono::microseconds time(15'000);; time /= 2) {
      ExecutionContext context;
      context.set_arena(arena);
      context.set_deadline(ExecutionContext::Clock::now() + time);
      const auto field = DistanceField::make(lines, kUnit, context);
      if (field && time.count() > 0) continue;
      ASSERT_FALSE(field);
      EXPECT_EQ(field.error().code, ErrorCode::kDeadlineExceeded);
      EXPECT_LT(context.pulse(), polls);
      break;
    }
  }
}

TEST(DistanceField, PollsOftenInOneLongPass) {
  ExecutionContext context;
  ASSERT_TRUE(DistanceField::make(std::vector<Line>(1'000'000, {{0, 0}, {1, 1}}), kUnit, context));
  EXPECT_GT(context.pulse(), 20u);
}

TEST(DistanceField, AnnouncesItsMemory) {
  struct Source : MemorySource {
    Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
      asked = needed;
      if (refuses) return fail(ErrorCode::kOutOfMemory, "", "none left");
      return needed;
    }
    std::uint64_t asked = 0;
    bool refuses = false;
  } source;
  std::mt19937_64 random(13);
  const std::vector<Line> lines = random_lines(20'000, kUnit, random);
  ExecutionContext context;
  context.set_memory(source, 0);
  const auto field = DistanceField::make(lines, kUnit, context);
  ASSERT_TRUE(field);
  EXPECT_GE(source.asked, field->bytes());
  EXPECT_LE(source.asked, 300 * lines.size() + (4u << 20));

  ExecutionContext refused;
  source.refuses = true;
  refused.set_memory(source, 0);
  EXPECT_EQ(DistanceField::make(lines, kUnit, refused).error().code, ErrorCode::kOutOfMemory);

  const ExecutionContext poor(Budget{.max_bytes = 1'000'000});
  EXPECT_EQ(DistanceField::make(lines, kUnit, poor).error().code, ErrorCode::kBudgetExceeded);
}

}  // namespace
}  // namespace weft
