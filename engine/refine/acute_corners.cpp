// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/refine/acute_corners.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace weft {
namespace {

struct Vector {
  double x, y;
};

Vector operator-(Point p, Point q) {
  return {p.x - q.x, p.y - q.y};
}
double dot(Vector u, Vector v) {
  return u.x * v.x + u.y * v.y;
}
double cross(Vector u, Vector v) {
  return u.x * v.y - u.y * v.x;
}
double length(Vector u) {
  return std::sqrt(dot(u, u));
}

// Whether the angle from u counter-clockwise to v, known to be below 180 degrees, is below 60.
bool below_60_degrees(Vector u, Vector v) {
  return cross(u, v) > 0 && dot(u, v) > 0.5 * length(u) * length(v);
}

}  // namespace

constexpr std::size_t kPollInterval = 1 << 16;

Result<AcuteCorners> AcuteCorners::build(const Domain& domain, const ExecutionContext& context) {
  AcuteCorners corners(domain);
  if (auto error = corners.find_acute_vertices(domain, context)) return tl::unexpected(*error);
  if (auto error = corners.sort_by_ends(domain, context)) return tl::unexpected(*error);
  return corners;
}

// A sector between two segments that is below 60 degrees is made of triangles that are: turn
// from each edge on a segment, through the triangles at its start, to the next such edge.
std::optional<Error> AcuteCorners::find_acute_vertices(const Domain& domain,
                                                       const ExecutionContext& context) {
  for (std::uint32_t t = 0; t < domain.triangles.size(); ++t) {
    if (t % kPollInterval == 0) {
      if (auto error = context.poll()) return error;
    }
    for (std::uint32_t i = 0; i < 3; ++i) {
      if (domain.triangles[t].subsegment[kPrevious[i]] == kNone) continue;
      const std::uint32_t corner = domain.triangles[t].vertex[i];
      const Point at = domain.vertices[corner];
      const Vector from = domain.vertices[domain.triangles[t].vertex[kNext[i]]] - at;
      std::uint32_t triangle = t;
      std::uint32_t at_corner = i;
      while (true) {
        const Domain::Triangle& current = domain.triangles[triangle];
        const Vector to = domain.vertices[current.vertex[kPrevious[at_corner]]] - at;
        if (!below_60_degrees(from, to)) break;
        if (current.subsegment[kNext[at_corner]] != kNone) {
          acute_[corner] = 1;
          break;
        }
        triangle = current.neighbor[kNext[at_corner]];
        at_corner = 0;
        while (domain.triangles[triangle].vertex[at_corner] != corner) ++at_corner;
      }
    }
  }
  return std::nullopt;
}

// A counting sort by the lower end: linear, so that it can be polled.
std::optional<Error> AcuteCorners::sort_by_ends(const Domain& domain,
                                                const ExecutionContext& context) {
  first_.assign(domain.vertices.size() + 2, 0);
  for (const Subsegment& s : domain.subsegments) ++first_[std::min(s.a, s.b) + 2];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  by_ends_.resize(domain.subsegments.size());
  for (std::uint32_t s = 0; s < domain.subsegments.size(); ++s) {
    if (s % kPollInterval == 0) {
      if (auto error = context.poll()) return error;
    }
    const auto [a, b] = std::minmax(domain.subsegments[s].a, domain.subsegments[s].b);
    by_ends_[first_[a + 1]++] = {b, s};
  }
  return std::nullopt;
}

Point AcuteCorners::split_point(const Mesh& mesh, std::uint32_t a, std::uint32_t b) const {
  Point from = mesh.vertices[a];
  Point to = mesh.vertices[b];
  if (acute(a) == acute(b)) return {0.5 * from.x + 0.5 * to.x, 0.5 * from.y + 0.5 * to.y};
  if (acute(b)) std::swap(from, to);
  const double whole = length(to - from);
  // The power of two in (whole / 3, 2/3 whole].
  int exponent = 0;
  const double fraction = std::frexp(whole, &exponent);  // in [1/2, 1)
  const double shell = std::ldexp(fraction < 0.75 ? 0.25 : 0.5, exponent);
  const double t = shell / whole;
  return {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
}

bool AcuteCorners::excuses(const Mesh& mesh, const Triangle& triangle) const {
  double shortest2 = 0;
  std::uint32_t edge = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Vector e =
        mesh.vertices[triangle.vertex[kPrevious[i]]] - mesh.vertices[triangle.vertex[kNext[i]]];
    const double length2 = dot(e, e);
    if (i == 0 || length2 < shortest2) {
      shortest2 = length2;
      edge = i;
    }
  }
  const std::uint32_t a = triangle.vertex[kNext[edge]];
  const std::uint32_t b = triangle.vertex[kPrevious[edge]];
  const std::uint32_t of_a = mesh.subsegment_of(a);
  const std::uint32_t of_b = mesh.subsegment_of(b);
  if (of_a == kNone || of_b == kNone || of_a == of_b) return false;
  const Subsegment& s = (*subsegments_)[of_a];
  const Subsegment& t = (*subsegments_)[of_b];
  const std::uint32_t shared = (s.a == t.a || s.a == t.b)   ? s.a
                               : (s.b == t.a || s.b == t.b) ? s.b
                                                            : kNone;
  if (shared == kNone || !acute(shared)) return false;
  const Point corner = mesh.vertices[shared];
  const Vector to_a = mesh.vertices[a] - corner;
  const Vector to_b = mesh.vertices[b] - corner;
  const bool small_angle = dot(to_a, to_b) > 0.5 * length(to_a) * length(to_b);
  constexpr double kSameDistance = 1e-4;  // rounding near the edge floor is 2e-5
  return small_angle && std::fabs(length(to_a) - length(to_b)) < kSameDistance * length(to_a);
}

std::uint32_t AcuteCorners::subsegment(const Mesh& mesh, std::uint32_t a, std::uint32_t b) const {
  if (const std::uint32_t s = mesh.subsegment_of(a); s != kNone) return s;
  if (const std::uint32_t s = mesh.subsegment_of(b); s != kNone) return s;
  const auto [low, high] = std::minmax(a, b);
  std::uint32_t i = first_[low];
  while (by_ends_[i].b != high) ++i;
  return by_ends_[i].subsegment;
}

}  // namespace weft
