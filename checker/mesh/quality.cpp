// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "checker/geometry/sum.h"
#include "checker/size/gradation.h"
#include "checker/size/gradation_within.h"
#include "checker/text.h"

namespace weft::check {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Angles are compared by their cotangents, which fall as the angle grows.
double cotangent(double degrees) {
  return std::tan((90 - degrees) / kDegrees);
}
double degrees_of(double cotangent) {
  return std::atan2(1.0, cotangent) * kDegrees;
}

struct Shape {
  double area = 0;
  double largest_cotangent = 0;  // of the smallest angle
  double smallest_cotangent = 0;
  double quality = 0;
  std::uint32_t smallest_corner = 0;
  Vec2 centroid;
};

Vec2 centroid_of(const std::array<Vec2, 3>& p) {
  return {(p[0].x + p[1].x + p[2].x) / 3, (p[0].y + p[1].y + p[2].y) / 3};
}

Shape shape_of(const std::array<Vec2, 3>& p) {
  const double cross =
      (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
  std::array<double, 3> dot;
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 v = p[i], next = p[(i + 1) % 3], previous = p[(i + 2) % 3];
    dot[i] = (next.x - v.x) * (previous.x - v.x) + (next.y - v.y) * (previous.y - v.y);
    squares += (next.x - v.x) * (next.x - v.x) + (next.y - v.y) * (next.y - v.y);
  }
  const auto [least, most] = std::minmax_element(dot.begin(), dot.end());
  // The triangle is counter-clockwise; a product of differences may still round to 0 or below.
  const double positive = std::max(cross, std::numeric_limits<double>::min());
  return {positive / 2,
          *most / positive,
          *least / positive,
          2 * std::numbers::sqrt3 * positive / squares,
          static_cast<std::uint32_t>(most - dot.begin()),
          centroid_of(p)};
}

class QualityJudge {
 public:
  QualityJudge(const Domain& domain, const Mesh& mesh, const Requirements& requirements,
               const QualityContext& context, Facts& facts, Findings& findings)
      : mesh_(mesh),
        requirements_(requirements),
        context_(context),
        facts_(facts),
        findings_(findings),
        misses_(requirements.listed_violations),
        cotangent_limit_(requirements.min_angle_deg.value_or(0) > kAngleTolerance
                             ? cotangent(*requirements.min_angle_deg - kAngleTolerance)
                             : std::numeric_limits<double>::infinity()) {
    auto size = size_function(requirements.size, domain);
    if (size)
      size_ = std::move(*size);
    else
      findings_.add(Rule::kSize, [&] { return size.error(); });
    if (requirements.size.gradation > 0) limit_gradation();
  }

  void judge() {
    Sum area;
    Sum quality;
    std::vector<double> cotangents;
    cotangents.reserve(mesh_.triangles.size());
    double largest_cotangent = -std::numeric_limits<double>::infinity();
    double smallest_cotangent = std::numeric_limits<double>::infinity();
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::array<Vec2, 3> corners = corners_of(t);
      const Shape shape = shape_of(corners);
      area.add(shape.area);
      if (context_.is_layer != nullptr && (*context_.is_layer)[t]) continue;
      quality.add(shape.quality);
      cotangents.push_back(shape.largest_cotangent);
      largest_cotangent = std::max(largest_cotangent, shape.largest_cotangent);
      smallest_cotangent = std::min(smallest_cotangent, shape.smallest_cotangent);
      const bool misses_angle = !judge_angle(t, shape);
      const bool misses_area = !judge_area(t, shape, corners);
      if (misses_angle || misses_area) note_unrefined(t, shape.centroid);
    }
    facts_.area = static_cast<double>(area.total());
    facts_.min_angle_deg = degrees_of(largest_cotangent);
    facts_.max_angle_deg = degrees_of(smallest_cotangent);
    if (facts_.judged_angle_at) facts_.judged_angle_deg = degrees_of(judged_cotangent_);
    if (!cotangents.empty()) {
      const auto percentile =
          cotangents.begin() + static_cast<std::ptrdiff_t>(cotangents.size() / 100);
      std::nth_element(cotangents.begin(), percentile, cotangents.end(), std::greater<>());
      facts_.min_angle_p1_deg = degrees_of(*percentile);
      facts_.mean_quality =
          static_cast<double>(quality.total()) / static_cast<double>(cotangents.size());
    }
    if (bounded_ > 0)
      facts_.ideal_ratio = static_cast<double>(bounded_) / static_cast<double>(shares_.total());
    if (facts_.unrefined > requirements_.allowed_unrefined) findings_.merge(misses_);
  }

 private:
  std::array<Vec2, 3> corners_of(std::uint32_t t) const {
    const auto [a, b, c] = mesh_.triangles[t];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }

  // Sizes grow from the bounds of regions, too.
  void limit_gradation() {
    std::vector<Vec2> points = mesh_.vertices;
    points.reserve(points.size() + mesh_.triangles.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      points.push_back(centroid_of(corners_of(t)));
    std::vector<double> areas(points.size(), std::numeric_limits<double>::infinity());
    if (size_) std::transform(points.begin(), points.end(), areas.begin(), size_);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      double& area = areas[mesh_.vertices.size() + t];
      if (!std::isnan(area)) area = std::min(area, region_bound(t));
    }
    const double gradation = requirements_.size.gradation;
    if (!requirements_.size.gradation_within) {
      limit_ = GradationLimit(points, areas, gradation);
      return;
    }
    for (const Mesh::Edge& edge : mesh_.edges)
      for (const SizeAt& at : requirements_.size.at)
        if (at.marker == edge.marker)
          for (const std::uint32_t v : {edge.a, edge.b}) {
            const double area = area_of_edge(at.max_edge);
            if (!(areas[v] <= area)) areas[v] = area;
          }
    limit_ = GradationWithin(mesh_, areas, gradation);
  }

  double region_bound(std::uint32_t t) const {
    return context_.faces.empty() ? std::numeric_limits<double>::infinity()
                                  : context_.roles[context_.faces[t]].max_area;
  }

  // The size at p; if a sample of the gradation limits it to less than `area`, the limit.
  double size_at(Vec2 p, double area) const {
    const double size = size_(p);
    if (!limit_ || !is_size(size)) return size;
    const double enough = std::min(size, area);
    const double limited = limit_(p, enough);
    return limited < enough ? limited : size;
  }

  static bool is_size(double size) { return size > 0 && !std::isinf(size); }

  void note_unrefined(std::uint32_t t, Vec2 at) {
    if (facts_.unrefined++ > 0) return;
    facts_.first_unrefined = t;
    facts_.first_unrefined_at = at;
  }

  void note_judged_angle(std::uint32_t t, const Shape& shape) {
    if (facts_.judged_angle_at && shape.largest_cotangent <= judged_cotangent_) return;
    judged_cotangent_ = shape.largest_cotangent;
    facts_.judged_angle_at = {t, shape.centroid};
  }

  bool judge_angle(std::uint32_t t, const Shape& shape) {
    const bool may_exempt = requirements_.allow_small_input_angles;
    if (may_exempt && context_.small_input_angles == nullptr) return true;
    if (shape.largest_cotangent <= cotangent_limit_) {
      note_judged_angle(t, shape);
      return true;
    }
    if (may_exempt) {
      switch (context_.small_input_angles->exemption(t, shape.smallest_corner)) {
        case Exemption::kCorner:
          ++facts_.exempt_corner;
          return true;
        case Exemption::kShell:
          ++facts_.exempt_shell;
          return true;
        case Exemption::kNone:
          break;
      }
    }
    note_judged_angle(t, shape);
    misses_.add(Rule::kAngle, [&] {
      return say(name(t), " has an angle of ", degrees_of(shape.largest_cotangent),
                 " degrees at vertex ", mesh_.triangles[t][shape.smallest_corner],
                 ", the bound is ", *requirements_.min_angle_deg);
    });
    return false;
  }

  bool judge_area(std::uint32_t t, const Shape& shape, const std::array<Vec2, 3>& corners) {
    const double fixed = std::min(
        requirements_.max_area.value_or(std::numeric_limits<double>::infinity()), region_bound(t));
    double bound = fixed;
    if (size_) {
      double size = size_at(shape.centroid, shape.area);
      if (!is_size(size) || shape.area > std::min(fixed, size) * (1 + kAreaTolerance))
        size = largest_size_nearby(shape, corners);
      if (!is_size(size)) {
        findings_.add(Rule::kSize, [&] {
          return say("the size is ", size_(shape.centroid), " at ", shape.centroid,
                     ", the centroid of triangle ", t);
        });
        return true;
      }
      bound = std::min(fixed, size);
    } else if (limit_) {
      bound = limit_(shape.centroid, fixed);
    }
    if (std::isinf(bound)) return true;
    ++bounded_;
    shares_.add(shape.area / bound);
    if (const double ratio = shape.area / bound; ratio > facts_.worst_area_ratio.value_or(0)) {
      facts_.worst_area_ratio = ratio;
      facts_.worst_area_at = {t, shape.centroid};
    }
    if (shape.area <= bound * (1 + kAreaTolerance)) return true;
    misses_.add(Rule::kArea, [&] {
      return say(name(t), " has the area ", shape.area, ", the bound at its centroid ",
                 shape.centroid, " is ", bound,
                 limit_ && bound < fixed && (!size_ || bound < size_(shape.centroid))
                     ? say(", because sizes grow by at most ", requirements_.size.gradation)
                     : "");
    });
    return false;
  }

  // The largest of the nine values around the centroid; 0 if none of them is a size.
  double largest_size_nearby(const Shape& shape, const std::array<Vec2, 3>& corners) const {
    double magnitude = 0;
    for (const Vec2 p : corners) magnitude = std::max({magnitude, std::fabs(p.x), std::fabs(p.y)});
    const double step = 16 * 0x1p-53 * magnitude;
    double largest = 0;
    for (const double dx : {-step, 0.0, step}) {
      for (const double dy : {-step, 0.0, step}) {
        const double size = size_at({shape.centroid.x + dx, shape.centroid.y + dy}, shape.area);
        if (is_size(size)) largest = std::max(largest, size);
      }
    }
    return largest;
  }

  std::string name(std::uint32_t t) const {
    const auto [a, b, c] = mesh_.triangles[t];
    return say("triangle ", t, " (", a, ", ", b, ", ", c, ") at ", mesh_.vertices[a], ", ",
               mesh_.vertices[b], ", ", mesh_.vertices[c]);
  }

  const Mesh& mesh_;
  const Requirements& requirements_;
  const QualityContext& context_;
  Facts& facts_;
  Findings& findings_;
  Findings misses_;  // violations, once there are more than allowed
  double cotangent_limit_;
  double judged_cotangent_ = 0;                // of facts_.judged_angle_at
  std::function<double(Vec2)> size_;           // empty if there is none
  std::function<double(Vec2, double)> limit_;  // of the size and the bounds of regions, or empty
  std::uint64_t bounded_ = 0;                  // triangles
  Sum shares_;                                 // of their bounds
};

}  // namespace

void judge_quality(const Domain& domain, const Mesh& mesh, const Requirements& requirements,
                   const QualityContext& context, Facts& facts, Findings& findings) {
  QualityJudge(domain, mesh, requirements, context, facts, findings).judge();
}

void judge_lengths(const Mesh& mesh, const Requirements& requirements, Findings& findings) {
  if (requirements.allowed_unrefined > 0) return;
  for (const Mesh::Edge& edge : mesh.edges) {
    const Vec2 a = mesh.vertices[edge.a];
    const Vec2 b = mesh.vertices[edge.b];
    const double magnitude =
        std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    for (const SizeAt& at : requirements.size.at)
      if (at.marker == edge.marker && length > at.max_edge * (1 + 2e-9) + 0x1p-49 * magnitude)
        findings.add(Rule::kLengths, [&] {
          return say("the edge from ", a, " to ", b, " is ", length, " long, the size at marker ",
                     at.marker, " is ", at.max_edge);
        });
  }
}

}  // namespace weft::check
