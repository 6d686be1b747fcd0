// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/geometry_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "files/base/text.h"
#include "files/formats/area_bound.h"
#include "files/formats/domains/ring_on_sphere.h"

namespace weft::files {
namespace {

constexpr std::size_t kMaxTold = 5;  // of each kind

// The bound on areas that a feature's two properties make together.
std::optional<double> area_bound(const GeometryProperties& properties) {
  if (!properties.max_edge) return properties.max_area;
  const double of_edge = area_of_edge(*properties.max_edge);
  return std::min(of_edge, properties.max_area.value_or(of_edge));
}

// Whether there are fewer than 3 distinct points. That all are on one line does not count: a ring
// around a pole is, in degrees.
bool is_collapsed(std::span<const Point> points) {
  const auto other = std::find_if(points.begin(), points.end(),
                                  [&](const Point& p) { return p != points.front(); });
  return std::all_of(other, points.end(),
                     [&](const Point& p) { return p == points.front() || p == *other; });
}

// Half-way between the least and the greatest longitude.
double middle(std::span<const Point> ring) {
  const auto [west, east] = std::ranges::minmax_element(ring, {}, &Point::x);
  return (west->x + east->x) / 2;
}

}  // namespace

void GeometryBuilder::warn(Warning warning) {
  warning.file = file_;
  domain_.warnings.push_back(std::move(warning));
}

void GeometryBuilder::warn_of_more(WarningKind kind, std::size_t all, const char* what) {
  if (all > kMaxTold)
    warn({.kind = kind,
          .count = all - kMaxTold,
          .text = std::to_string(all - kMaxTold) + " more " + what});
}

tl::unexpected<Error> GeometryBuilder::bad(const std::string& path, const std::string& what) const {
  return fail(ExitCode::kUnreadableInput, file_ + ": " + (path.empty() ? "" : path + " ") + what);
}

bool GeometryBuilder::is_usable(Point at) {
  // The limit of the service; it also keeps the predicates from overflow.
  constexpr double kLargest = 1e50;
  return std::abs(at.x) <= kLargest && std::abs(at.y) <= kLargest;
}

tl::unexpected<Error> GeometryBuilder::unusable(Point at, const std::string& path) const {
  return bad(path, "is " + coordinates(at.x, at.y) + ", magnitudes go up to 1e50");
}

std::vector<Point> GeometryBuilder::Chain::corners_after(std::size_t i) const {
  return chord_corners(points[i], points[i + 1 < points.size() ? i + 1 : 0], bulges[i]);
}

std::vector<Point> GeometryBuilder::Chain::chords() const {
  std::vector<Point> all;
  constexpr std::ptrdiff_t kMaxArcs = 10'000;  // more would take gigabytes, for a warning
  const auto arcs = std::ranges::count_if(bulges, [](double bulge) { return bulge != 0; });
  if (arcs == 0 || arcs > kMaxArcs) return all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.push_back(points[i]);
    for (const Point corner : corners_after(i)) all.push_back(corner);
  }
  return all;
}

Result<GeometryBuilder::Chain> GeometryBuilder::chain(std::span<const Point> positions,
                                                      const std::string& path,
                                                      const GeometryProperties& properties,
                                                      std::span<const std::uint32_t> markers,
                                                      std::span<const double> bulges) {
  Chain out;
  const std::uint32_t label = markers.empty() ? label_of(markers_, NameKind::kMarker,
                                                         properties.marker, properties.marker_name)
                                              : 0;
  out.points.reserve(positions.size());
  out.numbers.reserve(positions.size());
  out.markers.reserve(positions.size());
  out.bulges.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!is_usable(positions[i]))
      return unusable(positions[i], path + "[" + std::to_string(i) + "]");
    const std::uint32_t marker = markers.empty() ? label : markers[i];
    const double bulge = bulges.empty() ? 0 : bulges[i];
    if (!out.points.empty() && out.points.back() == positions[i]) {
      out.markers.back() = marker;  // of the segment that begins there
      out.bulges.back() = bulge;
      continue;
    }
    out.points.push_back(positions[i]);
    out.numbers.push_back(i);
    out.markers.push_back(marker);
    out.bulges.push_back(bulge);
  }
  return out;
}

Result<void> GeometryBuilder::add(const Chain& chain, bool closed, const std::string& path) {
  const std::size_t first = domain_.points.size();
  const std::size_t size = chain.points.size();
  if (size > std::numeric_limits<std::uint32_t>::max() - first)
    return bad(path, "makes more than 4294967295 points");
  const auto starts_run = [&chain](std::size_t i) {
    return i == 0 || chain.numbers[i] != chain.numbers[i - 1] + 1;
  };
  for (std::size_t i = 0; i < size; ++i)
    if (starts_run(i))
      domain_.point_places.add(first + i, file_ + ": " + path + "[", chain.numbers[i], "]");
  domain_.points.insert(domain_.points.end(), chain.points.begin(), chain.points.end());
  for (std::size_t i = 0; i < size - (closed ? 0 : 1); ++i) {
    if (starts_run(i))
      domain_.segment_places.add(domain_.segments.size(), file_ + ": " + path + ", edge from [",
                                 chain.numbers[i], "]");
    const std::size_t next = i + 1 < size ? i + 1 : 0;
    if (chain.bulges[i] != 0)
      domain_.arcs.push_back(
          {static_cast<std::uint32_t>(domain_.segments.size()), chain.bulges[i]});
    domain_.segments.push_back({static_cast<std::uint32_t>(first + i),
                                static_cast<std::uint32_t>(first + next),
                                static_cast<std::int32_t>(chain.markers[i])});
  }
  return {};
}

Result<void> GeometryBuilder::point(Point at, const std::string& path) {
  if (!is_usable(at)) return unusable(at, path);
  domain_.point_places.add(domain_.points.size(), file_ + ": " + path + ", point ", 0, "");
  domain_.points.push_back(at);
  return {};
}

Result<void> GeometryBuilder::line(std::span<const Point> positions, const std::string& path,
                                   const GeometryProperties& properties,
                                   std::span<const std::uint32_t> markers,
                                   std::span<const double> bulges) {
  const auto line = chain(positions, path, properties, markers, bulges);
  if (!line) return tl::unexpected(line.error());
  if (ruled_line_.empty() && (properties.region.value_or(0) != 0 ||
                              !properties.region_name.empty() || area_bound(properties)))
    ruled_line_ = path;
  if (line->points.size() < 2) {
    leave_out(LeftOut::kLine, path);
    return {};
  }
  return add(*line, false, path);
}

std::uint32_t GeometryBuilder::label_of(Labels& labels, NameKind kind, std::int32_t number,
                                        const std::string& name) {
  if (name.empty()) return labels.of(number);
  if (number == 0) return labels.of(name);
  names_.add(kind, number, name);
  return labels.of(number);
}

void GeometryBuilder::check_crossing(const Chain& ring, std::span<const Point> corners,
                                     const std::string& path) {
  if (ring.points.size() == 2) return;  // two arcs, which meet at their ends alone
  const std::vector<Point> plane = lonlat_ ? unrolled(corners, 0) : std::vector<Point>();
  const auto crossing = find_crossing(lonlat_ ? plane : corners);
  polygon_crosses_ = polygon_crosses_ || crossing;
  if (!crossing || ++crossings_ > kMaxTold) return;
  std::vector<std::size_t> edges;  // whose chord each is
  for (std::size_t i = 0; i < ring.points.size(); ++i)
    edges.insert(edges.end(), 1 + ring.corners_after(i).size(), i);
  const auto edge = [&](std::uint32_t chord) {
    const std::size_t e = chord < edges.size() ? edges[chord] : ring.points.size() - 1;
    const Point a = ring.points[e];
    const Point b = ring.points[e + 1 < ring.points.size() ? e + 1 : 0];
    return "edge " + std::to_string(ring.numbers[e]) + " from " + coordinates(a.x, a.y) + " to " +
           coordinates(b.x, b.y);
  };
  warn({.kind = WarningKind::kRingCrossesItself,
        .place = path,
        .text = path + " is a ring that crosses itself: " + edge(crossing->first) + " crosses " +
                edge(crossing->second)});
}

Result<void> GeometryBuilder::ring(std::span<const Point> positions, const std::string& path,
                                   const GeometryProperties& properties,
                                   std::span<const std::uint32_t> markers,
                                   std::span<const double> bulges, bool is_closed) {
  auto ring = chain(positions, path, properties, markers, bulges);
  if (!ring) return tl::unexpected(ring.error());
  if (lacks_outer_ring_) return {};
  std::vector<Point>& points = ring->points;
  const bool returns = !points.empty() && points.front() == points.back();
  if (returns) points.pop_back();
  std::vector<Point> chords = ring->chords();
  if (is_collapsed(chords.empty() ? points : chords)) {
    lacks_outer_ring_ =
        ring_roles_ == RingRoles::kOuterFirst && domain_.segments.size() == polygon_start_;
    leave_out(LeftOut::kRing, path);
    return {};
  }
  // The same meridian may be there by both of its longitudes.
  const bool closes_round = lonlat_ && comes_round(points);
  if (closes_round) points.pop_back();
  if (!returns && !closes_round && is_closed && ++open_rings_ <= kMaxTold)
    warn({.kind = WarningKind::kOpenRing,
          .place = path,
          .text = path + " is a ring that is not closed: it starts at " +
                  coordinates(points.front().x, points.front().y) + " and ends at " +
                  coordinates(points.back().x, points.back().y) + "; a segment closes it"});
  check_crossing(*ring, chords.empty() ? points : chords, path);
  polygon_rings_.push_back({domain_.points.size(), points.size(), path, std::move(chords)});
  return add(*ring, true, path);
}

void GeometryBuilder::check_overlap() {
  if (polygon_rings_.size() < 2 || polygon_crosses_) return;
  std::vector<std::span<const Point>> rings;
  std::vector<std::vector<Point>> planes;
  for (const Ring& ring : polygon_rings_)
    rings.push_back(
        ring.chords.empty()
            ? std::span(std::as_const(domain_).points).subspan(ring.first_point, ring.size)
            : ring.chords);
  if (lonlat_) {
    // A polygon around a pole has no plane of degrees in which its holes are in one piece.
    if (std::ranges::any_of(rings, is_around_pole)) return;
    for (std::span<const Point>& ring : rings) {
      planes.push_back(unrolled(ring, planes.empty() ? 0 : middle(planes[0])));
      ring = planes.back();
    }
  }
  const auto found = find_overlap(rings, ring_roles_);
  if (!found || ++overlaps_ > kMaxTold) return;
  const std::string at = coordinates(found->at.x, found->at.y);
  std::string fault = " is a hole that is outside of its polygon or in another hole, at " + at;
  if (found->crossed)
    fault =
        " is a ring that crosses another of its polygon: " + polygon_rings_[*found->crossed].path +
        ", near " + at;
  else if (ring_roles_ == RingRoles::kByDirection)
    fault = " overlaps another ring of its polygon, going by their directions, at " + at;
  const std::string& path = polygon_rings_[found->ring].path;
  warn({.kind = found->crossed ? WarningKind::kRingCrossesAnother : WarningKind::kRingsOverlap,
        .place = path,
        .text = path + fault + "; what an odd number of the rings encloses is meshed"});
}

void GeometryBuilder::leave_out_property(const std::string& path, const std::string& what) {
  if (++odd_properties_ <= kMaxTold)
    warn({.kind = WarningKind::kProperty,
          .place = path,
          .text = path + " is left out: it is " + what});
}

void GeometryBuilder::begin_polygon(RingRoles roles) {
  polygon_start_ = domain_.segments.size();
  ring_roles_ = roles;
  polygon_rings_.clear();
  polygon_crosses_ = false;
  lacks_outer_ring_ = false;
}

void GeometryBuilder::end_polygon(const std::string& path, const GeometryProperties& properties) {
  if (polygon_start_ == domain_.segments.size()) return;
  check_overlap();
  domain_.fill = Domain::Fill::kUnion;
  domain_.area_places.add(domain_.areas.size(), file_ + ": " + path + ", area ", 0, "");
  Domain::Area& area = domain_.areas.emplace_back();
  area.max_area = area_bound(properties);
  if (properties.region || !properties.region_name.empty())
    area.region = static_cast<std::int32_t>(label_of(
        regions_, NameKind::kRegion, properties.region.value_or(0), properties.region_name));
  for (std::size_t s = polygon_start_; s < domain_.segments.size(); ++s)
    domain_.segments[s].area = static_cast<std::uint32_t>(domain_.areas.size());
}

Result<Domain> GeometryBuilder::finish() {
  const std::string left_out = left_out_.sentence();
  if (domain_.points.empty())
    return bad("", "holds no geometry" + (left_out.empty() ? "" : ": " + left_out));
  if (!left_out.empty())
    warn({.kind = WarningKind::kLeftOut,
          .place = left_out_.first(),
          .count = left_out_.count(),
          .text = left_out});
  if (!ruled_line_.empty() && domain_.areas.empty())
    warn({.kind = WarningKind::kProperty,
          .place = ruled_line_,
          .text = ruled_line_ +
                  " is a line, and has a region or a bound on triangles as if it were a polygon: "
                  "there are no polygons, so these have no effect"});
  const std::vector<std::int32_t> region_numbers = regions_.numbers();
  for (Domain::Area& area : domain_.areas)
    if (area.region) area.region = region_numbers[static_cast<std::size_t>(*area.region)];
  const std::vector<std::int32_t> markers = markers_.numbers();
  for (Domain::Segment& segment : domain_.segments)
    segment.marker = markers[static_cast<std::size_t>(segment.marker)];
  markers_.name_all(NameKind::kMarker, names_);
  regions_.name_all(NameKind::kRegion, names_);
  warn_of_more(WarningKind::kOpenRing, open_rings_, "rings are not closed");
  warn_of_more(WarningKind::kRingCrossesItself, crossings_, "rings cross themselves");
  warn_of_more(WarningKind::kProperty, odd_properties_, "properties are left out");
  warn_of_more(WarningKind::kRingsOverlap, overlaps_, "polygons have rings that overlap");
  for (Warning& warning : names_.warnings()) domain_.warnings.push_back(std::move(warning));
  domain_.names = names_.take();
  return std::move(domain_);
}

}  // namespace weft::files
