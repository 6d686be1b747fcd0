// SPDX-License-Identifier: Apache-2.0
// Random dirty PSLGs: on a small integer grid crossings, overlaps, touchings and repeats abound.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/domain.h"
#include "tests/engine/domain/laws.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/generator.h"
#include "tests/support/processor_time.h"

namespace weft {
namespace {

// A box with segments of any kind inside.
Pslg dirty(Generator& random, int grid, double scale, double shift) {
  Pslg pslg;
  const auto point = [&] {
    const double x = random.below(grid + 1), y = random.below(grid + 1);
    return Point{x * scale + shift, y * scale + shift};
  };
  add_box(pslg, {-scale + shift, -scale + shift},
          {(grid + 1) * scale + shift, (grid + 1) * scale + shift}, 1);
  const int segments = random.below(30);
  for (int i = 0; i < segments; ++i) {
    const Point a = point(), b = point();
    if (a != b) add_segment(pslg, a, b, random.below(3));
  }
  const int points = random.below(5);
  for (int i = 0; i < points; ++i) pslg.points.push_back(point());
  return pslg;
}

void expect_sound(const Pslg& pslg, double box_area) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_chain(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_origin(pslg, *domain), std::nullopt);
  EXPECT_DOUBLE_EQ(area(*domain), box_area);
}

TEST(DirtyPslg, OnAnIntegerGridKeepsAllLaws) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(seed);
    const int grid = 2 + random.below(8);
    expect_sound(dirty(random, grid, 1, 0), (grid + 2.0) * (grid + 2.0));
  }
}

TEST(DirtyPslg, WithRoundedCoordinatesKeepsAllLaws) {
  // Tenths: what was collinear or concurrent is so only up to rounding.
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(1000 + seed);
    const int grid = 2 + random.below(8);
    const Pslg pslg = dirty(random, grid, 0.1, 0.7);
    const double width = pslg.points[1].x - pslg.points[0].x;
    const double height = pslg.points[2].y - pslg.points[1].y;
    expect_sound(pslg, width * height);
  }
}

TEST(DirtyPslg, FarFromTheOriginKeepsAllLaws) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(2000 + seed);
    const int grid = 2 + random.below(8);
    expect_sound(dirty(random, grid, 1, 1e9), (grid + 2.0) * (grid + 2.0));
  }
}

TEST(DirtyPslg, OfRandomSegmentsKeepsAllLaws) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(3000 + seed);
    Pslg pslg = square();
    for (int i = 0; i < 30; ++i) {
      const Point a{random.unit(), random.unit()};
      const Point b{random.unit(), random.unit()};
      add_segment(pslg, a, b, 1 + i);
    }
    expect_sound(pslg, 1);
  }
}

// What has not ended by then will not end.
const auto kPatience = std::chrono::duration_cast<ExecutionContext::Clock::duration>(
    std::chrono::duration<double>(20 * slowdown()));

// For segments closer to each other than the tolerance: whatever becomes of them, it ends,
// lawfully.
void expect_lawful(const Pslg& pslg, double ulps) {
  ExecutionContext context;
  context.set_deadline(ExecutionContext::Clock::now() + kPatience);
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  EXPECT_EQ(broken_chain(pslg, *domain, ulps), std::nullopt);
  EXPECT_EQ(broken_separation(pslg, *domain, 4), std::nullopt);
}

TEST(NearMisses, OnAGridAsFineAsTheToleranceEndLawfully) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(5000 + seed);
    const int grid = 2 + random.below(40);
    const double scale = std::ldexp(1, -44 + random.below(8));
    Pslg pslg;
    // Farther from the grid than the tolerance, so that no point ends up outside.
    const double margin = scale + std::ldexp(1, -38);
    const double high = 1.5 + grid * scale + margin;
    add_box(pslg, {1.5 - margin, 1.5 - margin}, {high, high});
    const int segments = random.below(60);
    for (int i = 0; i < segments; ++i) {
      const Point a{1.5 + random.below(grid) * scale, 1.5 + random.below(grid) * scale};
      const Point b{1.5 + random.below(grid) * scale, 1.5 + random.below(grid) * scale};
      if (a != b) add_segment(pslg, a, b);
    }
    expect_lawful(pslg, 4 * 8192);
  }
}

TEST(NearMisses, OfChordsThroughNearlyOnePointEndLawfully) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(6000 + seed);
    Pslg pslg;
    add_box(pslg, {-3, -3}, {3, 3});
    const int chords = 10 + random.below(30);
    for (int i = 0; i < chords; ++i) {
      const double angle = 2 * std::numbers::pi * random.unit();
      const double off = (random.below(9) - 4) * std::ldexp(1, -54 + random.below(12));
      const double x = (1 + random.unit()) * std::cos(angle);
      const double y = (1 + random.unit()) * std::sin(angle);
      add_segment(pslg, {0.3 + x + off, 0.4 + y}, {0.3 - x, 0.4 - y - off});
    }
    expect_lawful(pslg, 4 * 8192);
  }
}

TEST(NearMisses, OfNearlyCollinearSegmentsEndLawfully) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(7000 + seed);
    Pslg pslg;
    add_box(pslg, {-1, -1}, {3, 3});
    const double ux = random.unit(), uy = random.unit();
    const auto point = [&] {
      const double t = random.below(20) * 0.1;
      Point p{0.1 + t * ux, 0.2 + t * uy};
      for (int k = random.below(4); k > 0; --k) {
        p.x = std::nextafter(p.x, random.below(2) * 9.0);
        p.y = std::nextafter(p.y, random.below(2) * 9.0);
      }
      return p;
    };
    const int segments = 2 + random.below(40);
    for (int i = 0; i < segments; ++i) {
      const Point a = point(), b = point();
      if (a != b) add_segment(pslg, a, b);
    }
    expect_lawful(pslg, 4 * 8192);
  }
}

// A coarse grid, each of whose points is drawn anew with an error each time, as by an export: the
// errors lie around the tolerance, below and above.
TEST(NearMisses, OfPointsDrawnWithErrorsEndLawfully) {
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(8000 + seed);
    const double offset = std::array{0.0, 1.0, 1e3, 1e6}[seed % 4];
    const bool snaps = seed % 3 == 0;
    Pslg pslg;
    add_box(pslg, {offset - 1, offset - 1}, {offset + 9, offset + 9});
    if (snaps) pslg.snap = 0.01;
    const double error = (snaps ? 0.01 : 0x1p-40 * (offset + 9)) * std::ldexp(4, -random.below(6));
    const auto coordinate = [&] {
      return offset + random.below(9) + error * (2 * random.unit() - 1);
    };
    const int segments = 2 + random.below(30);
    for (int i = 0; i < segments; ++i) {
      const Point a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
      if (distance(a, b) > 0.5) add_segment(pslg, a, b, 1 + i);
    }
    ExecutionContext context;
    context.set_deadline(ExecutionContext::Clock::now() + kPatience);
    const Result<Domain> domain = triangulate(pslg, context);
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
    EXPECT_EQ(broken_separation(pslg, *domain, 3), std::nullopt);
    EXPECT_DOUBLE_EQ(area(*domain), 100);
  }
}

TEST(RandomEvenOdd, AgreesWithRaysOnRandomPolygons) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(4000 + seed);
    const int grid = 3 + random.below(6);
    Pslg pslg;
    pslg.fill = Fill::kEvenOdd;
    const int rings = 1 + random.below(4);
    for (int r = 0; r < rings; ++r) {
      std::vector<Point> ring;
      const int corners = 3 + random.below(6);
      for (int i = 0; i < corners; ++i) {
        const double x = random.below(grid), y = random.below(grid);
        if (ring.empty() || ring.back() != Point{x, y}) ring.push_back({x, y});
      }
      while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
      if (ring.size() > 1) add_ring(pslg, ring);
    }
    const ExecutionContext context;
    const Result<Domain> domain = triangulate(pslg, context);
    if (domain) {
      EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
    }
    for (int i = 0; i < 60; ++i) {
      const Point p{random.unit() * grid - 0.5, random.unit() * grid - 0.5};
      EXPECT_EQ(domain ? cover(*domain, p) : 0, odd(pslg, p) ? 1 : 0) << p.x << " " << p.y;
    }
  }
}

// Whether an odd number of the area's segments lies between the point and infinity.
bool is_covered(const Pslg& pslg, std::uint32_t area, Point p) {
  Pslg border;
  border.points = pslg.points;
  for (const Segment& s : pslg.segments)
    if (s.area == area) border.segments.push_back(s);
  return odd(border, p);
}

TEST(RandomAreas, AgreeWithRaysOnRandomPolygons) {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Generator random(7000 + seed);
    const int grid = 3 + random.below(6);
    Pslg pslg;
    pslg.fill = random.below(3) == 0 ? Fill::kEvenOdd : Fill::kUnion;
    for (int n = 1 + random.below(6); n > 0; --n) {
      const std::size_t first = pslg.segments.size();
      for (int r = 1 + random.below(2); r > 0; --r) {
        std::vector<Point> ring;
        for (int i = 3 + random.below(4); i > 0; --i)
          ring.push_back({double(random.below(grid)), double(random.below(grid))});
        add_ring(pslg, ring);
      }
      Area area{.region = static_cast<std::int32_t>(pslg.areas.size() + 1),
                .priority = random.below(8),  // mostly one area has the highest
                .is_hole = random.below(5) == 0};
      if (random.below(2) == 0) area.max_area = 1 + random.below(5);
      add_area(pslg, first, area);
    }
    const ExecutionContext context;
    const Result<Domain> domain = triangulate(pslg, context);
    if (domain) {
      EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
    }
    for (int i = 0; i < 40; ++i) {
      const Point p{random.unit() * grid - 0.5, random.unit() * grid - 0.5};
      std::uint32_t covering = 0;
      std::int32_t highest = -1;
      bool is_hole = false;
      double bound = Region{}.max_area;
      std::vector<std::int32_t> regions;  // of the highest priority
      for (std::uint32_t a = 0; a < pslg.areas.size(); ++a) {
        const Area& area = pslg.areas[a];
        if (!is_covered(pslg, a, p)) continue;
        is_hole = is_hole || area.is_hole;
        if (area.is_hole) continue;
        ++covering;
        bound = std::min(bound, area.max_area.value_or(bound));
        if (area.priority > highest) regions.clear();
        highest = std::max(highest, area.priority);
        if (area.priority == highest) regions.push_back(*area.region);
      }
      const bool inside =
          !is_hole && (pslg.fill == Fill::kUnion ? covering > 0 : covering % 2 == 1);
      ASSERT_EQ(domain ? cover(*domain, p) : 0, inside ? 1 : 0) << p.x << " " << p.y;
      if (!inside) continue;
      for (const Domain::Triangle& t : domain->triangles) {
        if (cover(Domain{domain->vertices, {}, {t}, {}, {}, {}, {}, {}, {}}, p) != 1) continue;
        const Region& region = domain->regions[t.region];
        EXPECT_EQ(region.max_area, bound);
        EXPECT_NE(std::find(regions.begin(), regions.end(), region.id), regions.end());
      }
    }
  }
}

}  // namespace
}  // namespace weft
