// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/distance_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "engine/size/constant_size.h"
#include "engine/size/fields/list_builder.h"
#include "engine/size/fields/polled_loop.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFarthest = 0x1p500;  // of a coordinate whose square is finite

// The allowance of a subtree per line, in entries of lists.
constexpr std::uint64_t kListedPerLine = 24;
constexpr std::uint64_t kListedBesides = std::uint64_t{1} << 16;
// Far from the lines, lists are long where boxes are not small: of some ten thousand lines, on
// which most domains have their distance, more may be listed.
constexpr std::uint64_t kMoreListedPerLine = 32;
constexpr std::uint64_t kMaxListedBesides = std::uint64_t{1} << 18;
constexpr int kSubtreeLevel = 4;  // the level whose subtrees are built on many threads

double largest(const Box& box) {
  return std::max(std::max(std::fabs(box.min_x), std::fabs(box.max_x)),
                  std::max(std::fabs(box.min_y), std::fabs(box.max_y)));
}

__m128d select(__m128d mask, __m128d a, __m128d b) {
  return _mm_or_pd(_mm_and_pd(mask, a), _mm_andnot_pd(mask, b));
}

}  // namespace

DistanceField::DistanceField(const Box& box)
    : centre_{0.5 * box.min_x + 0.5 * box.max_x, 0.5 * box.min_y + 0.5 * box.max_y} {
  // A box without a side gets one that is small beside its coordinates.
  const double side = std::max({box.width(), box.height(), 0x1p-40 * largest(box), 0x1p-170});
  const int exponent = std::ilogb(side);
  scale_ = std::ldexp(1.0, -exponent);
  unit_ = std::ldexp(1.0, exponent);
  root_ = 0.5 * (side * scale_) * (1 + 0x1p-10);  // the box's sides lie inside
  cells_ = std::ldexp(1.0, kMaxDepth - 1) / root_;
}

Result<DistanceField> DistanceField::make(std::vector<Line> lines, const DomainCover& cover,
                                          const ExecutionContext& context) {
  if (lines.size() > kMaxLines) {
    return fail(ErrorCode::kLimitExceeded, "",
                "a distance to " + std::to_string(lines.size()) + " lines; the limit is " +
                    std::to_string(kMaxLines));
  }
  const std::uint64_t bytes = bytes_to_make(lines.size());
  if (auto error =
          context.need_bytes(bytes, "a distance to " + std::to_string(lines.size()) + " lines"))
    return tl::unexpected(*error);

  DistanceField field(cover.box());
  std::vector<StraightLine> straight;
  straight.reserve(lines.size());
  for (const Line& line : lines) {
    constexpr std::size_t kAtATime = 1 << 16;
    if (straight.size() % kAtATime == 0) {
      if (auto error = context.poll()) return tl::unexpected(*error);
    }
    straight.push_back(StraightLine::between(field.inside(line.a), field.inside(line.b)));
    field.longest_ = std::max(field.longest_, straight.back().length());
  }
  lines = {};
  auto tree = LineTree::make(std::move(straight), context);
  if (!tree) return tl::unexpected(tree.error());
  field.tree_ = std::move(*tree);
  if (auto error = field.add_quadtree(cover, context)) return tl::unexpected(*error);
  return field;
}

std::optional<Error> DistanceField::add_quadtree(const DomainCover& cover,
                                                 const ExecutionContext& context) {
  const std::size_t n = tree_.lines().size();

  // Builds the first levels, then each subtree below them on one thread.
  ListBuilder top(*this, cover, kSubtreeLevel, context);
  ListBuilder::Pending root;
  root.allowed =
      kListedPerLine * n + std::min(kListedBesides + kMoreListedPerLine * n, kMaxListedBesides);
  root.lines.resize(n);
  std::iota(root.lines.begin(), root.lines.end(), 0u);
  if (auto error = top.build(std::move(root))) return error;
  std::vector<ListBuilder> parts;
  parts.reserve(top.later.size());
  for (std::size_t i = 0; i < top.later.size(); ++i)
    parts.emplace_back(*this, cover, kMaxDepth, context);
  std::vector<std::uint32_t> places;
  for (const auto& pending : top.later) places.push_back(pending.node);
  if (auto error = polled_loop(context, parts.size(), [&](std::size_t i) {
        return parts[i].build(std::move(top.later[i]));
      }))
    return error;

  // Joins the parts, one behind the other.
  std::size_t nodes = top.nodes.size();
  std::size_t listed = top.lists.size();
  for (const ListBuilder& part : parts) {
    nodes += part.nodes.size() - 1;
    listed += part.lists.size();
  }
  top.nodes.reserve(nodes);
  top.lists.reserve(listed);
  nodes_ = std::move(top.nodes);
  lists_ = std::move(top.lists);
  double looks = top.looks;
  std::size_t leaves = top.leaves;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    ListBuilder& part = parts[i];
    const auto node_offset = static_cast<std::uint32_t>(nodes_.size() - 1);
    const auto list_offset = static_cast<std::uint32_t>(lists_.size());
    for (Node& node : part.nodes) {
      if (node.count != kByTree) node.first += node.count == kInner ? node_offset : list_offset;
    }
    nodes_[places[i]] = part.nodes[0];
    nodes_.insert(nodes_.end(), part.nodes.begin() + 1, part.nodes.end());
    lists_.insert(lists_.end(), part.lists.begin(), part.lists.end());
    looks += part.looks;
    leaves += part.leaves;
    part.nodes = {};
    part.lists = {};
  }
  while (top_levels_ < kMaxTopLevels && std::size_t{1} << (2 * top_levels_) < nodes_.size())
    ++top_levels_;
  table_.resize(std::size_t{1} << (2 * top_levels_));
  fill_table(0, 0, 0, 0);
  constexpr double kBesides = 80;
  constexpr double kPerLook = 20;
  const auto divisor = static_cast<double>(std::max<std::size_t>(leaves, 1));
  operations_ = static_cast<std::size_t>(kBesides + kPerLook * looks / divisor);
  return std::nullopt;
}

void DistanceField::fill_table(std::uint32_t node, int depth, std::uint32_t ix, std::uint32_t iy) {
  if (nodes_[node].count == kInner && depth < top_levels_) {
    for (std::uint32_t c = 0; c < 4; ++c)
      fill_table(nodes_[node].first + c, depth + 1, 2 * ix + (c & 1), 2 * iy + (c >> 1));
    return;
  }
  const std::uint32_t side = 1u << (top_levels_ - depth);
  for (std::uint32_t j = iy * side; j < (iy + 1) * side; ++j)
    std::fill_n(table_.begin() + (j << top_levels_ | ix * side), side, node);
}

std::size_t DistanceField::bytes() const noexcept {
  return tree_.bytes() + nodes_.capacity() * sizeof(Node) +
         (lists_.capacity() + table_.capacity()) * sizeof(std::uint32_t);
}

// The leaf of a cell of the last level. What lies outside the root is kNone.
inline std::uint32_t DistanceField::leaf(int ix, int iy) const noexcept {
  const auto x = static_cast<std::uint32_t>(ix);
  const auto y = static_cast<std::uint32_t>(iy);
  if (((x | y) >> kMaxDepth) != 0) return kNone;
  const int below = kMaxDepth - top_levels_;
  std::uint32_t node = table_[(y >> below) << top_levels_ | x >> below];
  for (int bit = below - 1; nodes_[node].count == kInner; --bit)
    node = nodes_[node].first + ((x >> bit & 1) | (y >> bit & 1) << 1);
  return node;
}

void DistanceField::eight(const Lanes& at, __m128d* out) const noexcept {
  const __m128d infinity = _mm_set1_pd(kInfinity);
  const __m128d sign = _mm_set1_pd(-0.0);
  const __m128d largest = _mm_set1_pd(kFarthest);
  const __m128d root = _mm_set1_pd(root_);
  const __m128d cells = _mm_set1_pd(cells_);
  alignas(16) int ix[8];
  alignas(16) int iy[8];
  __m128d near[4];  // whose square is finite
  __m128d best[4];
  for (int i = 0; i < 4; ++i) {
    const auto cell = [&](__m128d v) {
      return _mm_cvttpd_epi32(_mm_floor_pd(_mm_mul_pd(_mm_add_pd(v, root), cells)));
    };
    _mm_storel_epi64(reinterpret_cast<__m128i*>(ix + 2 * i), cell(at.x[i]));
    _mm_storel_epi64(reinterpret_cast<__m128i*>(iy + 2 * i), cell(at.y[i]));
    near[i] = _mm_and_pd(_mm_cmple_pd(_mm_andnot_pd(sign, at.x[i]), largest),
                         _mm_cmple_pd(_mm_andnot_pd(sign, at.y[i]), largest));
    best[i] = infinity;
  }
  std::uint32_t leaves[kLanes];
  unsigned lists = 0;  // lanes
  for (unsigned i = 0; i < kLanes; ++i) {
    leaves[i] = leaf(ix[i], iy[i]);
    lists |= static_cast<unsigned>(leaves[i] != kNone && nodes_[leaves[i]].count != kByTree) << i;
  }
  constexpr unsigned kAll = (1u << kLanes) - 1;
  for (unsigned left = lists; left != 0;) {
    const auto lane = static_cast<unsigned>(__builtin_ctz(left));
    unsigned same = 0;
    for (unsigned i = 0; i < kLanes; ++i)
      same |= static_cast<unsigned>(leaves[i] == leaves[lane]) << i;
    left &= ~same;
    const Node node = nodes_[leaves[lane]];
    const std::uint32_t* const list = lists_.data() + node.first;
    // Other lanes may take the lines of this leaf, too: their distances then stay above the least.
    if (__builtin_popcount(same) > 2) {
      for (std::uint32_t i = 0; i < node.count; ++i)
        take_nearer<4>(tree_.lines()[list[i]], at.x, at.y, best);
      continue;
    }
    for (unsigned lanes = same; lanes != 0; lanes &= lanes - 1) {
      const int pair = __builtin_ctz(lanes) / 2;
      for (std::uint32_t i = 0; i < node.count; ++i)
        take_nearer<1>(tree_.lines()[list[i]], at.x + pair, at.y + pair, best + pair);
    }
  }
  if (lists != kAll) {
    alignas(16) double x[kLanes];
    alignas(16) double y[kLanes];
    alignas(16) double square[kLanes];
    unsigned asked = 0;
    for (int i = 0; i < 4; ++i) {
      _mm_store_pd(x + 2 * i, at.x[i]);
      _mm_store_pd(y + 2 * i, at.y[i]);
      _mm_store_pd(square + 2 * i, best[i]);
      asked |= static_cast<unsigned>(_mm_movemask_pd(near[i])) << (2 * i);
    }
    std::uint32_t guess = 0;
    for (unsigned lanes = asked & ~lists; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
      if (leaves[lane] != kNone) guess = nodes_[leaves[lane]].first;
      const LineTree::Nearest found = tree_.nearest({x[lane], y[lane]}, guess);
      square[lane] = found.square;
      guess = found.line;
    }
    for (int i = 0; i < 4; ++i) best[i] = _mm_load_pd(square + 2 * i);
  }
  for (int i = 0; i < 4; ++i) {
    const __m128d distance = select(near[i], _mm_sqrt_pd(best[i]), infinity);
    out[i] = _mm_or_pd(distance, _mm_cmpunord_pd(at.x[i], at.y[i]));
  }
}

// The value of `eight`, bit for bit.
double DistanceField::one(Point p) const noexcept {
  const __m128d cell =
      _mm_mul_pd(_mm_add_pd(_mm_set_pd(p.y, p.x), _mm_set1_pd(root_)), _mm_set1_pd(cells_));
  alignas(16) int at[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(at), _mm_cvttpd_epi32(_mm_floor_pd(cell)));
  const std::uint32_t in = leaf(at[0], at[1]);
  if (in == kNone || nodes_[in].count == kByTree)
    return std::sqrt(tree_.nearest(p, in == kNone ? 0 : nodes_[in].first).square);
  const __m128d x = _mm_set1_pd(p.x);
  const __m128d y = _mm_set1_pd(p.y);
  __m128d best = _mm_set1_pd(kInfinity);
  const std::uint32_t* const list = lists_.data() + nodes_[in].first;
  for (std::uint32_t i = 0; i < nodes_[in].count; ++i)
    take_nearer<1>(tree_.lines()[list[i]], &x, &y, &best);
  return std::sqrt(_mm_cvtsd_f64(best));
}

void DistanceField::evaluate(std::size_t n, const double* x, const double* y,
                             double* out) const noexcept {
  const __m128d cx = _mm_set1_pd(centre_.x);
  const __m128d cy = _mm_set1_pd(centre_.y);
  const __m128d scale = _mm_set1_pd(scale_);
  const __m128d unit = _mm_set1_pd(unit_);
  for (std::size_t k = 0; k < n; k += kLanes) {
    Lanes at;
    for (std::size_t i = 0; i < 4; ++i) {
      at.x[i] = _mm_mul_pd(_mm_sub_pd(_mm_load_pd(x + k + 2 * i), cx), scale);
      at.y[i] = _mm_mul_pd(_mm_sub_pd(_mm_load_pd(y + k + 2 * i), cy), scale);
    }
    __m128d distance[4];
    eight(at, distance);
    for (std::size_t i = 0; i < 4; ++i)
      _mm_store_pd(out + k + 2 * i, _mm_mul_pd(distance[i], unit));
  }
}

DistanceField::Around DistanceField::around(const Box& box) const noexcept {
  // Every point of the box lies, rounded, in the box of the rounded corners.
  const Point low = inside({box.min_x, box.min_y});
  const Point high = inside({box.max_x, box.max_y});
  const Point middle{0.5 * low.x + 0.5 * high.x, 0.5 * low.y + 0.5 * high.y};
  if (!(largest({low.x, low.y, high.x, high.y}) <= kFarthest))
    return {middle, kInfinity, 0, kInfinity};
  const double distance = one(middle);
  const double width = high.x - low.x;
  const double height = high.y - low.y;
  const double radius = 0.5 * std::sqrt(width * width + height * height);
  const double rounding =
      kRounding * (distance + radius + longest_ + std::fabs(middle.x) + std::fabs(middle.y));
  return {middle, radius, std::max(0.0, distance - radius - rounding),
          distance + radius + rounding};
}

Interval DistanceField::bounds_of(const Around& at) const noexcept {
  return {at.least * unit_, at.most * unit_, false};
}

Interval DistanceField::bounds(const Box& box) const noexcept {
  return bounds_of(around(box));
}

// The line that is nearest to some point of the box is at most at.most + at.radius away from the
// middle.
DistanceField::Near DistanceField::near(const LineTree::Numbers& numbers,
                                        const Box& box) const noexcept {
  const Around at = around(box);
  return {bounds_of(at), tree_.least_near(numbers, at.middle, at.most + at.radius)};
}

std::vector<Line> DistanceField::lines() const {
  std::vector<Line> lines;
  lines.reserve(tree_.lines().size());
  for (const StraightLine& line : tree_.lines())
    lines.push_back({outside(Point{line.ax, line.ay}), outside(line.end())});
  return lines;
}

std::unique_ptr<const Field> DistanceField::slope() const {
  return std::make_unique<const ConstantSize>(1.0);
}

}  // namespace weft
