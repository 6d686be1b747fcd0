// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/simplification.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/contacts.h"
#include "checker/geometry/sum.h"
#include "checker/size/size.h"
#include "checker/text.h"

namespace weft::check {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;  // of a length

// A point of the original's segments.
struct Nearest {
  double distance = kInfinity;
  Vec2 at;
  std::uint32_t segment = 0;
};

class Judge {
 public:
  Judge(const FacedDomain& original, const FacedDomain& simple, const Mesh& mesh,
        const Requirements& requirements, Findings& findings)
      : original_(original),
        simple_(simple),
        mesh_(mesh),
        requirements_(requirements),
        findings_(findings),
        tree_(boxes(original.domain)) {
    if (auto size = size_function(requirements.size, original.domain)) size_ = std::move(*size);
    for (const FaceRole& role : original.roles)
      if (role.kept) largest_bound_ = std::max(largest_bound_, role.max_area);
  }

  void judge() {
    for (std::uint32_t s = 0; s < simple_.domain.segments.size(); ++s) judge_segment(s);
    for (std::uint32_t s = 0; s < original_.domain.segments.size(); ++s) judge_beside(s);
    constexpr std::size_t kMaxTriangles = 20'000;
    const std::size_t step = 1 + mesh_.triangles.size() / kMaxTriangles;
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += step) {
      const auto [a, b, c] = mesh_.triangles[t];
      const Vec2 p = mesh_.vertices[a], q = mesh_.vertices[b], r = mesh_.vertices[c];
      judge_far_point({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
    }
    judge_points();
  }

 private:
  static std::vector<Box> boxes(const Domain& domain) {
    std::vector<Box> result;
    for (const auto& [a, b] : domain.segments)
      result.push_back(box_of(domain.points[a], domain.points[b]));
    return result;
  }

  double finest(Vec2 p) const {
    double area = std::min(largest_bound_, requirements_.max_area.value_or(kInfinity));
    if (size_) {
      const double asked = size_(p);
      if (asked > 0 && asked < area) area = asked;
    }
    double edge = std::sqrt(area * 4 / std::sqrt(3.0));
    return requirements_.simplify * edge;
  }

  // Sizes at markers bound the lengths on their segments alone.
  double finest(Vec2 p, std::int32_t marker) const {
    double edge = finest(p);
    for (const SizeAt& at : requirements_.size.at)
      if (at.marker == marker) edge = std::min(edge, requirements_.simplify * at.max_edge);
    return edge;
  }

  std::int32_t marker_of(const Domain& domain, std::uint32_t segment) const {
    return domain.markers.empty() ? 0 : domain.markers[segment];
  }

  // The nearest point of the original's segments that `counts`, if one is nearer than `within`.
  template <class Counts>
  Nearest nearest(Vec2 p, double within, Counts&& counts) const {
    Nearest result;
    const Domain& domain = original_.domain;
    const auto distance = [&](std::uint32_t s) {
      if (!counts(s)) return kInfinity;
      const auto [a, b] = domain.segments[s];
      return Track(domain.points[a], domain.points[b]).distance(p);
    };
    double below = within;
    const auto found = tree_.least(p, 1, below, distance);
    if (!found) return result;
    const auto [a, b] = domain.segments[*found];
    const Vec2 from = domain.points[a], to = domain.points[b];
    const Track track(from, to);
    const double t = std::clamp(track.position(p) / track.length(), 0.0, 1.0);
    return {below, {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}, *found};
  }

  // No segment is far from all of the original's with its marker.
  void judge_segment(std::uint32_t s) {
    const auto [a, b] = simple_.domain.segments[s];
    const Vec2 from = simple_.domain.points[a], to = simple_.domain.points[b];
    const std::int32_t marker = marker_of(simple_.domain, s);
    const double limit = std::max(finest(from, marker), finest(to, marker));
    if (!(limit < kInfinity)) return;
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    constexpr double kMaxSteps = 1e5;
    const double steps = std::clamp(std::ceil(8 * length / limit), 2.0, kMaxSteps);
    for (double i = 0; i <= steps; ++i) {
      const Vec2 p{from.x + i / steps * (to.x - from.x), from.y + i / steps * (to.y - from.y)};
      const Nearest near = nearest(p, kInfinity, [&](std::uint32_t other) {
        return marker_of(original_.domain, other) == marker;
      });
      const double most = std::max(limit, finest(near.at, marker));
      if (near.distance <= most * (1 + kRounding) + merging_distance(original_.domain)) continue;
      findings_.add(Rule::kSimplified, [&] {
        return say("the edge with marker ", marker, " from ", from, " to ", to, " is ",
                   near.distance, " from the segments with this marker at ", p, ", ", most,
                   " are allowed");
      });
      return;
    }
  }

  void judge_beside(std::uint32_t s) {
    const auto [a, b] = original_.domain.segments[s];
    const Vec2 from = original_.domain.points[a], to = original_.domain.points[b];
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const Vec2 middle{(from.x + to.x) / 2, (from.y + to.y) / 2};
    const double away = 1.02 * finest(middle);
    if (!(away < kInfinity)) return;
    for (const double side : {away, -away})
      judge_far_point(
          {middle.x - side * (to.y - from.y) / length, middle.y + side * (to.x - from.x) / length});
  }

  // What is far from the original's segments is as it was.
  void judge_far_point(Vec2 p) {
    const double limit = finest(p);
    if (!(limit < kInfinity)) return;
    const Nearest near = nearest(p, kInfinity, [](std::uint32_t) { return true; });
    const auto [a, b] = original_.domain.segments[near.segment];
    const double most = std::max({limit, finest(near.at), finest(original_.domain.points[a]),
                                  finest(original_.domain.points[b])});
    if (near.distance <= most * (1 + kRounding)) return;
    const std::uint32_t face = original_.arrangement.locate(p).face;
    const FaceRole was = original_.roles[face];
    const FaceRole is = simple_.roles[simple_.arrangement.locate(p).face];
    if (was.open || (was.kept && was.is_region_open)) return;
    if (was.kept == is.kept && (!was.kept || was.region == is.region)) return;
    if (was.kept && !is.kept && may_be_cut_off(p, original_.arrangement.faces()[face].area)) return;
    findings_.add(Rule::kSimplified, [&] {
      const auto name = [](const FaceRole& role) {
        return role.kept ? say("in region ", role.region) : std::string("not meshed");
      };
      return say("the point ", p, ", ", near.distance, " from all segments, was ", name(was),
                 " and is ", name(is));
    });
  }

  // Whether the face of both domains' segments together that p lies in is a small water, and part
  // of a face of this area that has others.
  bool may_be_cut_off(Vec2 p, double area) {
    if (!overlay_) {
      std::vector<Vec2> points = original_.domain.points;
      std::vector<SegmentEnds> segments = original_.domain.segments;
      const auto first = static_cast<std::uint32_t>(points.size());
      points.insert(points.end(), simple_.domain.points.begin(), simple_.domain.points.end());
      for (const auto& [a, b] : simple_.domain.segments) segments.push_back({first + a, first + b});
      const Contacts contacts = find_contacts(points, segments, kMaxContacts);
      if (!contacts.complete) return true;  // cannot be told
      overlay_.emplace(points, segments, contacts);
      largest_finest_.assign(overlay_->faces().size(), 0);
      for (std::uint32_t h = 0; h < 2 * overlay_->edges().size(); ++h) {
        double& largest = largest_finest_[overlay_->face(h)];
        largest = std::max(largest, finest(overlay_->vertices().at(overlay_->edges()[h / 2].u)));
      }
    }
    const std::uint32_t f = overlay_->locate(p).face;
    const Arrangement::Face& face = overlay_->faces()[f];
    const double length = largest_finest_[f];
    constexpr double kAlone = 1.01;
    return f != 0 && area > kAlone * face.area &&
           face.area - face.perimeter * length / 2 <
               kMaxCutOff * std::sqrt(3.0) / 4 * length * length;
  }

  // Points that no segment names, and those where segments meet or end, stay.
  void judge_points() {
    const Arrangement& arrangement = original_.arrangement;
    std::vector<Vec2> vertices = mesh_.vertices;
    std::sort(vertices.begin(), vertices.end(), lexicographically_less);
    const auto is_vertex = [&](Vec2 p) {
      return std::binary_search(vertices.begin(), vertices.end(), p, lexicographically_less);
    };
    std::vector<char> is_named(original_.domain.points.size(), 0);
    for (const auto& [a, b] : original_.domain.segments) is_named[a] = is_named[b] = 1;
    for (std::uint32_t i = 0; i < is_named.size(); ++i) {
      const Vec2 p = original_.domain.points[i];
      if (is_vertex(p)) continue;
      if (is_named[i] ? !is_end(arrangement.vertices().of_point(i))
                      : !original_.roles[arrangement.locate(p).face].kept)
        continue;
      findings_.add(Rule::kSimplified, [&] {
        return say(
            "point ", i, " at ", p, " is gone, ",
            is_named[i] ? "where segments meet, or a marker ends" : "which no segment names");
      });
    }
  }

  // Whether other than two edges beside kept faces meet in a vertex, or two with different markers.
  bool is_end(std::uint32_t vertex) const {
    const Arrangement& arrangement = original_.arrangement;
    int count = 0;
    std::optional<std::int32_t> marker;
    bool differ = false;
    for (const std::uint32_t h : arrangement.half_edges_at(vertex)) {
      const auto covers = arrangement.covers(h / 2);
      if (covers.empty() || (!original_.roles[arrangement.face(h)].kept &&
                             !original_.roles[arrangement.face(h ^ 1)].kept))
        continue;
      ++count;
      if (covers.size() > 1) continue;  // which marker counts is left to others
      const std::int32_t own = marker_of(original_.domain, covers[0]);
      differ = differ || (marker && *marker != own);
      marker = own;
    }
    return count > 0 && (count != 2 || differ);
  }

  const FacedDomain& original_;
  const FacedDomain& simple_;
  const Mesh& mesh_;
  const Requirements& requirements_;
  Findings& findings_;
  BoxTree tree_;                          // of the original's segments
  std::function<double(Vec2)> size_{};    // empty if there is none
  double largest_bound_ = 0;              // of the original's kept faces
  std::optional<Arrangement> overlay_{};  // of both domains' segments, once it is needed
  std::vector<double> largest_finest_{};  // per face of it
};

double kept_area(const FacedDomain& domain) {
  Sum sum;
  for (std::size_t f = 0; f < domain.roles.size(); ++f)
    if (domain.roles[f].kept) sum.add(domain.arrangement.faces()[f].area);
  return static_cast<double>(sum.total());
}

}  // namespace

void judge_simplification(const FacedDomain& original, const FacedDomain& simple, const Mesh& mesh,
                          const Requirements& requirements, Facts& facts, Findings& findings) {
  facts.area_change = kept_area(simple) - kept_area(original);
  Judge(original, simple, mesh, requirements, findings).judge();
}

}  // namespace weft::check
