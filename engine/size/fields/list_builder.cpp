// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/list_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kNodeCost = 2;  // of a node, in entries of lists
// A leaf lists at most so many lines, or so many per side of the leaf that they are away, because a
// straight line of n pieces has n parallel cells. It never lists more than kMaxInLeaf if they can
// be told apart.
constexpr double kInLeaf = 8;
constexpr double kInLeafPerSide = 2;
constexpr double kMaxInLeaf = 64;
constexpr std::uint32_t kShort = 16;  // a list that is hardly slower than the tree
// A look of the tree costs as much as so many lines of a list, which eight points share.
constexpr std::uint32_t kLinesPerLook = 4;

}  // namespace

Box ListBuilder::box_of(const Pending& pending) const {
  const double side = std::ldexp(2 * field_.root_, -pending.depth);
  const double x = pending.ix * side - field_.root_;
  const double y = pending.iy * side - field_.root_;
  return {x, y, x + side, y + side};
}

Point ListBuilder::middle_of(const Pending& pending) const {
  const Box box = box_of(pending);
  return {0.5 * (box.min_x + box.max_x), 0.5 * (box.min_y + box.max_y)};
}

// Sets the lines of the parts that the cover meets to those that may be nearest in them, and their
// distances.
std::optional<Error> ListBuilder::share_out(const Pending& pending, Pending (&parts)[4]) {
  const Box box = box_of(pending);
  const Point middle = middle_of(pending);
  const double x[3] = {box.min_x, middle.x, box.max_x};
  const double y[3] = {box.min_y, middle.y, box.max_y};
  Samples samples;
  for (std::size_t i = 0; i < kCorners; ++i) {
    samples.x.of[i] = x[i % 3];
    samples.y.of[i] = y[i / 3];
  }
  for (std::size_t i = kCorners; i < 2 * kPairs; ++i) {
    const Point at = middle_of(parts[(i - kCorners) % 4]);
    samples.x.of[i] = at.x;
    samples.y.of[i] = at.y;
  }
  if (auto error = take(pending.lines, samples)) return error;
  for (unsigned part = 0; part < 4; ++part) {
    if (!cover_.meets(field_.outside(box_of(parts[part])))) continue;
    parts[part].distance = std::sqrt(samples.least.of[kCorners + part]);
    if (auto error = filter(pending.lines, samples, part, parts[part].lines)) return error;
  }
  return std::nullopt;
}

// Sets the squares of the distances between the samples and each line, and the least of each.
std::optional<Error> ListBuilder::take(const std::vector<std::uint32_t>& lines, Samples& samples) {
  constexpr std::size_t kAtATime = 1 << 13;  // lines; takes about 200 us
  __m128d x[kPairs];
  __m128d y[kPairs];
  __m128d least[kPairs];
  for (int i = 0; i < kPairs; ++i) {
    x[i] = _mm_load_pd(samples.x.of + 2 * i);
    y[i] = _mm_load_pd(samples.y.of + 2 * i);
    least[i] = _mm_set1_pd(kInfinity);
  }
  squares_.resize(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (k % kAtATime == kAtATime - 1) {
      if (auto error = context_.poll()) return error;
    }
    __m128d square[kPairs];
    std::fill_n(square, kPairs, _mm_set1_pd(kInfinity));
    take_nearer<kPairs>(field_.tree_.lines()[lines[k]], x, y, square);
    unsigned nearer = 0;
    for (int i = 0; i < kPairs; ++i) {
      _mm_store_pd(squares_[k].of + 2 * i, square[i]);
      nearer |= static_cast<unsigned>(_mm_movemask_pd(_mm_cmplt_pd(square[i], least[i])))
                << (2 * i);
      least[i] = _mm_min_pd(least[i], square[i]);
    }
    for (nearer &= (1u << kSamples) - 1; nearer != 0; nearer &= nearer - 1)
      samples.nearest[__builtin_ctz(nearer)] = lines[k];
  }
  for (int i = 0; i < kPairs; ++i) _mm_store_pd(samples.least.of + 2 * i, least[i]);
  return std::nullopt;
}

// Appends the lines that may be nearest in a part to `kept`.
std::optional<Error> ListBuilder::filter(const std::vector<std::uint32_t>& lines,
                                         const Samples& samples, unsigned part,
                                         std::vector<std::uint32_t>& kept) {
  constexpr std::size_t kAtATime = 1 << 14;
  constexpr int kPoints = 5;
  // Covers points of neighbouring boxes that rounding puts into this one.
  constexpr double kGrown = 0x1p-38;
  const std::size_t low = 3 * (part >> 1) + (part & 1);  // its lower left corner
  const std::size_t at[kPoints] = {kCorners + part, low, low + 1, low + 3, low + 4};
  __m128d limit[kPoints][2];
  for (int k = 0; k < kPoints; ++k) {
    const Point q = field_.tree_.lines()[samples.nearest[at[k]]].nearest(
        {samples.x.of[at[k]], samples.y.of[at[k]]});
    double safe[4];
    for (int c = 0; c < 4; ++c) {
      const double dx = samples.x.of[at[c + 1]] - q.x, dy = samples.y.of[at[c + 1]] - q.y;
      const double d = std::sqrt(dx * dx + dy * dy);
      safe[c] = d + DistanceField::kRounding * (d + field_.longest_ + 4) + kGrown;
      safe[c] *= safe[c];
    }
    limit[k][0] = _mm_loadu_pd(safe);
    limit[k][1] = _mm_loadu_pd(safe + 2);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i % kAtATime == kAtATime - 1) {
      if (auto error = context_.poll()) return error;
    }
    const __m128d below = _mm_loadu_pd(squares_[i].of + low);
    const __m128d above = _mm_loadu_pd(squares_[i].of + low + 3);
    bool dropped = false;
    for (int k = 0; k < kPoints && !dropped; ++k)
      dropped = _mm_movemask_pd(_mm_and_pd(_mm_cmpgt_pd(below, limit[k][0]),
                                           _mm_cmpgt_pd(above, limit[k][1]))) == 3;
    if (!dropped) kept.push_back(lines[i]);
  }
  return std::nullopt;
}

void ListBuilder::add_leaf(const Pending& pending) {
  const auto count = static_cast<std::uint32_t>(pending.lines.size());
  std::size_t cost = count;
  Node& node = nodes[pending.node];
  node = {static_cast<std::uint32_t>(lists.size()), count};
  if (count > kShort) {
    const LineTree::Nearest found = field_.tree_.nearest(middle_of(pending), pending.lines[0]);
    if (kLinesPerLook * found.looks < count) {
      node = {found.line, DistanceField::kByTree};
      cost = kLinesPerLook * found.looks;
    }
  }
  if (node.count == count) lists.insert(lists.end(), pending.lines.begin(), pending.lines.end());
  looks += static_cast<double>(cost);
  ++leaves;
}

std::optional<Error> ListBuilder::split(Pending&& pending) {
  const double side = std::ldexp(2 * field_.root_, -pending.depth);
  const double in_leaf = std::clamp(kInLeafPerSide * pending.distance / side, kInLeaf, kMaxInLeaf);
  if (static_cast<double>(pending.lines.size()) <= in_leaf ||
      pending.depth == DistanceField::kMaxDepth) {
    add_leaf(pending);
    return std::nullopt;
  }
  if (pending.depth == last_level_) {
    later.push_back(std::move(pending));
    return std::nullopt;
  }
  if (auto error = context_.poll()) return error;
  Pending children[4];
  for (std::uint32_t c = 0; c < 4; ++c) {
    children[c].depth = pending.depth + 1;
    children[c].ix = 2 * pending.ix + (c & 1);
    children[c].iy = 2 * pending.iy + (c >> 1);
  }
  if (auto error = share_out(pending, children)) return error;
  std::uint64_t cost = 0;
  for (const Pending& child : children) cost += child.lines.size() + kNodeCost;
  if (cost > pending.allowed) {
    add_leaf(pending);
    return std::nullopt;
  }
  const auto first = static_cast<std::uint32_t>(nodes.size());
  nodes.resize(first + 4, {0, DistanceField::kByTree});
  nodes[pending.node] = {first, DistanceField::kInner};
  pending.lines = {};
  for (std::uint32_t c = 0; c < 4; ++c) {
    Pending& child = children[c];
    if (child.lines.empty()) continue;  // outside
    child.node = first + c;
    child.allowed = pending.allowed * (child.lines.size() + kNodeCost) / cost;
    if (auto error = split(std::move(child))) return error;
    child.lines = {};
  }
  return std::nullopt;
}

}  // namespace weft
