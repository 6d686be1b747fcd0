// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_quality.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>
#include <utility>

#include "checker/mesh/quality.h"
#include "client/report/mesh_angles.h"

namespace weft::client {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kBlock = std::size_t{1} << 18;  // triangles that one thread takes at a time

std::vector<double> steps(double step, int count) {
  std::vector<double> bounds;
  for (int i = 0; i <= count; ++i) bounds.push_back(i * step);
  return bounds;
}

Histogram area_histogram() {
  std::vector<double> bounds;
  for (int i = 0; i < 10; ++i) bounds.push_back(i / 10.0);
  bounds.push_back(std::nextafter(1 + check::kAreaTolerance, 2));
  for (const double over : {1.1, 1.5, 2.0, kInfinity}) bounds.push_back(over);
  return Histogram(bounds);
}

// The worst few triangles, by an order that puts the worst first.
template <class Worse>
class Worst {
 public:
  explicit Worst(Worse worse) : worse_(worse) {}

  bool takes(const MeasuredTriangle& one) const {
    return all_.size() < MeshQuality::kWorst || worse_(one, all_.back());
  }
  void add(const MeasuredTriangle& one) {
    if (!takes(one)) return;
    all_.insert(std::upper_bound(all_.begin(), all_.end(), one, worse_), one);
    if (all_.size() > MeshQuality::kWorst) all_.pop_back();
  }
  const std::vector<MeasuredTriangle>& all() const { return all_; }

 private:
  Worse worse_;
  std::vector<MeasuredTriangle> all_;
};

bool sharper(const MeasuredTriangle& a, const MeasuredTriangle& b) {
  return a.min_angle_deg < b.min_angle_deg;
}
bool larger(const MeasuredTriangle& a, const MeasuredTriangle& b) {
  return *a.area_over_bound > *b.area_over_bound;
}

// What a block of triangles adds to the figures.
struct Part {
  double area = 0;
  double quality = 0;
  AngleRange range;
  Histogram min_angles{steps(5, 12)};
  Histogram angles{steps(10, 18)};
  Histogram fine{steps(0.01, 6000)};  // of the smallest angles, for the percentile
  Histogram aspects{{1, 1.05, 1.1, 1.2, 1.3, 1.5, 1.75, 2, 3, 5, 10, kInfinity}};
  Histogram areas = area_histogram();
  std::uint64_t bounded = 0;
  double shares = 0;
  Worst<decltype(&sharper)> sharpest{&sharper};
  Worst<decltype(&larger)> largest{&larger};

  void add(const MeshView& mesh, std::size_t t, const AreaBound& bound);
  void add(const Part& next);
};

void Part::add(const MeshView& mesh, std::size_t t, const AreaBound& bound) {
  Point p[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t v = mesh.triangles[3 * t + i];
    p[i] = {mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]};
  }
  double edge[3];
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& q = p[i == 2 ? 0 : i + 1];
    const double dx = q.x - p[i].x;
    const double dy = q.y - p[i].y;
    squares += dx * dx + dy * dy;
    edge[i] = std::sqrt(dx * dx + dy * dy);
  }
  const double cross =
      std::abs((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x));
  const AngleRange corner = triangle_angles(mesh, t);
  MeasuredTriangle one{t,
                       {(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3},
                       corner.min_deg,
                       kInfinity,
                       std::nullopt};
  // R / 2r = abc (a + b + c) / (16 area^2), by ratios that neither overflow nor vanish.
  if (cross > 0)
    one.aspect = std::max(
        1.0, edge[0] * edge[1] / cross * (edge[2] / cross) * (edge[0] + edge[1] + edge[2]) / 4);
  area += cross / 2;
  if (squares > 0) quality += 2 * std::numbers::sqrt3 * cross / squares;
  range.min_deg = std::min(range.min_deg, corner.min_deg);
  range.max_deg = std::max(range.max_deg, corner.max_deg);
  min_angles.add(corner.min_deg);
  fine.add(corner.min_deg);
  angles.add(corner.min_deg);
  angles.add(180 - corner.min_deg - corner.max_deg);
  angles.add(corner.max_deg);
  aspects.add(one.aspect);
  if (const double limit = bound ? bound(one.at) : 0; limit > 0 && std::isfinite(limit)) {
    one.area_over_bound = cross / 2 / limit;
    areas.add(*one.area_over_bound);
    ++bounded;
    shares += *one.area_over_bound;
    largest.add(one);
  }
  sharpest.add(one);
}

void Part::add(const Part& next) {
  area += next.area;
  quality += next.quality;
  range.min_deg = std::min(range.min_deg, next.range.min_deg);
  range.max_deg = std::max(range.max_deg, next.range.max_deg);
  min_angles.add(next.min_angles);
  angles.add(next.angles);
  fine.add(next.fine);
  aspects.add(next.aspects);
  areas.add(next.areas);
  bounded += next.bounded;
  shares += next.shares;
  for (const MeasuredTriangle& one : next.sharpest.all()) sharpest.add(one);
  for (const MeasuredTriangle& one : next.largest.all()) largest.add(one);
}

// The value below which this share of all values lies; interpolated within a bin.
double percentile(const Histogram& histogram, double rank) {
  double below = 0;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const auto count = static_cast<double>(histogram.counts[i]);
    if (count > 0 && below + count >= rank)
      return histogram.bounds[i] +
             (histogram.bounds[i + 1] - histogram.bounds[i]) * (rank - below) / count;
    below += count;
  }
  return histogram.bounds.back();
}

std::vector<Part> parts_of(const MeshView& mesh, const MakeAreaBound& make_bound) {
  std::vector<Part> parts((mesh.triangle_count() + kBlock - 1) / kBlock);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    const AreaBound bound = make_bound ? make_bound() : AreaBound();
    for (std::size_t i = next++; i < parts.size(); i = next++) {
      const std::size_t end = std::min((i + 1) * kBlock, mesh.triangle_count());
      for (std::size_t t = i * kBlock; t < end; ++t) parts[i].add(mesh, t, bound);
    }
  };
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < std::min(most, parts.size()); ++i) threads.emplace_back(work);
  work();
  threads.clear();  // waits
  return parts;
}

}  // namespace

Histogram::Histogram(std::vector<double> of) : bounds(std::move(of)), counts(bounds.size() - 1) {}

void Histogram::add(double value) {
  const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, value);
  ++counts[static_cast<std::size_t>(above - bounds.begin()) - 1];
}

void Histogram::add(const Histogram& other) {
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
}

MeshQuality measure_quality(const MeshView& mesh, const MakeAreaBound& make_bound) {
  Part all;
  for (const Part& part : parts_of(mesh, make_bound)) all.add(part);
  MeshFigures figures;
  figures.vertices = mesh.vertex_count();
  figures.triangles = mesh.triangle_count();
  figures.edges = mesh.edge_count();
  figures.area = all.area;
  if (figures.triangles > 0) {
    const auto count = static_cast<double>(figures.triangles);
    figures.min_angle_deg = all.range.min_deg;
    figures.max_angle_deg = all.range.max_deg;
    figures.min_angle_p1_deg = std::max(all.range.min_deg, percentile(all.fine, 0.01 * count));
    figures.mean_quality = all.quality / count;
  }
  if (all.bounded > 0 && all.shares > 0)
    figures.ideal_ratio = static_cast<double>(all.bounded) / all.shares;
  return {figures,
          all.min_angles,
          all.angles,
          all.aspects,
          make_bound ? std::optional(all.areas) : std::nullopt,
          all.sharpest.all(),
          all.largest.all()};
}

}  // namespace weft::client
