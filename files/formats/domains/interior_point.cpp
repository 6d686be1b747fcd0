// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/interior_point.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace weft::files {
namespace {

// Lines per polygon; they pass through its widest gaps between vertices.
constexpr std::size_t kLinesPerPolygon = 3;
// Crossings of lines with segments, over all lines: some seconds of work.
constexpr std::uint64_t kMaxWork = 2'000'000'000;

struct ScanLine {
  double y = 0;
  double gap = 0;  // between the vertices above and below
  std::size_t polygon = 0;
};

// The distinct ordinates of the ends of segments [first, end), ascending.
std::vector<double> ordinates(const Domain& domain, std::size_t first, std::size_t end) {
  std::vector<double> ys;
  ys.reserve(2 * (end - first));
  for (std::size_t s = first; s < end; ++s) {
    ys.push_back(domain.points[domain.segments[s].a].y);
    ys.push_back(domain.points[domain.segments[s].b].y);
  }
  std::sort(ys.begin(), ys.end());
  ys.erase(std::unique(ys.begin(), ys.end()), ys.end());
  return ys;
}

void add_scan_lines(const Domain& domain, const PolygonRange& range, std::size_t polygon,
                    const std::vector<double>& all_ys, std::vector<ScanLine>& lines) {
  const std::vector<double> ys = ordinates(domain, range.first_segment, range.end_segment);
  if (ys.size() < 2) return;
  std::vector<std::size_t> gaps(ys.size() - 1);
  for (std::size_t i = 0; i < gaps.size(); ++i) gaps[i] = i;
  const std::size_t wanted = std::min(kLinesPerPolygon, gaps.size());
  std::partial_sort(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(wanted), gaps.end(),
                    [&ys](std::size_t i, std::size_t j) {
                      const double wide = ys[i + 1] - ys[i];
                      const double other = ys[j + 1] - ys[j];
                      return wide != other ? wide > other : i < j;
                    });
  for (std::size_t k = 0; k < wanted; ++k) {
    // Vertices of other parts may lie in the gap, so the middle of the free piece around the gap's
    // own middle is taken.
    const double middle = ys[gaps[k]] / 2 + ys[gaps[k] + 1] / 2;
    const auto above = std::upper_bound(all_ys.begin(), all_ys.end(), middle);
    const double low = *std::prev(above);
    const double high = *above;
    const double y = low / 2 + high / 2;
    if (low < y && y < high) lines.push_back({y, high - low, polygon});
  }
}

// Where a line crosses a segment, and whether that segment is one of the polygon's own.
struct Crossing {
  double x;
  bool own;
};

struct Candidate {
  double clearance = 0;
  Point at;
};

void consider(const ScanLine& line, std::vector<Crossing>& crossings, Candidate& best) {
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
  bool inside = false;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    if (crossings[i].own) inside = !inside;
    const double width = crossings[i + 1].x - crossings[i].x;
    const double clearance = std::min(width, line.gap);
    if (inside && clearance > best.clearance)
      best = {clearance, {crossings[i].x + width / 2, line.y}};
  }
}

}  // namespace

Result<std::vector<std::optional<Point>>> interior_points(const Domain& domain,
                                                          std::span<const PolygonRange> polygons) {
  const std::vector<double> all_ys = ordinates(domain, 0, domain.segments.size());
  std::vector<ScanLine> lines;
  for (std::size_t p = 0; p < polygons.size(); ++p)
    add_scan_lines(domain, polygons[p], p, all_ys, lines);
  std::sort(lines.begin(), lines.end(), [](const ScanLine& a, const ScanLine& b) {
    return a.y != b.y ? a.y < b.y : a.polygon < b.polygon;
  });

  const auto low = [&domain](std::size_t s) {
    const auto& segment = domain.segments[s];
    return std::min(domain.points[segment.a].y, domain.points[segment.b].y);
  };
  std::vector<std::size_t> by_low(domain.segments.size());
  for (std::size_t s = 0; s < by_low.size(); ++s) by_low[s] = s;
  std::sort(by_low.begin(), by_low.end(), [&low](std::size_t s, std::size_t t) {
    return low(s) != low(t) ? low(s) < low(t) : s < t;
  });

  std::vector<Candidate> best(polygons.size());
  std::vector<std::size_t> active;
  std::vector<Crossing> crossings;
  std::uint64_t work = 0;
  std::size_t next = 0;
  for (const ScanLine& line : lines) {
    while (next < by_low.size() && low(by_low[next]) < line.y) active.push_back(by_low[next++]);
    work += active.size();
    if (work > kMaxWork)
      return fail(
          ExitCode::kUnreadableInput,
          "the domain has too many polygons with a region: finding a point inside each of " +
              std::to_string(polygons.size()) + " takes too long");
    crossings.clear();
    std::erase_if(active, [&](std::size_t s) {
      Point a = domain.points[domain.segments[s].a];
      Point b = domain.points[domain.segments[s].b];
      if (a.y > b.y) std::swap(a, b);
      if (b.y < line.y) return true;
      const double x = a.x + (line.y - a.y) / (b.y - a.y) * (b.x - a.x);
      const PolygonRange& own = polygons[line.polygon];
      crossings.push_back({x, s >= own.first_segment && s < own.end_segment});
      return false;
    });
    consider(line, crossings, best[line.polygon]);
  }

  std::vector<std::optional<Point>> points(polygons.size());
  for (std::size_t p = 0; p < polygons.size(); ++p)
    if (best[p].clearance > 0) points[p] = best[p].at;
  return points;
}

}  // namespace weft::files
