// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "checker/lint/lint.h"
#include "checker/lint/rules.h"

namespace weft::check {
namespace {

// A face's two longest edges, as half-edges with the face on their left.
struct FaceShape {
  std::uint32_t edges = 0;
  std::array<std::uint32_t, 2> longest{};
  std::array<double, 2> length{};
  double width = 0;        // mean
  bool vanishes = false;   // by merging
  bool is_sliver = false;  // otherwise
};

class FaceJudge {
 public:
  FaceJudge(const LintContext& context, Faults& faults)
      : context_(context), arrangement_(*context.arrangement), faults_(faults) {
    measure();
  }

  void judge_slivers() {
    for (std::size_t f = 1; f < shapes_.size(); ++f) {
      const FaceShape& shape = shapes_[f];
      if (!shape.is_sliver) continue;
      Fault fault{.kind = FaultKind::kSliver, .at = inside(shape), .measure = shape.width};
      for (const std::uint32_t h : shape.longest)
        if (const auto covers = arrangement_.covers(h / 2); !covers.empty())
          fault.offenders.push_back(context_.segment(covers[0]));
      faults_.add(std::move(fault));
    }
  }

  // At ends of segments. Crossings are faults anyway, and so are slivers.
  void judge_angles() {
    const VertexOrder& vertices = arrangement_.vertices();
    std::vector<char> is_done(vertices.size(), 0);
    for (std::uint32_t place = 0; place < context_.snapped.places.size(); ++place) {
      if (context_.snapped.segments_at(place).empty()) continue;
      const std::uint32_t v = vertices.of_point(place);
      std::vector<std::uint32_t> around;
      for (const std::uint32_t h : arrangement_.half_edges_at(v))
        if (!arrangement_.covers(h / 2).empty()) around.push_back(h);
      for (std::size_t k = 0; around.size() > 1 && k < around.size(); ++k) {
        const std::uint32_t h = around[k], next = around[(k + 1) % around.size()];
        const FaceShape& shape = shapes_[arrangement_.face(h)];
        const double angle = angle_deg(h, next);
        if (!(angle < kSmallAngleDeg) || shape.vanishes || shape.is_sliver) continue;
        faults_.add({.kind = FaultKind::kSmallAngle,
                     .at = context_.snapped.places[place],
                     .offenders = {context_.segment(arrangement_.covers(h / 2)[0]),
                                   context_.segment(arrangement_.covers(next / 2)[0])},
                     .measure = angle});
      }
    }
  }

  // Of polygons that are neither holes nor inside each other.
  void judge_areas() {
    const Domain& domain = context_.domain;
    if (domain.fill == Fill::kEvenOdd) return;  // overlaps are meant
    struct Shared {
      std::uint32_t faces = 0;
      double area = 0;
      std::uint32_t largest = 0;  // face
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, Shared> shared;
    std::vector<std::uint32_t> faces(domain.areas.size(), 0);
    for (std::uint32_t f = 1; f < context_.covering.size(); ++f) {
      if (shapes_[f].vanishes) continue;
      std::vector<std::uint32_t> areas;
      for (const std::uint32_t a : context_.covering[f])
        if (!domain.areas[a].is_hole) areas.push_back(a);
      for (const std::uint32_t a : areas) ++faces[a];
      constexpr std::size_t kMaxStacked = 64;  // so that a pile of polygons takes linear time
      if (areas.size() > kMaxStacked) areas.resize(kMaxStacked);
      const double area = arrangement_.faces()[f].area;
      for (std::size_t i = 0; i < areas.size(); ++i)
        for (std::size_t j = i + 1; j < areas.size(); ++j) {
          Shared& pair = shared[{areas[i], areas[j]}];
          if (pair.faces++ == 0 || area > arrangement_.faces()[pair.largest].area) pair.largest = f;
          pair.area += area;
        }
    }
    for (const auto& [pair, what] : shared) {
      const auto [a, b] = pair;
      const bool same = what.faces == faces[a] && what.faces == faces[b];
      if (!same && (what.faces == faces[a] || what.faces == faces[b])) continue;
      faults_.add({.kind = FaultKind::kAreaOverlap,
                   .at = inside(shapes_[what.largest]),
                   .offenders = {{Offender::What::kArea, a}, {Offender::What::kArea, b}},
                   .measure = what.area});
    }
  }

 private:
  void measure() {
    const auto& faces = arrangement_.faces();
    shapes_.resize(faces.size());
    for (std::uint32_t h = 0; h < 2 * arrangement_.edges().size(); ++h) {
      FaceShape& shape = shapes_[arrangement_.face(h)];
      ++shape.edges;
      const Arrangement::Edge& edge = arrangement_.edges()[h / 2];
      const double length = distance(at(edge.u), at(edge.v));
      if (length > shape.length[0]) {
        shape.longest = {h, shape.longest[0]};
        shape.length = {length, shape.length[0]};
      } else if (length > shape.length[1]) {
        shape.longest[1] = h;
        shape.length[1] = length;
      }
    }
    for (std::size_t f = 1; f < faces.size(); ++f) {
      FaceShape& shape = shapes_[f];
      shape.width = 2 * faces[f].area / faces[f].perimeter;
      shape.vanishes = !(shape.width > context_.snapped.merging);
      shape.is_sliver =
          !shape.vanishes && shape.width < kSliverOfEdge * faces[f].perimeter / shape.edges;
    }
  }

  Vec2 at(std::uint32_t vertex) const { return arrangement_.vertices().at(vertex); }

  // Of the half-edge.
  Vec2 direction(std::uint32_t h) const {
    const Arrangement::Edge& edge = arrangement_.edges()[h / 2];
    const double sign = h % 2 == 0 ? 1 : -1;
    return {sign * (edge.to.x - edge.from.x), sign * (edge.to.y - edge.from.y)};
  }

  // Counter-clockwise, up to 360 degrees.
  double angle_deg(std::uint32_t h, std::uint32_t next) const {
    const Vec2 u = direction(h), v = direction(next);
    const double angle = std::atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
    return (angle < 0 ? angle + 2 * std::numbers::pi : angle) * 180 / std::numbers::pi;
  }

  // A little beside the middle of the longest edge.
  Vec2 inside(const FaceShape& shape) const {
    const Arrangement::Edge& edge = arrangement_.edges()[shape.longest[0] / 2];
    const Vec2 p = at(edge.u), q = at(edge.v), along = direction(shape.longest[0]);
    const double step = 0.25 * shape.width / std::hypot(along.x, along.y);
    return {p.x + 0.5 * (q.x - p.x) - step * along.y, p.y + 0.5 * (q.y - p.y) + step * along.x};
  }

  const LintContext& context_;
  const Arrangement& arrangement_;
  Faults& faults_;
  std::vector<FaceShape> shapes_;  // per face
};

}  // namespace

void judge_faces(const LintContext& context, Faults& faults) {
  FaceJudge judge(context, faults);
  judge.judge_slivers();
  judge.judge_angles();
  judge.judge_areas();
}

// Of holes the first in a face counts, of regions the last if there is no hole.
void judge_seeds(const LintContext& context, Faults& faults) {
  const Domain& domain = context.domain;
  std::map<std::uint32_t, Offender> seed_of;  // per face: the seed that counts
  const auto judge = [&](Vec2 at, Offender seed) {
    const Arrangement::Place place = context.arrangement->locate(at);
    if (place.edge) {
      Fault fault{.kind = FaultKind::kSeedOnSegment, .at = at, .offenders = {seed}};
      if (const auto covers = context.arrangement->covers(*place.edge); !covers.empty())
        fault.offenders.push_back(context.segment(covers[0]));
      faults.add(std::move(fault));
    } else if (place.face == 0) {
      faults.add({.kind = FaultKind::kSeedOutside, .at = at, .offenders = {seed}});
    } else if (const auto [first, is_new] = seed_of.emplace(place.face, seed); !is_new) {
      faults.add({.kind = FaultKind::kSeedShared, .at = at, .offenders = {seed, first->second}});
    }
  };
  for (std::uint32_t i = 0; i < domain.holes.size(); ++i)
    judge(domain.holes[i], {Offender::What::kHole, i});
  for (auto i = static_cast<std::uint32_t>(domain.regions.size()); i-- > 0;)
    judge(domain.regions[i].at, {Offender::What::kRegion, i});
}

}  // namespace weft::check
