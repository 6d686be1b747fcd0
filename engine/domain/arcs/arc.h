// SPDX-License-Identifier: Apache-2.0
// Arcs of circles, by their ends and their bulge: the tangent of a quarter of the turn from the
// first end to the second, above 0 if it turns left. An arc lies right of its chord then.
//
// Nothing but + - * / and square roots, which round the same on every machine: sines come from
// their series, arc tangents from halving the bulge.
//
// Units: coordinates of the domain; angles in radians; curvatures are 1 over the radius, with the
// sign of the bulge. Thread-safety: pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/geometry.h"
#include "engine/base/vector.h"

namespace weft {

// Of each half of an arc.
inline double half_bulge(double bulge) {
  return bulge / (1 + std::sqrt(1 + bulge * bulge));
}

// Of an arc with this curvature and chord, which turns by at most 180 degrees.
inline double bulge_of(double curvature, double chord) {
  const double sine = std::clamp(0.5 * curvature * chord, -1.0, 1.0);  // of half of the turn
  return sine / (1 + std::sqrt(1 - sine * sine));
}

inline double curvature_of(double chord, double bulge) {
  return 4 * bulge / ((1 + bulge * bulge) * chord);
}

// The end of a vector that is turned left.
inline Vector turned_left(Vector v, double cosine, double sine) {
  return {v.x * cosine - v.y * sine, v.x * sine + v.y * cosine};
}

// Of an arc that leaves the start of this chord along this tangent. Unlike `bulge_of`, exact to
// rounding for half circles, too.
inline double bulge_from_tangent(Vector tangent, Vector chord) {
  return cross(tangent, chord) / (length(tangent) * length(chord) + dot(tangent, chord));
}

// Along the arc, as long as its chord.
inline Vector tangent_at_start(Point a, Point b, double bulge) {
  const double scale = 1 / (1 + bulge * bulge);
  return turned_left(b - a, (1 - bulge * bulge) * scale, -2 * bulge * scale);
}
inline Vector tangent_at_end(Point a, Point b, double bulge) {
  const double scale = 1 / (1 + bulge * bulge);
  return turned_left(b - a, (1 - bulge * bulge) * scale, 2 * bulge * scale);
}

// The point on the bisector of the chord, at `height` times half of the chord from its middle, on
// the side of the arc: its own middle for a height of `bulge`.
inline Point above_chord(Point a, Point b, double height) {
  const Vector chord = b - a;
  return {0.5 * a.x + 0.5 * b.x + 0.5 * height * chord.y,
          0.5 * a.y + 0.5 * b.y - 0.5 * height * chord.x};
}
inline Point middle_of_arc(Point a, Point b, double bulge) {
  return above_chord(a, b, bulge);
}
// Where the tangents at the ends meet: the third corner of the triangle that holds the arc.
// REQUIRES: it turns by less than 180 degrees.
inline Point control_point(Point a, Point b, double bulge) {
  return above_chord(a, b, 2 * bulge / (1 - bulge * bulge));
}

// The point of an arc at a distance from the end `from` of it, where `tangent`, of length 1, leads
// along the arc. REQUIRES: the distance is at most the diameter.
inline Point at_distance(Point from, Vector tangent, double curvature, double distance) {
  const double sine = std::clamp(0.5 * curvature * distance, -1.0, 1.0);
  const Vector chord = turned_left(tangent, std::sqrt(1 - sine * sine), sine);
  return {from.x + distance * chord.x, from.y + distance * chord.y};
}

// How far p is from the circle through a with this curvature and tangent, of length 1, there: above
// 0 right of it.
inline double offset_from_circle(Point a, Vector tangent, double curvature, Point p) {
  const Vector d = p - a;
  const double left = cross(tangent, d);
  const double root = 1 - 2 * curvature * left + curvature * curvature * dot(d, d);
  return (curvature * dot(d, d) - 2 * left) / (1 + std::sqrt(std::max(0.0, root)));
}

// REQUIRES: -1.6 <= angle <= 1.6.
inline std::array<double, 2> cosine_and_sine(double angle) {
  double cosine = 0, sine = 0;
  for (int k = 24; k > 0; k -= 2) {
    const double square = angle * angle;
    cosine = (cosine + 1) * -square / (k * (k - 1));
    sine = (sine + 1) * -square / (k * (k + 1));
  }
  return {1 + cosine, angle + angle * sine};
}

// 4 atan(bulge).
inline double turn_of(double bulge) {
  double scale = 4;
  for (; std::fabs(bulge) > 0x1p-4; scale *= 2) bulge = half_bulge(bulge);
  const double square = bulge * bulge;
  double sum = 0;
  for (int k = 13; k > 0; k -= 2) sum = 1.0 / k - square * sum;
  return scale * bulge * sum;
}

// Between an arc and its chord; above 0 if the arc lies right of the line from a to b.
inline double area_beside_chord(Point a, Point b, double bulge) {
  const double square = dot(b - a, b - a), height = bulge * bulge;
  if (height < 1e-6) return square * bulge / 3;  // to 2e-7 of itself
  const double turn = std::copysign(turn_of(std::fabs(bulge)), bulge);
  const double sine = 4 * bulge * (1 - height) / ((1 + height) * (1 + height));
  return square * (1 + height) * (1 + height) / (32 * height) * (turn - sine);
}

// The point after this fraction of the arc. REQUIRES: it turns by at most 180 degrees.
inline Point at_fraction(Point a, Point b, double bulge, double fraction) {
  const double half_turn = 0.5 * turn_of(bulge);
  const double whole = cosine_and_sine(half_turn)[1];
  const double length = whole == 0 ? fraction : cosine_and_sine(fraction * half_turn)[1] / whole;
  const auto [cosine, sine] = cosine_and_sine((fraction - 1) * half_turn);
  const Vector along = turned_left(b - a, cosine, sine);
  return {a.x + length * along.x, a.y + length * along.y};
}

}  // namespace weft
