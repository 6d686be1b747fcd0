// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/fields_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "engine/size/fields/distance_field.h"
#include "tests/support/poly.h"

namespace weft::bench {
namespace {

constexpr std::size_t kPoints = 24'000;  // in one leaf of a mesh
constexpr std::size_t kLeaves = 40;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// From 0 to 1.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

struct Row {
  std::string name;
  Box box;
  std::vector<Line> lines;
};

Row coast(const std::string& models) {
  const Pslg pslg = read_poly(models + "/us-east-coast.poly");
  Row row{"coast", {}, {}};
  for (const Point p : pslg.points) row.box.add(p);
  for (const auto& segment : pslg.segments)
    row.lines.push_back({pslg.points[segment.a], pslg.points[segment.b]});
  return row;
}

Row random_lines(const std::string& name, std::size_t n) {
  std::mt19937_64 random(1);
  Row row{name, {0, 0, 1, 1}, {}};
  const double length = 0.5 / std::sqrt(static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const Point a{uniform(random), uniform(random)};
    const double angle = 6.283185307179586 * uniform(random);
    row.lines.push_back({a, {a.x + length * std::cos(angle), a.y + length * std::sin(angle)}});
  }
  return row;
}

Row straight_line(const std::string& name, std::size_t n) {
  Row row{name, {0, 0, 1, 1}, {}};
  const auto at = [n](std::size_t i) {
    const double t = static_cast<double>(i) / static_cast<double>(n);
    return Point{0.1 + 0.8 * t, 0.3 + 0.1 * t};
  };
  for (std::size_t i = 0; i < n; ++i) row.lines.push_back({at(i), at(i + 1)});
  return row;
}

enum class Order { kMorton, kShuffled, kRandom };

std::uint64_t morton(double x, double y) {
  std::uint64_t key = 0;
  const auto ix = static_cast<std::uint64_t>(x * 0x1p20);
  const auto iy = static_cast<std::uint64_t>(y * 0x1p20);
  for (unsigned bit = 0; bit < 20; ++bit)
    key |= (ix >> bit & 1) << (2 * bit) | (iy >> bit & 1) << (2 * bit + 1);
  return key;
}

// Aligned as fields want them. REQUIRES: n is a multiple of 8.
struct Points {
  struct alignas(64) Eight {
    double of[8];
  };
  explicit Points(std::size_t n) : n(n), eights(3 * n / 8) {}
  double* x() { return eights.data()->of; }
  double* y() { return x() + n; }
  double* out() { return y() + n; }

  std::size_t n;
  std::vector<Eight> eights;
};

// Asks as a mesh does, for leaves of 16,000 triangles whose edges are 0.15 of the distance, half of
// them at a line; or all over the box.
Points points_of(const Row& row, const Field& field, Order order) {
  std::mt19937_64 random(2);
  Points points(kPoints * kLeaves);
  const double extent = std::max(row.box.width(), row.box.height());
  std::vector<std::pair<std::uint64_t, Point>> leaf(kPoints);
  for (std::size_t l = 0; l < kLeaves; ++l) {
    Point middle{row.box.min_x + row.box.width() * uniform(random),
                 row.box.min_y + row.box.height() * uniform(random)};
    if (l % 2 == 1) middle = row.lines[random() % row.lines.size()].a;
    const double edge = std::clamp(0.15 * field(middle), 2e-4 * extent, 1e-2 * extent);
    const double side = 70 * edge;
    for (auto& [key, p] : leaf) {
      const double tx = uniform(random);
      const double ty = uniform(random);
      key = order == Order::kMorton ? morton(tx, ty) : random();
      p = {std::clamp(middle.x + side * (tx - 0.5), row.box.min_x, row.box.max_x),
           std::clamp(middle.y + side * (ty - 0.5), row.box.min_y, row.box.max_y)};
      if (order == Order::kRandom)
        p = {row.box.min_x + tx * row.box.width(), row.box.min_y + ty * row.box.height()};
    }
    std::sort(leaf.begin(), leaf.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < kPoints; ++i) {
      points.x()[l * kPoints + i] = leaf[i].second.x;
      points.y()[l * kPoints + i] = leaf[i].second.y;
    }
  }
  return points;
}

double nanoseconds(const Field& field, Points points, int runs) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const Clock::time_point start = Clock::now();
    field.evaluate(points.n, points.x(), points.y(), points.out());
    best = std::min(best, seconds_since(start));
  }
  return 1e9 * best / static_cast<double>(points.n);
}

}  // namespace

int run_fields_bench(const FieldsBenchOptions& options) {
  std::printf(
      "| distance to | lines | build ms, %d threads | MB | bytes a line "
      "| ns a point: Morton order | shuffled in a leaf | random |\n"
      "|---|---|---|---|---|---|---|---|\n",
      options.threads);
  Arena arena(options.threads);
  for (const Row& row : {coast(options.models), random_lines("1e5 random", 100'000),
                         random_lines("1e6 random", 1'000'000),
                         straight_line("1e5 pieces of a straight line", 100'000)}) {
    if (row.name.find(options.only) == std::string::npos) continue;
    ExecutionContext context;
    context.set_arena(arena);
    double build = std::numeric_limits<double>::infinity();
    Result<DistanceField> field = fail(ErrorCode::kInternal, "", "not built");
    for (int i = 0; i < options.runs; ++i) {
      const Clock::time_point start = Clock::now();
      field = DistanceField::make(row.lines, row.box, context);
      if (!field) {
        std::fprintf(stderr, "%s\n", field.error().message.c_str());
        return 1;
      }
      build = std::min(build, seconds_since(start));
    }
    const auto bytes = static_cast<double>(field->bytes());
    std::printf("| %s | %zu | %.1f | %.2f | %.0f ", row.name.c_str(), row.lines.size(), 1e3 * build,
                1e-6 * bytes, bytes / static_cast<double>(row.lines.size()));
    for (const Order order : {Order::kMorton, Order::kShuffled, Order::kRandom})
      std::printf("| %.1f ", nanoseconds(*field, points_of(row, *field, order), options.runs));
    std::printf("|\n");
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace weft::bench
