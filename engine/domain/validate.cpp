// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/validate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <string_view>

#include "engine/domain/triangulation/predicates.h"

namespace weft {
namespace {

std::string element(std::string_view list, std::size_t i) {
  return "domain." + std::string(list) + "[" + std::to_string(i) + "]";
}

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  out.precision(17);
  (out << ... << parts);
  return out.str();
}

bool is_coordinate(double value) {
  const double magnitude = std::fabs(value);
  return value == 0 || (magnitude >= kMinMagnitude && magnitude <= kMaxMagnitude);
}

std::optional<Error> check_coordinate(double value, const char* axis, std::string_view list,
                                      std::size_t i) {
  if (is_coordinate(value)) return {};
  const char* why = std::isfinite(value) ? "; magnitudes must be 0 or from 1e-100 to 1e50"
                                         : "; coordinates must be finite";
  return Error{ErrorCode::kBadCoordinate, element(list, i) + "." + axis,
               text("the ", axis, " coordinate is ", value, why)};
}

std::optional<Error> check_point(Point p, std::string_view list, std::size_t i) {
  if (is_coordinate(p.x) && is_coordinate(p.y)) [[likely]]
    return {};
  if (auto error = check_coordinate(p.x, "x", list, i)) return error;
  return check_coordinate(p.y, "y", list, i);
}

std::optional<Error> check_segment(const Pslg& pslg, std::size_t i) {
  const Segment& s = pslg.segments[i];
  const std::size_t n = pslg.points.size();
  const auto out_of_range = [&](const char* end, std::uint32_t value) {
    return Error{ErrorCode::kIndexOutOfRange, element("segments", i) + "." + end,
                 text("segment ", i, " ends at point ", value, ", but there are ", n, " points")};
  };
  if (s.a >= n) return out_of_range("a", s.a);
  if (s.b >= n) return out_of_range("b", s.b);
  if (s.area != kNone && s.area >= pslg.areas.size())
    return Error{ErrorCode::kIndexOutOfRange, element("segment_areas", i),
                 text("segment ", i, " is part of the border of area ", s.area, ", but there are ",
                      pslg.areas.size(), " areas")};
  return {};
}

std::optional<Error> check_arcs(const Pslg& pslg, StopPoller& poller) {
  std::vector<bool> is_arc(pslg.arcs.empty() ? 0 : pslg.segments.size(), false);
  for (std::size_t i = 0; i < pslg.arcs.size(); ++i) {
    poller.step();
    const Arc& arc = pslg.arcs[i];
    const auto bad = [&](std::string message) {
      return Error{ErrorCode::kBadOption, element("arcs", i), std::move(message)};
    };
    if (arc.segment >= pslg.segments.size())
      return Error{ErrorCode::kIndexOutOfRange, element("arcs", i) + ".segment",
                   text("arc ", i, " is segment ", arc.segment, ", but there are ",
                        pslg.segments.size(), " segments")};
    if (is_arc[arc.segment]) return bad(text("segment ", arc.segment, " has two arcs"));
    is_arc[arc.segment] = true;
    if (!(std::fabs(arc.bulge) <= kMaxBulge))
      return bad(text("the bulge is ", arc.bulge, "; its magnitude must be at most ", kMaxBulge));
    const Segment& s = pslg.segments[arc.segment];
    const Point a = pslg.points[s.a], b = pslg.points[s.b];
    if (s.a == s.b && arc.bulge != 0)
      return bad(text("the arc of segment ", arc.segment, " ends where it begins, at (", a.x, ", ",
                      a.y, "); a circle is two arcs or more"));
    const double across = std::max(std::fabs(b.x - a.x), std::fabs(b.y - a.y));
    if (across * std::max(1.0, std::fabs(arc.bulge)) > kMaxMagnitude)
      return bad(text("the arc of segment ", arc.segment, " reaches beyond 1e50"));
  }
  return {};
}

std::optional<Error> check_area(const Area& area, std::size_t i) {
  if (!area.max_area || (std::isfinite(*area.max_area) && *area.max_area > 0)) return {};
  return Error{ErrorCode::kBadOption, element("areas", i) + ".max_area",
               text("the maximum area is ", *area.max_area, "; it must be finite and above 0")};
}

// Whether the segments of each area close to rings.
std::optional<Error> check_rings(const Pslg& pslg, StopPoller& poller) {
  std::vector<std::size_t> first(pslg.areas.size() + 1, 0);
  for (const Segment& s : pslg.segments)
    if (s.area != kNone) ++first[s.area + 1];
  for (std::size_t i = 0; i < pslg.areas.size(); ++i) first[i + 1] += first[i];
  std::vector<std::uint32_t> by_area(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < pslg.segments.size(); ++i)
    if (const std::uint32_t area = pslg.segments[i].area; area != kNone) by_area[next[area]++] = i;

  std::vector<bool> is_odd(pslg.points.size(), false);  // whether an odd number of ends is there
  std::size_t odd = 0;
  const auto toggle = [&](std::uint32_t point) {
    is_odd[point] = !is_odd[point];
    odd += is_odd[point] ? 1 : -std::size_t{1};
  };
  for (std::size_t area = 0; area < pslg.areas.size(); ++area) {
    for (std::size_t k = first[area]; k < first[area + 1]; ++k) {
      poller.step();
      toggle(pslg.segments[by_area[k]].a);
      toggle(pslg.segments[by_area[k]].b);
    }
    if (odd == 0) continue;
    const std::size_t point =
        static_cast<std::size_t>(std::find(is_odd.begin(), is_odd.end(), true) - is_odd.begin());
    return Error{ErrorCode::kBadOption, element("areas", area),
                 text("the segments of area ", area,
                      " do not close to rings: an odd number of them "
                      "ends at point ",
                      point, ", (", pslg.points[point].x, ", ", pslg.points[point].y, ")")};
  }
  return {};
}

std::optional<Error> check_region(const RegionSeed& region, std::size_t i) {
  if (auto error = check_point(region.at, "regions", i)) return error;
  if (!region.max_area || (std::isfinite(*region.max_area) && *region.max_area > 0)) return {};
  return Error{ErrorCode::kBadOption, element("regions", i) + ".max_area",
               text("the maximum area is ", *region.max_area, "; it must be finite and above 0")};
}

std::optional<Error> check_snap(double snap) {
  if (snap >= 0 && std::isfinite(snap)) return {};
  return Error{ErrorCode::kBadOption, "domain.snap",
               text("the snap distance is ", snap, "; it must be finite and 0 or more")};
}

std::optional<Error> check_counts(const Pslg& pslg) {
  const auto over = [](const char* list, std::size_t count, std::uint64_t limit) {
    return Error{ErrorCode::kLimitExceeded, text("domain.", list),
                 text("there are ", count, " ", list, ", the limit is ", limit)};
  };
  if (pslg.points.size() > kMaxPoints) return over("points", pslg.points.size(), kMaxPoints);
  if (pslg.segments.size() > kMaxSegments)
    return over("segments", pslg.segments.size(), kMaxSegments);
  return {};
}

std::optional<Error> check_span(const Pslg& pslg, StopPoller& poller) {
  const std::vector<Point>& points = pslg.points;
  const Span span = spanning_points(points, poller);
  if (span.size == 2 && !pslg.arcs.empty()) return {};  // they enclose something between two points
  if (span.size < 2 || points.size() < 3)
    return Error{ErrorCode::kTooFewPoints, "domain.points",
                 text("there are ", points.size(), " points, ", span.size,
                      " of them distinct; a domain needs at least 3")};
  if (span.size == 3) return {};
  // Two distinct points and everything else on their line: are there three distinct ones?
  const Point p = points[span.point[0]];
  const Point q = points[span.point[1]];
  for (const Point r : points)
    if (r != p && r != q)
      return Error{ErrorCode::kCollinearPoints, "domain.points",
                   text("all ", points.size(), " points lie on the line through (", p.x, ", ", p.y,
                        ") and (", q.x, ", ", q.y, ")")};
  return Error{
      ErrorCode::kTooFewPoints, "domain.points",
      text("there are ", points.size(), " points, 2 of them distinct; a domain needs at least 3")};
}

}  // namespace

std::optional<Error> validate(const Pslg& pslg, StopPoller& poller) {
  if (auto error = check_counts(pslg)) return error;
  for (std::size_t i = 0; i < pslg.points.size(); ++i) {
    poller.step();
    if (auto error = check_point(pslg.points[i], "points", i)) return error;
  }
  for (std::size_t i = 0; i < pslg.segments.size(); ++i) {
    poller.step();
    if (auto error = check_segment(pslg, i)) return error;
  }
  if (auto error = check_arcs(pslg, poller)) return error;
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    poller.step();
    if (auto error = check_point(pslg.holes[i], "holes", i)) return error;
  }
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    poller.step();
    if (auto error = check_region(pslg.regions[i], i)) return error;
  }
  for (std::size_t i = 0; i < pslg.areas.size(); ++i) {
    poller.step();
    if (auto error = check_area(pslg.areas[i], i)) return error;
  }
  if (auto error = check_rings(pslg, poller)) return error;
  if (auto error = check_snap(pslg.snap)) return error;
  return check_span(pslg, poller);
}

Span spanning_points(const std::vector<Point>& points, StopPoller& poller) {
  Span span;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    poller.step();
    const Point p = points[i];
    if (span.size == 1 && p == points[span.point[0]]) continue;
    if (span.size == 2 && orientation_exact(points[span.point[0]], points[span.point[1]], p) == 0)
      continue;
    span.point[span.size++] = i;
    if (span.size == 3) break;
  }
  return span;
}

}  // namespace weft
