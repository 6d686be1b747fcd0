// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/bent_chain.h"

#include <algorithm>
#include <limits>

namespace weft::check {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The least costly path through what lies along one segment. A step costs the area between it and
// the segment. A jump, or a step back, costs more than any steps forward over the same length, and
// a jump something by itself; but the first bit of a jump is cheap, so that a path does not follow
// the edges of others to jump less far.
class PathSearch {
 public:
  PathSearch(const Mesh& mesh, const Track& track, std::span<const Step> steps, double bend,
             const ChainEnd& from, const ChainEnd& to, bool jumps_last)
      : bend_(bend), jumps_last_(jumps_last) {
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
    std::size_t from, to;  // stops; both ways are there
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
      links_.push_back({from, to});
      links_.push_back({to, from});
    }
    std::sort(links_.begin(), links_.end(),
              [](const Link& a, const Link& b) { return a.from < b.from; });
  }

  // Rounds of going forward through all stops: one is enough, but for steps back.
  void search(bool with_jumps) {
    for (Stop& stop : stops_) stop.cost = kInfinite;
    stops_[0].cost = 0;
    for (bool changed = true; changed;) {
      changed = false;
      double best_jump = kInfinite;  // the cost at a stop far before, less what its place is worth
      std::size_t jump_from = 0, far = 0;
      auto link = links_.begin();
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
          const double jump = 8 * price() * bend_;  // by itself
          reach(stop, best_jump + jump + price() * (stop.position - cheap_reach()), jump_from,
                true);
          for (std::size_t near = far; near < i; ++near) {
            const double length = std::max(0.0, stop.position - stops_[near].position);
            reach(stop, stops_[near].cost + jump + bend_ / 8 * length, near, true);
          }
        }
        for (; link != links_.end() && link->from == i; ++link) {
          Stop& next = stops_[link->to];
          const double forward = next.position - stop.position;
          const double beside = (weight(stop.distance) + weight(next.distance)) / 2;
          const double cost = forward > 0 ? beside * forward : price() * -forward;
          if (reach(next, stop.cost + cost, i, false) && link->to < i) changed = true;
        }
      }
    }
  }

  // Of a unit of length.
  double price() const { return jumps_last_ ? 16 * bend_ : 2 * bend_ / kMaxBend; }
  double weight(double distance) const {
    const double beyond = distance - bend_ / kMaxBend;
    return jumps_last_ || beyond < 0 ? distance : distance + 16 * beyond;
  }
  double cheap_reach() const { return 8 * bend_; }

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
  bool jumps_last_;
  std::vector<Stop> stops_;  // ascending, but for the ends
  std::vector<Link> links_;  // by `from`
};

}  // namespace

std::vector<ChainStop> bent_chain(const Mesh& mesh, const Track& track, std::span<const Step> steps,
                                  double bend, const ChainEnd& from, const ChainEnd& to,
                                  bool jumps_last) {
  if (from.vertex && from.vertex == to.vertex) return {{from.vertex, from.at}};
  return PathSearch(mesh, track, steps, bend, from, to, jumps_last).path();
}

}  // namespace weft::check
