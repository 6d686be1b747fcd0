// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/arc_path.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace weft::check {
namespace {

constexpr double kNotReached = std::numeric_limits<double>::infinity();

// The cost of a step is the square of its turn, so that many steps cost less than one; and a little
// for what it is off. That of a gap is more for any turn, and a little for the gap itself.
constexpr double kGap = 100;
constexpr double kEachGap = 1e-6;
constexpr double kOff = 1e-3;

struct Stop {
  ArcStop stop;
  double cost = kNotReached;
  std::size_t before = 0;
};

}  // namespace

std::vector<ArcStop> arc_path(std::span<const ArcStep> steps, double tolerance, double turn,
                              std::optional<std::uint32_t> from, std::optional<std::uint32_t> to) {
  std::vector<Stop> stops{{{0, from, nullptr}, 0}};
  for (const ArcStep& step : steps) {
    if (step.off > tolerance) continue;
    if (step.from != from) stops.push_back({{step.from_angle, step.from, nullptr}});
    if (step.to != to) stops.push_back({{step.to_angle, step.to, nullptr}});
  }
  std::sort(stops.begin() + 1, stops.end(), [](const Stop& s, const Stop& t) {
    return s.stop.angle != t.stop.angle ? s.stop.angle < t.stop.angle
                                        : s.stop.vertex < t.stop.vertex;
  });
  stops.erase(
      std::unique(stops.begin() + 1, stops.end(),
                  [](const Stop& s, const Stop& t) { return s.stop.vertex == t.stop.vertex; }),
      stops.end());
  stops.push_back({{turn, to, nullptr}});
  std::unordered_map<std::uint32_t, std::size_t> numbers;
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (stops[i].stop.vertex) numbers.emplace(*stops[i].stop.vertex, i);

  struct Link {
    std::size_t from, to;
    const ArcStep* step;
  };
  std::vector<Link> links;
  for (const ArcStep& step : steps)
    if (step.off <= tolerance) links.push_back({numbers[step.from], numbers[step.to], &step});
  std::sort(links.begin(), links.end(),
            [](const Link& l, const Link& m) { return l.from < m.from; });

  double least = kNotReached;  // the cost of a gap from before to the arc's start
  std::size_t least_at = 0;
  auto link = links.begin();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    Stop& stop = stops[i];
    const double by_gap = least + kGap * stop.stop.angle + kEachGap;
    if (i > 0 && by_gap < stop.cost) {
      stop.cost = by_gap;
      stop.before = least_at;
      stop.stop.step = nullptr;
    }
    if (stop.cost - kGap * stop.stop.angle < least) {
      least = stop.cost - kGap * stop.stop.angle;
      least_at = i;
    }
    for (; link != links.end() && link->from == i; ++link) {
      if (link->to <= i) continue;
      const double by = link->step->to_angle - link->step->from_angle;
      const double cost = stop.cost + by * by + kOff * by * link->step->off / tolerance;
      if (!(cost < stops[link->to].cost)) continue;
      stops[link->to].cost = cost;
      stops[link->to].before = i;
      stops[link->to].stop.step = link->step;
    }
  }
  std::vector<ArcStop> path;
  for (std::size_t i = stops.size() - 1;; i = stops[i].before) {
    path.push_back(stops[i].stop);
    if (i == 0) break;
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace weft::check
