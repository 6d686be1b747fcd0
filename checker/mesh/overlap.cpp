// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/overlap.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "checker/geometry/arrangement.h"
#include "checker/geometry/contacts.h"
#include "checker/text.h"

namespace weft::check {
namespace {

// Enough to name the offenders: a mesh that crosses itself may do so millions of times.
constexpr std::size_t kContactLimit = 1000;

// The edges of L as segments on their own points.
struct BoundaryGraph {
  std::vector<std::uint32_t> half_edges;  // per segment
  std::vector<std::uint32_t> vertices;    // per point, of the mesh
  std::vector<Vec2> points;
  std::vector<SegmentEnds> segments;
};

BoundaryGraph boundary_graph(const Mesh& mesh, const HalfEdges& half_edges,
                             const ListedEdges& listed) {
  BoundaryGraph graph;
  std::vector<std::uint32_t> point(mesh.vertices.size(), 0);  // plus 1; 0: none yet
  for (std::uint32_t h = 0; h < half_edges.size(); ++h) {
    const bool single = !half_edges.has_twin(h);
    if (!single && (!listed.listed[h] || half_edges.twin(h) < h)) continue;
    SegmentEnds ends{half_edges.start(h), half_edges.end(h)};
    for (std::uint32_t& end : ends) {
      if (point[end] == 0) {
        graph.vertices.push_back(end);
        graph.points.push_back(mesh.vertices[end]);
        point[end] = static_cast<std::uint32_t>(graph.points.size());
      }
      end = point[end] - 1;
    }
    graph.half_edges.push_back(h);
    graph.segments.push_back(ends);
  }
  return graph;
}

class OverlapJudge {
 public:
  OverlapJudge(const BoundaryGraph& graph, const HalfEdges& half_edges, Findings& findings)
      : graph_(graph), half_edges_(half_edges), findings_(findings) {}

  // Distinct vertices are distinct points.
  void judge_vertices() {
    std::vector<std::uint32_t> order(graph_.points.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const Vec2 p = graph_.points[i], q = graph_.points[j];
      return p == q ? i < j : lexicographically_less(p, q);
    });
    for (std::size_t k = 1; k < order.size(); ++k) {
      const Vec2 p = graph_.points[order[k]];
      if (!(graph_.points[order[k - 1]] == p)) continue;
      findings_.add(Rule::kOverlap, [&] {
        return say("vertices ", graph_.vertices[order[k - 1]], " and ", graph_.vertices[order[k]],
                   " are both at ", p);
      });
    }
  }

  void judge_contacts(const Contacts& contacts) {
    for (const Contacts::Touch& touch : contacts.touches)
      findings_.add(Rule::kOverlap, [&] {
        return say("vertex ", graph_.vertices[touch.point], " at ", graph_.points[touch.point],
                   " lies inside the edge ", name(touch.segment));
      });
    for (const Contacts::Crossing& crossing : contacts.crossings)
      findings_.add(Rule::kOverlap, [&] {
        return say("edges ", name(crossing.first), " and ", name(crossing.second), " cross");
      });
  }

  // Checks that all edges around a face agree. REQUIRES: no violation so far, so that edge e is
  // segment covers(e)[0] and no other.
  void judge_faces(const Arrangement& arrangement) {
    std::vector<char> known(arrangement.faces().size(), 0);
    std::vector<char> covered(arrangement.faces().size(), 0);
    known[0] = 1;
    for (std::uint32_t g = 0; g < 2 * arrangement.edges().size(); ++g) {
      const std::uint32_t segment = arrangement.covers(g / 2)[0];
      const auto [a, b] = graph_.segments[segment];
      const bool runs_up = lexicographically_less(graph_.points[a], graph_.points[b]);
      // The segment has its half-edge's triangle on the left, that of the twin on the right.
      const bool left = (g % 2 == 0) == runs_up;
      const bool has = left || half_edges_.has_twin(graph_.half_edges[segment]);
      const std::uint32_t face = arrangement.face(g);
      if (!known[face]) {
        known[face] = 1;
        covered[face] = has;
      } else if (covered[face] != static_cast<char>(has)) {
        findings_.add(Rule::kOverlap, [&] {
          return say("edge ", name(segment), " has ", has ? "a" : "no", " triangle on its ",
                     left ? "left" : "right", ", where its surroundings have ",
                     has ? "none" : "one");
        });
      }
    }
  }

 private:
  std::string name(std::uint32_t segment) const {
    const auto [a, b] = graph_.segments[segment];
    return say("(", graph_.vertices[a], ", ", graph_.vertices[b], ") from ", graph_.points[a],
               " to ", graph_.points[b]);
  }

  const BoundaryGraph& graph_;
  const HalfEdges& half_edges_;
  Findings& findings_;
};

}  // namespace

bool judge_overlap(const Mesh& mesh, const HalfEdges& half_edges, const ListedEdges& listed,
                   Findings& findings) {
  const BoundaryGraph graph = boundary_graph(mesh, half_edges, listed);
  OverlapJudge judge(graph, half_edges, findings);
  judge.judge_vertices();
  const Contacts contacts = find_contacts(graph.points, graph.segments, kContactLimit);
  judge.judge_contacts(contacts);
  if (findings.total(Rule::kOverlap) > 0) return false;
  judge.judge_faces(Arrangement(graph.points, graph.segments, contacts));
  return findings.total(Rule::kOverlap) == 0;
}

}  // namespace weft::check
