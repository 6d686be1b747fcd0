// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/pinches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/face.h"
#include "engine/domain/simplify/turns.h"
#include "engine/domain/triangulation/filtered.h"

namespace weft {
namespace {

constexpr int kHalvings = 12;

class PinchOpener {
 public:
  PinchOpener(LineGraph& graph, const NearLines& original, StopPoller& poller)
      : graph_(graph), original_(original), poller_(poller) {}

  void run() {
    if (!has_twins()) return;
    find_lines();
    Sides sides = triangulate_sides(graph_, poller_);
    a_ = std::move(sides.arrangement);
    region_ = std::move(sides.region);
    for (const Arrangement::Triangle& t : a_.triangles)
      corner_.push_back(
          {a_.vertices[t.vertex[0]], a_.vertices[t.vertex[1]], a_.vertices[t.vertex[2]]});
    find_sectors();
    for (std::size_t first = 0; first < sectors_.size();) {
      std::size_t last = first;
      while (last < sectors_.size() && sectors_[last].vertex == sectors_[first].vertex) ++last;
      open(first, last);
      first = last;
    }
  }

 private:
  struct Corner {
    std::uint32_t triangle;
    int index;
  };

  // The water between two lines that follow each other around a vertex.
  struct Sector {
    std::uint32_t vertex;     // of the triangulation
    std::uint32_t point;      // of the graph: the two lines' alone
    double turn;              // the angle between the lines (turns.h)
    std::vector<Corner> fan;  // counter-clockwise
  };

  void find_lines() {
    lines_at_.assign(graph_.points.size(), {});
    for (std::uint32_t l = 0; l < graph_.lines.size(); ++l) {
      lines_at_[graph_.lines[l].a].push_back(l);
      lines_at_[graph_.lines[l].b].push_back(l);
    }
  }

  bool has_twins() const {
    const std::vector<bool> is_twin = find_twins(graph_, used_points(graph_));
    return std::find(is_twin.begin(), is_twin.end(), true) != is_twin.end();
  }

  bool is_water(std::uint32_t t) const { return t != kNone && region_[t] != kNone; }
  bool is_border(std::uint32_t t, int i) const {
    return is_water(t) != is_water(a_.triangles[t].neighbor[i]);
  }
  std::uint32_t line_of(std::uint32_t t, int i) const {
    return a_.constraints[a_.triangles[t].constraint[i]].segment;
  }
  std::uint32_t other_end(std::uint32_t line, std::uint32_t point) const {
    return graph_.lines[line].a == point ? graph_.lines[line].b : graph_.lines[line].a;
  }

  void find_sectors() {
    for (std::uint32_t t = 0; t < region_.size(); ++t) {
      poller_.step();
      for (int i = 0; i < 3 && is_water(t); ++i)
        if (is_border(t, i)) add_sector(t, i);
    }
    std::stable_sort(sectors_.begin(), sectors_.end(), [](const Sector& p, const Sector& q) {
      return p.vertex != q.vertex ? p.vertex < q.vertex : p.turn > q.turn;
    });
  }

  // The sector at the start of a side, if it has a point of its own.
  void add_sector(std::uint32_t t, int side) {
    int at = ccw(side);
    Sector sector{.vertex = a_.triangles[t].vertex[at], .point = kNone, .turn = 0, .fan = {}};
    const std::uint32_t first = line_of(t, side);
    while (true) {
      sector.fan.push_back({t, at});
      if (is_border(t, ccw(at))) break;
      t = a_.triangles[t].neighbor[ccw(at)];
      at = 0;
      while (a_.triangles[t].vertex[at] != sector.vertex) ++at;
    }
    const std::uint32_t last = line_of(t, ccw(at));
    for (const std::uint32_t v : {graph_.lines[first].a, graph_.lines[first].b})
      if (v == graph_.lines[last].a || v == graph_.lines[last].b) sector.point = v;
    if (sector.point == kNone || first == last || lines_at_[sector.point].size() != 2) return;
    const Point v = graph_.points[sector.point];
    if (!(v == a_.vertices[sector.vertex])) return;
    sector.turn = turn(graph_.points[other_end(first, sector.point)], v,
                       graph_.points[other_end(last, sector.point)]);
    sectors_.push_back(std::move(sector));
  }

  void open(std::size_t first, std::size_t last) {
    for (std::size_t s = first + 1; s < last; ++s) {
      poller_.step();
      for (const double least_turn : {kTurn45, 0.0})
        if (move(sectors_[s], least_turn)) break;
    }
  }

  bool move(const Sector& sector, double least_turn) {
    const Point at = graph_.points[sector.point];
    const std::vector<std::uint32_t>& lines = lines_at_[sector.point];
    const std::array<std::uint32_t, 2> ends{other_end(lines[0], sector.point),
                                            other_end(lines[1], sector.point)};
    const Point u = graph_.points[ends[0]], w = graph_.points[ends[1]];
    const double allowed =
        std::min({graph_.finest[sector.point], graph_.finest[ends[0]], graph_.finest[ends[1]]});
    const double to_u = distance(at, u), to_w = distance(at, w);
    const double x = (u.x - at.x) / to_u + (w.x - at.x) / to_w;
    const double y = (u.y - at.y) / to_u + (w.y - at.y) / to_w;
    const double length = std::sqrt(x * x + y * y);
    if (!(length > 0) || !(allowed > 0)) return false;
    double by = std::min({allowed, to_u, to_w}) / 2;
    for (int i = 0; i < kHalvings; ++i, by /= 2) {
      const Point to{at.x + by * x / length, at.y + by * y / length};
      if (!may_move(sector, ends, to, allowed, least_turn)) continue;
      for (const auto& [t, corner] : sector.fan) corner_[t][corner] = to;
      replace(sector.point, to, allowed);
      return true;
    }
    return false;
  }

  void replace(std::uint32_t point, Point to, double error) {
    const std::uint32_t own = graph_.add_point(to, kNone, error, graph_.finest[point]);
    for (const std::uint32_t l : lines_at_[point]) {
      GraphLine& line = graph_.lines[l];
      (line.a == point ? line.a : line.b) = own;
      line.error = error;
    }
    lines_at_.push_back(std::move(lines_at_[point]));
    lines_at_[point].clear();
  }

  bool may_move(const Sector& sector, const std::array<std::uint32_t, 2>& ends, Point to,
                double allowed, double least_turn) const {
    for (const auto& [t, corner] : sector.fan)
      if (orientation(to, corner_[t][ccw(corner)], corner_[t][cw(corner)]) <= 0) return false;
    const Point at = graph_.points[sector.point];
    for (const int k : {0, 1}) {
      const GraphLine& line = graph_.lines[lines_at_[sector.point][k]];
      const Point end = graph_.points[ends[k]];
      if (!original_.holds_near({end, to, to}, allowed, line.marker) ||
          !original_.holds_near({end, at, to}, allowed))
        return false;
      for (const std::uint32_t l : lines_at_[ends[k]]) {
        const Point beyond = graph_.points[other_end(l, ends[k])];
        if (other_end(l, ends[k]) == sector.point) continue;
        const double after = turn_between(to, end, beyond);
        if (after < least_turn && after < turn_between(at, end, beyond)) return false;
      }
    }
    return true;
  }

  LineGraph& graph_;
  const NearLines& original_;
  StopPoller& poller_;
  std::vector<std::vector<std::uint32_t>> lines_at_;  // per point of the graph
  Arrangement a_;
  std::vector<std::uint32_t> region_;         // per triangle
  std::vector<std::array<Point, 3>> corner_;  // per triangle: where its corners are by now
  std::vector<Sector> sectors_;               // by vertex, the widest first
};

}  // namespace

void open_pinches(LineGraph& graph, const NearLines& original, StopPoller& poller) {
  PinchOpener(graph, original, poller).run();
}

}  // namespace weft
