// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "checker/domain/flattened.h"
#include "files/base/text.h"

namespace weft::files {

void Provenance::add(std::size_t first, std::string prefix, std::uint64_t number,
                     std::string suffix) {
  runs_.push_back({first, std::move(prefix), number, std::move(suffix)});
}

void Provenance::extend(std::size_t first, const std::string& prefix, std::uint64_t number) {
  if (!runs_.empty()) {
    const Run& last = runs_.back();
    if (last.number + (first - last.first) == number && last.prefix == prefix) return;
  }
  add(first, prefix, number, "");
}

void Provenance::add_same(std::size_t first, const Provenance& other, std::size_t i) {
  const Run* const found = other.run_of(i);
  if (found == nullptr) return;
  Run run = *found;
  run.number += i - run.first;
  run.first = first;
  runs_.push_back(std::move(run));
}

const Provenance::Run* Provenance::run_of(std::size_t i) const {
  const auto after = std::upper_bound(
      runs_.begin(), runs_.end(), i, [](std::size_t at, const Run& run) { return at < run.first; });
  return after == runs_.begin() ? nullptr : &*std::prev(after);
}

std::size_t Provenance::bytes() const {
  std::size_t bytes = runs_.capacity() * sizeof(Run);
  for (const Run& run : runs_) bytes += run.prefix.capacity() + run.suffix.capacity();
  return bytes;
}

std::string Provenance::locate(std::size_t i) const {
  const Run* const run = run_of(i);
  return run == nullptr
             ? ""
             : run->prefix + std::to_string(run->number + (i - run->first)) + run->suffix;
}

std::vector<Point> chord_corners(Point a, Point b, double bulge) {
  std::vector<Point> corners;
  for (const check::Vec2 p : check::flattened({a.x, a.y}, {b.x, b.y}, bulge))
    corners.push_back({p.x, p.y});
  return corners;
}

Result<void> flatten_arcs(Domain& domain) {
  if (domain.arcs.empty()) return {};
  constexpr std::uint64_t kMaxChords = 4'000'000;
  double chords = 0;
  for (const Domain::Arc& arc : domain.arcs)
    chords += 2 * 180 / std::numbers::pi * std::atan(std::fabs(arc.bulge));
  if (chords > static_cast<double>(kMaxChords))
    return fail(ExitCode::kUnreadableInput,
                "the domain's " + with_separators(domain.arcs.size()) + " arcs are " +
                    with_separators(static_cast<std::uint64_t>(chords)) +
                    " chords of 2 degrees, and at most " + with_separators(kMaxChords) +
                    " are made");
  std::vector<Domain::Segment> segments;
  Provenance places;
  auto arc = domain.arcs.begin();
  for (std::size_t s = 0; s < domain.segments.size(); ++s) {
    Domain::Segment piece = domain.segments[s];
    const std::uint32_t last = piece.b;
    const double bulge = arc != domain.arcs.end() && arc->segment == s ? (arc++)->bulge : 0;
    for (const Point corner : chord_corners(domain.points[piece.a], domain.points[last], bulge)) {
      piece.b = static_cast<std::uint32_t>(domain.points.size());
      domain.point_places.add_same(piece.b, domain.segment_places, s);
      domain.points.push_back(corner);
      places.add_same(segments.size(), domain.segment_places, s);
      segments.push_back(piece);
      piece.a = piece.b;
    }
    piece.b = last;
    places.add_same(segments.size(), domain.segment_places, s);
    segments.push_back(piece);
  }
  domain.segments = std::move(segments);
  domain.segment_places = std::move(places);
  domain.arcs.clear();
  if (!domain.point_markers.empty()) domain.point_markers.resize(domain.points.size());
  return {};
}

void fill_polygons(Domain& domain, PolygonFill fill) {
  if (fill == PolygonFill::kEvenOdd) domain.fill = Domain::Fill::kEvenOdd;
  if (fill == PolygonFill::kDifference)
    for (std::size_t i = 1; i < domain.areas.size(); ++i) domain.areas[i].is_hole = true;
}

}  // namespace weft::files
