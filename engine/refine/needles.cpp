// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/needles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"
#include "engine/domain/tolerance.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {
namespace {

// From this tangent on, arms are so far apart at the edges that refinement makes (tolerance.h) that
// no point can be rounded across one.
constexpr double kNeedleTangent = 0.125;

// Arms whose tangents are so near to each other touch, in radians: as of contacts (arcs/chords.h).
constexpr double kSameDirection = 1e-4;

// How far apart arms must be, over the largest coordinate: 16 units in the last place.
constexpr double kApart = 16 * 0x1p-53;

// Grows with the angle from the direction of x, from 0 to 4.
double pseudo_angle(Vector u) {
  const double part = u.x / (std::fabs(u.x) + std::fabs(u.y));
  return u.y >= 0 ? 1 - part : 3 + part;
}

}  // namespace

// Nearly every corner has two boundary edges: one that begins there, and one that ends.
Result<Needles> Needles::find(const Domain& domain, const ExecutionContext& context) {
  const Result<Edges> edges = boundary(domain, context);
  if (!edges) return tl::unexpected(edges.error());
  Needles needles;
  needles.apart_ = kApart * largest_coordinate(domain.vertices);
  constexpr std::uint32_t kSeveral = kNone - 1;
  std::vector<std::uint32_t> begins(domain.vertices.size(), kNone);  // an edge, per corner
  for (std::uint32_t e = 0; e < edges->size(); ++e) {
    std::uint32_t& at = begins[(*edges)[e].from];
    at = at == kNone ? e : kSeveral;
  }
  Edges several;  // arms of corners with more
  for (const Edge& edge : *edges) {
    const Edge back{edge.to, edge.from, edge.subsegment, false};
    if (begins[edge.from] == kSeveral) several.push_back(edge);
    if (begins[edge.to] == kSeveral)
      several.push_back(back);
    else
      needles.add(domain, back, (*edges)[begins[edge.to]]);
  }
  std::sort(several.begin(), several.end(),
            [](const Edge& a, const Edge& b) { return a.from < b.from; });
  for (auto first = several.begin(); first != several.end();) {
    const auto last = std::find_if(first, several.end(),
                                   [&](const Edge& arm) { return arm.from != first->from; });
    needles.add_fan(domain, Edges(first, last));
    first = last;
  }
  if (needles.nested_) return tl::unexpected(*needles.nested_);
  std::sort(needles.ends_.begin(), needles.ends_.end(),
            [](const End& a, const End& b) { return a.subsegment < b.subsegment; });
  return needles;
}

// Which edges are on the boundary is hard to predict, so there is no branch on it.
Result<Needles::Edges> Needles::boundary(const Domain& domain, const ExecutionContext& context) {
  constexpr std::size_t kRound = 1024;
  std::array<Edge, 3 * kRound + 1> round;
  Edges edges;
  for (std::size_t first = 0; first < domain.triangles.size(); first += kRound) {
    if (auto error = context.poll()) return tl::unexpected(*error);
    const std::size_t last = std::min(first + kRound, domain.triangles.size());
    std::size_t count = 0;
    for (std::size_t t = first; t < last; ++t) {
      const Domain::Triangle& triangle = domain.triangles[t];
      for (std::uint32_t i = 0; i < 3; ++i) {
        round[count] = {triangle.vertex[kNext[i]], triangle.vertex[kPrevious[i]],
                        triangle.subsegment[i], true};
        count += triangle.neighbor[i] == kNone;
      }
    }
    edges.insert(edges.end(), round.begin(), round.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return edges;
}

// Adds the needles between neighbouring arms of a corner.
void Needles::add_fan(const Domain& domain, Edges arms) {
  const Point at = domain.vertices[arms.front().from];
  const auto key = [&](const Edge& arm) {
    return std::pair{pseudo_angle(domain.vertices[arm.to] - at), arm.to};
  };
  std::sort(arms.begin(), arms.end(),
            [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < arms.size(); ++i) add(domain, arms[i], arms[(i + 1) % arms.size()]);
}

// Adds the two arms if they make a needle. A needle inside the domain does no harm.
void Needles::add(const Domain& domain, const Edge& arm, const Edge& other) {
  const Point corner = domain.vertices[arm.from];
  const Vector u = domain.vertices[arm.to] - corner;
  const Vector v = domain.vertices[other.to] - corner;
  const double area = std::fabs(cross(u, v));
  const double along = dot(u, v);
  if (!(along > 0 && area < kNeedleTangent * along)) return;
  if (!domain.curvatures.empty()) {
    const bool turns_left = cross(u, v) > 0;
    add_contact(domain, turns_left ? arm : other, turns_left ? other : arm);
  }
  for (const Edge& a : {arm, other})
    ends_.push_back({a.subsegment, corner, apart_ * (along / area)});
}

// The parts of the left one, after as little as a quarter of its length, must keep left of the
// chord of the right one, and so the other way round.
void Needles::add_contact(const Domain& domain, const Edge& right, const Edge& left) {
  if (right.domain_is_left || nested_) return;
  const auto curvature = [&](const Edge& arm) {
    const double forward = domain.curvatures[arm.subsegment];
    return domain.subsegments[arm.subsegment].a == arm.from ? forward : -forward;
  };
  const auto direction = [&](const Edge& arm) {
    const Point from = domain.vertices[arm.from], to = domain.vertices[arm.to];
    return tangent_at_start(from, to, bulge_of(curvature(arm), length(to - from)));
  };
  const Vector u = direction(right), v = direction(left);
  if (std::fabs(cross(u, v)) >= kSameDirection * length(u) * length(v)) return;
  const double p = curvature(right), q = curvature(left);
  if (p * q <= 0 ||
      4 * std::min(std::fabs(p), std::fabs(q)) <= std::max(std::fabs(p), std::fabs(q)))
    return;
  const Point at = domain.vertices[right.from];
  const auto segment = [&](const Edge& arm) {
    return std::to_string(domain.subsegments[arm.subsegment].segment);
  };
  nested_ = Error{ErrorCode::kBadOption, "domain.segments[" + segment(right) + "]",
                  "the arcs of segments " + segment(right) + " and " + segment(left) +
                      " touch at (" + text(at.x) + ", " + text(at.y) +
                      ") and curve the same way, and what is between them is not meshed: "
                      "edges on them may cross there",
                  at};
}

bool Needles::keep_apart(std::uint32_t subsegment, Point split) const {
  const auto first =
      std::lower_bound(ends_.begin(), ends_.end(), subsegment,
                       [](const End& end, std::uint32_t value) { return end.subsegment < value; });
  for (auto end = first; end != ends_.end() && end->subsegment == subsegment; ++end)
    if (length(split - end->corner) < end->distance) return false;
  return true;
}

}  // namespace weft
