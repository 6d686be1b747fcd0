// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/validate.h"

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

std::optional<Error> check_span(const std::vector<Point>& points, StopPoller& poller) {
  const Span span = spanning_points(points, poller);
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
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    poller.step();
    if (auto error = check_point(pslg.holes[i], "holes", i)) return error;
  }
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    poller.step();
    if (auto error = check_region(pslg.regions[i], i)) return error;
  }
  if (auto error = check_snap(pslg.snap)) return error;
  return check_span(pslg.points, poller);
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
