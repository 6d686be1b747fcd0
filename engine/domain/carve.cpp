// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/carve.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "engine/domain/cover.h"
#include "engine/domain/faces.h"
#include "engine/domain/triangulation/hilbert.h"
#include "engine/domain/triangulation/locate.h"

namespace weft {
namespace {

// Per face: whether the fewest segments between it and infinity are an odd number. A step across
// coincident segments costs the number of them modulo 2, so an even stack costs nothing.
std::vector<bool> find_odd_faces(const Arrangement& a, const Faces& faces, const FaceGraph& graph,
                                 StopPoller& poller) {
  // Breadth first; a step of length 0 goes to the front of the queue.
  std::vector<std::uint32_t> depth(faces.count, kNone);
  std::vector<bool> done(faces.count, false);
  std::deque<std::uint32_t> queue{Faces::kUnbounded};
  depth[Faces::kUnbounded] = 0;
  while (!queue.empty()) {
    poller.step();
    const std::uint32_t f = queue.front();
    queue.pop_front();
    if (done[f]) continue;
    done[f] = true;
    for (const FaceGraph::Step& s : graph.from(f)) {
      const bool is_odd = a.constraints[s.constraint].odd;
      const std::uint32_t d = depth[f] + (is_odd ? 1 : 0);
      if (d >= depth[s.to]) continue;
      depth[s.to] = d;
      is_odd ? queue.push_back(s.to) : queue.push_front(s.to);
    }
  }
  std::vector<bool> odd(faces.count);
  for (std::size_t f = 0; f < odd.size(); ++f) odd[f] = depth[f] % 2 == 1;
  return odd;
}

std::string number(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

std::string coordinates(Point p) {
  return "(" + number(p.x) + ", " + number(p.y) + ")";
}

// Finds the bounded faces that hold the seeds. Visits the seeds along a Hilbert curve, and starts
// each walk at the place of the seed before.
class SeedLocator {
 public:
  SeedLocator(const Arrangement& arrangement, const Faces& faces, const Pslg& pslg,
              StopPoller& poller)
      : faces_(faces), tolerance_(arrangement.merging.tolerance), seeds_(pslg.holes) {
    for (const RegionSeed& region : pslg.regions) seeds_.push_back(region.at);
    locations_.resize(seeds_.size());
    is_near_.resize(seeds_.size());
    std::uint32_t start = 0;
    for (const std::uint32_t seed : hilbert_order(seeds_, poller)) {
      locations_[seed] = locate(arrangement, seeds_[seed], start, poller);
      if (locations_[seed].triangle == kNone) continue;
      start = locations_[seed].triangle;
      is_near_[seed] = is_near(arrangement, seeds_[seed], start, tolerance_, poller);
    }
  }

  // The face of a seed; holes are numbered first, then regions. `field` makes the name of its
  // field.
  template <class Field>
  Result<std::uint32_t> face(std::size_t seed, const Field& field) const {
    const Location& location = locations_[seed];
    if (location.on_segment || location.on_vertex)
      return fail(ErrorCode::kSeedOnSegment, field(),
                  "the seed " + coordinates(seeds_[seed]) + " lies on a " +
                      (location.on_vertex ? "point" : "segment") +
                      ", so it does not tell which face it means");
    if (is_near_[seed])
      return fail(ErrorCode::kSeedOnSegment, field(),
                  "the seed " + coordinates(seeds_[seed]) + " is nearer than " +
                      number(tolerance_) +
                      " to a segment or point, so its face may have changed or vanished when what "
                      "is so near was merged");
    if (location.triangle == kNone || faces_.of_triangle[location.triangle] == Faces::kUnbounded)
      return fail(
          ErrorCode::kSeedOutsideDomain, field(),
          "the seed " + coordinates(seeds_[seed]) + " lies outside: no segments enclose it");
    return faces_.of_triangle[location.triangle];
  }

 private:
  const Faces& faces_;
  const double tolerance_;
  std::vector<Point> seeds_;
  std::vector<Location> locations_;
  std::vector<bool> is_near_;  // to a segment or vertex
};

bool is_inside(const Cover& cover, Fill fill) {
  if (cover.is_hole) return false;
  switch (fill) {
    case Fill::kSeeds:
      return true;
    case Fill::kEvenOdd:
      return cover.areas % 2 == 1;
    case Fill::kUnion:
      return cover.areas > 0;
  }
  return false;
}

// Per face an index into `regions`, to which those of the areas are added, each once.
std::vector<std::uint32_t> regions_of_areas(const std::vector<Cover>& covers,
                                            std::vector<Region>& regions) {
  std::map<std::pair<std::int32_t, double>, std::uint32_t> known{{{0, Region{}.max_area}, 0}};
  std::vector<std::uint32_t> result;
  result.reserve(covers.size());
  for (const Cover& cover : covers) {
    const Region region{cover.region.value_or(0), cover.max_area.value_or(Region{}.max_area)};
    const auto [at, is_new] =
        known.try_emplace({region.id, region.max_area}, static_cast<std::uint32_t>(regions.size()));
    if (is_new) regions.push_back(region);
    result.push_back(at->second);
  }
  return result;
}

// `last_hole`: the last that carved something away.
Error empty_domain(const Pslg& pslg, const Merging& merging, const Faces& faces,
                   std::size_t last_hole) {
  if (faces.count == 1 && merging.vanished_faces > 0) return closed_by_merging(merging);
  if (faces.count == 1)
    return {ErrorCode::kEmptyDomain, "domain.segments",
            "no face is enclosed by segments (" + std::to_string(pslg.segments.size()) +
                " given), so there is nothing to mesh"};
  if (pslg.holes.empty() && merging.vanished_faces > 0) return closed_by_merging(merging);
  if (!pslg.areas.empty())
    return {ErrorCode::kEmptyDomain, "domain.areas",
            "the fill and the holes leave nothing of the areas (" +
                std::to_string(pslg.areas.size()) + " given)"};
  if (pslg.holes.empty() && pslg.fill == Fill::kUnion)
    return {ErrorCode::kEmptyDomain, "domain.areas", "there are no areas to unite"};
  if (pslg.holes.empty())
    return {ErrorCode::kEmptyDomain, "domain.segments",
            "by the even-odd rule nothing is inside: every face is enclosed an even number of "
            "times"};
  return {ErrorCode::kEmptyDomain, "domain.holes[" + std::to_string(last_hole) + "]",
          "the holes carve everything away (" + std::to_string(pslg.holes.size()) +
              " given): the seed " + coordinates(pslg.holes[last_hole]) + " floods the last face"};
}

}  // namespace

Result<Carving> carve(const Arrangement& arrangement, const Pslg& pslg, StopPoller& poller) {
  const Faces faces = find_faces(arrangement, poller);
  std::vector<bool> inside(faces.count, true);
  Covers covered;
  if (!pslg.areas.empty() || pslg.fill != Fill::kSeeds) {
    const FaceGraph graph(arrangement, faces, poller);
    if (pslg.areas.empty() && pslg.fill == Fill::kEvenOdd)
      inside = find_odd_faces(arrangement, faces, graph, poller);
    else
      covered = cover_faces(arrangement, faces, graph, pslg, poller);
    covered.overlap.united = pslg.fill != Fill::kEvenOdd;
  }
  const std::vector<Cover>& covers = covered.of_face;
  for (std::uint32_t f = 0; f < covers.size(); ++f) inside[f] = is_inside(covers[f], pslg.fill);
  inside[Faces::kUnbounded] = false;

  const SeedLocator locator(arrangement, faces, pslg, poller);
  std::size_t last_hole = 0;
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    const auto face = locator.face(i, [i] { return "domain.holes[" + std::to_string(i) + "]"; });
    if (!face) return tl::unexpected(face.error());
    if (inside[*face]) last_hole = i;
    inside[*face] = false;
  }
  if (std::find(inside.begin(), inside.end(), true) == inside.end())
    return tl::unexpected(empty_domain(pslg, arrangement.merging, faces, last_hole));

  Carving carving{.region = {}, .regions = {Region{}}, .overlap = covered.overlap};
  std::vector<std::uint32_t> region_of_face = regions_of_areas(covers, carving.regions);
  region_of_face.resize(faces.count, 0);
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    const RegionSeed& seed = pslg.regions[i];
    const auto field = [i] { return "domain.regions[" + std::to_string(i) + "]"; };
    const auto face = locator.face(pslg.holes.size() + i, field);
    if (!face) return tl::unexpected(face.error());
    if (!inside[*face])
      return fail(ErrorCode::kSeedOutsideDomain, field(),
                  "the seed " + coordinates(seed.at) + " lies in a hole");
    double bound = seed.max_area.value_or(Region{}.max_area);
    if (!covers.empty()) bound = std::min(bound, covers[*face].max_area.value_or(bound));
    region_of_face[*face] = static_cast<std::uint32_t>(carving.regions.size());
    carving.regions.push_back({seed.id, bound});
  }

  for (std::uint32_t face = 0; face < faces.count; ++face)
    if (!inside[face]) region_of_face[face] = kNone;
  carving.region.resize(arrangement.triangles.size());
  for (std::size_t t = 0; t < carving.region.size(); ++t) {
    poller.step();
    carving.region[t] = region_of_face[faces.of_triangle[t]];
  }
  return carving;
}

}  // namespace weft
