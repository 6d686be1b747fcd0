// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/biarcs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace weft::files {
namespace {

constexpr int kMaxDivisions = 12;  // in halves; one into three counts for two
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kSamples = 7;              // of a piece, between its ends
constexpr double kOfExtent = 2e-5;       // that a curve may leave its arcs by
constexpr double kOfRadius = 1e-4;       // of the smaller arc
constexpr double kMinOfExtent = 1e-7;    // no nearer than this
constexpr double kRounding = 1e-12;      // of the extent: an arc that is no higher is straight
constexpr double kSameCurvature = 1e-9;  // times the distance between the ends
constexpr double kStandsStill = 1e-9;    // of the extent: a tangent that says nothing

Point operator-(Point a, Point b) {
  return {a.x - b.x, a.y - b.y};
}
double dot(Point a, Point b) {
  return a.x * b.x + a.y * b.y;
}
double cross(Point a, Point b) {
  return a.x * b.y - a.y * b.x;
}
double length(Point v) {
  return std::sqrt(dot(v, v));
}
Point unit(Point v) {
  const double l = length(v);
  return {v.x / l, v.y / l};
}
// No product of two coordinates overflows; no domain has larger ones.
bool is_usable(Point p) {
  return std::abs(p.x) <= 1e60 && std::abs(p.y) <= 1e60;
}

// From a point where it has a tangent of length 1 to another one.
struct Arc {
  Point from, tangent, to;

  double curvature() const {
    const Point chord = to - from;
    return 2 * cross(tangent, chord) / dot(chord, chord);
  }
  // The tangent of a quarter of its turn, which is twice the angle from the tangent to the chord.
  double bulge() const {
    const Point chord = to - from;
    return cross(tangent, chord) / (length(chord) + dot(tangent, chord));
  }
  // From its circle.
  double distance(Point p) const {
    const Point w = p - from;
    const double k = curvature();
    const double h = 2 * cross(tangent, w) - k * dot(w, w);
    return std::abs(h) / (1 + std::sqrt(std::max(1 - k * h, 0.0)));
  }
};

struct Biarc {
  Arc first, second;

  double distance(Point p) const {
    return dot(p - second.from, second.tangent) < 0 ? first.distance(p) : second.distance(p);
  }
  // Whether both are of one circle, or of one line.
  bool is_one_arc() const {
    return std::abs(first.curvature() - second.curvature()) * length(second.to - first.from) <=
           kSameCurvature;
  }
};

// With the ends and the tangents there, which are of length 1. Of the biarcs there are it is the
// one whose arcs have tangents of the same length, up to where these meet. None if the direction
// turns by more than 60 degrees from that of the chord.
std::optional<Biarc> biarc(Point a, Point tangent_a, Point b, Point tangent_b) {
  const Point v = b - a;
  const double span = length(v);
  if (!(dot(tangent_a, v) >= 0.5 * span && dot(tangent_b, v) >= 0.5 * span && span > 0))
    return std::nullopt;
  const double along = dot(v, tangent_a) + dot(v, tangent_b);
  const double d =
      span * span /
      (along + std::sqrt(along * along + 2 * (1 - dot(tangent_a, tangent_b)) * span * span));
  const Point before{a.x + d * tangent_a.x, a.y + d * tangent_a.y};
  const Point after{b.x - d * tangent_b.x, b.y - d * tangent_b.y};
  const Point joint{(before.x + after.x) / 2, (before.y + after.y) / 2};
  return Biarc{{a, tangent_a, joint}, {joint, unit(after - before), b}};
}

class Follower {
 public:
  Follower(const Curve& curve, double extent, ArcChain& chain)
      : curve_(curve), extent_(extent), chain_(chain) {}

  void follow(double from, const CurvePoint& a, double to, const CurvePoint& b, int divisions) {
    std::array<CurvePoint, kSamples> samples;
    for (int i = 0; i < kSamples; ++i)
      samples[static_cast<std::size_t>(i)] = curve_(from + (to - from) * (i + 1) / (kSamples + 1));
    if (is_point(a.at, b.at, samples) || divisions <= 0) return chain_.add(b.at, 0);
    const Point tangent_a = tangent_at(a, from + (to - from) / 64, 1);
    const Point tangent_b = tangent_at(b, to - (to - from) / 64, -1);
    const auto fit = biarc(a.at, tangent_a, b.at, tangent_b);
    const double excess = fit ? excess_of(*fit, samples) : kNever;
    if (excess <= 1) return add(*fit);
    // The excess goes by the cube of the length.
    const bool in_three = excess > 8 && excess <= 27;
    divide(from, a, to, b, in_three ? 3 : 2, divisions - (in_three ? 2 : 1));
  }

  // In equal pieces of the parameter.
  void divide(double from, CurvePoint a, double to, const CurvePoint& b, int pieces,
              int divisions) {
    double start = from;
    for (int i = 1; i <= pieces; ++i) {
      const double end = i == pieces ? to : from + (to - from) * i / pieces;
      const CurvePoint at = i == pieces ? b : curve_(end);
      follow(start, a, end, at, divisions);
      start = end;
      a = at;
    }
  }

 private:
  using Samples = std::array<CurvePoint, kSamples>;

  // Or no number.
  bool is_point(Point a, Point b, const Samples& samples) const {
    const auto is_near = [&](Point p) { return length(p - a) <= kMinOfExtent * extent_; };
    return !std::ranges::all_of(samples, is_usable, &CurvePoint::at) || !is_usable(b) ||
           (is_near(b) && std::ranges::all_of(samples, is_near, &CurvePoint::at));
  }

  // Of length 1; from inside the piece, where the curve stands still at its end.
  Point tangent_at(const CurvePoint& end, double inside, double sign) const {
    if (length(end.tangent) > kStandsStill * extent_) return unit(end.tangent);
    const Point v = curve_(inside).at - end.at;
    return unit({sign * v.x, sign * v.y});
  }

  // The greatest distance of a sample over the one that is allowed.
  double excess_of(const Biarc& fit, const Samples& samples) const {
    const Point v = fit.second.to - fit.first.from;
    const double curvature =
        std::max(std::abs(fit.first.curvature()), std::abs(fit.second.curvature()));
    const double allowed =
        std::min(kOfExtent * extent_, std::max(kOfRadius / curvature, kMinOfExtent * extent_));
    double reached = 0;
    double most = 0;
    for (const CurvePoint& sample : samples) {
      const double along = dot(sample.at - fit.first.from, v);
      if (!(along >= reached)) return kNever;
      reached = along;
      most = std::max(most, fit.distance(sample.at));
    }
    return reached <= dot(v, v) ? most / allowed : kNever;
  }

  void add(const Biarc& fit) {
    const Arc whole{fit.first.from, fit.first.tangent, fit.second.to};
    if (fit.is_one_arc()) return add(whole);
    add(fit.first);
    add(fit.second);
  }
  // Straight if it is hardly higher than its chord.
  void add(const Arc& arc) {
    const double bulge = arc.bulge();
    const double height = std::abs(bulge) * length(arc.to - arc.from) / 2;
    chain_.add(arc.to, height > kRounding * extent_ ? bulge : 0);
  }

  const Curve& curve_;
  const double extent_;
  ArcChain& chain_;
};

}  // namespace

void add_biarcs(const Curve& curve, double from, double to, int pieces, double extent,
                ArcChain& chain) {
  Follower(curve, extent, chain).divide(from, curve(from), to, curve(to), pieces, kMaxDivisions);
}

}  // namespace weft::files
