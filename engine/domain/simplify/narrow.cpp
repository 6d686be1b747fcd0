// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/narrow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <vector>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/face.h"
#include "engine/domain/simplify/straits.h"
#include "engine/domain/simplify/turns.h"

namespace weft {
namespace {

// Of the finest length: the diameter of a circle around the corners of a narrow triangle at most.
// Between shores that are this length apart, with points at half of it, it is sqrt(5) / 2 at most.
constexpr double kNarrow = 1.118;

// The diameter of the smallest circle around the corners; infinite if they are nearly on a line,
// with an angle above 150 degrees.
double diameter(Point a, Point b, Point c) {
  constexpr double kCosine150 = -0.8660254037844387;
  std::array<double, 3> side{distance(b, c), distance(c, a), distance(a, b)};
  std::sort(side.begin(), side.end());
  const double cosine =
      (side[0] * side[0] + side[1] * side[1] - side[2] * side[2]) / (2 * side[0] * side[1]);
  if (cosine < kCosine150) return std::numeric_limits<double>::infinity();
  if (cosine < 0) return side[2];
  const double doubled = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  return side[0] * side[1] * side[2] / doubled;
}

// Divides the lines that `parts` has several parts for.
void divide(LineGraph& graph, const std::vector<std::uint32_t>& parts,
            const std::function<double(Point)>& finest_at) {
  const std::size_t count = graph.lines.size();
  for (std::size_t l = 0; l < count; ++l) {
    if (parts[l] < 2) continue;
    const GraphLine line = graph.lines[l];
    const Point a = graph.points[line.a], b = graph.points[line.b];
    const double fine_a = graph.finest[line.a], fine_b = graph.finest[line.b];
    std::uint32_t from = line.a;
    for (std::uint32_t i = 1; i <= parts[l]; ++i) {
      const double t = static_cast<double>(i) / parts[l];
      const Point p{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      const std::uint32_t to =
          i == parts[l]
              ? line.b
              : graph.add_point(p, kNone, line.error, std::min({fine_a, fine_b, finest_at(p)}));
      GraphLine part = line;
      part.a = from;
      part.b = to;
      i == 1 ? graph.lines[l] = part : graph.lines.emplace_back(part);
      from = to;
    }
  }
}

class Narrowing {
 public:
  Narrowing(LineGraph& graph, const NearLines& original,
            const std::function<double(Point)>& finest_at, StopPoller& poller)
      : graph_(graph), original_(original), finest_at_(finest_at), poller_(poller) {}

  Narrowed run() {
    find_plain_points();
    triangulate();
    if (make_dense()) {
      find_plain_points();
      triangulate();
    }
    const auto count = static_cast<std::uint32_t>(region_.size());
    for (std::uint32_t t = 0; t < count; ++t)
      if (is_water(t)) queue_.push_back(t);
    peel(true);
    cut_channels();
    for (std::uint32_t t = 0; t < count; ++t)
      if (!is_water(t)) queue_.push_back(t);
    peel(false);
    if (result_.changed > 0) set_lines();
    return result_;
  }

 private:
  // Points of two lines that bound one region, where nothing ends.
  void find_plain_points() {
    std::vector<std::uint32_t> count(graph_.points.size(), 0);
    std::vector<std::uint32_t> region(graph_.points.size(), kNone);
    is_plain_.assign(graph_.points.size(), true);
    line_at_.assign(graph_.points.size(), kNone);
    for (std::uint32_t l = 0; l < graph_.lines.size(); ++l) {
      const GraphLine& line = graph_.lines[l];
      for (const std::uint32_t v : {line.a, line.b}) {
        line_at_[v] = l;
        const std::uint32_t here = std::min(line.left, line.right);
        if (!line.bounds_domain() || (count[v]++ > 0 && region[v] != here)) is_plain_[v] = false;
        region[v] = here;
      }
    }
    for (std::size_t v = 0; v < count.size(); ++v)
      if (count[v] != 2 || graph_.is_end[v]) is_plain_[v] = false;
  }

  void triangulate() {
    Sides sides = triangulate_sides(graph_, poller_);
    a_ = std::move(sides.arrangement);
    region_ = std::move(sides.region);
    changed_.assign(region_.size(), false);
    source_.assign(region_.size(), {kNone, kNone, kNone});
    for (std::uint32_t t = 0; t < region_.size(); ++t)
      for (int i = 0; i < 3; ++i)
        if (a_.triangles[t].constraint[i] != kNone)
          source_[t][i] = a_.constraints[a_.triangles[t].constraint[i]].segment;
    own_error_.clear();
  }

  // Returns whether lines were divided.
  bool make_dense() {
    constexpr double kMaxParts = 1e6;
    std::vector<std::uint32_t> parts(graph_.lines.size(), 1);
    bool any = false;
    for (std::uint32_t t = 0; t < region_.size(); ++t) {
      poller_.step();
      if (!is_plain(t) || !(finest(t) > 0) || !is_low(t)) continue;
      for (const std::uint32_t l : source_[t]) {
        if (l == kNone) continue;
        const GraphLine& line = graph_.lines[l];
        const double length = distance(graph_.points[line.a], graph_.points[line.b]);
        const double wanted = std::min(std::ceil(2 * length / finest(t)), kMaxParts);
        parts[l] = std::max(parts[l], static_cast<std::uint32_t>(wanted));
        any = any || parts[l] > 1;
      }
    }
    if (any) divide(graph_, parts, finest_at_);
    return any;
  }

  // Whether a line of the triangle has a corner near to it, or meets another one at a small angle.
  bool is_low(std::uint32_t t) const {
    for (int i = 0; i < 3; ++i) {
      if (source_[t][i] == kNone) continue;
      if (distance_to_line(at(t, i), at(t, ccw(i)), at(t, cw(i))) < finest(t)) return true;
      if (source_[t][ccw(i)] != kNone &&
          turn_between(at(t, i), at(t, cw(i)), at(t, ccw(i))) < kTurn45)
        return true;
    }
    return false;
  }

  std::uint32_t point(std::uint32_t t, int i) const {
    return a_.input_point[a_.triangles[t].vertex[i]];
  }
  Point at(std::uint32_t t, int i) const { return a_.vertices[a_.triangles[t].vertex[i]]; }
  bool is_water(std::uint32_t t) const { return t != kNone && region_[t] != kNone; }

  // Whether all corners are plain points.
  bool is_plain(std::uint32_t t) const {
    for (int i = 0; i < 3; ++i)
      if (point(t, i) == kNone || !is_plain_[point(t, i)]) return false;
    return true;
  }
  double finest(std::uint32_t t) const {
    return std::min(
        {graph_.finest[point(t, 0)], graph_.finest[point(t, 1)], graph_.finest[point(t, 2)]});
  }
  bool is_narrow(std::uint32_t t) const {
    return diameter(at(t, 0), at(t, 1), at(t, 2)) < kNarrow * finest(t);
  }

  bool is_border(std::uint32_t t, int i) const {
    return is_water(t) != is_water(a_.triangles[t].neighbor[i]);
  }
  int borders(std::uint32_t t) const {
    return int{is_border(t, 0)} + int{is_border(t, 1)} + int{is_border(t, 2)};
  }

  // A line whose marker a side may have that becomes a line; kNone if there is none.
  std::uint32_t line_for_side(std::uint32_t t, int i) const {
    const std::uint32_t p = point(t, ccw(i)), q = point(t, cw(i));
    std::array<std::uint32_t, 5> lines{kNone, kNone, kNone, line_at_[p], line_at_[q]};
    for (int k = 0; k < 3; ++k)
      if (is_border(t, k)) lines[k] = source_[t][k];
    for (const std::uint32_t line : lines)
      if (line != kNone &&
          original_.holds_near({graph_.points[p], graph_.points[q], graph_.points[q]}, finest(t),
                               graph_.lines[line].marker))
        return line;
    return kNone;
  }

  bool may_change(std::uint32_t t) const {
    if (changed_[t] || !is_plain(t) || !is_narrow(t) ||
        !original_.holds_near({at(t, 0), at(t, 1), at(t, 2)}, finest(t)))
      return false;
    for (int i = 0; i < 3; ++i)
      if (!is_border(t, i) && line_for_side(t, i) == kNone) return false;
    return true;
  }

  // Exchanges water and land in a triangle. REQUIRES: it may change, and has a side on the border.
  void change(std::uint32_t t) {
    int side = 0;
    while (!is_border(t, side)) ++side;
    std::array<std::uint32_t, 3> line{};
    for (int i = 0; i < 3; ++i) line[i] = is_border(t, i) ? kNone : line_for_side(t, i);
    for (int i = 0; i < 3; ++i) {
      if (line[i] == kNone) continue;
      const std::uint32_t n = a_.triangles[t].neighbor[i];
      source_[t][i] = line[i];
      int back = 0;
      while (a_.triangles[n].neighbor[back] != t) ++back;
      source_[n][back] = line[i];
      own_error_.push_back({t, n, finest(t)});
    }
    const std::uint32_t beyond = a_.triangles[t].neighbor[side];
    region_[t] = is_water(t) ? kNone : region_[beyond];
    changed_[t] = true;
    ++result_.changed;
    for (int i = 0; i < 3; ++i)
      if (a_.triangles[t].neighbor[i] != kNone) queue_.push_back(a_.triangles[t].neighbor[i]);
  }

  // Whether the triangles of one side around a corner of t are not divided by others: land that
  // changes there then joins no two shores.
  bool is_manifold_at(std::uint32_t t, int corner) const {
    const std::uint32_t v = a_.triangles[t].vertex[corner];
    int crossings = 0;
    std::uint32_t now = t;
    do {
      int i = 0;
      while (a_.triangles[now].vertex[i] != v) ++i;
      crossings += int{is_border(now, ccw(i))};
      now = a_.triangles[now].neighbor[ccw(i)];
    } while (now != kNone && now != t);
    return now != kNone && crossings <= 2;
  }

  // Changes narrow triangles of one kind with two or three sides on the border, as long as there
  // are any.
  void peel(bool water) {
    while (!queue_.empty()) {
      poller_.step();
      const std::uint32_t t = queue_.front();
      queue_.pop_front();
      if (is_water(t) != water) continue;
      const int sides = borders(t);
      if (sides < 2 || !may_change(t)) continue;
      if (!water && !opens_cleanly(t)) continue;
      if (sides == 3) ++(water ? result_.dropped.waters : result_.dropped.islands);
      change(t);
    }
  }

  // Land that becomes water joins water of one region, and no shores.
  bool opens_cleanly(std::uint32_t t) const {
    std::uint32_t region = kNone;
    for (int i = 0; i < 3; ++i) {
      if (!is_border(t, i)) continue;
      const std::uint32_t n = a_.triangles[t].neighbor[i];
      if (region != kNone && region_[n] != region) return false;
      region = region_[n];
    }
    for (int i = 0; i < 3; ++i)
      if (!is_manifold_at(t, i)) return false;
    return true;
  }

  // How many of the finest triangles one of water is worth (straits.h). Corners without a finest
  // length do not count.
  double weight(std::uint32_t t) const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i)
      if (point(t, i) != kNone && graph_.finest[point(t, i)] > 0)
        least = std::min(least, graph_.finest[point(t, i)]);
    if (std::isinf(least)) return least;
    const Point a = at(t, 0), b = at(t, 1), c = at(t, 2);
    if (diameter(a, b, c) < kNarrow * least) return 0;
    const double doubled = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return doubled / (2 * kFinestTriangle * least * least);
  }

  void cut_channels() {
    const std::size_t count = region_.size();
    std::vector<double> width(count, std::numeric_limits<double>::infinity());
    weight_.assign(count, 0);
    std::vector<bool> was_water(count, false), must_stay(count, false);
    for (std::uint32_t t = 0; t < count; ++t) {
      poller_.step();
      if (!is_water(t)) continue;
      was_water[t] = true;
      weight_[t] = weight(t);
      must_stay[t] = !is_plain(t);
      if (may_change(t)) width[t] = diameter(at(t, 0), at(t, 1), at(t, 2));
    }
    const std::vector<bool> in_strait =
        find_straits({a_, region_, width, weight_, must_stay}, poller_);
    std::vector<std::uint32_t> set;
    result_.straits = number_sets(a_, in_strait, set, poller_);
    std::vector<std::pair<double, std::uint32_t>> narrow;
    for (std::uint32_t t = 0; t < count; ++t)
      if (std::isfinite(width[t]) && !in_strait[t]) narrow.emplace_back(width[t], t);
    std::sort(narrow.begin(), narrow.end());
    for (const auto& [_, t] : narrow) {
      if (!is_water(t) || borders(t) != 1 || !may_change(t)) continue;
      change(t);
      result_.cuts.push_back(centroid(at(t, 0), at(t, 1), at(t, 2)));
      peel(true);
    }
    drop_what_is_cut_off(was_water);
  }

  // Of each water before the cuts, only the heaviest of what is left stays.
  void drop_what_is_cut_off(const std::vector<bool>& was_water) {
    std::vector<bool> still(region_.size());
    for (std::uint32_t t = 0; t < still.size(); ++t) still[t] = is_water(t);
    std::vector<std::uint32_t> before, now;
    const std::uint32_t before_count = number_sets(a_, was_water, before, poller_);
    const std::uint32_t now_count = number_sets(a_, still, now, poller_);
    std::vector<double> sum(now_count, 0);
    std::vector<std::uint32_t> origin(now_count);
    for (std::uint32_t t = 0; t < still.size(); ++t)
      if (still[t]) sum[now[t]] += weight_[t], origin[now[t]] = before[t];
    std::vector<std::uint32_t> heaviest(before_count, kNone);
    for (std::uint32_t n = 0; n < now_count; ++n)
      if (std::uint32_t& most = heaviest[origin[n]]; most == kNone || sum[n] > sum[most]) most = n;
    for (std::uint32_t t = 0; t < still.size(); ++t) {
      if (!still[t] || heaviest[before[t]] == now[t]) continue;
      region_[t] = kNone;
      ++result_.changed;
    }
    for (std::uint32_t n = 0; n < now_count; ++n)
      if (heaviest[origin[n]] != n) ++result_.cut_off;
  }

  // The border as lines, and the lines inside as they were. A point where several shores meet
  // becomes one point for each.
  void set_lines() {
    std::vector<GraphLine> lines;
    std::vector<bool> done(graph_.lines.size(), false);
    start_.assign(region_.size(), {kNone, kNone, kNone});
    end_ = start_;
    std::vector<bool> taken(graph_.points.size(), false);
    for (std::uint32_t t = 0; t < region_.size(); ++t)
      for (int i = 0; i < 3; ++i)
        if (is_water(t) && is_border(t, i)) name_sector(t, i, taken);
    std::sort(own_error_.begin(), own_error_.end());
    for (std::uint32_t t = 0; t < region_.size(); ++t) {
      poller_.step();
      for (int i = 0; i < 3 && is_water(t); ++i) {
        if (source_[t][i] == kNone) continue;
        const GraphLine& from = graph_.lines[source_[t][i]];
        if (is_border(t, i)) {
          lines.push_back({.a = start_[t][i],
                           .b = end_[t][i],
                           .left = region_[t],
                           .right = kNone,
                           .marker = from.marker,
                           .segment = from.segment,
                           .error = error_of_border(t, i, from)});
        } else if (a_.triangles[t].constraint[i] != kNone && !from.bounds_domain() &&
                   t < a_.triangles[t].neighbor[i]) {
          GraphLine line = from;
          line.a = point(t, ccw(i));
          line.b = point(t, cw(i));
          line.left = region_[t];
          line.right = region_[a_.triangles[t].neighbor[i]];
          lines.push_back(line);
        }
      }
    }
    graph_.lines = std::move(lines);
  }

  double error_of_border(std::uint32_t t, int i, const GraphLine& from) const {
    const std::uint32_t n = a_.triangles[t].neighbor[i];
    if (a_.triangles[t].constraint[i] != kNone) return from.error;
    for (const auto& [first, second] : {std::pair{t, n}, std::pair{n, t}}) {
      const auto found =
          std::lower_bound(own_error_.begin(), own_error_.end(), SideError{first, second, 0});
      if (found != own_error_.end() && found->from == first && found->to == second)
        return found->error;
    }
    return from.error;
  }

  // Gives the lines before and after the sector of water at the start of a side of the border one
  // point: that of the graph for the first such sector, a copy for others.
  void name_sector(std::uint32_t t, int i, std::vector<bool>& taken) {
    std::uint32_t now = t;
    int from = ccw(i);  // the corner, in the triangle `now`
    const std::uint32_t v = point(t, from);
    std::uint32_t named = v;
    if (is_plain_[v]) {
      if (taken[v])
        named = graph_.add_point(graph_.points[v], graph_.original[v], graph_.error[v],
                                 graph_.finest[v]);
      taken[v] = true;
    }
    start_[t][i] = named;
    // Counter-clockwise from the side that starts at v to the one that ends there.
    while (!is_border(now, ccw(from))) {
      const std::uint32_t n = a_.triangles[now].neighbor[ccw(from)];
      const std::uint32_t vertex = a_.triangles[now].vertex[from];
      from = 0;
      while (a_.triangles[n].vertex[from] != vertex) ++from;
      now = n;
    }
    end_[now][ccw(from)] = named;
  }

  struct SideError {
    std::uint32_t from, to;  // triangles
    double error;
    friend bool operator<(const SideError& a, const SideError& b) {
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    }
  };

  LineGraph& graph_;
  const NearLines& original_;
  const std::function<double(Point)>& finest_at_;
  StopPoller& poller_;
  Arrangement a_;
  std::vector<std::uint32_t> region_;   // per triangle
  std::vector<bool> is_plain_;          // per point
  std::vector<std::uint32_t> line_at_;  // per point: a line that ends there
  std::vector<bool> changed_;           // per triangle
  std::vector<double> weight_;          // per triangle: of water, before channels are cut
  // Per side of a triangle: the line that it is on, or whose marker it takes.
  std::vector<std::array<std::uint32_t, 3>> source_;
  std::vector<SideError> own_error_;  // of sides that were no lines
  std::deque<std::uint32_t> queue_;
  // Per side of the border, seen from the water: the points of its line.
  std::vector<std::array<std::uint32_t, 3>> start_, end_;
  Narrowed result_;
};

}  // namespace

Narrowed close_narrow_places(LineGraph& graph, const NearLines& original,
                             const std::function<double(Point)>& finest_at, StopPoller& poller) {
  return Narrowing(graph, original, finest_at, poller).run();
}

}  // namespace weft
