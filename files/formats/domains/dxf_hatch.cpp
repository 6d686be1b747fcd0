// SPDX-License-Identifier: Apache-2.0
// The boundary of a HATCH: paths, each a polyline with bulges or a chain of edges of four kinds.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "files/base/text.h"
#include "files/formats/domains/dxf_shapes.h"
#include "files/formats/domains/spline.h"

namespace weft::files {
namespace {

class Hatch {
 public:
  Hatch(const DxfEntity& hatch, const DxfPlacement& place) : hatch_(hatch), place_(place) {}

  std::vector<ArcChain> rings() {
    while (at_ < hatch_.groups.size() && hatch_.groups[at_].code != 91) ++at_;
    const int paths = take_integer(91);
    std::vector<ArcChain> all;
    for (int i = 0; i < paths && skip_to(92); ++i) {
      constexpr int kPolyline = 2;
      ArcChain ring = (take_integer(92) & kPolyline) != 0 ? polyline() : edges();
      if (ring.points.empty()) continue;
      if (ring.points.back() != ring.points.front()) ring.add(ring.points.front(), 0);
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

  ArcChain polyline() {
    take_integer(72);  // whether there are bulges
    take_integer(73);  // every ring is closed
    take_integer(93);
    std::vector<std::pair<Point, double>> corners;
    while (here(10) != nullptr) {
      const Point at = take_point(10);
      corners.emplace_back(at, take(42));
    }
    ArcChain ring;
    if (corners.empty()) return ring;
    ring = ArcChain({place_(corners[0].first)});
    for (std::size_t i = 0; i < corners.size(); ++i)
      add_bulge(place_, corners[i].first, corners[(i + 1) % corners.size()].first,
                corners[i].second, ring);
    return ring;
  }

  ArcChain edges() {
    ArcChain ring;
    take_integer(93);
    while (here(72) != nullptr) {
      ArcChain edge;
      switch (take_integer(72)) {
        case 1: {
          const Point from = place_(take_point(10));
          edge = ArcChain({from, place_(take_point(11))});
          break;
        }
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
  static void join(ArcChain& ring, ArcChain edge) {
    if (ring.points.empty()) std::swap(ring, edge);
    if (edge.points.empty()) return;
    const auto gap = [end = ring.points.back()](Point p) {
      return std::hypot(p.x - end.x, p.y - end.y);
    };
    if (gap(edge.points.back()) < gap(edge.points.front())) turn_round(edge);
    const bool meets = gap(edge.points.front()) <= 1e-9 * gap(edge.points.back());
    if (!meets) ring.add(edge.points.front(), 0);
    for (std::size_t i = 1; i < edge.points.size(); ++i)
      ring.add(edge.points[i], edge.bulges[i - 1]);
  }
  static void turn_round(ArcChain& edge) {
    std::ranges::reverse(edge.points);
    std::reverse(edge.bulges.begin(), edge.bulges.end() - 1);
    for (double& bulge : edge.bulges) bulge = -bulge;
  }

  // Angles go clockwise if the edge does.
  ArcChain arc() {
    const Point centre = take_point(10);
    const double radius = take(40);
    return elliptic({centre, {radius, 0}, {0, radius}});
  }
  ArcChain ellipse() {
    const Point centre = take_point(10);
    const Point major = take_point(11);
    const double ratio = take(40);
    return elliptic({centre, major, {-major.y * ratio, major.x * ratio}});
  }
  ArcChain elliptic(DxfEllipse curve) {
    constexpr double kDegree = std::numbers::pi / 180;
    curve.from = take(50) * kDegree;
    curve.to = take(51) * kDegree;
    const bool is_clockwise = here(73) != nullptr && take_integer(73) == 0;
    if (is_clockwise) curve.minor = {-curve.minor.x, -curve.minor.y};
    if (curve.to < curve.from) curve.to += 2 * std::numbers::pi;
    return arcs_of(curve.placed(place_));
  }

  ArcChain spline() {
    Spline curve;
    curve.degree = take_integer(94);
    for (const int code : {73, 74, 95, 96}) take_integer(code);
    while (here(40) != nullptr) curve.knots.push_back(take(40));
    while (here(10) != nullptr) {
      curve.control.push_back(place_(take_point(10)));
      if (here(42) != nullptr) curve.weights.push_back(take(42));
    }
    if (here(97) != nullptr) {
      // The number of fit points, or of source objects, which follow the last edge.
      take_integer(97);
      while (here(11) != nullptr) take_point(11);
      for (const int code : {12, 13}) take_point(code);
    }
    return curve.is_sound() ? arcs_of(curve) : ArcChain(std::move(curve.control));
  }

  const DxfEntity& hatch_;
  const DxfPlacement& place_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<ArcChain> hatch_rings(const DxfEntity& hatch, const DxfPlacement& placement) {
  return Hatch(hatch, placement).rings();
}

}  // namespace weft::files
