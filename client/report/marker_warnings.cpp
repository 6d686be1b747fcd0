// SPDX-License-Identifier: Apache-2.0
#include "client/report/marker_warnings.h"

#include <cstddef>
#include <optional>
#include <utility>

#include "checker/geometry/box_tree.h"
#include "files/base/text.h"
#include "files/formats/derived/orientation.h"

namespace weft::client {
namespace {

// "marker 7", "markers 7, 8 and 12 more"; nullopt if `wanted` are all in the mesh.
std::optional<std::string> absent(NameKind kind, const std::set<std::int32_t>& wanted,
                                  const std::set<std::int32_t>& in_mesh) {
  constexpr std::size_t kMaxNamed = 5;
  std::vector<std::int32_t> missing;
  for (const std::int32_t number : wanted)
    if (!in_mesh.contains(number)) missing.push_back(number);
  if (missing.empty()) return std::nullopt;
  std::string text = std::string(word_of(kind)) + (missing.size() == 1 ? " " : "s ");
  for (std::size_t i = 0; i < missing.size() && i < kMaxNamed; ++i)
    text += (i == 0 ? "" : ", ") + std::to_string(missing[i]);
  if (missing.size() > kMaxNamed)
    text += " and " + with_separators(missing.size() - kMaxNamed) + " more";
  return text;
}

// The distinct numbers of a list in which equal ones mostly follow each other.
std::set<std::int32_t> runs_of(std::span<const std::int32_t> numbers) {
  std::set<std::int32_t> distinct;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (i == 0 || numbers[i] != numbers[i - 1]) distinct.insert(numbers[i]);
  return distinct;
}

bool before(Point a, Point b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// Whether the two have more than a point in common.
bool overlap(const Domain& domain, const Domain::Segment& s, const Domain::Segment& t) {
  const auto ends = [&domain](const Domain::Segment& segment) {
    const Point a = domain.points[segment.a];
    const Point b = domain.points[segment.b];
    return before(a, b) ? std::pair{a, b} : std::pair{b, a};
  };
  const auto [s_low, s_high] = ends(s);
  const auto [t_low, t_high] = ends(t);
  return orientation(s_low, s_high, t_low) == 0 && orientation(s_low, s_high, t_high) == 0 &&
         before(before(s_low, t_low) ? t_low : s_low, before(s_high, t_high) ? s_high : t_high);
}

// Those that have a marker and a length, and are straight.
std::vector<std::size_t> marked_segments(const Domain& domain) {
  std::vector<std::size_t> marked;
  std::set<std::int32_t> markers;
  auto arc = domain.arcs.begin();
  for (std::size_t s = 0; s < domain.segments.size(); ++s) {
    const Domain::Segment& segment = domain.segments[s];
    if (arc != domain.arcs.end() && arc->segment == s) {
      ++arc;
      continue;
    }
    if (segment.marker == 0 || domain.points[segment.a] == domain.points[segment.b]) continue;
    marked.push_back(s);
    markers.insert(segment.marker);
  }
  if (markers.size() < 2) marked.clear();  // they agree
  return marked;
}

}  // namespace

std::set<std::int32_t> markers_of(const MeshView& mesh) {
  return runs_of(mesh.edge_markers);
}

std::vector<std::string> open_boundary_warnings(const std::set<std::int32_t>& in_mesh,
                                                std::span<const std::int32_t> open_boundaries) {
  const auto markers =
      absent(NameKind::kMarker, {open_boundaries.begin(), open_boundaries.end()}, in_mesh);
  if (!markers) return {};
  return {"no edge of the mesh carries " + *markers + " of --open-boundary"};
}

std::vector<std::string> deep_boundary_warnings(const DeepBoundary& deep, double deeper) {
  if (deep.opened > 0) return {};
  const std::string metres = shortest(deeper);
  return {"--open-boundary deeper:" + metres +
          " opens nothing: nowhere are two edges in a row of the outer boundary deeper than " +
          metres + " m"};
}

std::vector<std::string> hidden_marker_warnings(const std::set<std::int32_t>& in_mesh,
                                                const Domain& domain) {
  std::set<std::int32_t> given;
  for (const Domain::Segment& segment : domain.segments)
    if (segment.marker != 0) given.insert(segment.marker);
  const auto markers = absent(NameKind::kMarker, given, in_mesh);
  if (!markers) return {};
  return {"no edge of the mesh carries " + *markers +
          " of the input: other segments lie on theirs, or they are not part of what is meshed"};
}

std::vector<std::string> hidden_region_warnings(const MeshView& mesh, const Domain& domain) {
  std::set<std::int32_t> given;
  for (const Domain::Region& region : domain.regions) given.insert(region.id);
  for (const Domain::Area& area : domain.areas)
    if (area.region && !area.is_hole) given.insert(*area.region);
  given.erase(0);
  if (given.empty()) return {};
  const auto regions = absent(NameKind::kRegion, given, runs_of(mesh.regions));
  if (!regions) return {};
  return {"no triangle of the mesh carries " + *regions +
          " of the input: another seed or a smaller polygon decides where it is, or it is not part "
          "of what is meshed"};
}

std::vector<std::string> contradicting_marker_warnings(const Domain& domain) {
  const std::vector<std::size_t> marked = marked_segments(domain);
  std::vector<check::Box> boxes;
  for (const std::size_t s : marked) {
    const Point a = domain.points[domain.segments[s].a];
    const Point b = domain.points[domain.segments[s].b];
    boxes.push_back(check::box_of({a.x, a.y}, {b.x, b.y}));
  }
  const check::BoxTree tree(boxes);
  constexpr std::size_t kMaxPairs = 50'000'000;  // of boxes that meet
  std::size_t looked_at = 0;
  std::size_t found = 0;
  std::pair<std::size_t, std::size_t> first;
  for (std::size_t i = 0; i < marked.size() && looked_at < kMaxPairs; ++i)
    tree.visit(boxes[i], [&](std::uint32_t j) {
      ++looked_at;
      const Domain::Segment& s = domain.segments[marked[j]];
      const Domain::Segment& t = domain.segments[marked[i]];
      if (j >= i || s.marker == t.marker || (s.area == 0) != (t.area == 0) ||
          !overlap(domain, s, t))
        return;
      const std::pair pair{marked[i], marked[j]};
      if (found++ == 0 || pair < first) first = pair;
    });
  if (found == 0) return {};
  const auto named = [&domain](std::size_t s) {
    const std::string place = domain.segment_places.locate(s);
    return std::to_string(domain.segments[s].marker) + " of the segment " +
           (place.empty() ? std::to_string(s) : "at " + place);
  };
  return {
      "segments that lie on each other have different markers, of which edges carry the first: " +
      named(first.second) + ", " + named(first.first) +
      (found > 1 ? ", and " + with_separators(found - 1) + " more" : "")};
}

void add_marker_warnings(const MeshView& mesh, std::span<const std::int32_t> open_boundaries,
                         const Domain* domain, MeshReport& report) {
  report.markers = markers_of(mesh);
  add_warnings(open_boundary_warnings(report.markers, open_boundaries), report);
  if (domain == nullptr) return;
  add_warnings(hidden_marker_warnings(report.markers, *domain), report);
  add_warnings(contradicting_marker_warnings(*domain), report);
  add_warnings(hidden_region_warnings(mesh, *domain), report);
}

}  // namespace weft::client
