// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/near_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "checker/domain/gaps.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {
namespace {

// Where the lines of two segments that cross meet, in more than double precision.
Vec2 crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const long double ux = static_cast<long double>(b.x) - a.x;
  const long double uy = static_cast<long double>(b.y) - a.y;
  const long double vx = static_cast<long double>(d.x) - c.x;
  const long double vy = static_cast<long double>(d.y) - c.y;
  const long double wx = static_cast<long double>(c.x) - a.x;
  const long double wy = static_cast<long double>(c.y) - a.y;
  const long double t = (wx * vy - wy * vx) / (ux * vy - uy * vx);
  return {static_cast<double>(a.x + t * ux), static_cast<double>(a.y + t * uy)};
}

// Of the angle between two segments.
double sine_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const double ux = b.x - a.x, uy = b.y - a.y, vx = d.x - c.x, vy = d.y - c.y;
  return std::fabs(ux * vy - uy * vx) / (std::hypot(ux, uy) * std::hypot(vx, vy));
}

class NearFeatureFinder {
 public:
  explicit NearFeatureFinder(const Domain& domain)
      : domain_(domain), rounding_(on_segment_tolerance(domain)), tree_(boxes(domain)) {
    found.merging_distance = merging_distance(domain);
    found.rounding = rounding_;
    found.may_move.assign(domain.points.size(), 0);
    found.bend.assign(domain.segments.size(), rounding_);
    surely_near_ = found.merging_distance * (1 - kMergingSlack);
    perhaps_near_ = found.merging_distance * (1 + kMergingSlack);
    reach_ = found.merging_distance * NearFeatures::kReach;
  }

  void compare_points() {
    std::vector<std::uint32_t> order(domain_.points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto at = [&](std::uint32_t i) { return domain_.points[i]; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      return at(i) == at(j) ? i < j : lexicographically_less(at(i), at(j));
    });
    std::vector<Box> boxes;
    boxes.reserve(order.size());
    for (const std::uint32_t i : order) boxes.push_back(box_of(at(i), at(i)));
    const BoxTree tree(std::move(boxes));
    for (std::uint32_t k = 0; k < order.size(); ++k) {
      const std::uint32_t i = order[k];
      tree.visit(box_of(at(i), at(i)).grown(perhaps_near_), [&](std::uint32_t l) {
        const std::uint32_t j = order[l];
        if (l <= k || at(i) == at(j)) return;
        const double distance = std::hypot(at(i).x - at(j).x, at(i).y - at(j).y);
        if (distance > perhaps_near_) return;
        found.may_move[i] = found.may_move[j] = 1;
        found.any = true;
        if (distance <= surely_near_) found.points.push_back({i, j});
      });
    }
  }

  // First finds what is nearer than T, then what that may move farther.
  void compare_points_and_segments() {
    std::vector<char> is_active = found.may_move;  // per point: whether something bends to it
    std::vector<Contacts::Touch> reached;
    for (std::uint32_t i = 0; i < domain_.points.size(); ++i) {
      const Vec2 p = domain_.points[i];
      visit_near(p, [&](std::uint32_t s, double distance) {
        const auto [a, b] = ends(s);
        if (p == a || p == b) return;
        if (distance <= surely_near_) found.touches.push_back({s, i});
        if (distance <= snap_distance(a, b)) return;
        reached.push_back({s, i});
        if (distance > perhaps_near_) return;
        is_active[i] = 1;
        loosen(s);
      });
    }
    for (const auto [segment, point] : reached)
      if (is_active[point]) loosen(segment);
    // A segment moves if one of its ends does.
    for (std::uint32_t s = 0; s < domain_.segments.size(); ++s)
      for (const std::uint32_t end : domain_.segments[s])
        if (found.may_move[end]) loosen(s);
  }

  void compare_crossings_and_segments(std::span<const Contacts::Crossing> crossings) {
    for (const Contacts::Crossing& crossing : crossings) {
      const auto [a, b] = ends(crossing.first);
      const auto [c, d] = ends(crossing.second);
      // Rounding moves where two cross by so many units in the last place over the sine.
      constexpr double kSharp = 0.25;
      const bool is_sharp = sine_of(a, b, c, d) < kSharp;
      visit_near(crossing_of(a, b, c, d), [&](std::uint32_t s, double distance) {
        if (s == crossing.first || s == crossing.second) return;
        const auto [e, f] = ends(s);
        const bool is_on_it = distance <= snap_distance(e, f) && !is_sharp;
        const std::array three{crossing.first, crossing.second, s};
        const auto is_bent = [&](std::uint32_t t) { return found.is_bent(t); };
        // What bends a segment moves its crossings, with what else passes there.
        if ((is_on_it || distance > perhaps_near_) &&
            std::none_of(three.begin(), three.end(), is_bent))
          return;
        for (const std::uint32_t t : three) loosen(t);
      });
    }
  }

  NearFeatures found;

 private:
  static std::vector<Box> boxes(const Domain& domain) {
    std::vector<Box> boxes;
    boxes.reserve(domain.segments.size());
    for (const auto [a, b] : domain.segments)
      boxes.push_back(box_of(domain.points[a], domain.points[b]));
    return boxes;
  }

  std::array<Vec2, 2> ends(std::uint32_t segment) const {
    const auto [a, b] = domain_.segments[segment];
    return {domain_.points[a], domain_.points[b]};
  }

  void loosen(std::uint32_t segment) {
    found.bend[segment] = std::max(rounding_, kMaxBend * perhaps_near_);
    found.any = true;
  }

  // Calls visit(s, distance) for every segment within reach of p.
  template <class Visit>
  void visit_near(Vec2 p, Visit&& visit) const {
    tree_.visit(box_of(p, p).grown(reach_), [&](std::uint32_t s) {
      const auto [a, b] = ends(s);
      const double distance = Track(a, b).distance(p);
      if (distance <= reach_) visit(s, distance);
    });
  }

  const Domain& domain_;
  double rounding_, surely_near_, perhaps_near_, reach_;
  BoxTree tree_;  // of the segments
};

}  // namespace

NearFeatures find_near_features(const Domain& domain, const Contacts& contacts) {
  NearFeatureFinder finder(domain);
  finder.compare_points();
  finder.compare_points_and_segments();
  finder.compare_crossings_and_segments(contacts.crossings);
  return std::move(finder.found);
}

}  // namespace weft::check
