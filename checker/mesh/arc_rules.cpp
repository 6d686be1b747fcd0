// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/arc_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "checker/geometry/box_tree.h"
#include "checker/geometry/circular_arc.h"
#include "checker/mesh/tangent_curves.h"
#include "checker/text.h"

namespace weft::check {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kTurnTolerance = 1e-9;  // of it
constexpr double kGapTolerance = 16;     // tolerances of the chains: lengths of edges to leave out

class HullJudge {
 public:
  HullJudge(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed,
            Findings& findings)
      : chains_(chains),
        chords_(chains.chords),
        mesh_(mesh),
        listed_(listed),
        findings_(findings),
        tangent_(chains, mesh, listed),
        tree_(boxes(chains.chords)) {
    for (std::uint32_t k = 0; k < chords_.size(); ++k)
      if (chords_[k].hull) hulls_.push_back(k);
  }

  void judge_vertices() {
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      const Vec2 p = mesh_.vertices[v];
      tree_.visit(box_of(p, p), [&](std::uint32_t i) {
        if (holds(*chord(i).hull, p) && !(is_beyond(i, p) && tangent_.have_vertex(chord(i), v)))
          bad(i, "vertex ", v, " at ", p, " lies between ", name(chord(i)), " and its arc");
      });
    }
  }

  void judge_edges() {
    for (std::uint32_t e = 0; e < mesh_.edges.size(); ++e) {
      if (!listed_.half_edge[e]) continue;
      const Mesh::Edge& edge = mesh_.edges[e];
      const Vec2 p = mesh_.vertices[edge.a], q = mesh_.vertices[edge.b];
      tree_.visit(box_of(p, q), [&](std::uint32_t i) {
        if (meet(*chord(i).hull, p, q) && !tangent_.have_edge(chord(i), e))
          bad(i, "the listed edge (", edge.a, ", ", edge.b, ") from ", p, " to ", q,
              " comes between ", name(chord(i)), " and its arc");
      });
    }
  }

  void judge_pairs() {
    for (std::uint32_t i = 0; i < hulls_.size(); ++i)
      tree_.visit(box_of(*chord(i).hull), [&](std::uint32_t j) {
        if (j > i && chord(i).edge != chord(j).edge && meet(*chord(i).hull, *chord(j).hull) &&
            !tangent_.have_edge(chord(i), chord(j).edge))
          bad(i, name(chord(i)), " and ", name(chord(j)), ", of segment ", chord(j).segment,
              ", are too long to keep their arcs apart");
      });
  }

 private:
  static std::vector<Box> boxes(const std::vector<ArcChains::Chord>& chords) {
    std::vector<Box> boxes;
    for (const ArcChains::Chord& chord : chords)
      if (chord.hull) boxes.push_back(box_of(*chord.hull));
    return boxes;
  }

  // Whether the arc is between the chord and p.
  bool is_beyond(std::uint32_t hull, Vec2 p) const {
    return chains_.curves[chord(hull).segment]->distance(p) >= -chains_.tolerance;
  }

  const ArcChains::Chord& chord(std::uint32_t hull) const { return chords_[hulls_[hull]]; }

  std::string name(const ArcChains::Chord& chord) const {
    return say("the edge (", chord.from, ", ", chord.to, ") from ", mesh_.vertices[chord.from],
               " to ", mesh_.vertices[chord.to]);
  }

  template <class... Parts>
  void bad(std::uint32_t hull, const Parts&... parts) {
    findings_.add(Rule::kChains,
                  [&] { return say("segment ", chord(hull).segment, ": ", parts...); });
  }

  const ArcChains& chains_;
  const std::vector<ArcChains::Chord>& chords_;
  const Mesh& mesh_;
  const ListedEdges& listed_;
  Findings& findings_;
  TangentCurves tangent_;
  std::vector<std::uint32_t> hulls_;  // chords
  BoxTree tree_;                      // of these
};

// The vertex beside a gap of an arc that seems to be meant as part of its chain, in words.
std::string nearest_beside(const CircularArc& arc, Vec2 from, Vec2 to, const Mesh& mesh,
                           const ListedEdges& listed) {
  const double start = arc.angle(from), end = arc.angle(to);
  double least = 0.05 * arc.radius();
  std::optional<std::uint32_t> nearest;
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    if (!listed.half_edge[i]) continue;
    for (const std::uint32_t v : {mesh.edges[i].a, mesh.edges[i].b}) {
      const Vec2 p = mesh.vertices[v];
      const double angle = arc.angle(p), distance = std::fabs(arc.distance(p));
      if (!(angle > start && angle < end) || p == from || p == to || distance >= least) continue;
      least = distance;
      nearest = v;
    }
  }
  if (!nearest) return "";
  return say("; vertex ", *nearest, " at ", mesh.vertices[*nearest], " is ", least,
             " away from it");
}

}  // namespace

void judge_arc_chords(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed,
                      double max_turn, Findings& findings) {
  for (const ArcChains::Chord& chord : chains.chords) {
    const Vec2 p = mesh.vertices[chord.from], q = mesh.vertices[chord.to];
    const double rounding = 4 * chains.tolerance / std::hypot(q.x - p.x, q.y - p.y);
    if (chord.turn() <= max_turn / kDegreesPerRadian * (1 + kTurnTolerance) + rounding) continue;
    findings.add(Rule::kChains, [&] {
      return say("segment ", chord.segment, ": the edge (", chord.from, ", ", chord.to, ") from ",
                 p, " to ", q, " turns by ", chord.turn() * kDegreesPerRadian,
                 " degrees, more than ", max_turn);
    });
  }
  HullJudge judge(chains, mesh, listed, findings);
  judge.judge_vertices();
  judge.judge_edges();
  judge.judge_pairs();
}

void judge_arc_bulges(const ArcChains& chains, const Mesh& mesh, const ListedEdges& listed,
                      Findings& findings) {
  if (mesh.bulges.empty()) return;
  // The middle may be off by as much as the ends are, on either side.
  const double tolerance = 4 * chains.tolerance;
  const auto middle = [&](std::uint32_t e) {
    const Vec2 p = mesh.vertices[mesh.edges[e].a], q = mesh.vertices[mesh.edges[e].b];
    return Vec2{(p.x + q.x) / 2 + mesh.bulges[e] / 2 * (q.y - p.y),
                (p.y + q.y) / 2 - mesh.bulges[e] / 2 * (q.x - p.x)};
  };
  std::vector<char> on_arc(mesh.edges.size(), 0);
  for (const ArcChains::Chord& chord : chains.chords) {
    on_arc[chord.edge] = 1;
    const CircularArc& curve = *chains.curves[chord.segment];
    const Vec2 right = curve.at((chord.from_angle + chord.to_angle) / 2);
    const Vec2 said = middle(chord.edge);
    if (std::hypot(said.x - right.x, said.y - right.y) <= tolerance) continue;
    findings.add(Rule::kChains, [&] {
      return say("segment ", chord.segment, ": the edge (", chord.from, ", ", chord.to,
                 ") bends through ", said, ", the middle of its arc is ", right);
    });
  }
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    if (!listed.half_edge[e] || on_arc[e] || mesh.bulges[e] == 0) continue;
    const Mesh::Edge& edge = mesh.edges[e];
    const Vec2 p = mesh.vertices[edge.a], q = mesh.vertices[edge.b];
    if (std::fabs(mesh.bulges[e]) / 2 * std::hypot(q.x - p.x, q.y - p.y) <= tolerance) continue;
    findings.add(Rule::kChains, [&] {
      return say("the edge (", edge.a, ", ", edge.b, ") from ", p, " to ", q,
                 " is on no arc, but bends through ", middle(e));
    });
  }
}

void judge_arc_crossings(const ArcChains& chains, const BentDomain& bent,
                         const Arrangement& arrangement, const std::vector<Need>& needs,
                         const Mesh& mesh, Findings& findings) {
  // What is between a chord and its arc for certain: up to the middle of the arc.
  std::vector<Hull> caps;
  std::vector<const ArcChains::Chord*> chords;
  std::vector<Box> boxes;
  for (const ArcChains::Chord& chord : chains.chords) {
    if (!chord.hull || chord.turn() > kMaxTurn / kDegreesPerRadian * (1 + kTurnTolerance)) continue;
    const auto& [p, q, corner] = *chord.hull;
    const Vec2 middle{(p.x + q.x) / 2, (p.y + q.y) / 2};
    const double share = std::tan(chord.turn() / 4) / std::tan(chord.turn() / 2);
    caps.push_back(
        {p,
         q,
         {middle.x + share * (corner.x - middle.x), middle.y + share * (corner.y - middle.y)}});
    chords.push_back(&chord);
    boxes.push_back(box_of(caps.back()));
  }
  const BoxTree tree(std::move(boxes));
  for (std::uint32_t e = 0; e < arrangement.edges().size(); ++e) {
    const auto covers = arrangement.covers(e);
    if (covers.empty() || std::max(needs[arrangement.face(2 * e)],
                                   needs[arrangement.face(2 * e + 1)]) != Need::kNothing)
      continue;
    const Arrangement::Edge& edge = arrangement.edges()[e];
    const Vec2 u = arrangement.vertices().at(edge.u), v = arrangement.vertices().at(edge.v);
    tree.visit(box_of(u, v), [&](std::uint32_t k) {
      // Where it passes an end of the chord, it may be rounded.
      const auto rounded = [&](Vec2 at) {
        for (const Vec2 end : {caps[k].from, caps[k].to})
          if (std::hypot(at.x - end.x, at.y - end.y) <= kGapTolerance * chains.tolerance)
            return end;
        return at;
      };
      const Vec2 a = rounded(u), b = rounded(v);
      if (a == b || !meet(caps[k], a, b)) return;
      const ArcChains::Chord& chord = *chords[k];
      findings.add(Rule::kChains, [&] {
        return say("segment ", chord.segment, ": no vertex where it meets segment ",
                   bent.given[covers[0]], ", beside the edge (", chord.from, ", ", chord.to,
                   ") from ", mesh.vertices[chord.from], " to ", mesh.vertices[chord.to]);
      });
    });
  }
}

void judge_arc_gaps(const ArcChains& chains, const BentDomain& bent, const Arrangement& arrangement,
                    const std::vector<Need>& needs, const Mesh& mesh, const ListedEdges& listed,
                    Findings& findings) {
  const auto& [straight, origin] = chains.straight;
  std::vector<double> needed(origin.size(), 0);  // per segment: of its length
  for (std::uint32_t piece = 0; piece < bent.origin.size(); ++piece) {
    if (!chains.is_gap[bent.origin[piece]]) continue;
    for (const std::uint32_t e : arrangement.edges_of(piece)) {
      if (std::max(needs[arrangement.face(2 * e)], needs[arrangement.face(2 * e + 1)]) !=
          Need::kAll)
        continue;
      const Arrangement::Edge& edge = arrangement.edges()[e];
      const Vec2 p = arrangement.vertices().at(edge.u), q = arrangement.vertices().at(edge.v);
      needed[bent.origin[piece]] += std::hypot(q.x - p.x, q.y - p.y);
    }
  }
  for (std::size_t first = 0, end = 0; first < origin.size(); first = end) {
    double length = 0;
    for (end = first; end < origin.size() && chains.is_gap[end] && origin[end] == origin[first];
         ++end)
      length += needed[end];
    if (end == first) end = first + 1;
    if (!(length > kGapTolerance * chains.tolerance)) continue;
    const std::uint32_t s = origin[first];
    const Vec2 p = straight.points[straight.segments[first][0]];
    const Vec2 q = straight.points[straight.segments[end - 1][1]];
    findings.add(Rule::kChains, [&] {
      return say("segment ", s, ": no chain of listed edges along its arc from ", p, " to ", q,
                 nearest_beside(*chains.curves[s], p, q, mesh, listed));
    });
  }
}

}  // namespace weft::check
