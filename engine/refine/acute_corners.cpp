// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/acute_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/base/vector.h"
#include "engine/domain/arcs/arc.h"

namespace weft {
namespace {

// Whether u and v make an angle below 60 degrees.
bool below_60_degrees_apart(Vector u, Vector v) {
  return dot(u, v) > 0.5 * length(u) * length(v);
}

// Whether they may be: false for most angles that are not below 60 degrees, never for one that is.
bool maybe_below_60_degrees_apart(Vector u, Vector v) {
  const double cosine = dot(u, v);
  return (cosine > 0) & (cosine * cosine > 0.249 * dot(u, u) * dot(v, v));
}

// Whether the chords of two arms may make an angle so large, though their tangents make one below
// 93 degrees: each is 30 degrees from its tangent at most.
bool maybe_tangents_of_right_angle(Vector u, Vector v) {
  return dot(u, v) > -0.9 * length(u) * length(v);
}

// Along an arm, away from its corner.
Vector leaving(const Domain& domain, std::uint32_t subsegment, std::uint32_t corner) {
  const Subsegment& s = domain.subsegments[subsegment];
  const Point a = domain.vertices[s.a], b = domain.vertices[s.b];
  const double curvature = domain.curvatures[subsegment];
  const double bulge = bulge_of(curvature, length(b - a));
  return s.a == corner ? tangent_at_start(a, b, bulge) : tangent_at_start(b, a, -bulge);
}

// Whether they make an angle below 93 degrees: a right angle, after rounding.
bool at_most_right_angle_apart(Vector u, Vector v) {
  return dot(u, v) > -0.05 * length(u) * length(v);
}

// The multiple of the largest power of two in the middle third of [low, high]; of two, the nearer
// to the middle. REQUIRES: 0 <= low <= high.
double dyadic_between(double low, double high) {
  const double middle = 0.5 * (low + high);
  const double reach = (high - low) / 6;
  int exponent = 0;
  std::frexp(high, &exponent);
  for (const int last = exponent - 53; exponent > last; --exponent) {
    const double step = std::ldexp(1.0, exponent);
    const double nearest = std::nearbyint(middle / step) * step;
    if (std::fabs(nearest - middle) <= reach) return nearest;
  }
  return middle;
}

// The fraction of the way from `from` to `to`, both on a ray from the corner, at which this
// distance from the corner lies.
double fraction_at(double distance, Point corner, Point from, Point to) {
  const double start = length(from - corner);
  return (distance - start) / (length(to - corner) - start);
}

// A vertex that a piece is to match is nearer to it than this fraction of its length.
constexpr double kNarrow = 0.1;

// A split here leaves no piece below a quarter.
bool in_middle(double fraction) {
  return fraction > 0.25 && fraction < 0.75;
}

// Whether p and q are at the same distance from the corner, and below 60 degrees apart there.
bool on_shell(Point corner, Point p, Point q) {
  const double largest = std::max({std::fabs(corner.x), std::fabs(corner.y), std::fabs(p.x),
                                   std::fabs(p.y), std::fabs(q.x), std::fabs(q.y)});
  return std::fabs(length(p - corner) - length(q - corner)) <=
             AcuteCorners::kSameDistance * largest &&
         below_60_degrees_apart(p - corner, q - corner);
}

}  // namespace

constexpr std::size_t kPollInterval = 1 << 16;

Result<AcuteCorners> AcuteCorners::build(const Domain& domain, const QualityBounds& quality,
                                         const ExecutionContext& context) {
  AcuteCorners corners(domain);
  const bool above_30_degrees = quality.sin2 > 0.25;
  const auto sharp = corners.find_corners(domain, above_30_degrees, context);
  if (!sharp) return tl::unexpected(sharp.error());
  auto crossed = CrossedArms::find(domain, *sharp, context);
  if (!crossed) return tl::unexpected(crossed.error());
  corners.crossed_ = std::move(*crossed);
  if (auto error = corners.sort_by_ends(domain, context)) return tl::unexpected(*error);
  auto needles = Needles::find(domain, context);
  if (!needles) return tl::unexpected(needles.error());
  corners.needles_ = std::move(*needles);
  return corners;
}

// A sector between two segments is below an angle if its triangles are: turn from each edge on a
// segment, through the triangles at its start, to the next such edge.
Result<std::vector<CrossedArms::Sector>> AcuteCorners::find_corners(
    const Domain& domain, bool at_right_angles, const ExecutionContext& context) {
  std::vector<CrossedArms::Sector> sharp;
  const bool has_arcs = !domain.curvatures.empty();
  // Collects the corners where a sector may begin, in rounds. Which ones do is hard to predict, so
  // there is no branch on it.
  constexpr std::uint32_t kRound = 256;
  std::array<HalfEdge, 3 * kRound + 1> begins;
  for (std::uint32_t first = 0; first < domain.triangles.size(); first += kRound) {
    if (first % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    const auto last =
        static_cast<std::uint32_t>(std::min<std::size_t>(first + kRound, domain.triangles.size()));
    std::uint32_t count = 0;
    for (std::uint32_t t = first; t < last; ++t) {
      const Domain::Triangle& triangle = domain.triangles[t];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const Point at = domain.vertices[triangle.vertex[i]];
        const bool on_segment = triangle.subsegment[kPrevious[i]] != kNone;
        begins[count] = half_edge(t, i);
        const bool begins_sector =
            maybe_below_60_degrees_apart(domain.vertices[triangle.vertex[kNext[i]]] - at,
                                         domain.vertices[triangle.vertex[kPrevious[i]]] - at);
        count += on_segment & (at_right_angles | has_arcs | begins_sector);
      }
    }
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t t = triangle_of(begins[k]);
      const std::uint32_t i = edge_of(begins[k]);
      const std::uint32_t corner = domain.triangles[t].vertex[i];
      const Point at = domain.vertices[corner];
      const Vector from = domain.vertices[domain.triangles[t].vertex[kNext[i]]] - at;
      std::uint32_t triangle = t;
      std::uint32_t at_corner = i;
      while (true) {
        const Domain::Triangle& current = domain.triangles[triangle];
        const Vector to = domain.vertices[current.vertex[kPrevious[at_corner]]] - at;
        const bool counts = below_60_degrees_apart(from, to) ||
                            (at_right_angles && at_most_right_angle_apart(from, to)) ||
                            (has_arcs && maybe_tangents_of_right_angle(from, to));
        if (cross(from, to) <= 0 || !counts) break;
        const std::uint32_t other_arm = current.subsegment[kNext[at_corner]];
        if (other_arm != kNone) {
          const std::array arms{domain.triangles[t].subsegment[kPrevious[i]], other_arm};
          bool acute = below_60_degrees_apart(from, to);
          bool right = at_right_angles && at_most_right_angle_apart(from, to);
          if (has_arcs) {
            const Vector u = leaving(domain, arms[0], corner);
            const Vector v = leaving(domain, arms[1], corner);
            acute |= below_60_degrees_apart(u, v);
            right |= at_right_angles && at_most_right_angle_apart(u, v);
          }
          if (!acute && !right) break;
          corners_[corner] = std::max(corners_[corner], acute ? Corner::kAcute : Corner::kShells);
          const auto sine = static_cast<float>(cross(from, to) / (length(from) * length(to)));
          for (const std::uint32_t s : arms) {
            float& least = sine_at(s, corner);
            least = std::min(least, sine);
          }
          const double tangent = cross(from, to) / dot(from, to);
          if (acute && tangent < CrossedArms::kSharp && curvature(arms[0]) == 0 &&
              curvature(arms[1]) == 0)
            sharp.push_back({corner, {arms[0], arms[1]}, tangent});
          break;
        }
        triangle = current.neighbor[kNext[at_corner]];
        at_corner = 0;
        while (domain.triangles[triangle].vertex[at_corner] != corner) ++at_corner;
      }
    }
  }
  return sharp;
}

void AcuteCorners::share_shells(const std::vector<Twins>& twins) {
  for (const auto& [subsegments, ends] : twins) {
    float& here = sine_at(subsegments[0], ends[0]);
    float& there = sine_at(subsegments[1], ends[1]);
    here = there = std::min(here, there);
    if (!has_shells(ends[0]) && !has_shells(ends[1])) continue;
    for (const std::uint32_t end : ends) corners_[end] = std::max(corners_[end], Corner::kShells);
  }
}

// Two counting sorts, by the higher end and then by the lower: linear, so that they can be polled.
std::optional<Error> AcuteCorners::sort_by_ends(const Domain& domain,
                                                const ExecutionContext& context) {
  struct Entry {
    std::uint32_t low, high, subsegment;
  };
  const std::size_t n = domain.subsegments.size();
  std::vector<std::uint32_t> next(domain.vertices.size() + 1, 0);
  first_.assign(domain.vertices.size() + 2, 0);
  for (const Subsegment& s : domain.subsegments) {
    ++next[std::max(s.a, s.b) + 1];
    ++first_[std::min(s.a, s.b) + 2];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<Entry> by_high(n);
  for (std::uint32_t s = 0; s < n; ++s) {
    if (s % kPollInterval == 0) {
      if (auto error = context.poll()) return error;
    }
    const auto [low, high] = std::minmax(domain.subsegments[s].a, domain.subsegments[s].b);
    by_high[next[high]++] = {low, high, s};
  }
  by_ends_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (i % kPollInterval == 0) {
      if (auto error = context.poll()) return error;
    }
    by_ends_[first_[by_high[i].low + 1]++] = {by_high[i].high, by_high[i].subsegment};
  }
  return std::nullopt;
}

Point AcuteCorners::split_point(const MeshStore& mesh, Pair ends, Pair apexes,
                                double fraction) const {
  const Point from = mesh.vertices[ends[0]];
  const Point to = mesh.vertices[ends[1]];
  const std::uint32_t s = subsegment(mesh, ends[0], ends[1]);
  const std::optional<Shell> shell = this->shell(mesh, s, from, to, apexes);
  if (curvature(s) != 0) [[unlikely]]
    return split_arc(mesh, s, from, to, shell, fraction);
  if (shell) fraction = shell->fraction;
  // The half of exact ends is exact: no length is rounded.
  if (fraction == 0.5) return {0.5 * from.x + 0.5 * to.x, 0.5 * from.y + 0.5 * to.y};
  return {from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y)};
}

Point AcuteCorners::split_arc(const MeshStore& mesh, std::uint32_t subsegment, Point from, Point to,
                              std::optional<Shell> shell, double fraction) const {
  const Subsegment& s = (*subsegments_)[subsegment];
  const Point a = mesh.vertices[s.a], b = mesh.vertices[s.b];
  const double curvature = this->curvature(subsegment);
  if (shell && shell->corner != kNone) {
    const bool at_a = shell->corner == s.a;
    const double bulge = bulge_of(curvature, length(b - a));
    const Point corner = at_a ? a : b;
    const Vector along = at_a ? tangent_at_start(a, b, bulge) : tangent_at_start(b, a, -bulge);
    const double size = length(along);
    const double start = length(from - corner);
    return at_distance(corner, {along.x / size, along.y / size}, at_a ? curvature : -curvature,
                       start + shell->fraction * (length(to - corner) - start));
  }
  const double bulge =
      bulge_of(dot(to - from, b - a) > 0 ? curvature : -curvature, length(to - from));
  if (fraction == 0.5) return middle_of_arc(from, to, bulge);
  return at_fraction(from, to, bulge, fraction);
}

std::optional<AcuteCorners::Shell> AcuteCorners::shell(const MeshStore& mesh,
                                                       std::uint32_t subsegment, Point from,
                                                       Point to, Pair apexes) const {
  const Subsegment& s = (*subsegments_)[subsegment];
  if (!has_shells(s.a) && !has_shells(s.b) && crossed_.of(subsegment).empty()) return std::nullopt;
  const auto matching = matching_shell(mesh, subsegment, from, to, apexes);
  return matching ? matching : dyadic_shell(mesh, subsegment, from, to);
}

std::optional<AcuteCorners::Shell> AcuteCorners::matching_shell(const MeshStore& mesh,
                                                                std::uint32_t subsegment,
                                                                Point from, Point to,
                                                                Pair apexes) const {
  const Subsegment& s = (*subsegments_)[subsegment];
  const Vector piece = to - from;
  std::optional<Shell> shell;
  double narrowest = kNarrow * dot(piece, piece);  // distance times the piece's length
  const auto match = [&](std::uint32_t apex, std::uint32_t corner_vertex, std::uint32_t far_end) {
    if (apex == kNone || !on_other_arm(mesh, apex, corner_vertex, subsegment)) return;
    const Point corner = mesh.vertices[corner_vertex];
    const Point at = mesh.vertices[apex];
    const Point far = mesh.vertices[far_end];
    if (!below_60_degrees_apart(at - corner, far - corner)) return;
    const double candidate = fraction_at(length(at - corner), corner, from, to);
    const double width = std::fabs(cross(piece, at - from));
    if (!in_middle(candidate) || width >= narrowest) return;
    shell = {candidate, corner_vertex};
    narrowest = width;
  };
  for (const std::uint32_t apex : apexes) {
    if (has_shells(s.a)) match(apex, s.a, s.b);
    if (has_shells(s.b)) match(apex, s.b, s.a);
    for (const CrossedArms::Arm& arm : crossed_.of(subsegment)) match(apex, arm.corner, arm.end);
  }
  return shell;
}

AcuteCorners::Shell AcuteCorners::dyadic_shell(const MeshStore& mesh, std::uint32_t subsegment,
                                               Point from, Point to) const {
  const Subsegment& s = (*subsegments_)[subsegment];
  std::uint32_t corner_vertex = kNone;
  double narrowest = std::numeric_limits<double>::infinity();
  const auto consider = [&](std::uint32_t vertex, double sine) {
    const Point at = mesh.vertices[vertex];
    const double width = (length(from - at) + length(to - at)) * sine;
    if (width >= narrowest) return;
    corner_vertex = vertex;
    narrowest = width;
  };
  if (has_shells(s.a)) consider(s.a, sines_[subsegment][0]);
  if (has_shells(s.b)) consider(s.b, sines_[subsegment][1]);
  for (const CrossedArms::Arm& arm : crossed_.of(subsegment)) consider(arm.corner, arm.tangent);
  const Point corner = mesh.vertices[corner_vertex];
  const auto [low, high] = std::minmax({length(from - corner), length(to - corner)});
  const double fraction = fraction_at(dyadic_between(low, high), corner, from, to);
  return in_middle(fraction) ? Shell{fraction, corner_vertex} : Shell{0.5, kNone};
}

bool AcuteCorners::on_other_arm(const MeshStore& mesh, std::uint32_t vertex, std::uint32_t corner,
                                std::uint32_t subsegment) const {
  const std::uint32_t segment = (*subsegments_)[subsegment].segment;
  const auto is_other = [&](std::uint32_t s) { return (*subsegments_)[s].segment != segment; };
  const auto continues = [&](const CrossedArms::Arm& arm) {
    return arm.corner == corner && is_other(arm.subsegment);
  };
  if (const std::uint32_t on = mesh.subsegment_of(vertex); on != kNone) {
    if ((*subsegments_)[on].a == corner || (*subsegments_)[on].b == corner) return is_other(on);
    return std::ranges::any_of(crossed_.of(on), continues);
  }
  if (vertex >= corners_.size() || vertex == corner) return false;
  if (const std::uint32_t on = subsegment_between(vertex, corner); on != kNone) return is_other(on);
  return std::ranges::any_of(crossed_.at(vertex), continues);
}

bool AcuteCorners::exempts(const MeshStore& mesh, const Triangle& triangle) const {
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
  std::uint32_t a = triangle.vertex[kNext[edge]];
  std::uint32_t b = triangle.vertex[kPrevious[edge]];
  if (mesh.subsegment_of(a) == kNone) std::swap(a, b);
  const std::uint32_t of_a = mesh.subsegment_of(a);
  if (of_a == kNone) return false;
  const Subsegment& s = (*subsegments_)[of_a];
  const auto exempt_at = [&](std::uint32_t corner) {
    return acute(corner) && on_other_arm(mesh, b, corner, of_a) &&
           on_shell(mesh.vertices[corner], mesh.vertices[a], mesh.vertices[b]);
  };
  return exempt_at(s.a) || exempt_at(s.b) ||
         std::ranges::any_of(crossed_.of(of_a),
                             [&](const CrossedArms::Arm& arm) { return exempt_at(arm.corner); });
}

std::uint32_t AcuteCorners::subsegment(const MeshStore& mesh, std::uint32_t a,
                                       std::uint32_t b) const {
  if (const std::uint32_t s = mesh.subsegment_of(a); s != kNone) return s;
  if (const std::uint32_t s = mesh.subsegment_of(b); s != kNone) return s;
  return subsegment_between(a, b);
}

std::uint32_t AcuteCorners::subsegment_between(std::uint32_t a, std::uint32_t b) const {
  const auto [low, high] = std::minmax(a, b);
  const auto begin = by_ends_.begin() + first_[low];
  const auto end = by_ends_.begin() + first_[low + 1];
  const auto found = std::lower_bound(
      begin, end, high, [](const Ends& ends, std::uint32_t vertex) { return ends.b < vertex; });
  return found != end && found->b == high ? found->subsegment : kNone;
}

}  // namespace weft
