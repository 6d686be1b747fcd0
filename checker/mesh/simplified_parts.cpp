// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/simplified_parts.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"
#include "checker/text.h"

namespace weft::check {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

class PartsJudge {
 public:
  PartsJudge(const FacedDomain& original, const Mesh& mesh, const HalfEdges& half_edges,
             Findings& findings)
      : original_(original), mesh_(mesh), half_edges_(half_edges), findings_(findings) {}

  void judge_connection() {
    join_faces();
    first_.assign(faces_.size(), kNone);
    std::vector<char> seen(mesh_.triangles.size(), 0);
    for (std::uint32_t t = 0; t < seen.size(); ++t)
      if (!seen[t]) judge_part(t, seen);
  }

  void judge_pinches() {
    std::vector<std::uint32_t> borders(mesh_.vertices.size(), 0);
    for (std::uint32_t h = 0; h < half_edges_.size(); ++h)
      if (!half_edges_.has_twin(h)) ++borders[half_edges_.start(h)];
    std::vector<Box> boxes;
    for (const auto& [a, b] : original_.domain.segments)
      boxes.push_back(box_of(original_.domain.points[a], original_.domain.points[b]));
    const BoxTree tree(std::move(boxes));
    const double reach = kMaxBend * merging_distance(original_.domain);
    for (std::uint32_t v = 0; v < borders.size(); ++v) {
      if (borders[v] < 2) continue;
      const Vec2 p = mesh_.vertices[v];
      int rays = 0;  // that leave the place along segments
      tree.visit(Box{p.x, p.y, p.x, p.y}.grown(reach), [&](std::uint32_t s) {
        const auto [a, b] = original_.domain.segments[s];
        const Vec2 from = original_.domain.points[a], to = original_.domain.points[b];
        if (Track(from, to).distance(p) > reach) return;
        const bool ends_here = std::hypot(from.x - p.x, from.y - p.y) <= reach ||
                               std::hypot(to.x - p.x, to.y - p.y) <= reach;
        rays += ends_here ? 1 : 2;
      });
      if (rays > 2) continue;
      findings_.add(Rule::kSimplified, [&] {
        return say("the boundary passes vertex ", v, " at ", p, " ", borders[v],
                   " times, though no segments meet there");
      });
    }
  }

 private:
  // Kept faces that share an edge are one part.
  void join_faces() {
    faces_.resize(original_.roles.size());
    std::iota(faces_.begin(), faces_.end(), 0u);
    const Arrangement& arrangement = original_.arrangement;
    for (std::uint32_t e = 0; e < arrangement.edges().size(); ++e) {
      const std::uint32_t f = arrangement.face(2 * e), g = arrangement.face(2 * e + 1);
      if (is_kept(f) && is_kept(g)) faces_[part_of(f)] = part_of(g);
    }
  }
  bool is_kept(std::uint32_t face) const {
    return original_.roles[face].kept || original_.roles[face].open;
  }
  std::uint32_t part_of(std::uint32_t face) {
    while (faces_[face] != face) face = faces_[face] = faces_[faces_[face]];
    return face;
  }

  Vec2 middle(std::uint32_t t) const {
    const auto [a, b, c] = mesh_.triangles[t];
    const Vec2 p = mesh_.vertices[a], q = mesh_.vertices[b], r = mesh_.vertices[c];
    return {(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3};
  }

  void judge_part(std::uint32_t first, std::vector<char>& seen) {
    std::uint32_t lies_in = kNone;
    bool lies_in_several = false;
    std::vector<std::uint32_t> stack{first};
    seen[first] = 1;
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      if (const std::uint32_t face = original_.arrangement.locate(middle(t)).face; is_kept(face)) {
        const std::uint32_t part = part_of(face);
        lies_in_several = lies_in_several || (lies_in != kNone && lies_in != part);
        lies_in = part;
      }
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (!half_edges_.has_twin(h) || seen[half_edges_.twin(h) / 3]) continue;
        seen[half_edges_.twin(h) / 3] = 1;
        stack.push_back(half_edges_.twin(h) / 3);
      }
    }
    if (lies_in == kNone || lies_in_several) return;
    if (first_[lies_in] == kNone) {
      first_[lies_in] = first;
      return;
    }
    findings_.add(Rule::kSimplified, [&] {
      return say("the triangles at ", middle(first_[lies_in]), " and ", middle(first),
                 " are not connected, though the domain is there");
    });
  }

  const FacedDomain& original_;
  const Mesh& mesh_;
  const HalfEdges& half_edges_;
  Findings& findings_;
  std::vector<std::uint32_t> faces_;  // per face of the original: another one of its part
  std::vector<std::uint32_t> first_;  // per part: a triangle of the first part of the mesh there
};

}  // namespace

void judge_parts(const FacedDomain& original, const Mesh& mesh, const HalfEdges& half_edges,
                 Findings& findings) {
  PartsJudge judge(original, mesh, half_edges, findings);
  if (!(original.domain.snap > 0)) judge.judge_connection();
  judge.judge_pinches();
}

}  // namespace weft::check
