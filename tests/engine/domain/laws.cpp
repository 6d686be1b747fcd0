// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/domain/laws.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "engine/domain/tolerance.h"

namespace weft {
namespace {

using Broken = std::optional<std::string>;

struct Exact {
  explicit Exact(Point p) : x(p.x), y(p.y) {}
  mpq_class x, y;
};

mpq_class twice_area(const Exact& a, const Exact& b, const Exact& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

int turn(Point a, Point b, Point c) {
  return sgn(twice_area(Exact(a), Exact(b), Exact(c)));
}

bool in_circle(Point a, Point b, Point c, Point p) {
  const auto row = [&](Point q) {
    const mpq_class x = mpq_class(q.x) - p.x, y = mpq_class(q.y) - p.y;
    return std::array<mpq_class, 3>{x, y, x * x + y * y};
  };
  const auto r = row(a), s = row(b), t = row(c);
  return r[0] * (s[1] * t[2] - s[2] * t[1]) - r[1] * (s[0] * t[2] - s[2] * t[0]) +
             r[2] * (s[0] * t[1] - s[1] * t[0]) >
         0;
}

template <class... Parts>
Broken broken(const Parts&... parts) {
  std::string text;
  const auto append = [&text](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(part)>>) {
      text += std::to_string(part);
    } else {
      text += part;
    }
  };
  (append(parts), ...);
  return text;
}

Broken broken_triangle(const Domain& d, std::uint32_t t) {
  const Domain::Triangle& triangle = d.triangles[t];
  for (const std::uint32_t v : triangle.vertex)
    if (v >= d.vertices.size()) return broken("triangle ", t, " has no vertex ", v);
  const auto p = [&](int i) { return d.vertices[triangle.vertex[i]]; };
  if (turn(p(0), p(1), p(2)) <= 0) return broken("triangle ", t, " is not counter-clockwise");
  if (triangle.region >= d.regions.size()) return broken("triangle ", t, " has no region");

  for (int i = 0; i < 3; ++i) {
    const std::uint32_t a = triangle.vertex[(i + 1) % 3];
    const std::uint32_t b = triangle.vertex[(i + 2) % 3];
    const std::uint32_t s = triangle.subsegment[i];
    if (s != kNone) {
      if (s >= d.subsegments.size()) return broken("triangle ", t, ": no subsegment ", s);
      if (std::minmax(d.subsegments[s].a, d.subsegments[s].b) != std::minmax(a, b))
        return broken("triangle ", t, ": subsegment ", s, " is another edge");
    }
    const std::uint32_t n = triangle.neighbor[i];
    if (n == kNone) {
      if (s == kNone) return broken("triangle ", t, ": edge ", i, " borders on nothing");
      continue;
    }
    if (n >= d.triangles.size()) return broken("triangle ", t, " has no neighbour ", n);
    const Domain::Triangle& other = d.triangles[n];
    int j = 0;
    while (j < 3 && !(other.vertex[(j + 1) % 3] == b && other.vertex[(j + 2) % 3] == a)) ++j;
    if (j == 3) return broken("triangles ", t, " and ", n, " share no edge");
    if (other.neighbor[j] != t) return broken("triangle ", n, " does not name ", t, " back");
    if (other.subsegment[j] != s) return broken("triangles ", t, ", ", n, ": subsegments differ");
    if (s == kNone && in_circle(p(0), p(1), p(2), d.vertices[other.vertex[j]]))
      return broken("edge ", i, " of triangle ", t, " is not Delaunay");
    if (s == kNone && other.region != triangle.region)
      return broken("triangles ", t, ", ", n, ": regions differ across no segment");
  }
  return {};
}

Broken broken_vertices(const Pslg& pslg, const Domain& d) {
  std::vector<bool> used(d.vertices.size(), false);
  for (const Domain::Triangle& t : d.triangles)
    for (const std::uint32_t v : t.vertex) used[v] = true;
  std::map<std::pair<double, double>, std::uint32_t> lowest;
  for (std::uint32_t i = 0; i < pslg.points.size(); ++i)
    lowest.try_emplace({pslg.points[i].x, pslg.points[i].y}, i);
  if (d.input_point.size() != d.vertices.size()) return broken("input_point has another size");
  std::set<std::pair<double, double>> seen;
  for (std::uint32_t v = 0; v < d.vertices.size(); ++v) {
    const Point p = d.vertices[v];
    if (!used[v]) return broken("vertex ", v, " belongs to no triangle");
    if (!seen.insert({p.x, p.y}).second) return broken("vertex ", v, " repeats another one");
    const auto input = lowest.find({p.x, p.y});
    if (d.input_point[v] != (input == lowest.end() ? kNone : input->second))
      return broken("vertex ", v, " names the wrong input point");
    if (v > 0 && d.input_point[v] != kNone && d.input_point[v - 1] >= d.input_point[v])
      return broken("vertex ", v, " is out of order");
  }
  return {};
}

double ulp_of(Point a, Point b) {
  const double m = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
  return std::nextafter(m, INFINITY) - m;
}

// Whether p lies within `ulps` ulps of the closed segment ab.
bool near(Point p, Point a, Point b, double ulps) {
  const Exact ea(a), eb(b), ep(p);
  const mpq_class ux = eb.x - ea.x, uy = eb.y - ea.y;
  const mpq_class length2 = ux * ux + uy * uy;
  mpq_class t = ((ep.x - ea.x) * ux + (ep.y - ea.y) * uy) / length2;
  t = t < 0 ? mpq_class(0) : t > 1 ? mpq_class(1) : t;
  const mpq_class dx = ea.x + t * ux - ep.x, dy = ea.y + t * uy - ep.y;
  const mpq_class limit = mpq_class(ulps) * ulp_of(a, b);
  return dx * dx + dy * dy <= limit * limit;
}

// The subsegments whose ends are both within `ulps` ulps of segment i.
std::vector<std::uint32_t> subsegments_on(const Pslg& pslg, const Domain& d, std::uint32_t i,
                                          double ulps) {
  const Point a = pslg.points[pslg.segments[i].a], b = pslg.points[pslg.segments[i].b];
  const double ux = b.x - a.x, uy = b.y - a.y;
  const double scale = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
  // A quick look before the exact one.
  const auto may_be_near = [&](Point p) {
    return std::fabs(ux * (p.y - a.y) - uy * (p.x - a.x)) <=
           std::max(1e-10, ulps * 0x1p-50) * scale * (std::fabs(ux) + std::fabs(uy));
  };
  std::vector<std::uint32_t> on;
  for (std::uint32_t k = 0; k < d.subsegments.size(); ++k) {
    const Point p = d.vertices[d.subsegments[k].a], q = d.vertices[d.subsegments[k].b];
    if (may_be_near(p) && may_be_near(q) && near(p, a, b, ulps) && near(q, a, b, ulps))
      on.push_back(k);
  }
  return on;
}

}  // namespace

Broken broken_law(const Pslg& pslg, const Domain& d) {
  if (d.triangles.empty()) return broken("there are no triangles");
  if (d.regions.empty()) return broken("there is no default region");
  std::vector<bool> used(d.subsegments.size(), false);
  for (std::uint32_t t = 0; t < d.triangles.size(); ++t) {
    if (auto b = broken_triangle(d, t)) return b;
    for (const std::uint32_t s : d.triangles[t].subsegment)
      if (s != kNone) used[s] = true;
  }
  if (std::find(used.begin(), used.end(), false) != used.end())
    return broken("a subsegment belongs to no triangle");
  return broken_vertices(pslg, d);
}

Broken broken_chain(const Pslg& pslg, const Domain& d, double ulps) {
  std::map<std::pair<double, double>, std::uint32_t> vertex_at;
  for (std::uint32_t v = 0; v < d.vertices.size(); ++v)
    vertex_at[{d.vertices[v].x, d.vertices[v].y}] = v;
  // The vertex of an input point, or those that it may have moved to.
  const auto vertices_of = [&](Point p) {
    std::set<std::uint32_t> vertices;
    const auto found = vertex_at.find({p.x, p.y});
    if (found != vertex_at.end()) return std::set{found->second};
    for (std::uint32_t v = 0; v < d.vertices.size(); ++v)
      if (std::hypot(d.vertices[v].x - p.x, d.vertices[v].y - p.y) < d.merging.tolerance)
        vertices.insert(v);
    return vertices;
  };
  for (std::uint32_t i = 0; i < pslg.segments.size(); ++i) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> adjacent;
    for (const std::uint32_t k : subsegments_on(pslg, d, i, ulps)) {
      adjacent[d.subsegments[k].a].push_back(d.subsegments[k].b);
      adjacent[d.subsegments[k].b].push_back(d.subsegments[k].a);
    }
    const Point a = pslg.points[pslg.segments[i].a], b = pslg.points[pslg.segments[i].b];
    std::set<std::uint32_t> reached = vertices_of(a);
    std::vector<std::uint32_t> stack(reached.begin(), reached.end());
    while (!stack.empty()) {
      const std::uint32_t v = stack.back();
      stack.pop_back();
      for (const std::uint32_t w : adjacent[v])
        if (reached.insert(w).second) stack.push_back(w);
    }
    const std::set<std::uint32_t> ends = vertices_of(b);
    const auto is_reached = [&](std::uint32_t v) { return reached.contains(v); };
    if (std::none_of(ends.begin(), ends.end(), is_reached))
      return broken("segment ", i, " is not a chain of subsegments");
  }
  return {};
}

Broken broken_origin(const Pslg& pslg, const Domain& d, double ulps) {
  std::vector<std::vector<std::uint32_t>> lies_on(d.subsegments.size());
  for (std::uint32_t i = 0; i < pslg.segments.size(); ++i)
    for (const std::uint32_t k : subsegments_on(pslg, d, i, ulps)) lies_on[k].push_back(i);
  for (std::uint32_t k = 0; k < d.subsegments.size(); ++k) {
    if (lies_on[k].empty()) return broken("subsegment ", k, " lies on no segment");
    std::int32_t marker = 0;
    for (const std::uint32_t i : lies_on[k])
      if (marker == 0) marker = pslg.segments[i].marker;
    if (d.subsegments[k].segment != lies_on[k].front())
      return broken("subsegment ", k, " names segment ", d.subsegments[k].segment, ", not ",
                    lies_on[k].front());
    if (d.subsegments[k].marker != marker)
      return broken("subsegment ", k, " has marker ", d.subsegments[k].marker, ", not ", marker);
  }
  return {};
}

Broken broken_separation(const Pslg& pslg, const Domain& d, double reach) {
  constexpr double kRounding = 1e-3;  // of the arithmetic here, as a fraction of the tolerance
  const double tolerance = d.merging.tolerance;
  const auto to_segment = [](Point p, Point a, Point b) {
    const double x = b.x - a.x, y = b.y - a.y;
    const double along = (x * (p.x - a.x) + y * (p.y - a.y)) / (x * x + y * y);
    const double t = std::clamp(along, 0.0, 1.0);
    return std::hypot(a.x + t * x - p.x, a.y + t * y - p.y);
  };
  for (std::uint32_t v = 0; v < d.vertices.size(); ++v) {
    const Point p = d.vertices[v];
    for (std::uint32_t w = 0; w < v; ++w)
      if (std::hypot(p.x - d.vertices[w].x, p.y - d.vertices[w].y) < (1 - kRounding) * tolerance)
        return broken("vertices ", v, " and ", w, " are nearer than the tolerance");
    for (std::uint32_t k = 0; k < d.subsegments.size(); ++k) {
      const Subsegment& s = d.subsegments[k];
      if (s.a == v || s.b == v) continue;
      const double off = to_segment(p, d.vertices[s.a], d.vertices[s.b]);
      const Segment& from = pslg.segments[s.segment];
      const bool is_near =
          to_segment(p, pslg.points[from.a], pslg.points[from.b]) < (1 - kRounding) * tolerance;
      if (off < (0.5 - kRounding) * (is_near ? tolerance : least_tolerance(pslg)))
        return broken("vertex ", v, " is ", off / tolerance, " tolerances off subsegment ", k);
    }
  }
  for (std::uint32_t i = 0; i < pslg.points.size(); ++i) {
    const Point p = pslg.points[i];
    const bool is_there = std::any_of(d.vertices.begin(), d.vertices.end(), [&](Point q) {
      return std::hypot(p.x - q.x, p.y - q.y) <= reach * tolerance;
    });
    if (!is_there) return broken("input point ", i, " is near no vertex");
  }
  for (std::uint32_t k = 0; k < d.subsegments.size(); ++k) {
    const Segment& s = pslg.segments[d.subsegments[k].segment];
    for (const std::uint32_t v : {d.subsegments[k].a, d.subsegments[k].b}) {
      const double off = to_segment(d.vertices[v], pslg.points[s.a], pslg.points[s.b]);
      if (off > reach * tolerance)
        return broken("subsegment ", k, " is ", off / tolerance, " tolerances off its segment");
    }
  }
  return {};
}

double area(const Domain& d) {
  mpq_class sum = 0;
  for (const Domain::Triangle& t : d.triangles)
    sum += twice_area(Exact(d.vertices[t.vertex[0]]), Exact(d.vertices[t.vertex[1]]),
                      Exact(d.vertices[t.vertex[2]]));
  return mpq_class(sum / 2).get_d();
}

int cover(const Domain& d, Point p) {
  int count = 0;
  for (const Domain::Triangle& t : d.triangles) {
    const Point a = d.vertices[t.vertex[0]], b = d.vertices[t.vertex[1]],
                c = d.vertices[t.vertex[2]];
    if (turn(a, b, p) > 0 && turn(b, c, p) > 0 && turn(c, a, p) > 0) ++count;
  }
  return count;
}

bool odd(const Pslg& pslg, Point p) {
  bool odd = false;
  for (const Segment& s : pslg.segments) {
    const Point a = pslg.points[s.a], b = pslg.points[s.b];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const auto [low, high] = a.y < b.y ? std::pair(a, b) : std::pair(b, a);
    if (turn(low, high, p) > 0) odd = !odd;
  }
  return odd;
}

}  // namespace weft
