// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/source_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/size/box_overlap.h"
#include "engine/size/domain_boxes.h"
#include "engine/size/fields/distance_field.h"
#include "engine/size/fields/polled_loop.h"
#include "engine/size/gradation/hull.h"
#include "engine/size/gradation/lowest_samples.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// More than the few operations of a comparison round.
constexpr double kSlack = 1e-9;
// The areas of edges below this are not normal numbers.
constexpr double kMinEdge = 1e-150;

// A box that is to be looked at.
struct Pending {
  DomainBox at;
  std::uint32_t node = 0;
  std::uint32_t family = 0;  // of Level::families
};

struct Level {
  std::vector<Pending> boxes;
  std::vector<std::uint32_t> triangles;
  std::vector<LowSamples> families;
  std::vector<std::uint32_t> children_of;  // slot at the level before -> first slot at this one
};

struct Seen {
  Interval edge;  // not below 0
  SizeSample sample;
};

enum class Fate : std::uint8_t { kDropped, kSource, kDivided };

struct Verdict {
  Fate fate = Fate::kDropped;
  Box box;          // of a source
  double edge = 0;  // of a source
  std::array<DomainBox, 4> children;
  LowSamples candidates;
};

// Boxes that one thread looks at.
struct Group {
  std::vector<Verdict> verdicts;
  std::vector<std::uint32_t> triangles;  // of the children, one after the other
  bool asked_how_far = false;            // the distance of a box to the border was needed
  bool blocked = false;                  // no walk may cross some box outside the domain
};

void reach(const Interval& edge, Interval& all) {
  all.lo = std::min(all.lo, edge.lo);
  all.hi = std::max(all.hi, edge.hi);
}

// Boxes as they were divided; `compact` makes nodes of them.
struct Draft {
  Box box;
  double edge = kInfinity;
  std::uint32_t first_child = 0;
};

class Builder {
 public:
  Builder(const SizeFunction& size, double gradation, const Domain& domain,
          const ExecutionContext& context, bool borders_count)
      : size_(size),
        gradation_(gradation),
        domain_(domain),
        context_(context),
        borders_count_(borders_count),
        hull_(domain.vertices) {
    for (const Point p : domain.vertices) around_.add(p);
  }

  // Returns false if the division did not come to an end: then borders have to count.
  Result<bool> run();
  std::vector<SourceTree::Node> compact();

 private:
  static constexpr std::size_t kAtATime = 64;  // boxes: about 20 us
  static constexpr std::size_t kGroupsAtATime = 256;

  void see(const DomainBox& at, const std::uint32_t* triangles, Seen& seen) const;
  SizeSample sample(const DomainBox& at, const std::uint32_t* triangles) const;
  std::optional<Error> judge(const Level& level, const std::vector<Seen>& seen, std::size_t slot,
                             int depth, bool may_divide, TrianglePoll& poll, Group& group) const;
  bool gentle(const Box& box, const Interval& edge) const;
  bool on_border(const DomainBox& at, const std::uint32_t* triangles) const;
  bool irrelevant(const Box& box, Group& group) const;
  std::optional<Error> measure_distance();
  Interval edges(const Box& box) const;
  Box shrunk(const DomainBox& at, const std::uint32_t* triangles) const;
  std::size_t take(const Level& level, const std::vector<Seen>& seen, std::size_t slot,
                   const Group& group, Level& next);
  std::optional<Error> hold(const Level& level, const Level& next);

  const SizeFunction& size_;
  const double gradation_;
  const Domain& domain_;
  const ExecutionContext& context_;
  const bool borders_count_;
  const Hull hull_;
  Box around_;
  Interval met_{kInfinity, 0};        // of edges in the boxes that are done
  Interval all_{kInfinity, 0};        // of edges in the domain
  std::optional<DistanceField> far_;  // to the border of the domain; made when it is asked for
  std::vector<Draft> drafts_;
  std::uint64_t held_ = 0;
};

Interval Builder::edges(const Box& box) const {
  const Interval areas = size_.bounds(box);
  if (areas.lo > areas.hi || !(areas.hi > 0)) return kUndefined;
  return {areas.lo > 0 ? SizeFunction::edge_of_area(areas.lo) : 0,
          SizeFunction::edge_of_area(areas.hi), areas.may_be_nan || !(areas.lo > 0)};
}

// The lowest of eight points.
SizeSample Builder::sample(const DomainBox& at, const std::uint32_t* triangles) const {
  alignas(64) std::array<double, Field::kLanes> x;
  alignas(64) std::array<double, Field::kLanes> y;
  alignas(64) std::array<double, Field::kLanes> area;
  const Box& b = at.box;
  const Point m = middle(b);
  constexpr std::uint32_t kFew = 16;
  const bool within = at.inside || (at.count <= kFew && !on_border(at, triangles));
  if (within) {
    x = {b.min_x, b.max_x, b.min_x, b.max_x, m.x, m.x, b.min_x, b.max_x};
    y = {b.min_y, b.min_y, b.max_y, b.max_y, b.min_y, b.max_y, m.y, m.y};
  } else {
    constexpr std::uint32_t kLooked = 4;
    CommonPart part{{}, 0};
    double largest = 0;
    for (std::uint32_t i = 0; i < std::min(at.count, kLooked); ++i) {
      const CommonPart other = common_part(b, corners_of(domain_, triangles[i]));
      const double other_area = other.area();
      if (!(other_area > largest)) continue;
      largest = other_area;
      part = other;
    }
    if (part.count == 0) return {};
    Point center;
    for (std::size_t i = 0; i < part.count; ++i) {
      center.x += part.corners[i].x / static_cast<double>(part.count);
      center.y += part.corners[i].y / static_cast<double>(part.count);
    }
    // Inwards from the sides, because the corners are rounded.
    constexpr double kInwards = 1e-3;
    for (std::size_t i = 0; i < Field::kLanes; ++i) {
      const Point p = i < part.count ? part.corners[i] : center;
      x[i] = p.x + kInwards * (center.x - p.x);
      y[i] = p.y + kInwards * (center.y - p.y);
    }
  }
  size_.evaluate(Field::kLanes, x.data(), y.data(), area.data());
  SizeSample best;
  double highest = 0;
  for (std::size_t i = 0; i < Field::kLanes; ++i) {
    best.bad = best.bad || !(area[i] >= 0);
    if (!(area[i] > 0)) continue;
    const double edge = SizeFunction::edge_of_area(area[i]);
    highest = std::max(highest, edge);
    if (edge < kMinEdge || edge >= best.edge) continue;
    best.p = {x[i], y[i]};
    best.edge = edge;
  }
  if (within && !best.bad) best.highest = highest;
  return best;
}

void Builder::see(const DomainBox& at, const std::uint32_t* triangles, Seen& seen) const {
  seen.edge = edges(at.box);
  seen.sample = seen.edge.lo <= seen.edge.hi && at.count > 0 ? sample(at, triangles) : SizeSample{};
}

// If the bounds are far apart, the steepness is not asked for: the children will decide.
bool Builder::gentle(const Box& box, const Interval& edge) const {
  constexpr double kFar = 8;
  if (edge.may_be_nan || edge.lo > edge.hi) return false;
  if (edge.lo == edge.hi) return true;
  if (edge.hi - edge.lo > kFar * gradation_ * diagonal(box)) return false;
  return size_.edge_steepness(box) <= gradation_ * (1 + kSlack);
}

bool Builder::on_border(const DomainBox& at, const std::uint32_t* triangles) const {
  if (at.inside) return false;
  for (std::uint32_t i = 0; i < at.count; ++i) {
    const Domain::Triangle& t = domain_.triangles[triangles[i]];
    const Corners c = corners_of(domain_, triangles[i]);
    for (unsigned k = 0; k < 3; ++k)
      if (t.neighbor[k] == kNone && meets(at.box, c[(k + 1) % 3], c[(k + 2) % 3])) return true;
  }
  return false;
}

// Whether no walk that matters crosses the box, which lies outside the domain. A walk there would
// be so long that a cone is above all sizes at its end.
bool Builder::irrelevant(const Box& box, Group& group) const {
  if (!far_) {
    group.asked_how_far = true;
    return false;
  }
  return all_.lo + 2 * gradation_ * far_->bounds(box).lo >= all_.hi * (1 + kSlack);
}

std::optional<Error> Builder::measure_distance() {
  std::vector<Line> borders;
  for (std::uint32_t t = 0; t < domain_.triangles.size(); ++t) {
    const Corners c = corners_of(domain_, t);
    for (unsigned k = 0; k < 3; ++k)
      if (domain_.triangles[t].neighbor[k] == kNone)
        borders.push_back({c[(k + 1) % 3], c[(k + 2) % 3]});
  }
  if (auto error = context_.need_bytes(
          domain_.bytes() + size_.bytes() + held_ + DistanceField::bytes_to_make(borders.size()),
          "the gradation"))
    return error;
  // It is asked for outside of the domain, and too seldom for lists to pay.
  auto made = DistanceField::make(std::move(borders), DomainCover::nothing_of(around_), context_);
  if (!made) return std::move(made).error();
  far_.emplace(std::move(*made));
  return std::nullopt;
}

// The part of a box that the domain has. If no walk crosses a box outside the domain, none needs
// more than this part.
Box Builder::shrunk(const DomainBox& at, const std::uint32_t* triangles) const {
  constexpr std::uint32_t kFew = 16;
  if (!borders_count_ || at.inside || at.count > kFew) return at.box;
  Box around;
  for (std::uint32_t i = 0; i < at.count; ++i) {
    const CommonPart part = common_part(at.box, corners_of(domain_, triangles[i]));
    for (std::size_t k = 0; k < part.count; ++k) around.add(part.corners[k]);
  }
  return around.min_x <= around.max_x ? around : at.box;
}

std::optional<Error> Builder::judge(const Level& level, const std::vector<Seen>& seen,
                                    std::size_t slot, int depth, bool may_divide,
                                    TrianglePoll& poll, Group& group) const {
  constexpr int kBadDepth = 6;      // how fine to look where no mesh will be made
  constexpr int kNoSizeDepth = 10;  // how fine, if the size has no value outside the domain
  const Pending& pending = level.boxes[slot];
  const DomainBox& at = pending.at;
  const std::uint32_t* const triangles = level.triangles.data() + at.first;
  const Interval& edge = seen[slot].edge;
  Verdict& verdict = group.verdicts.emplace_back();
  const bool outside = at.count == 0;
  if (outside && hull_.misses(at.box)) return std::nullopt;
  if (!outside && (edge.lo > edge.hi || (seen[slot].sample.bad && depth >= kBadDepth)))
    return std::nullopt;

  LowestSamples lowest(middle(at.box), gradation_);
  const LowSamples& family = level.families[pending.family];
  for (std::size_t i = 0; i < family.count; ++i) {
    LowSample candidate = family.best[i];
    const std::uint32_t children =
        candidate.slot != kNone ? level.children_of[candidate.slot] : kNone;
    candidate.slot = kNone;
    lowest.add(candidate);
    if (children == kNone) continue;
    for (std::uint32_t s = children;
         s < level.boxes.size() && level.boxes[s].family == level.boxes[children].family; ++s)
      lowest.add({seen[s].sample, s});
  }
  if (family.count == 0) lowest.add({seen[slot].sample, static_cast<std::uint32_t>(slot)});
  verdict.candidates = lowest.found();

  if (verdict.candidates.below(edge.lo * (1 - kSlack), at.box, gradation_)) return std::nullopt;
  const bool border = borders_count_ && on_border(at, triangles);
  if (!border && gentle(at.box, edge)) return std::nullopt;
  const double finest = std::max(SourceTree::kTolerance, SourceTree::kSmallest * gradation_);
  // Seen from any point, one of the box's samples is at most half a side farther than the box.
  const double off = std::min(gradation_ * diagonal(at.box),
                              seen[slot].sample.highest - edge.lo +
                                  0.5 * gradation_ * std::max(at.box.width(), at.box.height()));
  const bool resolved = off <= finest * edge.lo;
  if (outside) {
    if (irrelevant(at.box, group)) return std::nullopt;
    const bool no_size = !(edge.lo <= edge.hi) || (edge.may_be_nan && depth >= kNoSizeDepth);
    if (resolved || !may_divide || (no_size && far_)) {
      group.blocked = true;
      return std::nullopt;
    }
  }
  if (!outside && (resolved || !may_divide)) {
    verdict.fate = Fate::kSource;
    verdict.box = shrunk(at, triangles);
    verdict.edge = edge.lo;
    if (verdict.edge >= kMinEdge) return std::nullopt;
    const SizeSample& sample = seen[slot].sample;
    verdict.box = {sample.p.x, sample.p.y, sample.p.x, sample.p.y};
    verdict.edge = sample.edge;
    if (!(sample.edge < kInfinity)) verdict.fate = Fate::kDropped;
    return std::nullopt;
  }
  verdict.fate = Fate::kDivided;
  return split(at, level.triangles.data(), domain_, poll, verdict.children, group.triangles);
}

std::optional<Error> Builder::hold(const Level& level, const Level& next) {
  const auto of = [](const Level& l) {
    return l.boxes.capacity() * (sizeof(Pending) + sizeof(Seen)) +
           l.triangles.capacity() * sizeof(std::uint32_t) +
           l.families.capacity() * sizeof(LowSamples);
  };
  const std::uint64_t bytes = domain_.bytes() + size_.bytes() + (far_ ? far_->bytes() : 0) +
                              drafts_.capacity() * (sizeof(Draft) + sizeof(SourceTree::Node)) +
                              of(level) + of(next);
  if (bytes <= held_) return std::nullopt;
  held_ = std::max(bytes, std::min(bytes + bytes / 2, context_.budget().max_bytes));
  return context_.need_bytes(held_, "the gradation");
}

// Returns the sources among them.
std::size_t Builder::take(const Level& level, const std::vector<Seen>& seen, std::size_t slot,
                          const Group& group, Level& next) {
  std::size_t sources = 0;
  auto first = static_cast<std::uint32_t>(next.triangles.size());
  next.triangles.insert(next.triangles.end(), group.triangles.begin(), group.triangles.end());
  for (const Verdict& verdict : group.verdicts) {
    Draft& draft = drafts_[level.boxes[slot].node];
    if (verdict.fate != Fate::kDivided && level.boxes[slot].at.count > 0)
      reach(seen[slot].edge, met_);
    if (verdict.fate == Fate::kSource) {
      draft.box = verdict.box;
      draft.edge = verdict.edge;
      ++sources;
    }
    if (verdict.fate == Fate::kDivided) {
      draft.first_child = static_cast<std::uint32_t>(drafts_.size());
      next.children_of[slot] = static_cast<std::uint32_t>(next.boxes.size());
      const auto family = static_cast<std::uint32_t>(next.families.size());
      next.families.push_back(verdict.candidates);
      const std::uint32_t node = draft.first_child;
      for (unsigned c = 0; c < 4; ++c) {
        DomainBox at = verdict.children[c];
        drafts_.push_back({at.box, kInfinity, 0});
        at.first += first;
        if (at.count > 0 || !borders_count_) next.boxes.push_back({at, node + c, family});
      }
    }
    ++slot;
  }
  return sources;
}

Result<bool> Builder::run() {
  Level level;
  level.boxes.push_back({whole_domain(domain_, root_square(domain_), level.triangles), 0, 0});
  level.families.emplace_back();
  drafts_.push_back({level.boxes[0].at.box, kInfinity, 0});
  std::vector<Seen> seen;
  std::vector<Group> groups;
  std::size_t sources = 0;
  for (int depth = 0; !level.boxes.empty(); ++depth) {
    all_ = met_;
    seen.resize(level.boxes.size());
    const std::size_t count = (level.boxes.size() + kAtATime - 1) / kAtATime;
    const auto each = [&](std::size_t g, auto&& f) -> std::optional<Error> {
      const std::size_t end = std::min((g + 1) * kAtATime, level.boxes.size());
      for (std::size_t i = g * kAtATime; i < end; ++i)
        if (auto error = f(i)) return error;
      return std::nullopt;
    };
    if (auto error = polled_loop(context_, count, [&](std::size_t g) {
          return each(g, [&](std::size_t i) {
            const DomainBox& at = level.boxes[i].at;
            see(at, level.triangles.data() + at.first, seen[i]);
            return std::optional<Error>();
          });
        }))
      return tl::unexpected(*error);
    for (std::size_t i = 0; i < level.boxes.size(); ++i)
      if (level.boxes[i].at.count > 0) reach(seen[i].edge, all_);
    const bool room = sources + 4 * level.boxes.size() <= SourceTree::kMaxSources;
    const bool may_divide = depth < SourceTree::kMaxDepth && room;
    Level next;
    next.children_of.assign(level.boxes.size(), kNone);
    bool asked_how_far = false;
    for (std::size_t from = 0; from < count; from += kGroupsAtATime) {
      groups.assign(std::min(kGroupsAtATime, count - from), {});
      if (auto error = polled_loop(context_, groups.size(), [&](std::size_t g) {
            TrianglePoll poll(context_);
            return each(from + g, [&](std::size_t i) {
              return judge(level, seen, i, depth, may_divide, poll, groups[g]);
            });
          }))
        return tl::unexpected(*error);
      for (std::size_t g = 0; g < groups.size(); ++g) {
        if (groups[g].blocked) return false;
        asked_how_far = asked_how_far || groups[g].asked_how_far;
        sources += take(level, seen, (from + g) * kAtATime, groups[g], next);
      }
      if (auto error = hold(level, next)) return tl::unexpected(*error);
    }
    if (asked_how_far && !far_) {
      if (auto error = measure_distance()) return tl::unexpected(*error);
    }
    level = std::move(next);
  }
  return true;
}

// Drops nodes without a source, and replaces those with a single child by that child.
std::vector<SourceTree::Node> Builder::compact() {
  // Bottom up: the box and the least edge of the sources below.
  std::vector<Draft>& whole = drafts_;
  for (std::size_t i = whole.size(); i-- > 0;) {
    Draft& draft = whole[i];
    if (draft.first_child == 0) continue;
    Box box;
    for (unsigned c = 0; c < 4; ++c) {
      const Draft& child = whole[draft.first_child + c];
      if (child.edge == kInfinity) continue;
      box.merge(child.box);
      draft.edge = std::min(draft.edge, child.edge);
    }
    draft.box = box;
  }
  std::vector<SourceTree::Node> nodes;
  if (whole[0].edge == kInfinity) return nodes;
  std::vector<std::uint32_t> from;  // the draft of each node
  const auto add = [&](std::uint32_t d) {
    for (;;) {  // skips nodes with a single child
      std::uint32_t only = kNone;
      unsigned count = 0;
      for (unsigned c = 0; c < 4 && whole[d].first_child != 0; ++c) {
        if (whole[whole[d].first_child + c].edge == kInfinity) continue;
        only = whole[d].first_child + c;
        ++count;
      }
      if (count != 1) break;
      d = only;
    }
    nodes.push_back({whole[d].box, whole[d].edge, 0, 0});
    from.push_back(d);
  };
  add(0);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::uint32_t child = whole[from[n]].first_child;
    if (child == 0) continue;
    nodes[n].first_child = static_cast<std::uint32_t>(nodes.size());
    for (unsigned c = 0; c < 4; ++c) {
      if (whole[child + c].edge == kInfinity) continue;
      ++nodes[n].children;
      add(child + c);
    }
  }
  nodes.shrink_to_fit();
  return nodes;
}

}  // namespace

double SourceTree::Node::diagonal() const {
  return weft::diagonal(box);
}

std::size_t SourceTree::sources() const {
  return static_cast<std::size_t>(
      std::count_if(nodes_.begin(), nodes_.end(), [](const Node& n) { return n.source(); }));
}

Result<SourceTree> SourceTree::build(const SizeFunction& size, double gradation,
                                     const Domain& domain, const ExecutionContext& context) {
  SourceTree tree;
  if (size.constant() || domain.triangles.empty()) return tree;
  for (const bool borders_count : {false, true}) {
    Builder builder(size, gradation, domain, context, borders_count);
    const Result<bool> ended = builder.run();
    if (!ended) return tl::unexpected(ended.error());
    if (!*ended) continue;
    tree.nodes_ = builder.compact();
    break;
  }
  return tree;
}

}  // namespace weft
