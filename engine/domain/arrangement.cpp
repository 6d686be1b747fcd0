// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/arrangement.h"

#include <cstddef>

#include "engine/domain/cdt.h"
#include "engine/domain/hilbert.h"
#include "engine/domain/segment_inserter.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

// A biased randomised insertion order (Amenta, Choi, Rote, "Incremental constructions con BRIO",
// 2003): rounds of doubling size, each along the Hilbert curve. The round comes from a hash of the
// rank, so the order is the same on every run.
unsigned insertion_round(std::uint64_t rank) {
  std::uint64_t h = (rank + 1) * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  h ^= h >> 31;
  constexpr unsigned kLastRound = 12;
  unsigned round = kLastRound;
  for (; round > 0 && (h & 1) != 0; h >>= 1) --round;
  return round;
}
constexpr unsigned kRounds = 13;

// Returns the vertex of each point.
std::vector<Cdt::Vertex_handle> insert_points(const std::vector<Point>& points, Cdt& cdt,
                                              Pacer& pacer) {
  std::vector<Cdt::Vertex_handle> vertices(points.size());
  Cdt::Face_handle hint;
  const auto insert = [&](std::uint32_t i) {
    pacer.step();
    const Cdt::Point p(points[i].x, points[i].y);
    Cdt::Locate_type type = Cdt::VERTEX;
    int k = 0;
    const Cdt::Face_handle face = cdt.locate(p, type, k, hint);
    Cdt::Vertex_handle& v = vertices[i];
    if (type == Cdt::VERTEX) {
      v = face->vertex(k);
      v->info() = std::min(v->info(), i);
    } else {
      v = cdt.insert(p, type, face, k);
      v->info() = i;
    }
    hint = v->face();
  };
  // A triangle first: on a line CGAL takes linear time to find a place.
  for (const std::uint32_t i : spanning_points(points, pacer).point) insert(i);
  const std::vector<std::uint32_t> order = hilbert_order(points, pacer);
  for (unsigned round = 0; round < kRounds; ++round)
    for (std::size_t rank = 0; rank < order.size(); ++rank)
      if (insertion_round(rank) == round) insert(order[rank]);
  return vertices;
}

// The finite part of the triangulation in plain arrays; vertices in the order of their ids.
Arrangement extract(const Pslg& pslg, Cdt& cdt, const SegmentInserter& segments, Pacer& pacer) {
  const std::size_t inputs = pslg.points.size();
  std::vector<std::uint32_t> number(inputs + segments.crossings(), kNone);
  for (const Cdt::Vertex_handle v : cdt.finite_vertex_handles()) {
    pacer.step();
    number[v->info()] = 0;
  }
  Arrangement result;
  for (std::uint32_t id = 0; id < number.size(); ++id) {
    pacer.step();
    if (number[id] == kNone) continue;
    number[id] = static_cast<std::uint32_t>(result.input_point.size());
    result.input_point.push_back(id < inputs ? id : kNone);
  }
  result.vertices.resize(result.input_point.size());
  for (const Cdt::Vertex_handle v : cdt.finite_vertex_handles()) {
    pacer.step();
    const std::uint32_t id = v->info();
    result.vertices[number[id]] = id < inputs ? pslg.points[id] : at(v);  // of 0 and -0, the first
  }

  std::uint32_t faces = 0;
  for (const Cdt::Face_handle f : cdt.all_face_handles()) {
    pacer.step();
    f->info() = cdt.is_infinite(f) ? kNone : faces++;
  }
  result.triangles.reserve(faces);
  for (const Cdt::Face_handle f : cdt.finite_face_handles()) {
    pacer.step();
    Arrangement::Triangle t{};
    for (int i = 0; i < 3; ++i) {
      t.vertex[i] = number[f->vertex(i)->info()];
      t.neighbor[i] = f->neighbor(i)->info();
      t.constraint[i] = kNone;
      if (!f->is_constrained(i)) continue;
      if (t.neighbor[i] < f->info()) {
        const Arrangement::Triangle& n = result.triangles[t.neighbor[i]];
        t.constraint[i] = n.constraint[f->neighbor(i)->index(f)];
        continue;
      }
      const auto [right, left] = ends({f, i});
      t.constraint[i] = static_cast<std::uint32_t>(result.constraints.size());
      result.constraints.push_back(segments.constraints().at(right->info(), left->info()));
    }
    result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

std::uint64_t estimated_bytes(std::uint64_t vertices, std::uint64_t edges) {
  return 300 * vertices + 120 * edges;
}

Arrangement arrange(const Pslg& pslg, Pacer& pacer, std::uint64_t max_splits) {
  pacer.require(estimated_bytes(pslg.points.size(), pslg.segments.size()));
  Cdt cdt{CdtKernel(pacer)};
  const std::vector<Cdt::Vertex_handle> vertices = insert_points(pslg.points, cdt, pacer);
  SegmentInserter segments(pslg, vertices, cdt, max_splits, pacer);
  segments.insert_all();
  return extract(pslg, cdt, segments, pacer);
}

}  // namespace weft
