// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/limit_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/size/box_overlap.h"
#include "engine/size/domain_boxes.h"
#include "engine/size/fields/polled_loop.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// More than the few operations of a comparison round.
constexpr double kSlack = 1e-12;

using Source = SourceTree::Node;

// The cone at (x, y). Every operation rounds monotonically, so the bounds below are bounds of what
// this computes.
double cone(const Source& source, double gradation, double dx, double dy) {
  return source.edge + gradation * std::sqrt(dx * dx + dy * dy);
}
double beyond(double lo, double hi, double x) {
  return std::max(std::max(lo - x, x - hi), 0.0);
}
double cone_at(const Source& s, double gradation, double x, double y) {
  return cone(s, gradation, beyond(s.box.min_x, s.box.max_x, x),
              beyond(s.box.min_y, s.box.max_y, y));
}
double lowest_over(const Source& s, double gradation, const Box& box) {
  const double dx = std::max(std::max(s.box.min_x - box.max_x, box.min_x - s.box.max_x), 0.0);
  const double dy = std::max(std::max(s.box.min_y - box.max_y, box.min_y - s.box.max_y), 0.0);
  return cone(s, gradation, dx, dy);
}
double highest_over(const Source& s, double gradation, const Box& box) {
  const double dx = std::max(std::max(s.box.min_x - box.min_x, box.max_x - s.box.max_x), 0.0);
  const double dy = std::max(std::max(s.box.min_y - box.min_y, box.max_y - s.box.max_y), 0.0);
  return cone(s, gradation, dx, dy);
}
// Of the cone of some source below the node.
double highest_below(const Source& s, double gradation, double x, double y) {
  return cone(s, gradation, std::max(s.box.max_x - x, x - s.box.min_x),
              std::max(s.box.max_y - y, y - s.box.min_y));
}

using List = std::vector<std::uint32_t>;

struct Pending {
  DomainBox at;
  std::uint32_t node = 0;
  std::uint32_t first = 0;  // of the parent's list
  std::uint32_t count = 0;
};

struct Level {
  std::vector<Pending> boxes;
  std::vector<std::uint32_t> triangles;
  List lists;
};

struct Verdict {
  bool divided = false;
  std::uint32_t listed = 0;  // of a leaf's list, or the one for its children
  double lo = kInfinity;     // of a leaf
  double hi = kInfinity;
  std::array<DomainBox, 4> children;
};

struct Group {
  std::vector<Verdict> verdicts;
  std::vector<std::uint32_t> triangles;
  List lists;
};

}  // namespace

class LimitTreeBuilder {
 public:
  LimitTreeBuilder(LimitTree& tree, const SizeFunction& size, const Domain& domain,
                   const ExecutionContext& context)
      : tree_(tree),
        sources_(tree.sources_.nodes()),
        gradation_(tree.gradation_),
        size_(size),
        domain_(domain),
        context_(context) {}

  std::optional<Error> run();

 private:
  static constexpr std::size_t kAtATime = 64;  // boxes: about 50 us
  static constexpr std::size_t kGroupsAtATime = 256;
  static constexpr std::size_t kShort = 24;    // a leaf's list
  static constexpr std::size_t kTooLong = 96;  // a longer list is given up at once

  static constexpr std::size_t kCorners = 4;
  static constexpr std::size_t kSpots = 5;  // the corners and the middle

  // A node's cone over a box.
  struct Over {
    std::array<double, kSpots> above;    // the lowest cone below the node is no higher
    std::array<double, kCorners> below;  // a plane that is below all of these cones
  };
  struct Scratch {
    List list;  // what may be the lowest somewhere in a box
    List opened;
    std::vector<Over> over;
  };

  bool stands_for_all(const Source& s, const Box& box) const {
    return s.source() ||
           gradation_ * s.diagonal() <= SourceTree::kTolerance * lowest_over(s, gradation_, box);
  }
  void prune(Scratch& scratch, const Box& box, double highest) const;
  template <class Opens>
  bool open(Scratch& scratch, const Box& box, double highest, std::size_t most_listed,
            Opens opens) const;
  std::optional<Error> judge(const Level& level, const Pending& pending, bool may_divide,
                             TrianglePoll& poll, Scratch& scratch, Group& group) const;
  void take(const Level& level, std::size_t slot, const Group& group, Level& next);
  std::optional<Error> hold(const Level& level, const Level& next);
  void sum_up();

  LimitTree& tree_;
  const std::vector<Source>& sources_;
  const double gradation_;
  const SizeFunction& size_;
  const Domain& domain_;
  const ExecutionContext& context_;
  std::uint64_t held_ = 0;
};

// Drops a node if another node, or the size, is lower everywhere in the box.
//
// The cone of m is convex. That of n is above its tangent plane at the middle of the box. So if m
// is below that plane at the four corners, it is below n's cone in all of the box. The nodes that
// are lowest at each corner and in the middle are tried as m.
void LimitTreeBuilder::prune(Scratch& scratch, const Box& box, double highest) const {
  List& list = scratch.list;
  std::vector<Over>& over = scratch.over;
  over.clear();
  const Point m = middle(box);
  const std::array<double, kSpots> x{box.min_x, box.max_x, box.min_x, box.max_x, m.x};
  const std::array<double, kSpots> y{box.min_y, box.min_y, box.max_y, box.max_y, m.y};
  std::size_t kept = 0;
  for (const std::uint32_t n : list) {
    const Source& s = sources_[n];
    const double lowest = lowest_over(s, gradation_, box);
    if (lowest >= highest) continue;
    list[kept++] = n;
    const bool stands = s.source() || gradation_ * s.diagonal() <= SourceTree::kTolerance * lowest;
    Over& at = over.emplace_back();
    for (std::size_t i = 0; i < kSpots; ++i)
      at.above[i] =
          stands ? cone_at(s, gradation_, x[i], y[i]) : highest_below(s, gradation_, x[i], y[i]);
    const double dx = m.x - std::min(std::max(m.x, s.box.min_x), s.box.max_x);
    const double dy = m.y - std::min(std::max(m.y, s.box.min_y), s.box.max_y);
    const double d = std::sqrt(dx * dx + dy * dy);
    const double middle_of_cone = s.edge + gradation_ * d;
    const double slope = d > 0 ? gradation_ / d : 0;
    for (std::size_t i = 0; i < kCorners; ++i)
      at.below[i] =
          std::max(lowest, middle_of_cone + slope * (dx * (x[i] - m.x) + dy * (y[i] - m.y)));
  }
  list.resize(kept);
  if (kept < 2) return;
  std::array<std::size_t, kSpots> lowest{};
  for (std::size_t n = 1; n < kept; ++n)
    for (std::size_t i = 0; i < kSpots; ++i)
      if (over[n].above[i] < over[lowest[i]].above[i]) lowest[i] = n;
  kept = 0;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const bool dropped = std::any_of(lowest.begin(), lowest.end(), [&](std::size_t l) {
      bool all = true;
      for (std::size_t i = 0; i < kCorners; ++i)
        all = all && over[l].above[i] < over[n].below[i] * (1 - kSlack);
      return all;
    });
    if (!dropped) list[kept++] = list[n];
  }
  list.resize(kept);
}

// Replaces each node that `opens` by its children, until there is none. Returns false if the list
// grew too long.
template <class Opens>
bool LimitTreeBuilder::open(Scratch& scratch, const Box& box, double highest,
                            std::size_t most_listed, Opens opens) const {
  List& list = scratch.list;
  List& opened = scratch.opened;
  for (bool again = true; again;) {
    again = false;
    opened.clear();
    for (const std::uint32_t n : list) {
      const Source& s = sources_[n];
      if (s.source() || !opens(s)) {
        opened.push_back(n);
        continue;
      }
      again = true;
      for (std::uint32_t c = 0; c < s.children; ++c) opened.push_back(s.first_child + c);
    }
    if (!again) break;
    list.swap(opened);
    prune(scratch, box, highest);
    if (list.size() > most_listed) return false;
  }
  return true;
}

std::optional<Error> LimitTreeBuilder::judge(const Level& level, const Pending& pending,
                                             bool may_divide, TrianglePoll& poll, Scratch& scratch,
                                             Group& group) const {
  const Box& box = pending.at.box;
  Verdict& verdict = group.verdicts.emplace_back();
  const Interval areas = size_.bounds(box);
  const double highest = areas.lo <= areas.hi && areas.hi > 0
                             ? SizeFunction::edge_of_area(areas.hi) * (1 + 1e-12)
                             : kInfinity;
  List& list = scratch.list;
  list.assign(level.lists.begin() + pending.first,
              level.lists.begin() + pending.first + pending.count);
  prune(scratch, box, highest);
  const auto leaf = [&] {
    verdict.listed = static_cast<std::uint32_t>(list.size());
    for (const std::uint32_t n : list) {
      verdict.lo = std::min(verdict.lo, lowest_over(sources_[n], gradation_, box));
      verdict.hi = std::min(verdict.hi, highest_over(sources_[n], gradation_, box));
    }
    group.lists.insert(group.lists.end(), list.begin(), list.end());
    return std::nullopt;
  };
  if (!may_divide) {
    if (list.size() > kTooLong) list.assign(1, 0);
    return leaf();
  }
  const double size = diagonal(box);
  open(scratch, box, highest, std::numeric_limits<std::size_t>::max(),
       [&](const Source& s) { return s.diagonal() > 0.5 * size && !stands_for_all(s, box); });
  if (list.empty()) return leaf();
  if (pending.at.count == 0) {
    const auto lowest =
        std::min_element(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
          return highest_over(sources_[a], gradation_, box) <
                 highest_over(sources_[b], gradation_, box);
        });
    list.assign(1, *lowest);
    return leaf();
  }
  const std::size_t before = list.size();
  double lowest = kInfinity;
  for (const std::uint32_t n : list)
    lowest = std::min(lowest, lowest_over(sources_[n], gradation_, box));
  // The box is as small as the sources beside it.
  const bool small = gradation_ * size <= SourceTree::kTolerance * lowest;
  if (before <= kShort || small) {
    List kept = list;
    const std::size_t longest = small ? std::numeric_limits<std::size_t>::max() : kTooLong;
    if (open(scratch, box, highest, longest,
             [&](const Source& s) { return !stands_for_all(s, box); }) &&
        (small || list.size() <= kShort))
      return leaf();
    list.swap(kept);
  }
  verdict.divided = true;
  verdict.listed = static_cast<std::uint32_t>(list.size());
  group.lists.insert(group.lists.end(), list.begin(), list.end());
  return split(pending.at, level.triangles.data(), domain_, poll, verdict.children,
               group.triangles);
}

void LimitTreeBuilder::take(const Level& level, std::size_t slot, const Group& group, Level& next) {
  const auto first = static_cast<std::uint32_t>(next.triangles.size());
  next.triangles.insert(next.triangles.end(), group.triangles.begin(), group.triangles.end());
  std::size_t from = 0;
  for (const Verdict& verdict : group.verdicts) {
    const std::uint32_t at = level.boxes[slot++].node;
    List& to = verdict.divided ? next.lists : tree_.lists_;
    const auto listed = static_cast<std::uint32_t>(to.size());
    to.insert(to.end(), group.lists.begin() + static_cast<std::ptrdiff_t>(from),
              group.lists.begin() + static_cast<std::ptrdiff_t>(from + verdict.listed));
    from += verdict.listed;
    if (!verdict.divided) {
      tree_.nodes_[at] = {0, listed, verdict.listed, verdict.lo, verdict.hi};
      continue;
    }
    const auto child = static_cast<std::uint32_t>(tree_.nodes_.size());
    tree_.nodes_[at].first_child = child;
    tree_.nodes_.resize(child + 4);
    for (unsigned c = 0; c < 4; ++c) {
      DomainBox box = verdict.children[c];
      box.first += first;
      next.boxes.push_back({box, child + c, listed, verdict.listed});
    }
  }
}

std::optional<Error> LimitTreeBuilder::hold(const Level& level, const Level& next) {
  const auto of = [](const Level& l) {
    return l.boxes.capacity() * sizeof(Pending) +
           (l.triangles.capacity() + l.lists.capacity()) * sizeof(std::uint32_t);
  };
  const std::uint64_t bytes =
      domain_.bytes() + size_.bytes() + tree_.bytes() + of(level) + of(next);
  if (bytes <= held_) return std::nullopt;
  held_ = std::max(bytes, std::min(bytes + bytes / 2, context_.budget().max_bytes));
  return context_.need_bytes(held_, "the gradation");
}

std::optional<Error> LimitTreeBuilder::run() {
  Level level;
  level.lists.push_back(0);
  level.boxes.push_back({whole_domain(domain_, tree_.root_, level.triangles), 0, 0, 1});
  tree_.nodes_.emplace_back();
  std::vector<Group> groups;
  for (int depth = 0; !level.boxes.empty(); ++depth) {
    const std::size_t count = (level.boxes.size() + kAtATime - 1) / kAtATime;
    Level next;
    for (std::size_t from = 0; from < count; from += kGroupsAtATime) {
      groups.assign(std::min(kGroupsAtATime, count - from), {});
      const bool may_divide =
          depth < LimitTree::kMaxDepth &&
          tree_.nodes_.size() + 4 * kGroupsAtATime * kAtATime <= LimitTree::kMaxNodes &&
          tree_.lists_.size() + next.lists.size() <= LimitTree::kMaxListed;
      if (auto error =
              polled_loop(context_, groups.size(), [&](std::size_t g) -> std::optional<Error> {
                TrianglePoll poll(context_);
                Scratch scratch;
                const std::size_t begin = (from + g) * kAtATime;
                const std::size_t end = std::min(begin + kAtATime, level.boxes.size());
                for (std::size_t i = begin; i < end; ++i)
                  if (auto stop =
                          judge(level, level.boxes[i], may_divide, poll, scratch, groups[g]))
                    return stop;
                return std::nullopt;
              }))
        return error;
      for (std::size_t g = 0; g < groups.size(); ++g)
        take(level, (from + g) * kAtATime, groups[g], next);
      if (auto error = hold(level, next)) return error;
    }
    level = std::move(next);
  }
  sum_up();
  return std::nullopt;
}

// Children come after their parents.
void LimitTreeBuilder::sum_up() {
  for (std::size_t i = tree_.nodes_.size(); i-- > 0;) {
    LimitTree::Node& node = tree_.nodes_[i];
    if (node.first_child == 0) continue;
    node.lo = kInfinity;
    node.hi = -kInfinity;
    for (unsigned c = 0; c < 4; ++c) {
      node.lo = std::min(node.lo, tree_.nodes_[node.first_child + c].lo);
      node.hi = std::max(node.hi, tree_.nodes_[node.first_child + c].hi);
    }
  }
}

Result<LimitTree> LimitTree::build(SourceTree sources, const SizeFunction& size, double gradation,
                                   const Domain& domain, const ExecutionContext& context) {
  LimitTree tree;
  tree.sources_ = std::move(sources);
  tree.gradation_ = gradation;
  if (tree.empty()) return tree;
  tree.root_ = root_square(domain);
  if (auto error = LimitTreeBuilder(tree, size, domain, context).run())
    return tl::unexpected(*error);
  tree.nodes_.shrink_to_fit();
  tree.lists_.shrink_to_fit();
  return tree;
}

const LimitTree::Node& LimitTree::leaf(double x, double y) const noexcept {
  const Node* node = nodes_.data();
  Box at = root_;
  while (node->first_child != 0) {
    const Point m = middle(at);
    const bool right = x >= m.x;
    const bool upper = y >= m.y;
    (right ? at.min_x : at.max_x) = m.x;
    (upper ? at.min_y : at.max_y) = m.y;
    node = &nodes_[node->first_child + (right ? 1 : 0) + (upper ? 2 : 0)];
  }
  return *node;
}

void LimitTree::evaluate(const double* x, const double* y, double* edge) const noexcept {
  constexpr std::size_t kLanes = Field::kLanes;
  std::array<double, kLanes> px;
  std::array<double, kLanes> py;
  std::array<const Node*, kLanes> leaves;
  for (std::size_t i = 0; i < kLanes; ++i) {
    px[i] = std::min(std::max(x[i], root_.min_x), root_.max_x);
    py[i] = std::min(std::max(y[i], root_.min_y), root_.max_y);
    leaves[i] = &leaf(px[i], py[i]);
  }
  const Source* const sources = sources_.nodes().data();
  unsigned left = (1u << kLanes) - 1;
  while (left != 0) {
    const Node& node = *leaves[static_cast<std::size_t>(__builtin_ctz(left))];
    unsigned here = 0;
    for (std::size_t i = 0; i < kLanes; ++i) here |= static_cast<unsigned>(leaves[i] == &node) << i;
    left &= ~here;
    std::array<double, kLanes> least;
    least.fill(kInfinity);
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Source& source = sources[lists_[k]];
      for (std::size_t i = 0; i < kLanes; ++i)
        least[i] = std::min(least[i], cone_at(source, gradation_, px[i], py[i]));
    }
    for (unsigned lanes = here; lanes != 0; lanes &= lanes - 1) {
      const auto i = static_cast<std::size_t>(__builtin_ctz(lanes));
      edge[i] = least[i];
    }
  }
}

// Recursion ends kMaxDepth below the root.
void LimitTree::add_bounds(const Node& node, const Box& at, const Box& box,
                           Interval& found) const noexcept {
  constexpr double kFine = 0.125;  // of the size of the box: smaller nodes are not looked into
  const bool within = at.min_x >= box.min_x && at.max_x <= box.max_x && at.min_y >= box.min_y &&
                      at.max_y <= box.max_y;
  const bool fine = at.width() < kFine * std::max(box.width(), box.height());
  if (within || fine || node.lo == node.hi) {
    found.lo = std::min(found.lo, node.lo);
    found.hi = std::max(found.hi, node.hi);
    return;
  }
  if (node.first_child == 0) {
    const Box common{std::max(at.min_x, box.min_x), std::max(at.min_y, box.min_y),
                     std::min(at.max_x, box.max_x), std::min(at.max_y, box.max_y)};
    double lo = kInfinity;
    double hi = kInfinity;
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Source& source = sources_.nodes()[lists_[k]];
      lo = std::min(lo, lowest_over(source, gradation_, common));
      hi = std::min(hi, highest_over(source, gradation_, common));
    }
    found.lo = std::min(found.lo, lo);
    found.hi = std::max(found.hi, hi);
    return;
  }
  const Point m = middle(at);
  for (unsigned c = 0; c < 4; ++c) {
    const bool meets = (c & 1 ? box.max_x >= m.x : box.min_x <= m.x) &&
                       (c & 2 ? box.max_y >= m.y : box.min_y <= m.y);
    if (meets) add_bounds(nodes_[node.first_child + c], child_box(at, c), box, found);
  }
}

Interval LimitTree::bounds(const Box& box) const noexcept {
  const auto clamped = [](double v, double lo, double hi) { return std::min(std::max(v, lo), hi); };
  const Box common{
      clamped(box.min_x, root_.min_x, root_.max_x), clamped(box.min_y, root_.min_y, root_.max_y),
      clamped(box.max_x, root_.min_x, root_.max_x), clamped(box.max_y, root_.min_y, root_.max_y)};
  Interval found{kInfinity, -kInfinity, false};
  add_bounds(nodes_.front(), root_, common, found);
  return found;
}

}  // namespace weft
