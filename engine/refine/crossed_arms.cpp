// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/crossed_arms.h"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <tuple>
#include <utility>

#include "engine/base/vector.h"
#include "engine/refine/storage/mesh_store.h"

namespace weft {
namespace {

constexpr std::size_t kPollInterval = 1 << 16;

// A subsegment of an arm; `low` comes before `high` along the arm.
struct Piece {
  std::uint32_t segment;  // of the input
  std::uint32_t subsegment;
  std::uint32_t low, high;
  double at;  // where it begins along the arm
};

// A side of a sector: the subsegment of one arm, and how far from the corner the other arm goes on.
struct Side {
  std::uint32_t subsegment;
  std::uint32_t corner;
  double tangent;
  double reach;
};

auto place_of(const Side& side) {
  return std::tie(side.subsegment, side.corner);
}

// The pieces of the input segments that are arms, by segment.
Result<std::vector<Piece>> pieces_of(const Domain& domain,
                                     const std::vector<CrossedArms::Sector>& sectors,
                                     const ExecutionContext& context) {
  std::vector<std::uint32_t> segments;
  segments.reserve(2 * sectors.size());
  for (const CrossedArms::Sector& sector : sectors)
    for (const std::uint32_t s : sector.subsegments)
      segments.push_back(domain.subsegments[s].segment);
  std::sort(segments.begin(), segments.end());
  std::vector<Piece> pieces;
  for (std::uint32_t s = 0; s < domain.subsegments.size(); ++s) {
    if (s % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    const Subsegment& subsegment = domain.subsegments[s];
    if (std::binary_search(segments.begin(), segments.end(), subsegment.segment))
      pieces.push_back({subsegment.segment, s, subsegment.a, subsegment.b, 0});
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.segment, a.subsegment) < std::tie(b.segment, b.subsegment);
  });
  return pieces;
}

// Along their segment, in the direction of the longest.
void order_along(const Domain& domain, std::span<Piece> pieces) {
  const Point origin = domain.vertices[pieces.front().low];
  Vector direction{0, 0};
  for (const Piece& piece : pieces) {
    const Vector v = domain.vertices[piece.high] - domain.vertices[piece.low];
    if (dot(v, v) > dot(direction, direction)) direction = v;
  }
  for (Piece& piece : pieces) {
    const double low = dot(domain.vertices[piece.low] - origin, direction);
    const double high = dot(domain.vertices[piece.high] - origin, direction);
    if (high < low) std::swap(piece.low, piece.high);
    piece.at = std::min(low, high);
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tie(a.at, a.subsegment) < std::tie(b.at, b.subsegment);
  });
}

// The sides of the sectors, by place_of. REQUIRES: `segments` are the pieces of each arm, along it.
std::vector<Side> sides_of(const Domain& domain, const std::vector<CrossedArms::Sector>& sectors,
                           const std::vector<std::span<Piece>>& segments) {
  // From the corner, in the direction of the arm's subsegment there.
  const auto reach = [&](std::uint32_t corner, std::uint32_t subsegment) {
    const Subsegment& s = domain.subsegments[subsegment];
    const Point at = domain.vertices[corner];
    const Vector direction = domain.vertices[s.a == corner ? s.b : s.a] - at;
    const auto pieces = std::partition_point(
        segments.begin(), segments.end(),
        [&](const std::span<Piece>& arm) { return arm.front().segment < s.segment; });
    const Vector back = domain.vertices[pieces->front().low] - at;
    const Vector ahead = domain.vertices[pieces->back().high] - at;
    return length(dot(ahead, direction) > dot(back, direction) ? ahead : back);
  };
  std::vector<Side> sides;
  sides.reserve(2 * sectors.size());
  for (const auto& [corner, arms, tangent] : sectors) {
    sides.push_back({arms[0], corner, tangent, reach(corner, arms[1])});
    sides.push_back({arms[1], corner, tangent, reach(corner, arms[0])});
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return place_of(a) < place_of(b); });
  return sides;
}

}  // namespace

Result<CrossedArms> CrossedArms::find(const Domain& domain, const std::vector<Sector>& sectors,
                                      const ExecutionContext& context) {
  CrossedArms arms;
  if (sectors.empty()) return arms;
  auto pieces = pieces_of(domain, sectors, context);
  if (!pieces) return tl::unexpected(pieces.error());
  std::vector<std::span<Piece>> segments;
  for (auto first = pieces->begin(); first != pieces->end();) {
    const auto last = std::find_if(
        first, pieces->end(), [&](const Piece& piece) { return piece.segment != first->segment; });
    segments.emplace_back(first, last);
    order_along(domain, segments.back());
    first = last;
  }
  const std::vector<Side> sides = sides_of(domain, sectors, segments);

  // Sweeps along a segment, from this end of each piece. Of the sides that it has left behind, the
  // sharpest whose other arm reaches the piece counts.
  const auto is_wider = [](const Side& a, const Side& b) {
    return std::tie(a.tangent, a.corner) > std::tie(b.tangent, b.corner);
  };
  const auto sweep = [&](std::span<const Piece> segment, std::uint32_t Piece::*end) {
    std::priority_queue<Side, std::vector<Side>, decltype(is_wider)> behind(is_wider);
    for (const Piece& piece : segment) {
      const std::uint32_t from = piece.*end;
      const auto is_past = [&](const Side& side) {
        return length(domain.vertices[from] - domain.vertices[side.corner]) >= side.reach;
      };
      while (!behind.empty() && is_past(behind.top())) behind.pop();
      if (!behind.empty())
        for (const std::uint32_t v : {piece.low, piece.high})
          arms.by_subsegment_.push_back(
              {piece.subsegment, behind.top().corner, v, static_cast<float>(behind.top().tangent)});
      const Side here{piece.subsegment, from, 0, 0};
      const auto [first, last] =
          std::equal_range(sides.begin(), sides.end(), here,
                           [](const Side& a, const Side& b) { return place_of(a) < place_of(b); });
      for (auto side = first; side != last; ++side) behind.push(*side);
    }
  };
  for (const std::span<Piece> segment : segments) {
    if (segment.size() == 1) continue;
    if (auto error = context.poll()) return tl::unexpected(*error);
    sweep(segment, &Piece::low);
    std::reverse(segment.begin(), segment.end());
    sweep(segment, &Piece::high);
  }
  const auto key = [](const Arm& arm) { return std::tie(arm.subsegment, arm.corner, arm.end); };
  std::sort(arms.by_subsegment_.begin(), arms.by_subsegment_.end(),
            [&](const Arm& a, const Arm& b) { return key(a) < key(b); });
  arms.by_end_ = arms.by_subsegment_;
  std::sort(arms.by_end_.begin(), arms.by_end_.end(), [&](const Arm& a, const Arm& b) {
    return std::pair{a.end, key(a)} < std::pair{b.end, key(b)};
  });
  return arms;
}

std::span<const CrossedArms::Arm> CrossedArms::of(std::uint32_t subsegment) const {
  const auto [first, last] =
      std::equal_range(by_subsegment_.begin(), by_subsegment_.end(), Arm{subsegment, 0, 0, 0},
                       [](const Arm& a, const Arm& b) { return a.subsegment < b.subsegment; });
  return {first, last};
}

bool CrossedArms::share_corner(std::uint32_t subsegment, std::uint32_t other) const {
  const auto others = of(other);
  return std::ranges::any_of(of(subsegment), [&](const Arm& arm) {
    return std::ranges::any_of(others, [&](const Arm& o) { return o.corner == arm.corner; });
  });
}

std::span<const CrossedArms::Arm> CrossedArms::at(std::uint32_t vertex) const {
  const auto [first, last] =
      std::equal_range(by_end_.begin(), by_end_.end(), Arm{0, 0, vertex, 0},
                       [](const Arm& a, const Arm& b) { return a.end < b.end; });
  return {first, last};
}

}  // namespace weft
