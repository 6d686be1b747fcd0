// SPDX-License-Identifier: Apache-2.0
// The boundary of a HATCH: paths, each a polyline with bulges or a chain of edges of four kinds.
#include <cmath>
#include <numbers>
#include <utility>

#include "client/base/text.h"
#include "client/formats/domains/dxf_shapes.h"

namespace weft::client {
namespace {

class Hatch {
 public:
  explicit Hatch(const DxfEntity& hatch) : hatch_(hatch) {}

  std::vector<std::vector<Point>> rings() {
    while (at_ < hatch_.groups.size() && hatch_.groups[at_].code != 91) ++at_;
    const int paths = take_integer(91);
    std::vector<std::vector<Point>> all;
    for (int i = 0; i < paths && skip_to(92); ++i) {
      constexpr int kPolyline = 2;
      std::vector<Point> ring = (take_integer(92) & kPolyline) != 0 ? polyline() : edges();
      if (ring.empty()) continue;
      ring.push_back(ring.front());
      all.push_back(std::move(ring));
    }
    return all;
  }

 private:
  const DxfGroup* here(int code) const {
    return at_ < hatch_.groups.size() && hatch_.groups[at_].code == code ? &hatch_.groups[at_]
                                                                         : nullptr;
  }
  // Past the numbers of source objects; not past the boundary, which a group 75 follows.
  bool skip_to(int code) {
    while (at_ < hatch_.groups.size() && here(code) == nullptr && here(75) == nullptr) ++at_;
    return here(code) != nullptr;
  }
  // 0 if the next group is another one.
  double take(int code) {
    const DxfGroup* const group = here(code);
    if (group == nullptr) return 0;
    ++at_;
    return hatch_.real_of(*group);
  }
  int take_integer(int code) {
    const DxfGroup* const group = here(code);
    if (group == nullptr) return 0;
    ++at_;
    return hatch_.integer_of(*group);
  }
  Point take_point(int code) {
    const double x = take(code);
    return {x, take(code + 10)};
  }

  std::vector<Point> polyline() {
    take_integer(72);  // whether there are bulges
    take_integer(73);  // every ring is closed
    take_integer(93);
    std::vector<std::pair<Point, double>> corners;
    while (here(10) != nullptr) {
      const Point at = take_point(10);
      corners.emplace_back(at, take(42));
    }
    std::vector<Point> ring;
    if (corners.empty()) return ring;
    ring.push_back(corners[0].first);
    for (std::size_t i = 0; i < corners.size(); ++i)
      add_bulge_chords(corners[i].first, corners[(i + 1) % corners.size()].first, corners[i].second,
                       ring);
    return ring;
  }

  std::vector<Point> edges() {
    std::vector<Point> ring;
    take_integer(93);
    while (here(72) != nullptr) {
      std::vector<Point> edge;
      switch (take_integer(72)) {
        case 1:
          edge.push_back(take_point(10));
          edge.push_back(take_point(11));
          break;
        case 2:
          edge = arc();
          break;
        case 3:
          edge = ellipse();
          break;
        case 4:
          edge = spline();
          break;
        default:
          return ring;
      }
      join(ring, std::move(edge));
    }
    return ring;
  }
  // Edges may run against the direction of their ring.
  static void join(std::vector<Point>& ring, std::vector<Point> edge) {
    if (edge.empty()) return;
    if (!ring.empty()) {
      const auto gap = [&ring](Point p) {
        return std::hypot(p.x - ring.back().x, p.y - ring.back().y);
      };
      if (gap(edge.back()) < gap(edge.front())) std::reverse(edge.begin(), edge.end());
      if (gap(edge.front()) <= 1e-9 * gap(edge.back())) edge.erase(edge.begin());
    }
    ring.insert(ring.end(), edge.begin(), edge.end());
  }

  // Angles go clockwise if the edge does.
  std::vector<Point> arc() {
    const Point centre = take_point(10);
    const double radius = take(40);
    return elliptic({centre, {radius, 0}, {0, radius}});
  }
  std::vector<Point> ellipse() {
    const Point centre = take_point(10);
    const Point major = take_point(11);
    const double ratio = take(40);
    return elliptic({centre, major, {-major.y * ratio, major.x * ratio}});
  }
  std::vector<Point> elliptic(DxfEllipse curve) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double from = take(50) * kDegree;
    double to = take(51) * kDegree;
    const bool is_clockwise = here(73) != nullptr && take_integer(73) == 0;
    if (is_clockwise) curve.minor = {-curve.minor.x, -curve.minor.y};
    if (to < from) to += 2 * std::numbers::pi;
    std::vector<Point> points = {curve(from)};
    add_chords(curve, from, to, 16, points);
    return points;
  }

  std::vector<Point> spline() {
    DxfSpline curve;
    curve.degree = take_integer(94);
    for (const int code : {73, 74, 95, 96}) take_integer(code);
    while (here(40) != nullptr) curve.knots.push_back(take(40));
    while (here(10) != nullptr) {
      curve.control.push_back(take_point(10));
      if (here(42) != nullptr) curve.weights.push_back(take(42));
    }
    if (here(97) != nullptr) {
      // The number of fit points, or of source objects, which follow the last edge.
      take_integer(97);
      while (here(11) != nullptr) take_point(11);
      for (const int code : {12, 13}) take_point(code);
    }
    return curve.is_sound() ? chords_of(curve) : curve.control;
  }

  const DxfEntity& hatch_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<std::vector<Point>> hatch_rings(const DxfEntity& hatch, const DxfPlacement& placement) {
  std::vector<std::vector<Point>> rings = Hatch(hatch).rings();
  for (std::vector<Point>& ring : rings)
    for (Point& p : ring) p = placement(p);
  return rings;
}

}  // namespace weft::client
