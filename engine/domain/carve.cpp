// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/carve.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <sstream>
#include <string>
#include <utility>

#include "engine/domain/triangulation/hilbert.h"
#include "engine/domain/triangulation/locate.h"

namespace weft {
namespace {

// The faces of the arrangement, numbered from 0; kUnbounded is face 0.
struct Faces {
  static constexpr std::uint32_t kUnbounded = 0;
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 1;
};

// Floods from `start` across edges without a constraint. Whether a neighbour is new is hard to
// predict, so each is stored without a branch (the compiler would turn a choice of what to store
// into one). The queue is first in, first out, so that a triangle is known long before its turn.
// `queue` has room for all triangles and three more; of_triangle has one more, which stands for
// what is beyond the hull.
void flood(const Arrangement& a, std::uint32_t start, std::uint32_t face, Faces& faces,
           std::vector<std::uint32_t>& queue, StopPoller& poller) {
  std::uint32_t* const of = faces.of_triangle.data();
  const auto beyond = static_cast<std::uint32_t>(a.triangles.size());
  of[start] = face;
  std::uint32_t* first = queue.data();
  std::uint32_t* last = first;
  *last++ = start;
  while (first != last) {
    poller.step();
    const Arrangement::Triangle& t = a.triangles[*first++];
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t n = std::min(t.neighbor[i], beyond);
      const std::uint32_t known = of[n];
      const std::uint32_t is_new = (t.constraint[i] & known) == kNone;
      *last = n;
      last += is_new;
      of[n] = known ^ ((known ^ face) & (0 - is_new));
    }
  }
}

Faces find_faces(const Arrangement& a, StopPoller& poller) {
  Faces faces;
  faces.of_triangle.assign(a.triangles.size() + 1, kNone);
  faces.of_triangle.back() = Faces::kUnbounded;
  std::vector<std::uint32_t> queue(a.triangles.size() + 3);
  const auto open_to_the_outside = [](const Arrangement::Triangle& t) {
    for (int i = 0; i < 3; ++i)
      if (t.neighbor[i] == kNone && t.constraint[i] == kNone) return true;
    return false;
  };
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t)
    if (faces.of_triangle[t] == kNone && open_to_the_outside(a.triangles[t]))
      flood(a, t, Faces::kUnbounded, faces, queue, poller);
  for (std::uint32_t t = 0; t < a.triangles.size(); ++t)
    if (faces.of_triangle[t] == kNone) flood(a, t, faces.count++, faces, queue, poller);
  return faces;
}

// Per face: whether the fewest segments between it and infinity are an odd number. A step across
// coincident segments costs the number of them modulo 2, so an even stack costs nothing.
std::vector<bool> find_odd_faces(const Arrangement& a, const Faces& faces, StopPoller& poller) {
  struct Step {
    std::uint32_t from, to;
    bool odd;
  };
  // The dual graph in compressed rows: steps from face f lie at first[f] .. first[f + 1].
  std::vector<Step> steps;
  const auto for_each_step = [&](auto&& visit) {
    for (std::size_t t = 0; t < a.triangles.size(); ++t) {
      poller.step();
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t c = a.triangles[t].constraint[i];
        if (c == kNone) continue;
        const std::uint32_t n = a.triangles[t].neighbor[i];
        const std::uint32_t from = faces.of_triangle[t];
        const std::uint32_t to = n == kNone ? Faces::kUnbounded : faces.of_triangle[n];
        if (from == to) continue;
        visit(Step{from, to, a.constraints[c].odd});
        // The unbounded face has no triangle behind the hull to visit this edge from.
        if (n == kNone) visit(Step{to, from, a.constraints[c].odd});
      }
    }
  };
  std::vector<std::size_t> first(faces.count + 1, 0);
  for_each_step([&](const Step& s) { ++first[s.from + 1]; });
  for (std::size_t f = 0; f < faces.count; ++f) first[f + 1] += first[f];
  steps.resize(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for_each_step([&](const Step& s) { steps[next[s.from]++] = s; });

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
    for (std::size_t k = first[f]; k < first[f + 1]; ++k) {
      const Step& s = steps[k];
      const std::uint32_t d = depth[f] + (s.odd ? 1 : 0);
      if (d >= depth[s.to]) continue;
      depth[s.to] = d;
      s.odd ? queue.push_back(s.to) : queue.push_front(s.to);
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

Error empty_domain(const Pslg& pslg, const Merging& merging, const Faces& faces) {
  if (faces.count == 1 && merging.vanished_faces > 0) return closed_by_merging(merging);
  if (faces.count == 1)
    return {ErrorCode::kEmptyDomain, "domain.segments",
            "no face is enclosed by segments (" + std::to_string(pslg.segments.size()) +
                " given), so there is nothing to mesh"};
  if (pslg.holes.empty() && merging.vanished_faces > 0) return closed_by_merging(merging);
  if (pslg.holes.empty())
    return {ErrorCode::kEmptyDomain, "domain.segments",
            "by the even-odd rule nothing is inside: every face is enclosed an even number of "
            "times"};
  return {ErrorCode::kEmptyDomain, "domain.holes",
          "the holes carve everything away (" + std::to_string(pslg.holes.size()) + " given)"};
}

}  // namespace

Result<Carving> carve(const Arrangement& arrangement, const Pslg& pslg, StopPoller& poller) {
  const Faces faces = find_faces(arrangement, poller);
  std::vector<bool> inside(faces.count, true);
  if (pslg.fill == Fill::kEvenOdd) inside = find_odd_faces(arrangement, faces, poller);
  inside[Faces::kUnbounded] = false;

  const SeedLocator locator(arrangement, faces, pslg, poller);
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    const auto face = locator.face(i, [i] { return "domain.holes[" + std::to_string(i) + "]"; });
    if (!face) return tl::unexpected(face.error());
    inside[*face] = false;
  }
  if (std::find(inside.begin(), inside.end(), true) == inside.end())
    return tl::unexpected(empty_domain(pslg, arrangement.merging, faces));

  Carving carving{.region = {}, .regions = {Region{}}};
  std::vector<std::uint32_t> region_of_face(faces.count, 0);
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    const RegionSeed& seed = pslg.regions[i];
    const auto field = [i] { return "domain.regions[" + std::to_string(i) + "]"; };
    const auto face = locator.face(pslg.holes.size() + i, field);
    if (!face) return tl::unexpected(face.error());
    if (!inside[*face])
      return fail(ErrorCode::kSeedOutsideDomain, field(),
                  "the seed " + coordinates(seed.at) + " lies in a hole");
    region_of_face[*face] = static_cast<std::uint32_t>(carving.regions.size());
    carving.regions.push_back({seed.id, seed.max_area.value_or(Region{}.max_area)});
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
