// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/width_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "engine/size/fields/medial_axis.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/poly.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double operator()() { return random_() / 4294967296.0; }

 private:
  std::mt19937 random_;
};

Domain domain_of(const Pslg& pslg) {
  const ExecutionContext context;
  Result<Domain> domain = triangulate(pslg, context);
  if (!domain) throw std::runtime_error(domain.error().message);
  return *std::move(domain);
}

WidthField width_of(const Pslg& pslg) {
  const ExecutionContext context;
  Result<WidthField> width = WidthField::make(domain_of(pslg), context);
  if (!width) throw std::runtime_error(width.error().message);
  return *std::move(width);
}

std::vector<Point> circle(int corners, double radius = 1) {
  std::vector<Point> ring;
  for (int i = 0; i < corners; ++i)
    ring.push_back(
        {radius * std::cos(kTurn * i / corners), radius * std::sin(kTurn * i / corners)});
  return ring;
}

Pslg polygon(const std::vector<Point>& ring) {
  Pslg pslg;
  add_ring(pslg, ring);
  return pslg;
}

Pslg strip(double length = 10, double width = 1) {
  return polygon({{0, 0}, {length, 0}, {length, width}, {0, width}});
}

// A strip whose banks are moved by up to `noise` / 2, every 0.05.
Pslg noisy_strip(double noise, unsigned seed) {
  Random random(seed);
  std::vector<Point> ring;
  for (int i = 0; i < 200; ++i) ring.push_back({0.05 * i, noise * (random() - 0.5)});
  for (int i = 0; i < 200; ++i) ring.push_back({10 - 0.05 * i, 1 + noise * (random() - 0.5)});
  return polygon(ring);
}

// Points of the domain.
std::vector<Point> points_in(const Domain& domain, int count, unsigned seed) {
  Random random(seed);
  std::vector<Point> points;
  while (points.size() < static_cast<std::size_t>(count)) {
    const auto t =
        static_cast<std::size_t>(random() * static_cast<double>(domain.triangles.size()));
    const auto& v = domain.triangles[t].vertex;
    const Point a = domain.vertices[v[0]], b = domain.vertices[v[1]], c = domain.vertices[v[2]];
    const double s = 0.02 + 0.9 * random(), u = (0.98 - s) * random();
    points.push_back(
        {a.x + s * (b.x - a.x) + u * (c.x - a.x), a.y + s * (b.y - a.y) + u * (c.y - a.y)});
  }
  return points;
}

struct Ratios {
  double least;
  double median;
  double most;
};

// Of the field to the true width, at points that `at` makes of two numbers from 0 to 1.
Ratios ratios(const WidthField& width, const std::function<Point(double, double)>& at,
              const std::function<double(Point)>& truth) {
  Random random(5);
  std::vector<double> all;
  for (int i = 0; i < 2000; ++i) {
    const double s = random();
    const Point p = at(s, random());
    all.push_back(width(p) / truth(p));
  }
  std::sort(all.begin(), all.end());
  return {all.front(), all[all.size() / 2], all.back()};
}

Ratios strip_ratios(const Pslg& pslg, double width = 1) {
  return ratios(
      width_of(pslg),
      [&](double s, double u) {
        return Point{1 + 8 * s, width * (0.06 + 0.88 * u)};
      },
      [&](Point) { return width; });
}

TEST(WidthField, OfAStripIsItsWidth) {
  const Ratios r = strip_ratios(strip());
  EXPECT_NEAR(r.least, 1, 1e-9);
  EXPECT_NEAR(r.most, 1, 1e-9);
}

TEST(WidthField, OfAPassageTooNarrowForPiecesIsItsWidth) {
  for (const double width : {1e-3, 1e-7}) {
    const Ratios r = strip_ratios(strip(10, width), width);
    EXPECT_NEAR(r.least, 1, 1e-6) << width;
    EXPECT_NEAR(r.most, 1, 1e-6) << width;
  }
}

// The walls' points do not face each other.
TEST(WidthField, OfANarrowPassageDoesNotDependOnWhereItsPointsAre) {
  Random random(14);
  std::vector<Point> ring;
  double x = 0;
  for (; x < 10; x += 0.1 + random()) ring.push_back({x, 0});
  ring.push_back({10, 0});
  for (x = 10; x > 0; x -= 0.1 + random()) ring.push_back({x, 1e-6});
  ring.push_back({0, 1e-6});
  const Ratios r = strip_ratios(polygon(ring), 1e-6);
  EXPECT_NEAR(r.least, 1, 1e-6);
  EXPECT_NEAR(r.most, 1, 1e-6);
}

TEST(WidthField, OfAWedgeGrowsWithTheDistanceFromItsTip) {
  for (const double half : {0.1, 1e-7}) {
    const double rise = 10 * std::tan(half);
    const Ratios r = ratios(
        width_of(polygon({{0, 0}, {10, -rise}, {10, rise}})),
        [](double s, double) {
          return Point{6 + 3 * s, 0};
        },
        [&](Point p) { return 2 * std::sin(half) * p.x; });
    EXPECT_GT(r.least, 0.999) << half;
    EXPECT_NEAR(r.median, 1, 0.01) << half;
    EXPECT_LT(r.most, 1.06) << half;
  }
}

// A size by the width would have no end at the tip.
TEST(WidthField, OfACornerIsNotBelowThatOfTheMiddleOfItsWalls) {
  for (const double half : {0.3, 0.05}) {
    const double rise = 10 * std::tan(half);
    const WidthField width = width_of(polygon({{0, 0}, {10, -rise}, {10, rise}}));
    const double middle = 2 * std::sin(half) * 5;
    for (const double x : {1e-9, 1e-3, 0.1, 1.0, 3.0, 4.5, 6.0})
      EXPECT_GT(width({x, 0}), 0.9 * middle) << half << " " << x;
    EXPECT_GT(width.bounds({0, -rise, 10, rise}).lo, 0.9 * middle) << half;
  }
}

TEST(WidthField, BoundsOfABoxAcrossAStripAreTight) {
  const WidthField width = width_of(strip());
  const Interval all = width.bounds({0, 0, 10, 1});
  EXPECT_GT(all.lo, 0.97);
  EXPECT_LE(all.lo, 1);
  EXPECT_GT(width.bounds({3, 0, 5, 1}).lo, 0.97);
}

TEST(WidthField, OfADiskIsItsDiameterHoweverManyItsCorners) {
  struct Case {
    int corners;
    double least;
  };
  for (const auto [corners, least] :
       {Case{8, 0.92}, Case{16, 0.98}, Case{64, 0.998}, Case{1024, 0.9999}}) {
    const Ratios r = ratios(
        width_of(polygon(circle(corners))),
        [](double s, double u) {
          const double radius = 0.9 * std::sqrt(s);
          return Point{radius * std::cos(kTurn * u), radius * std::sin(kTurn * u)};
        },
        [](Point) { return 2.0; });
    EXPECT_GT(r.least, least) << corners;
    EXPECT_LT(r.most, 1.000001) << corners;
  }
}

TEST(WidthField, HardlyFeelsUnevenBanks) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Ratios r = strip_ratios(noisy_strip(0.05, seed));
    EXPECT_GT(r.least, 0.93) << seed;
    EXPECT_LT(r.most, 1.07) << seed;
  }
}

TEST(WidthField, OfARingIsTheGapAroundItsHole) {
  Pslg ring = polygon(circle(256, 3));
  add_ring(ring, circle(256, 2));
  ring.holes = {{0, 0}};
  const Ratios r = ratios(
      width_of(ring),
      [](double s, double u) {
        const double radius = 2.02 + 0.96 * s;
        return Point{radius * std::cos(kTurn * u), radius * std::sin(kTurn * u)};
      },
      [](Point) { return 1.0; });
  EXPECT_NEAR(r.least, 1, 0.002);
  EXPECT_NEAR(r.most, 1, 0.002);
}

TEST(WidthField, OfEachComponentIsItsOwn) {
  Pslg both = strip();
  add_box(both, {0, 1.5}, {10, 4.5});
  const WidthField width = width_of(both);
  EXPECT_NEAR(width({5, 0.3}), 1, 1e-9);
  EXPECT_NEAR(width({5, 2.2}), 3, 1e-9);
}

TEST(WidthField, WhatHasTheMeshedAreaOnBothSidesIsNoWall) {
  Pslg divided = strip();
  add_segment(divided, {0.5, 0.5}, {9, 0.5}, 7);  // a slit
  add_segment(divided, {8, 0}, {8, 1}, 8);        // the border of a region
  divided.regions = {{.at = {9, 0.2}, .id = 3, .max_area = {}}};
  for (int i = 0; i < 50; ++i) divided.points.push_back({0.2 * i, 0.7});
  const Ratios r = strip_ratios(divided);
  EXPECT_NEAR(r.least, 1, 1e-9);
  EXPECT_NEAR(r.most, 1, 1e-9);
}

TEST(WidthField, DuplicatePointsAndSegmentsChangeNothing) {
  Pslg twice = noisy_strip(0.05, 1);
  const Pslg once = twice;
  add_ring(twice, once.points);
  const WidthField a = width_of(once), b = width_of(twice);
  for (const Point p : points_in(domain_of(once), 500, 2)) EXPECT_EQ(a(p), b(p));
}

TEST(WidthField, IsPositiveAndNotAboveTheShorterSideInAnyPolygon) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    std::vector<Point> ring;
    const int corners = 3 + i % 8;
    for (int k = 0; k < corners; ++k) {
      const double radius = 0.05 + random();
      ring.push_back(
          {radius * std::cos(kTurn * k / corners), radius * std::sin(kTurn * k / corners)});
    }
    const Domain domain = domain_of(polygon(ring));
    Box box;
    for (const Point p : domain.vertices) box.add(p);
    const WidthField width = width_of(polygon(ring));
    for (const Point p : points_in(domain, 50, 3)) {
      EXPECT_GT(width(p), 0) << i;
      EXPECT_LE(width(p), std::min(box.width(), box.height())) << i;
    }
  }
}

TEST(WidthField, OfATriangleIsThatOfItsInscribedDiskAtItsCentre) {
  Random random(12);
  for (int i = 0; i < 300; ++i) {
    const Point a{random(), random()}, b{random(), random()}, c{random(), random()};
    const double la = std::sqrt(distance2(b, c)), lb = std::sqrt(distance2(c, a)),
                 lc = std::sqrt(distance2(a, b)), around = la + lb + lc;
    const double area2 = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    const Point centre{(la * a.x + lb * b.x + lc * c.x) / around,
                       (la * a.y + lb * b.y + lc * c.y) / around};
    const double ratio = width_of(polygon({a, b, c}))(centre) * around / (2 * area2);
    EXPECT_GT(ratio, 0.999) << i;
    EXPECT_LT(ratio, 1.4) << i;
  }
}

TEST(WidthField, GrowsWithTheDomain) {
  const Pslg plain = noisy_strip(0.05, 4);
  const WidthField width = width_of(plain);
  for (const double scale : {0x1p160, 0x1p-160}) {
    Pslg scaled = plain;
    for (Point& p : scaled.points) p = {p.x * scale, p.y * scale};
    const WidthField other = width_of(scaled);
    for (const Point p : points_in(domain_of(plain), 100, 4))
      EXPECT_NEAR(other({p.x * scale, p.y * scale}) / scale, width(p), 1e-9) << scale;
  }
}

TEST(WidthField, OfACoastIsQuickAndWithinItsExtent) {
  const Domain domain = domain_of(read_poly(model("us-east-coast.poly")));
  Box box;
  for (const Point p : domain.vertices) box.add(p);
  const ExecutionContext context;
  const double start = processor_seconds();
  const Result<WidthField> width = WidthField::make(domain, context);
  const double seconds = processor_seconds() - start;
  ASSERT_TRUE(width) << width.error().message;
  RecordProperty("milliseconds", static_cast<int>(1e3 * seconds));
  EXPECT_LT(seconds, 5 * slowdown());
  for (const Point p : points_in(domain, 5000, 6)) {
    const double value = (*width)(p);
    EXPECT_GT(value, 0);
    EXPECT_LE(value, std::min(box.width(), box.height()));
  }
}

// A coast by displaced middles, 131,072 walls.
Pslg fractal_coast() {
  Random random(13);
  std::vector<Point> ring{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  while (ring.size() < 100'000) {
    std::vector<Point> next;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point a = ring[i], b = ring[(i + 1) % ring.size()];
      const double off = 0.4 * (random() - 0.5);
      next.push_back(a);
      next.push_back(
          {0.5 * (a.x + b.x) + off * (b.y - a.y), 0.5 * (a.y + b.y) - off * (b.x - a.x)});
    }
    ring = std::move(next);
  }
  return polygon(ring);
}

TEST(WidthField, OfAHundredThousandWallsTakesSeconds) {
  const Domain domain = domain_of(fractal_coast());
  const ExecutionContext context;
  const double start = processor_seconds();
  const Result<WidthField> width = WidthField::make(domain, context);
  const double seconds = processor_seconds() - start;
  ASSERT_TRUE(width) << width.error().message;
  RecordProperty("milliseconds", static_cast<int>(1e3 * seconds));
  EXPECT_LT(seconds, 60 * slowdown());  // with sanitizers
}

TEST(WidthField, BoundsHoldWhatIsEvaluated) {
  const WidthField width = width_of(read_poly(model("key.poly")));
  Box extent;
  for (const Point p : read_poly(model("key.poly")).points) extent.add(p);
  Random random(8);
  for (int i = 0; i < 3000; ++i) {
    const double side = extent.width() * std::pow(2, -12 * random());
    const Point low{extent.min_x + random() * extent.width(),
                    extent.min_y + random() * extent.height()};
    const Box box{low.x, low.y, low.x + side * random(), low.y + side * random()};
    const Interval bounds = width.bounds(box);
    const double steepness = width.steepness(box);
    Point last = low;
    for (int k = 0; k < 10; ++k) {
      const Point p{std::min(box.max_x, box.min_x + random() * box.width()),
                    std::min(box.max_y, box.min_y + random() * box.height())};
      const double value = width(p);
      EXPECT_GE(value, bounds.lo);
      EXPECT_LE(value, bounds.hi);
      EXPECT_LE(std::fabs(value - width(last)),
                steepness * std::sqrt(distance2(p, last)) + 1e-12 * extent.width());
      last = p;
    }
    // Twice two distances, each known to half the diagonal.
    const double diagonal = std::sqrt(box.width() * box.width() + box.height() * box.height());
    EXPECT_LE(bounds.hi - bounds.lo, 4 * diagonal * (1 + 1e-9) + 1e-9 * extent.width());
  }
}

TEST(WidthField, IsTheSameOnAnyNumberOfThreads) {
  const Domain domain = domain_of(read_poly(model("us-east-coast.poly")));
  const std::vector<Point> points = points_in(domain, 2000, 9);
  std::vector<double> first;
  for (const int threads : {1, 2, 3, 7}) {
    Arena arena(threads);
    ExecutionContext context;
    context.set_arena(arena);
    const Result<WidthField> width =
        context.compute([&] { return WidthField::make(domain, context); });
    ASSERT_TRUE(width) << width.error().message;
    std::vector<double> values;
    for (const Point p : points) values.push_back((*width)(p));
    if (first.empty()) first = values;
    EXPECT_EQ(values, first) << threads;
  }
}

TEST(WidthField, EvaluatesManyPointsLikeEach) {
  const WidthField width = width_of(noisy_strip(0.05, 2));
  constexpr std::size_t kPoints = 1001;
  alignas(64) static double x[1008], y[1008], out[1008];
  Random random(10);
  for (std::size_t i = 0; i < 1008; ++i) {
    x[i] = 10 * random();
    y[i] = random();
  }
  width.evaluate(kPoints, x, y, out);
  for (std::size_t i = 0; i < kPoints; ++i) EXPECT_EQ(out[i], width({x[i], y[i]})) << i;
}

TEST(WidthField, StopsAtOnceIfCancelled) {
  ExecutionContext context;
  context.cancel();
  const Result<WidthField> width = WidthField::make(domain_of(strip()), context);
  ASSERT_FALSE(width);
  EXPECT_EQ(width.error().code, ErrorCode::kCancelled);
}

TEST(WidthField, StopsSoonAfterTheDeadline) {
  const Domain domain = domain_of(fractal_coast());
  for (const int ms : {1, 10, 50}) {
    ExecutionContext context;
    context.set_deadline(ExecutionContext::Clock::now() + std::chrono::milliseconds(ms));
    const double start = processor_seconds();
    const Result<WidthField> width = WidthField::make(domain, context);
    const double seconds = processor_seconds() - start;
    ASSERT_FALSE(width) << ms;
    EXPECT_EQ(width.error().code, ErrorCode::kDeadlineExceeded);
    EXPECT_LT(seconds, 1e-3 * ms + 0.25 * slowdown());
  }
}

// Refuses more than so many bytes, and remembers the most that was asked for.
class Source final : public MemorySource {
 public:
  explicit Source(std::uint64_t limit) : limit_(limit) {}
  Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
    most_ = std::max(most_, needed);
    if (needed > limit_) return fail(ErrorCode::kOutOfMemory, "", "no more");
    return needed;
  }
  std::uint64_t most() const { return most_; }

 private:
  const std::uint64_t limit_;
  std::uint64_t most_ = 0;
};

TEST(WidthField, AnnouncesItsMemoryBeforeItTakesIt) {
  const Domain domain = domain_of(read_poly(model("us-east-coast.poly")));
  Source rich(std::uint64_t{1} << 40);
  ExecutionContext context;
  context.set_memory(rich, 0);
  const Result<MedialAxis> axis = medial_axis(domain, context);
  ASSERT_TRUE(axis) << axis.error().message;
  EXPECT_GE(rich.most(), domain.bytes() + 300 * axis->axis.size());
  const Result<WidthField> width = WidthField::make(domain, context);
  ASSERT_TRUE(width) << width.error().message;
  EXPECT_GE(rich.most(), domain.bytes() + DistanceField::bytes_to_make(
                                              axis->walls.size() + axis->axis.size(), 2));
  EXPECT_GE(rich.most(), domain.bytes() + width->bytes());

  Source poor(domain.bytes() + 100'000);
  ExecutionContext refused;
  refused.set_memory(poor, 0);
  const Result<WidthField> none = WidthField::make(domain, refused);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kOutOfMemory);

  ExecutionContext bounded(Budget{.max_bytes = 100'000});
  const Result<WidthField> over = WidthField::make(domain, bounded);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, ErrorCode::kBudgetExceeded);
}

}  // namespace
}  // namespace weft
