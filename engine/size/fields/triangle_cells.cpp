// SPDX-License-Identifier: Apache-2.0
#include "engine/size/fields/triangle_cells.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/size/fields/polled_loop.h"

namespace weft {
namespace {

using List = std::vector<std::uint32_t>;

// The allowance of a subtree per triangle, in entries of lists; a node counts as kNodeCost of them.
constexpr std::uint64_t kListedPerTriangle = 12;
constexpr std::uint64_t kListedBesides = 1 << 12;
constexpr std::uint64_t kNodeCost = 2;
constexpr std::size_t kInLeaf = 12;     // if it can be divided
constexpr std::size_t kMaxInLeaf = 32;  // a list that is hardly slower than the tree
constexpr std::size_t kAtATime = 1 << 14;

// The cells of the last level that a triangle's box meets.
struct Cells {
  std::uint32_t first_x, first_y, last_x, last_y;
};

}  // namespace

// Builds a part of the quadtree: its nodes, the root first, and the lists of its leaves.
class CellBuilder {
 public:
  using Node = TriangleCells::Node;
  // A node that is still to be built.
  struct Pending {
    std::uint32_t node = 0;
    int depth = 0;
    std::uint32_t ix = 0;
    std::uint32_t iy = 0;
    std::uint64_t allowed = 0;  // for its subtree
  };
  struct Later {
    Pending pending;
    List list;
  };

  // Nodes with up to `later_below` triangles that are to be divided stay in `later`.
  CellBuilder(const std::vector<Cells>& cells, std::size_t later_below,
              const ExecutionContext& context)
      : cells_(cells), later_below_(later_below), context_(context) {}

  std::optional<Error> build(Pending root, List list) {
    nodes.assign(1, {});
    root.node = 0;
    stack_ = std::move(list);
    auto error = divide(root, 0);
    stack_ = {};
    return error;
  }

  std::vector<Node> nodes;
  List lists;
  std::vector<Later> later;

 private:
  static constexpr unsigned kChildren = 4;

  std::optional<Error> divide(const Pending& pending, std::size_t first);
  void add_leaf(const Pending& pending, std::size_t first);
  // The children that a triangle's box meets, a bit each.
  unsigned met(const Cells& cells, std::uint32_t middle_x, std::uint32_t middle_y) const {
    const unsigned columns =
        (cells.first_x < middle_x ? 0b0101u : 0u) | (cells.last_x >= middle_x ? 0b1010u : 0u);
    const unsigned rows =
        (cells.first_y < middle_y ? 0b0011u : 0u) | (cells.last_y >= middle_y ? 0b1100u : 0u);
    return columns & rows;
  }

  const std::vector<Cells>& cells_;
  const std::size_t later_below_;
  const ExecutionContext& context_;
  List stack_;  // the lists of a node, its parent and so on, the last one first
  std::vector<std::uint8_t> met_;
};

void CellBuilder::add_leaf(const Pending& pending, std::size_t first) {
  const std::size_t count = stack_.size() - first;
  if (count > kMaxInLeaf) return;  // stays kTooMany
  nodes[pending.node] = {static_cast<std::uint32_t>(lists.size()),
                         static_cast<std::uint32_t>(count)};
  lists.insert(lists.end(), stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end());
}

// The node's list is that on the stack from `first` on.
std::optional<Error> CellBuilder::divide(const Pending& pending, std::size_t first) {
  const std::size_t count = stack_.size() - first;
  if (count <= kInLeaf || pending.depth == TriangleCells::kMaxDepth) {
    add_leaf(pending, first);
    return std::nullopt;
  }
  if (count <= later_below_) {
    later.push_back({pending, {stack_.begin() + static_cast<std::ptrdiff_t>(first), stack_.end()}});
    return std::nullopt;
  }
  const int bit = TriangleCells::kMaxDepth - pending.depth - 1;
  const std::uint32_t middle_x = (2 * pending.ix + 1) << bit;
  const std::uint32_t middle_y = (2 * pending.iy + 1) << bit;
  met_.resize(count);
  std::array<std::size_t, kChildren> counts{};
  for (std::size_t i = 0; i < count; ++i) {
    if (i % kAtATime == kAtATime - 1) {
      if (auto error = context_.poll()) return error;
    }
    const unsigned children = met(cells_[stack_[first + i]], middle_x, middle_y);
    met_[i] = static_cast<std::uint8_t>(children);
    for (unsigned c = 0; c < kChildren; ++c) counts[c] += children >> c & 1;
  }
  const std::uint64_t cost = counts[0] + counts[1] + counts[2] + counts[3] + kChildren * kNodeCost;
  if (cost > pending.allowed) {
    add_leaf(pending, first);
    return std::nullopt;
  }
  // The children's lists, the last child's first, so that each is the last on the stack in turn.
  const std::size_t end = stack_.size();
  stack_.resize(end + static_cast<std::size_t>(cost) - kChildren * kNodeCost);
  std::array<std::size_t, kChildren> firsts{};
  std::size_t next = end;
  for (unsigned c = kChildren; c-- > 0;) {
    firsts[c] = next;
    next += counts[c];
  }
  std::array<std::size_t, kChildren> to = firsts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t place = stack_[first + i];
    for (unsigned left = met_[i]; left != 0; left &= left - 1)
      stack_[to[static_cast<unsigned>(__builtin_ctz(left))]++] = place;
  }
  const auto child = static_cast<std::uint32_t>(nodes.size());
  nodes.resize(child + kChildren);
  nodes[pending.node] = {child, TriangleCells::kInner};
  for (unsigned c = 0; c < kChildren; ++c) {
    const Pending of_child{child + c, pending.depth + 1, 2 * pending.ix + (c & 1),
                           2 * pending.iy + (c >> 1),
                           pending.allowed * (counts[c] + kNodeCost) / cost};
    if (auto error = divide(of_child, firsts[c])) return error;
    stack_.resize(firsts[c]);
  }
  return std::nullopt;
}

std::optional<Error> TriangleCells::build(const TriangleTree& tree,
                                          const ExecutionContext& context) {
  constexpr std::size_t kParts = 64;
  constexpr std::size_t kSmallPart = 1 << 12;
  box_ = tree.box();
  cells_per_unit_ = (1u << kMaxDepth) / std::max(box_.width(), box_.height());
  const auto& triangles = tree.triangles();
  const std::size_t n = triangles.size();
  std::vector<Cells> cells(n);
  // Of each number, the place of the triangle. Numbers of flat triangles are left out.
  std::uint32_t numbers = 0;
  for (const NumberedTriangle& t : triangles) numbers = std::max(numbers, t.number + 1);
  List order(numbers, kNone);
  const auto stop = polled_loop(context, (n + kAtATime - 1) / kAtATime, [&](std::size_t group) {
    const std::size_t end = std::min((group + 1) * kAtATime, n);
    for (std::size_t i = group * kAtATime; i < end; ++i) {
      const auto place = static_cast<std::uint32_t>(i);
      Box box;
      for (int k = 0; k < 3; ++k) box.add(tree.corner(place, k));
      cells[i] = {column(box.min_x), row(box.min_y), column(box.max_x), row(box.max_y)};
      order[triangles[i].number] = place;
    }
  });
  if (stop) return stop;
  order.erase(std::remove(order.begin(), order.end(), kNone), order.end());

  CellBuilder top(cells, std::max(n / kParts, kSmallPart), context);
  CellBuilder::Pending root;
  root.allowed = kListedPerTriangle * n + kListedBesides;
  if (auto error = top.build(root, std::move(order))) return error;
  std::vector<CellBuilder> parts;
  parts.reserve(top.later.size());
  std::vector<std::uint32_t> places;
  for (const auto& later : top.later) {
    parts.emplace_back(cells, 0, context);
    places.push_back(later.pending.node);
  }
  if (auto error = polled_loop(context, parts.size(), [&](std::size_t i) {
        return parts[i].build(top.later[i].pending, std::move(top.later[i].list));
      }))
    return error;

  // Joins the parts, one behind the other.
  std::size_t nodes = top.nodes.size();
  std::size_t listed = top.lists.size();
  for (const CellBuilder& part : parts) {
    nodes += part.nodes.size() - 1;
    listed += part.lists.size();
  }
  nodes_ = std::move(top.nodes);
  lists_ = std::move(top.lists);
  nodes_.reserve(nodes);
  lists_.reserve(listed);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    CellBuilder& part = parts[i];
    const auto node_offset = static_cast<std::uint32_t>(nodes_.size() - 1);
    const auto list_offset = static_cast<std::uint32_t>(lists_.size());
    for (Node& node : part.nodes) {
      if (node.count != kTooMany) node.first += node.count == kInner ? node_offset : list_offset;
    }
    nodes_[places[i]] = part.nodes[0];
    nodes_.insert(nodes_.end(), part.nodes.begin() + 1, part.nodes.end());
    lists_.insert(lists_.end(), part.lists.begin(), part.lists.end());
    part.nodes = {};
    part.lists = {};
  }
  while (top_levels_ < kMaxTopLevels && std::size_t{1} << (2 * top_levels_) < nodes_.size())
    ++top_levels_;
  table_.resize(std::size_t{1} << (2 * top_levels_));
  fill_table(0, 0, 0, 0);
  return std::nullopt;
}

void TriangleCells::fill_table(std::uint32_t node, int depth, std::uint32_t ix, std::uint32_t iy) {
  if (nodes_[node].count == kInner && depth < top_levels_) {
    for (std::uint32_t c = 0; c < 4; ++c)
      fill_table(nodes_[node].first + c, depth + 1, 2 * ix + (c & 1), 2 * iy + (c >> 1));
    return;
  }
  const std::uint32_t side = 1u << (top_levels_ - depth);
  for (std::uint32_t j = iy * side; j < (iy + 1) * side; ++j)
    std::fill_n(table_.begin() + (j << top_levels_ | ix * side), side, node);
}

}  // namespace weft
