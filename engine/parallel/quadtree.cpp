// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/quadtree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "engine/base/failure.h"

namespace weft {
namespace {

constexpr unsigned kMaxDepth = Quadtree::kMaxDepth;

// Spreads the bits of v to the even places.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 16) & 0x0000ffff0000ffff;
  v = (v | v << 8) & 0x00ff00ff00ff00ff;
  v = (v | v << 4) & 0x0f0f0f0f0f0f0f0f;
  v = (v | v << 2) & 0x3333333333333333;
  return (v | v << 1) & 0x5555555555555555;
}
std::uint64_t morton(std::uint64_t x, std::uint64_t y) {
  return spread(x) | spread(y) << 1;
}

// Places nodes: node (x, y) of a depth spans 2^(kMaxDepth - depth) cells each way. The coordinates
// of a border follow from its cell alone, so they are the same doubles for all nodes beside it.
class Grid {
 public:
  explicit Grid(const Box& domain)
      : origin_{domain.min_x, domain.min_y},
        cell_(std::max(domain.width(), domain.height()) * (1 + 0x1p-20) / (1u << kMaxDepth)) {}

  std::uint64_t column(double x) const { return cell_of(x - origin_.x); }
  std::uint64_t row(double y) const { return cell_of(y - origin_.y); }

  // The box from cell (x0, y0) to (x1, y1), in halves of cells.
  Box box(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) const {
    return {at(origin_.x, x0), at(origin_.y, y0), at(origin_.x, x1), at(origin_.y, y1)};
  }

 private:
  std::uint64_t cell_of(double offset) const {
    constexpr double kLast = (1u << kMaxDepth) - 1;
    return static_cast<std::uint64_t>(std::clamp(offset / cell_, 0.0, kLast));
  }
  double at(double origin, std::int64_t half_cells) const {
    return origin + 0.5 * cell_ * static_cast<double>(half_cells);
  }

  Point origin_;
  double cell_;
};

// The nodes to split, per depth, by Morton code. Throws Failure if there may not be so many.
class Splits {
 public:
  explicit Splits(const Quadtree::MayHave& may_have) : may_have_(may_have) {}

  void insert(unsigned depth, std::uint64_t code) {
    if (of_depth_[depth].insert(code).second && ++count_ == next_look_) look();
  }
  bool contains(unsigned depth, std::uint64_t code) const {
    return of_depth_[depth].contains(code);
  }
  const std::unordered_set<std::uint64_t>& at(unsigned depth) const { return of_depth_[depth]; }
  std::size_t nodes() const { return 1 + 4 * count_; }
  std::size_t leaves() const { return 1 + 3 * count_; }

  void look() {
    next_look_ = count_ + kBetweenLooks;
    if (auto error = may_have_(leaves())) throw Failure(*std::move(error));
  }

 private:
  static constexpr std::size_t kBetweenLooks = 1024;

  const Quadtree::MayHave& may_have_;
  std::array<std::unordered_set<std::uint64_t>, kMaxDepth + 1> of_depth_;
  std::size_t count_ = 0;
  std::size_t next_look_ = kBetweenLooks;
};

struct Keyed {
  std::uint64_t code;
  double weight;
};

void split_by_weight(Splits& splits, const Keyed* first, const Keyed* last, unsigned depth,
                     double target) {
  double weight = 0;
  for (const Keyed* s = first; s != last; ++s) weight += s->weight;
  if (weight <= target || last - first == 1 || depth == kMaxDepth) return;
  const unsigned shift = 2 * (kMaxDepth - depth);
  splits.insert(depth, first->code >> shift);
  for (unsigned child = 0; first != last; ++child) {
    const Keyed* const end = std::find_if(
        first, last, [&](const Keyed& s) { return (s.code >> (shift - 2) & 3) != child; });
    split_by_weight(splits, first, end, depth + 1, target);
    first = end;
  }
}

// Where a node is split, the eight around it must exist.
void balance(Splits& splits) {
  for (unsigned depth = kMaxDepth; depth >= 1; --depth) {
    const std::uint64_t across = std::uint64_t{1} << depth;
    for (const std::uint64_t code : splits.at(depth)) {
      std::uint64_t x = 0;
      std::uint64_t y = 0;
      for (unsigned bit = 0; bit < depth; ++bit) {
        x |= (code >> (2 * bit) & 1) << bit;
        y |= (code >> (2 * bit + 1) & 1) << bit;
      }
      for (std::uint64_t i = x == 0 ? 0 : x - 1; i <= x + 1 && i < across; ++i) {
        for (std::uint64_t j = y == 0 ? 0 : y - 1; j <= y + 1 && j < across; ++j)
          splits.insert(depth - 1, morton(i >> 1, j >> 1));
      }
    }
  }
}

// Moves leaf order[i] to place i, without a second list of them.
void put_in_order(std::vector<Quadtree::Leaf>& leaves, std::vector<std::uint32_t> order) {
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] == i) continue;
    const Quadtree::Leaf first = leaves[i];
    std::uint32_t hole = i;
    while (order[hole] != i) {
      leaves[hole] = leaves[order[hole]];
      hole = std::exchange(order[hole], hole);
    }
    leaves[hole] = first;
    order[hole] = hole;
  }
}

// The largest total weight of leaves that one line across a direction cuts. `place` is a leaf's
// place along that direction.
double most_cut(const std::vector<Quadtree::Leaf>& leaves, std::uint32_t Quadtree::Leaf::*place) {
  std::vector<std::pair<std::uint32_t, double>> changes;
  changes.reserve(2 * leaves.size());
  for (const Quadtree::Leaf& leaf : leaves) {
    const unsigned shift = kMaxDepth - leaf.depth;
    changes.push_back({leaf.*place << shift, leaf.weight});
    changes.push_back({(leaf.*place + 1) << shift, -leaf.weight});
  }
  std::sort(changes.begin(), changes.end());  // at the same place, ends come before starts
  double cut = 0;
  double most = 0;
  for (const auto& [at, change] : changes) {
    cut += change;
    most = std::max(most, cut);
  }
  return most;
}

}  // namespace

Result<Quadtree> Quadtree::build(const Box& domain, std::vector<Sample> samples, double target,
                                 const MayHave& may_have) try {
  const Grid grid(domain);
  std::vector<Keyed> keyed;
  keyed.reserve(samples.size());
  for (const Sample& s : samples)
    keyed.push_back({morton(grid.column(s.at.x), grid.row(s.at.y)), s.weight});
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const Keyed& a, const Keyed& b) { return a.code < b.code; });
  Splits splits(may_have);
  split_by_weight(splits, keyed.data(), keyed.data() + keyed.size(), 0, target);
  balance(splits);
  splits.look();

  Quadtree tree;
  tree.nodes_.reserve(splits.nodes());
  tree.leaves_.reserve(splits.leaves());
  auto next = keyed.cbegin();  // leaves come in Morton order, as the samples do
  const auto add = [&](auto& self, std::uint32_t index, unsigned depth, std::int64_t x,
                       std::int64_t y) -> void {
    const std::int64_t side = std::int64_t{2} << (kMaxDepth - depth);  // in halves of cells
    const std::int64_t x0 = x * side;
    const std::int64_t y0 = y * side;
    const auto is_split = [&](std::int64_t i, std::int64_t j) {
      return splits.contains(depth,
                             morton(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)));
    };
    // The margin on a side, where the neighbour is the node (i, j).
    const bool leaf = !is_split(x, y);
    const auto margin = [&](std::int64_t i, std::int64_t j) {
      const bool outside = std::min(i, j) < 0 || std::max(i, j) >= std::int64_t{1} << depth;
      return leaf && !outside && is_split(i, j) ? side / 4 : side / 2;
    };
    const Box halo = grid.box(x0 - margin(x - 1, y), y0 - margin(x, y - 1),
                              x0 + side + margin(x + 1, y), y0 + side + margin(x, y + 1));
    const Box centre = grid.box(x0 + side / 2, y0 + side / 2, x0 + side / 2, y0 + side / 2);
    tree.nodes_[index] = {{centre.min_x, centre.min_y}, halo, 0, 0};
    const auto code = morton(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y));
    if (leaf) {
      tree.nodes_[index].leaf = static_cast<std::uint32_t>(tree.leaves_.size());
      const unsigned shift = 2 * (kMaxDepth - depth);
      double weight = 0;
      for (; next != keyed.end() && next->code >> shift == code; ++next) weight += next->weight;
      tree.leaves_.push_back({grid.box(x0, y0, x0 + side, y0 + side), halo, weight, depth,
                              static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)});
      return;
    }
    const auto first = static_cast<std::uint32_t>(tree.nodes_.size());
    tree.nodes_[index].first_child = first;
    tree.nodes_.resize(tree.nodes_.size() + 4);
    for (unsigned child = 0; child < 4; ++child)
      self(self, first + child, depth + 1, 2 * x + (child & 1), 2 * y + (child >> 1));
  };
  tree.box_ = grid.box(0, 0, std::int64_t{2} << kMaxDepth, std::int64_t{2} << kMaxDepth);
  tree.nodes_.resize(1);
  add(add, 0, 0, 0, 0);
  tree.sweep();
  return tree;
} catch (const Failure& failure) {
  return tl::unexpected(failure.error());
}

// Sorts the leaves, which so far have their columns and rows for `along` and `across`.
void Quadtree::sweep() {
  const double along_x = most_cut(leaves_, &Leaf::along);
  const double along_y = most_cut(leaves_, &Leaf::across);
  if (along_y < along_x) {
    for (Leaf& leaf : leaves_) std::swap(leaf.along, leaf.across);
  }
  const auto key = [&](std::uint32_t l) {
    const Leaf& leaf = leaves_[l];
    const std::uint32_t middle = (2 * leaf.along + 1) << (kMaxDepth - leaf.depth);
    return std::tuple(middle, leaf.across);  // those with the same middle are equally large
  };
  std::vector<std::uint32_t> order(leaves_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  put_in_order(leaves_, std::move(order));
  for (Node& node : nodes_) {
    if (node.first_child == 0) node.leaf = place[node.leaf];
  }
}

std::uint32_t Quadtree::leaf_at(Point p) const {
  const Node* node = nodes_.data();
  while (node->first_child != 0) {
    const unsigned child = (p.x >= node->middle.x ? 1 : 0) | (p.y >= node->middle.y ? 2 : 0);
    node = &nodes_[node->first_child + child];
  }
  return node->leaf;
}

std::vector<std::uint32_t> Quadtree::touching(std::uint32_t leaf) const {
  // Borders are the same doubles, so boxes that touch do so exactly.
  const auto touch = [](const Box& a, const Box& b) {
    return a.min_x <= b.max_x && b.min_x <= a.max_x && a.min_y <= b.max_y && b.min_y <= a.max_y;
  };
  std::vector<std::uint32_t> result;
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    if (!touch(node.halo, leaves_[leaf].box)) continue;
    if (node.first_child != 0) {
      for (std::uint32_t child = 4; child-- > 0;) stack.push_back(node.first_child + child);
    } else if (node.leaf != leaf && touch(leaves_[node.leaf].box, leaves_[leaf].box)) {
      result.push_back(node.leaf);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<std::vector<std::uint32_t>> Quadtree::overlapping() const {
  std::vector<std::vector<std::uint32_t>> result(leaves_.size());
  for (std::uint32_t l = 0; l < leaves_.size(); ++l) {
    for_overlapping(leaves_[l].halo, [&](std::uint32_t other) {
      if (other != l) result[l].push_back(other);
    });
    std::sort(result[l].begin(), result[l].end());
  }
  return result;
}

}  // namespace weft
