// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/arrangement.h"

#include <cstddef>

#include "engine/domain/segment_inserter.h"
#include "engine/domain/triangulation.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

// The finite part of the triangulation in plain arrays; vertices in the order of their ids.
Arrangement extract(const Pslg& pslg, const Triangulation& t, SegmentInserter& segments,
                    Pacer& pacer) {
  const std::size_t inputs = pslg.points.size();
  std::vector<std::uint32_t> vertex_of_id(inputs + segments.crossings(), kNone);
  for (Triangulation::Vertex v = 0; v < t.vertices(); ++v) {
    pacer.step();
    if (t.exists(v)) vertex_of_id[t.id(v)] = v;
  }
  Arrangement result;
  result.vertices.reserve(vertex_of_id.size());
  result.input_point.reserve(vertex_of_id.size());
  std::vector<std::uint32_t> number(t.vertices(), kNone);
  for (std::uint32_t id = 0; id < vertex_of_id.size(); ++id) {
    pacer.step();
    const std::uint32_t v = vertex_of_id[id];
    if (v == kNone) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.input_point.push_back(id < inputs ? id : kNone);
    result.vertices.push_back(id < inputs ? pslg.points[id] : t.at(v));  // of 0 and -0, the first
  }

  std::vector<std::uint32_t> face_number(t.faces());
  std::uint32_t faces = 0;
  for (std::uint32_t f = 0; f < t.faces(); ++f) {
    pacer.step();
    face_number[f] = t.is_infinite(f) ? kNone : faces++;
  }
  result.triangles.resize(faces);
  for (std::uint32_t f = 0; f < t.faces(); ++f) {
    pacer.step();
    if (face_number[f] == kNone) continue;
    Arrangement::Triangle& to = result.triangles[face_number[f]];
    for (int i = 0; i < 3; ++i) {
      to.vertex[i] = number[t.vertex(f, i)];
      to.neighbor[i] = face_number[t.mirror({f, i}).face];
      to.constraint[i] = t.constraint({f, i});
    }
  }
  result.constraints = segments.take_constraints();
  return result;
}

}  // namespace

std::uint64_t estimated_bytes(std::uint64_t vertices, std::uint64_t edges) {
  return 240 * vertices + 40 * edges;
}

Arrangement arrange(const Pslg& pslg, Pacer& pacer, std::uint64_t max_splits) {
  pacer.require(estimated_bytes(pslg.points.size(), pslg.segments.size()));
  Triangulation triangulation(pacer);
  const Span span = spanning_points(pslg.points, pacer);
  triangulation.build(pslg.points, span.point[0], span.point[1], span.point[2]);
  SegmentInserter segments(pslg, triangulation, max_splits, pacer);
  segments.insert_all();
  return extract(pslg, triangulation, segments, pacer);
}

}  // namespace weft
