// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/decimation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/simplify/chains.h"
#include "engine/domain/simplify/point_tree.h"
#include "engine/domain/simplify/turns.h"
#include "engine/domain/triangulation/filtered.h"

namespace weft {
namespace {

class Decimation {
 public:
  Decimation(LineGraph& graph, const NearLines& original, double share, double tolerance,
             StopPoller& poller)
      : graph_(graph),
        original_(original),
        share_(share),
        tolerance_(tolerance),
        poller_(poller),
        used_(used_points(graph)),
        is_twin_(find_twins(graph, used_)),
        tree_(graph.points, used_, poller),
        chains_(chains_of(graph, poller)),
        version_(chains_.nodes.size(), 0),
        is_mixed_(chains_.nodes.size(), false) {
    error_.reserve(chains_.nodes.size());
    for (const Node& node : chains_.nodes) error_.push_back(node.error);
  }

  Dropped run() {
    drop_specks();
    // What blocks a node may go after it; angles below 60 degrees are made only if lines would stay
    // too short without.
    for (const double least_turn : {kTurn60, kTurn45}) {
      least_turn_ = least_turn;
      for (int passes = 0; passes < kMaxPasses && pass(); ++passes) {
      }
    }
    drop_specks();
    set_lines(chains_, error_, graph_);
    return dropped_;
  }

 private:
  using Node = Chains::Node;
  using Chain = Chains::Chain;

  struct Candidate {
    double cost;
    std::uint32_t node;
    std::uint32_t version;
    friend bool operator<(const Candidate& a, const Candidate& b) {
      return a.cost != b.cost ? a.cost > b.cost : a.node > b.node;
    }
  };

  Point at(std::uint32_t node) const { return graph_.points[chains_.nodes[node].point]; }
  double finest(std::uint32_t node) const { return graph_.finest[chains_.nodes[node].point]; }

  template <class Visit>
  void for_each_node(const Chain& chain, Visit&& visit) const {
    for (std::uint32_t n = chain.start;;) {
      visit(n);
      n = chains_.nodes[n].after;
      if (n == kNone || n == chain.start) return;
    }
  }

  void drop_specks() {
    for (Chain& chain : chains_.chains)
      if (chain.is_ring && !chain.is_dropped && is_speck(chain)) drop(chain);
  }

  // Whether a ring is too small to keep, and holds nothing.
  bool is_speck(const Chain& ring) {
    double doubled = 0;
    double least = std::numeric_limits<double>::infinity();
    Box box;
    const Point origin = at(ring.start);
    for_each_node(ring, [&](std::uint32_t n) {
      poller_.step();
      const Point p = at(n), q = at(chains_.nodes[n].after);
      doubled += (p.x - origin.x) * (q.y - origin.y) - (p.y - origin.y) * (q.x - origin.x);
      least = std::min(least, finest(n));
      box.add(p);
    });
    if (!(std::fabs(doubled) < 2 * kFinestTriangle * least * least)) return false;
    std::vector<bool>& is_own = mark_;
    is_own.resize(graph_.points.size(), false);
    for_each_node(ring, [&](std::uint32_t n) { is_own[chains_.nodes[n].point] = true; });
    const bool is_empty = tree_.for_each_in(box, [&](std::uint32_t v) {
      poller_.step();
      return is_own[v] || is_twin_[v] || !is_in(ring, graph_.points[v]);
    });
    for_each_node(ring, [&](std::uint32_t n) { is_own[chains_.nodes[n].point] = false; });
    return is_empty;
  }

  bool is_in(const Chain& ring, Point p) const {
    bool inside = false;
    for_each_node(ring, [&](std::uint32_t n) {
      Point a = at(n), b = at(chains_.nodes[n].after);
      if ((a.y > p.y) == (b.y > p.y)) return;
      if (a.y > b.y) std::swap(a, b);
      if (orientation(a, b, p) > 0) inside = !inside;
    });
    return inside;
  }

  void drop(Chain& ring) {
    double doubled = 0;
    const Point origin = at(ring.start);
    for_each_node(ring, [&](std::uint32_t n) {
      const Point p = at(n), q = at(chains_.nodes[n].after);
      doubled += (p.x - origin.x) * (q.y - origin.y) - (p.y - origin.y) * (q.x - origin.x);
      tree_.remove(chains_.nodes[n].point);
    });
    const std::uint32_t inner = doubled > 0 ? ring.left : ring.right;
    const std::uint32_t outer = doubled > 0 ? ring.right : ring.left;
    if (inner == kNone) ++dropped_.islands;
    if (outer == kNone) ++dropped_.waters;
    ring.is_dropped = true;
  }

  // Takes nodes out, cheapest first. Returns whether there was one.
  bool pass() {
    queue_ = {};
    for (std::uint32_t n = 0; n < version_.size(); ++n)
      if (version_[n] != kGone && !chains_.chains[chains_.nodes[n].chain].is_dropped) consider(n);
    bool any = false;
    while (!queue_.empty()) {
      poller_.step();
      const Candidate best = queue_.top();
      queue_.pop();
      if (best.version != version_[best.node]) continue;
      const auto cost = cost_of(best.node);
      if (!cost) continue;  // what was taken out elsewhere forbids it now
      take_out(best.node);
      any = true;
    }
    return any;
  }

  void take_out(std::uint32_t v) {
    const std::uint32_t u = chains_.nodes[v].before, w = chains_.nodes[v].after;
    const double allowed = share_ * least_finest(u, w);
    const std::uint32_t like = marked_like(u, v, w, allowed);
    is_mixed_[u] =
        is_mixed_[u] || is_mixed_[v] || chains_.nodes[u].marker != chains_.nodes[v].marker;
    error_[u] = is_mixed_[u] ? allowed : std::min(error_of(u, w), allowed);
    chains_.nodes[u].segment = chains_.nodes[like].segment;
    chains_.nodes[u].marker = chains_.nodes[like].marker;
    tree_.remove(chains_.nodes[v].point);
    chains_.remove(v);
    version_[v] = kGone;
    for (const std::uint32_t n : {u, w}) {
      ++version_[n];
      consider(n);
    }
  }

  void consider(std::uint32_t v) {
    poller_.step();
    if (chains_.is_held(v) || !is_wanted(v)) return;
    if (const auto cost = cost_of(v)) queue_.push({*cost, v, version_[v]});
  }

  bool is_short(std::uint32_t u, std::uint32_t v) const {
    return distance(at(u), at(v)) < std::min(finest(u), finest(v));
  }

  bool is_wanted(std::uint32_t v) const {
    const std::uint32_t point = chains_.nodes[v].point;
    return graph_.original[point] == kNone || is_twin_[point] ||
           is_short(chains_.nodes[v].before, v) || is_short(v, chains_.nodes[v].after);
  }

  // Of the line uw in the place of the chain from u to w.
  double error_of(std::uint32_t u, std::uint32_t w) {
    const Point a = at(u), b = at(w);
    double error = 0;
    double from = 0;
    for (std::uint32_t n = u; n != w;) {
      poller_.step();
      const std::uint32_t next = chains_.originally_after(n);
      const double to = next == w ? 0 : distance_to_segment(at(next), a, b);
      error = std::max(error, std::max(from, to) + chains_.nodes[n].error);
      from = to;
      n = next;
    }
    return error;
  }

  double least_finest(std::uint32_t u, std::uint32_t w) const {
    double least = std::min(finest(u), finest(w));
    for (std::uint32_t n = u; n != w; n = chains_.originally_after(n))
      least = std::min(least, finest(n));
    return least;
  }

  // What taking the node out costs; nullopt if it must stay.
  std::optional<double> cost_of(std::uint32_t v) {
    constexpr std::uint32_t kMinRing = 3;
    const Node& node = chains_.nodes[v];
    const std::uint32_t u = node.before, w = node.after;
    const Chain& chain = chains_.chains[node.chain];
    if (chain.is_ring && chain.length <= kMinRing) return std::nullopt;
    if (is_joined(u, w)) return std::nullopt;
    const double allowed = share_ * least_finest(u, w);
    if (!(allowed > 0)) return std::nullopt;
    const double error = error_of(u, w);
    const bool bounds_domain = (chain.left == kNone) != (chain.right == kNone);
    if (error > allowed && !bounds_domain) return std::nullopt;
    if (!keeps_angles(u, v, w, chain) || !is_free(u, v, w, chain)) return std::nullopt;
    if (error > allowed && !original_.holds_near({at(u), at(v), at(w)}, allowed))
      return std::nullopt;
    if (marked_like(u, v, w, allowed) == kNone) return std::nullopt;
    return error / allowed;
  }

  // The node, u or v, whose line has the marker that a line uw has; kNone if it may have neither.
  std::uint32_t marked_like(std::uint32_t u, std::uint32_t v, std::uint32_t w, double allowed) {
    const bool is_pure =
        !is_mixed_[u] && !is_mixed_[v] && chains_.nodes[u].marker == chains_.nodes[v].marker;
    if (is_pure && error_of(u, w) <= allowed) return u;
    const bool u_is_longer = distance(at(u), at(v)) >= distance(at(v), at(w));
    for (const std::uint32_t n : {u_is_longer ? u : v, u_is_longer ? v : u})
      if (original_.holds_near({at(u), at(w), at(w)}, allowed, chains_.nodes[n].marker)) return n;
    return kNone;
  }

  // Whether a line between u and w might be there already.
  bool is_joined(std::uint32_t u, std::uint32_t w) const {
    const std::uint32_t p = chains_.nodes[u].point, q = chains_.nodes[w].point;
    if (p == q || (is_twin_[p] && is_twin_[q])) return true;
    if (!chains_.is_held(u) || !chains_.is_held(w)) return false;
    for (const auto& [point, end] : chains_.ends_at(p)) {
      const Node& node = chains_.nodes[end];
      const std::uint32_t next = node.before == kNone ? node.after : node.before;
      if (chains_.nodes[next].point == q) return true;
    }
    return false;
  }

  // The least angle inside the domain at a node with these neighbours.
  static double inner_turn(Point before, Point at, Point after, const Chain& chain) {
    double least = 4;
    if (chain.left != kNone) least = std::min(least, turn(after, at, before));
    if (chain.right != kNone) least = std::min(least, turn(before, at, after));
    return least;
  }

  // The least angle at the end u of a chain, if its line leads to `next`.
  double held_turn(std::uint32_t u, Point next) const {
    double least = 2;
    for (const auto& [point, end] : chains_.ends_at(chains_.nodes[u].point)) {
      if (end == u || chains_.chains[chains_.nodes[end].chain].is_dropped) continue;
      const Node& node = chains_.nodes[end];
      const std::uint32_t neighbour = node.before == kNone ? node.after : node.before;
      least = std::min(least, turn_between(next, at(u), at(neighbour)));
    }
    return least;
  }

  bool keeps_angles(std::uint32_t u, std::uint32_t v, std::uint32_t w, const Chain& chain) const {
    const auto turn_of_u = [&](Point next) {
      return chains_.is_held(u) ? held_turn(u, next)
                                : inner_turn(at(chains_.nodes[u].before), at(u), next, chain);
    };
    const auto turn_of_w = [&](Point next) {
      return chains_.is_held(w) ? held_turn(w, next)
                                : inner_turn(next, at(w), at(chains_.nodes[w].after), chain);
    };
    const double after = std::min(turn_of_u(at(w)), turn_of_w(at(u)));
    if (after >= least_turn_) return true;
    const double now =
        std::min({turn_of_u(at(v)), turn_of_w(at(v)), inner_turn(at(u), at(v), at(w), chain)});
    return after >= now;
  }

  // Whether nothing else is in the triangle or too near to uw.
  bool is_free(std::uint32_t u, std::uint32_t v, std::uint32_t w, const Chain& chain) {
    const Point a = at(u), b = at(v), c = at(w);
    const int side = orientation(a, b, c);
    if (is_twin_[chains_.nodes[v].point]) {
      // The other chain through this place is on the side that is not meshed.
      const std::uint32_t here = side > 0 ? chain.left : chain.right;
      if (side == 0 || here == kNone || !(chain.left == kNone || chain.right == kNone))
        return false;
    }
    Box box;
    for (const Point p : {a, b, c}) box.add(p);
    box.min_x -= tolerance_, box.min_y -= tolerance_;
    box.max_x += tolerance_, box.max_y += tolerance_;
    return tree_.for_each_in(box, [&](std::uint32_t x) {
      poller_.step();
      const Point p = graph_.points[x];
      if (p == a || p == b || p == c) return true;
      if (distance_to_segment(p, a, c) < tolerance_) return false;
      if (side == 0) return true;
      return orientation(a, b, p) * side < 0 || orientation(b, c, p) * side < 0 ||
             orientation(c, a, p) * side < 0;
    });
  }

  static constexpr std::uint32_t kGone = kNone;
  static constexpr int kMaxPasses = 8;

  LineGraph& graph_;
  const NearLines& original_;
  const double share_;
  const double tolerance_;
  StopPoller& poller_;
  std::vector<bool> used_;
  std::vector<bool> is_twin_;
  PointTree tree_;
  Chains chains_;
  std::vector<double> error_;           // per node: of the line after it
  std::vector<std::uint32_t> version_;  // per node: changes with its neighbours
  std::vector<bool> is_mixed_;  // per node: whether the line after it replaces several markers
  std::vector<bool> mark_;      // per point
  std::priority_queue<Candidate> queue_;
  double least_turn_ = 0;
  Dropped dropped_;
};

}  // namespace

Dropped decimate(LineGraph& graph, const NearLines& original, double share, double tolerance,
                 StopPoller& poller) {
  return Decimation(graph, original, share, tolerance, poller).run();
}

}  // namespace weft
