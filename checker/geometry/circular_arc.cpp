// SPDX-License-Identifier: Apache-2.0
#include "checker/geometry/circular_arc.h"

#include <cmath>

namespace weft::check {

// With the chord from (-h, 0) to (h, 0) and the arc above it, of bulge t, the circle is
//   t (x^2 + y^2 - h^2) + h (1 - t^2) y = 0,
// and t times its radius is h (1 + t^2) / 2.
CircularArc::CircularArc(Vec2 from, Vec2 to, double bulge)
    : middle_x_((static_cast<long double>(from.x) + to.x) / 2),
      middle_y_((static_cast<long double>(from.y) + to.y) / 2),
      x_(static_cast<long double>(to.x) - from.x),
      y_(static_cast<long double>(to.y) - from.y),
      half_(std::hypot(x_, y_) / 2),
      bulge_(std::fabs(bulge)),
      sign_(bulge > 0 ? 1 : -1),
      turn_(4 * std::atan(bulge_)) {
  x_ /= 2 * half_;
  y_ /= 2 * half_;
}

double CircularArc::radius() const {
  return static_cast<double>(half_ * (1 + bulge_ * bulge_) / (2 * bulge_));
}

double CircularArc::distance(Vec2 p) const {
  const long double dx = p.x - middle_x_, dy = p.y - middle_y_;
  const long double x = dx * x_ + dy * y_, y = sign_ * (dx * y_ - dy * x_);
  const long double square = bulge_ * bulge_;
  const long double off = bulge_ * (x * x + y * y - half_ * half_) + half_ * (1 - square) * y;
  const long double to_centre = std::hypot(bulge_ * x, bulge_ * y + half_ * (1 - square) / 2);
  return static_cast<double>(off / (to_centre + half_ * (1 + square) / 2));
}

// As seen from the centre, which is (1 - t^2) h / 2 below the chord, over t.
double CircularArc::angle(Vec2 p) const {
  const long double dx = p.x - middle_x_, dy = p.y - middle_y_;
  const long double x = dx * x_ + dy * y_, y = sign_ * (dx * y_ - dy * x_);
  const long double from_middle =
      std::atan2(bulge_ * x, bulge_ * y + half_ * (1 - bulge_ * bulge_) / 2);
  return static_cast<double>(turn_ / 2 + from_middle);
}

Vec2 CircularArc::at(double angle) const {
  const long double diameter = half_ * (1 + bulge_ * bulge_) / bulge_;
  const long double length = diameter * std::sin(angle / 2.0L);
  const long double above = (turn_ - angle) / 2;  // the chord
  const long double x = length * std::cos(above) - half_, y = sign_ * length * std::sin(above);
  return {static_cast<double>(middle_x_ + x * x_ + y * y_),
          static_cast<double>(middle_y_ + x * y_ - y * x_)};
}

Vec2 CircularArc::tangent(double angle) const {
  const long double left = sign_ * (angle - turn_ / 2);  // of the chord
  const long double cosine = std::cos(left), sine = std::sin(left);
  return {static_cast<double>(x_ * cosine - y_ * sine),
          static_cast<double>(x_ * sine + y_ * cosine)};
}

double CircularArc::beside(Vec2 p, Vec2 q, double turn) const {
  const long double length =
      std::hypot(static_cast<long double>(q.x) - p.x, static_cast<long double>(q.y) - p.y);
  const long double angle = turn;
  // Of a sector less its triangle, over the squared radius, times 2.
  const long double part = turn < 1e-4 ? angle * angle * angle / 6 : angle - std::sin(angle);
  const long double radius = length / (2 * std::sin(angle / 2));
  return static_cast<double>(sign_ * radius * radius / 2 * part);
}

double CircularArc::height(Vec2 p, Vec2 q, double turn) {
  return std::hypot(q.x - p.x, q.y - p.y) / 2 * std::tan(turn / 2);
}

Vec2 CircularArc::side(Vec2 p, Vec2 q, double height) const {
  const double length = std::hypot(q.x - p.x, q.y - p.y);
  const double by = static_cast<double>(sign_) * height / length;
  return {(p.x + q.x) / 2 + by * (q.y - p.y), (p.y + q.y) / 2 - by * (q.x - p.x)};
}

}  // namespace weft::check
