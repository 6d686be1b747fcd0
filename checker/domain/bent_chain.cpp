// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/bent_chain.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace weft::check {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The least costly path through what lies along one segment. A step costs the area between it and
// the segment. A jump, or a step back, costs more than any steps forward over the same length, and
// each jump has a fixed cost. The first part of a jump is cheap, and a step of another segment
// costs as much as a long jump, so that a path does not follow the edges of others to make its
// jumps shorter.
class PathSearch {
 public:
  PathSearch(const Mesh& mesh, const Track& track, std::span<const Step> steps, double bend,
             const ChainEnd& from, const ChainEnd& to, Jumps jumps)
      : bend_(bend), jumps_(jumps), jumps_last_(jumps != Jumps::kFree) {
    const auto stop = [&](std::optional<std::uint32_t> vertex, Vec2 at) {
      return Stop{vertex, at, track.position(at), track.distance(at)};
    };
    stops_.push_back(stop(from.vertex, from.at));
    for (const Step& step : steps)
      for (const std::uint32_t v : {step.from, step.to})
        if (v != from.vertex && v != to.vertex) stops_.push_back(stop(v, mesh.vertices[v]));
    std::sort(stops_.begin() + 1, stops_.end(), [](const Stop& s, const Stop& t) {
      return s.position != t.position ? s.position < t.position : s.vertex < t.vertex;
    });
    stops_.erase(std::unique(stops_.begin() + 1, stops_.end(),
                             [](const Stop& s, const Stop& t) { return s.vertex == t.vertex; }),
                 stops_.end());
    stops_.push_back(stop(to.vertex, to.at));
    add_links(steps);
  }

  std::vector<ChainStop> path() {
    std::vector<ChainStop> result;
    if (jumps_last_) {
      search(false);
      result = trace();
    }
    if (result.empty()) {
      search(true);
      result = trace();
    }
    return result;
  }

 private:
  struct Stop {
    std::optional<std::uint32_t> vertex;
    Vec2 at;
    double position, distance;  // along the segment, and from it
    double cost = kInfinite;
    std::size_t before = 0;
    bool jumped = false;
  };
  struct Link {
    std::size_t from, to;  // indices of stops; each link is there in both directions
    bool is_of_another;
  };

  void add_links(std::span<const Step> steps) {
    std::vector<std::pair<std::uint32_t, std::size_t>> numbers;  // of mesh vertices
    for (std::size_t i = 0; i < stops_.size(); ++i)
      if (stops_[i].vertex) numbers.emplace_back(*stops_[i].vertex, i);
    std::sort(numbers.begin(), numbers.end());
    const auto number = [&](std::uint32_t v) {
      return std::lower_bound(numbers.begin(), numbers.end(), std::pair{v, std::size_t{0}})->second;
    };
    for (const Step& step : steps) {
      const std::size_t from = number(step.from), to = number(step.to);
      links_.push_back({from, to, step.is_of_another});
      links_.push_back({to, from, step.is_of_another});
    }
    std::sort(links_.begin(), links_.end(),
              [](const Link& a, const Link& b) { return a.from < b.from; });
    first_link_.assign(stops_.size() + 1, 0);
    for (const Link& link : links_) ++first_link_[link.from + 1];
    std::partial_sum(first_link_.begin(), first_link_.end(), first_link_.begin());
  }

  // Rounds of going forward through all stops, each followed by the links from what steps back have
  // improved. One is enough unless there are steps back.
  void search(bool with_jumps) {
    for (Stop& stop : stops_) stop.cost = kInfinite;
    stops_[0].cost = 0;
    for (Queue improved; go_forward(with_jumps, improved), !improved.empty();) settle(improved);
  }

  using Queue = std::priority_queue<std::pair<double, std::size_t>,
                                    std::vector<std::pair<double, std::size_t>>, std::greater<>>;

  // Notes the stops that steps back have improved, with their costs.
  void go_forward(bool with_jumps, Queue& improved) {
    double best_jump = kInfinite;  // the cost at a stop far before, minus that of its position
    std::size_t jump_from = 0, far = 0;
    std::deque<std::size_t> cheapest;  // of the near stops, by position; the first is the cheapest
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      Stop& stop = stops_[i];
      if (with_jumps) {
        for (; far < i && stops_[far].position < stop.position - cheap_reach(); ++far) {
          const double cost = stops_[far].cost - price() * stops_[far].position;
          if (cost < best_jump) {
            best_jump = cost;
            jump_from = far;
          }
        }
        reach(stop, best_jump + jump() + price() * (stop.position - cheap_reach()), jump_from,
              true);
        // Only the ends may be out of order: from the first, and to the last, each jump counts.
        const bool is_last = i + 1 == stops_.size();
        for (std::size_t near = far; near < (is_last ? i : std::min<std::size_t>(i, 1)); ++near)
          jump_nearby(near, stop);
        while (!cheapest.empty() && cheapest.front() < far) cheapest.pop_front();
        if (!cheapest.empty()) jump_nearby(cheapest.front(), stop);
      }
      for (const Link& link : links_of(i)) {
        Stop& next = stops_[link.to];
        if (reach(next, stop.cost + cost_of(link), i, false) && link.to < i)
          improved.emplace(next.cost, link.to);
      }
      if (i == 0) continue;
      while (!cheapest.empty() && nearby_cost(cheapest.back()) > nearby_cost(i))
        cheapest.pop_back();
      cheapest.push_back(i);
    }
  }

  // Dijkstra's search along links.
  void settle(Queue& improved) {
    while (!improved.empty()) {
      const auto [cost, i] = improved.top();
      improved.pop();
      if (cost > stops_[i].cost) continue;
      for (const Link& link : links_of(i))
        if (reach(stops_[link.to], cost + cost_of(link), i, false))
          improved.emplace(stops_[link.to].cost, link.to);
    }
  }

  std::span<const Link> links_of(std::size_t i) const {
    return std::span(links_).subspan(first_link_[i], first_link_[i + 1] - first_link_[i]);
  }

  // The fixed cost, above what is cheap.
  double jump() const { return (jumps_ == Jumps::kShortest ? 1 : 9) * price() * bend_; }
  void jump_nearby(std::size_t near, Stop& stop) {
    const double length = std::max(0.0, stop.position - stops_[near].position);
    reach(stop, stops_[near].cost + jump() + bend_ / 8 * length, near, true);
  }
  // What tells stops apart from which to jump nearby.
  double nearby_cost(std::size_t i) const {
    return stops_[i].cost - bend_ / 8 * stops_[i].position;
  }

  double cost_of(const Link& link) const {
    const Stop &stop = stops_[link.from], &next = stops_[link.to];
    return link.is_of_another && !jumps_last_ ? cost_beside(stop, next) : cost_along(stop, next);
  }
  double cost_along(const Stop& stop, const Stop& next) const {
    const double forward = next.position - stop.position;
    const double beside = (weight(stop.distance) + weight(next.distance)) / 2;
    return forward > 0 ? beside * forward : price() * -forward;
  }
  // A little more than that of a longer jump, so that there is no tie; less than a jump's own.
  double cost_beside(const Stop& stop, const Stop& next) const {
    return price() * (std::hypot(next.at.x - stop.at.x, next.at.y - stop.at.y) + 0x1p-12 * bend_);
  }

  // The price of a unit of length.
  double price() const { return jumps_last_ ? 16 * bend_ : 2 * bend_ / kMaxBend; }
  double weight(double distance) const {
    const double beyond = distance - bend_ / kMaxBend;
    return jumps_last_ || beyond < 0 ? distance : distance + 16 * beyond;
  }
  double cheap_reach() const { return jumps_ == Jumps::kShortest ? 0 : 8 * bend_; }

  static bool reach(Stop& stop, double cost, std::size_t before, bool jumped) {
    if (!(cost < stop.cost)) return false;
    stop.cost = cost;
    stop.before = before;
    stop.jumped = jumped;
    return true;
  }

  // Empty if there is no path, or if it turns back too far.
  std::vector<ChainStop> trace() const {
    std::vector<ChainStop> result;
    if (!(stops_.back().cost < kInfinite)) return result;
    double least = kInfinite;
    for (std::size_t i = stops_.size() - 1;; i = stops_[i].before) {
      const Stop& stop = stops_[i];
      if (stop.position > least + bend_) return {};
      least = std::min(least, stop.position);
      result.push_back({stop.vertex, stop.at, stop.jumped});
      if (i == 0) break;
    }
    std::reverse(result.begin(), result.end());
    return result;
  }

  double bend_;
  Jumps jumps_;
  bool jumps_last_;
  std::vector<Stop> stops_;  // ascending, but for the ends
  std::vector<Link> links_;  // by `from`
  std::vector<std::size_t> first_link_;
};

}  // namespace

std::vector<ChainStop> bent_chain(const Mesh& mesh, const Track& track, std::span<const Step> steps,
                                  double bend, const ChainEnd& from, const ChainEnd& to,
                                  Jumps jumps) {
  if (from.vertex && from.vertex == to.vertex) return {{from.vertex, from.at}};
  return PathSearch(mesh, track, steps, bend, from, to, jumps).path();
}

}  // namespace weft::check
