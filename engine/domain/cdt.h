// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's constrained Delaunay triangulation as this folder uses it. Included by the few sources
// that work on it, for its headers are slow to compile.
//
// A vertex carries its id: the index of its input point, the lowest where several coincide, or
// where segments cross points.size() + k for the k-th crossing. CGAL never sees a crossing: pieces
// of segments are inserted only once nothing is in their way. It is deterministic: it breaks
// in-circle ties by coordinates, and its randomised walks start from a fixed seed.
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cstdint>

#include "engine/domain/pacer.h"
#include "engine/geometry.h"

namespace weft {

// CGAL's kernel, whose predicates count as steps of the pacer: one call that inserts a long
// constraint or flips many edges can be stopped too. What it leaves behind can only be destroyed.
class CdtKernel : public CGAL::Exact_predicates_inexact_constructions_kernel {
  using Base = CGAL::Exact_predicates_inexact_constructions_kernel;

  template <class Predicate>
  class Paced : public Predicate {
   public:
    explicit Paced(Pacer& pacer) : pacer_(&pacer) {}
    template <class... Points>
    auto operator()(const Points&... points) const {
      pacer_->step();
      return Predicate::operator()(points...);
    }

   private:
    Pacer* pacer_;
  };

 public:
  using Orientation_2 = Paced<Base::Orientation_2>;
  using Side_of_oriented_circle_2 = Paced<Base::Side_of_oriented_circle_2>;

  explicit CdtKernel(Pacer& pacer) : pacer_(&pacer) {}
  Orientation_2 orientation_2_object() const { return Orientation_2(*pacer_); }
  Side_of_oriented_circle_2 side_of_oriented_circle_2_object() const {
    return Side_of_oriented_circle_2(*pacer_);
  }

 private:
  Pacer* pacer_;
};

using CdtVertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, CdtKernel>;
using CdtFaceBase = CGAL::Triangulation_face_base_with_info_2<
    std::uint32_t, CdtKernel, CGAL::Constrained_triangulation_face_base_2<CdtKernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    CdtKernel, CGAL::Triangulation_data_structure_2<CdtVertexBase, CdtFaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

inline Point at(Cdt::Vertex_handle v) {
  return {v->point().x(), v->point().y()};
}

// The ends of an edge as seen from its face, which lies on the near side: going from the near side
// across the edge, `right` is on the right.
struct EdgeEnds {
  Cdt::Vertex_handle right, left;
};
inline EdgeEnds ends(Cdt::Edge e) {
  return {e.first->vertex(Cdt::ccw(e.second)), e.first->vertex(Cdt::cw(e.second))};
}

}  // namespace weft
