// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/crossed_arms.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "engine/refine/storage/mesh_store.h"
#include "engine/refine/storage/vector.h"

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

// That an input segment is an arm of a sharp corner.
struct SharpEnd {
  std::uint32_t segment;
  std::uint32_t corner;
  double tangent;
};

bool before(const SharpEnd& a, const SharpEnd& b) {
  return std::tie(a.segment, a.corner, a.tangent) < std::tie(b.segment, b.corner, b.tangent);
}

// By segment and corner, the sharpest of each.
std::vector<SharpEnd> sharp_ends(const Domain& domain,
                                 const std::vector<CrossedArms::Sector>& sectors) {
  std::vector<SharpEnd> ends;
  ends.reserve(2 * sectors.size());
  for (const CrossedArms::Sector& sector : sectors)
    for (const std::uint32_t s : sector.subsegments)
      ends.push_back({domain.subsegments[s].segment, sector.corner, sector.tangent});
  std::sort(ends.begin(), ends.end(), before);
  const auto last = std::unique(ends.begin(), ends.end(), [](const SharpEnd& a, const SharpEnd& b) {
    return a.segment == b.segment && a.corner == b.corner;
  });
  ends.erase(last, ends.end());
  return ends;
}

const SharpEnd* find_end(const std::vector<SharpEnd>& ends, std::uint32_t segment,
                         std::uint32_t corner) {
  const auto found =
      std::lower_bound(ends.begin(), ends.end(), SharpEnd{segment, corner, 0}, before);
  return found != ends.end() && found->segment == segment && found->corner == corner ? &*found
                                                                                     : nullptr;
}

// The pieces of the segments of `ends`, by segment.
Result<std::vector<Piece>> pieces_of(const Domain& domain, const std::vector<SharpEnd>& ends,
                                     const ExecutionContext& context) {
  std::vector<Piece> pieces;
  for (std::uint32_t s = 0; s < domain.subsegments.size(); ++s) {
    if (s % kPollInterval == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    const Subsegment& subsegment = domain.subsegments[s];
    const auto end = std::lower_bound(
        ends.begin(), ends.end(), subsegment.segment,
        [](const SharpEnd& e, std::uint32_t segment) { return e.segment < segment; });
    if (end != ends.end() && end->segment == subsegment.segment)
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

}  // namespace

Result<CrossedArms> CrossedArms::find(const Domain& domain, const std::vector<Sector>& sectors,
                                      const ExecutionContext& context) {
  CrossedArms arms;
  if (sectors.empty()) return arms;
  const std::vector<SharpEnd> ends = sharp_ends(domain, sectors);
  auto pieces = pieces_of(domain, ends, context);
  if (!pieces) return tl::unexpected(pieces.error());

  // The sharpest corner among the vertices that a sweep along the segment has left behind.
  const auto sweep = [&](const Piece& piece, std::uint32_t from, const SharpEnd*& sharpest) {
    if (sharpest != nullptr)
      for (const std::uint32_t end : {piece.low, piece.high})
        arms.by_subsegment_.push_back({piece.subsegment, sharpest->corner, end});
    const SharpEnd* here = find_end(ends, piece.segment, from);
    if (here != nullptr && (sharpest == nullptr || here->tangent < sharpest->tangent))
      sharpest = here;
  };
  for (auto first = pieces->begin(); first != pieces->end();) {
    if (auto error = context.poll()) return tl::unexpected(*error);
    const auto last = std::find_if(
        first, pieces->end(), [&](const Piece& piece) { return piece.segment != first->segment; });
    const std::span<Piece> segment(first, last);
    if (segment.size() > 1) {
      order_along(domain, segment);
      const SharpEnd* sharpest = nullptr;
      for (const Piece& piece : segment) sweep(piece, piece.low, sharpest);
      sharpest = nullptr;
      for (std::size_t i = segment.size(); i-- > 0;) sweep(segment[i], segment[i].high, sharpest);
    }
    first = last;
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
      std::equal_range(by_subsegment_.begin(), by_subsegment_.end(), Arm{subsegment, 0, 0},
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
      std::equal_range(by_end_.begin(), by_end_.end(), Arm{0, 0, vertex},
                       [](const Arm& a, const Arm& b) { return a.end < b.end; });
  return {first, last};
}

}  // namespace weft
