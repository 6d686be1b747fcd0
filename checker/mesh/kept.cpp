// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/kept.h"

#include <algorithm>
#include <array>

#include "checker/text.h"

namespace weft::check {

void judge_kept(const Mesh& mesh, const SegmentsOfVertices& segments,
                const InputPoints& input_points, const std::vector<std::int32_t>& markers,
                Findings& findings) {
  const auto is_kept = [&](const Mesh::Edge& edge) {
    return markers.empty() ||
           std::find(markers.begin(), markers.end(), edge.marker) != markers.end();
  };
  const auto lies_on = [&](std::uint32_t vertex, std::uint32_t segment) {
    return std::binary_search(segments.begin(), segments.end(), std::pair{vertex, segment});
  };
  struct Listed {  // edges at a vertex
    std::uint32_t count = 0;
    std::uint32_t kept = 0;
    std::array<std::uint32_t, 2> ends{};  // of the first two
    void add(std::uint32_t end, bool is_kept) {
      if (count < 2) ends[count] = end;
      ++count;
      kept += is_kept;
    }
  };
  std::vector<Listed> listed(mesh.vertices.size());
  for (const Mesh::Edge& edge : mesh.edges) {
    listed[edge.a].add(edge.b, is_kept(edge));
    listed[edge.b].add(edge.a, is_kept(edge));
  }
  for (const auto& [vertex, segment] : segments) {
    const auto& [count, kept, ends] = listed[vertex];
    if (count != 2 || kept != 2 || input_points.has(mesh.vertices[vertex])) continue;
    if (!lies_on(ends[0], segment) || !lies_on(ends[1], segment)) continue;
    findings.add(Rule::kKept, [&, vertex = vertex, segment = segment] {
      return say("vertex ", vertex, " at ", mesh.vertices[vertex], " lies on segment ", segment,
                 ", which is kept");
    });
  }
}

}  // namespace weft::check
