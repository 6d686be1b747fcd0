// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/cgal_mesh_2.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

namespace weft::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Delaunay_mesh_vertex_base_2<Kernel>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure>;

// The criterion of CGAL's manual (Delaunay_mesh_size_criteria_2), with an area where it has an
// edge length.
class GradedCriteria {
 public:
  using Face_handle = Cdt::Face_handle;
  using Size = std::function<double(double, double)>;

  struct Quality {
    double sin2 = 1;
    double area_ratio = 0;
    bool operator<(const Quality& other) const {
      if (area_ratio > 1 || other.area_ratio > 1) {
        if (area_ratio != other.area_ratio) return area_ratio > other.area_ratio;
      }
      return sin2 < other.sin2;
    }
  };

  GradedCriteria(Size size, double sin2) : size_(std::move(size)), sin2_(sin2) {}

  class Is_bad {
   public:
    Is_bad(const Size& size, double sin2) : size_(&size), sin2_(sin2) {}

    CGAL::Mesh_2::Face_badness operator()(const Quality& quality) const {
      if (quality.area_ratio > 1) return CGAL::Mesh_2::IMPERATIVELY_BAD;
      return quality.sin2 < sin2_ ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
    }

    CGAL::Mesh_2::Face_badness operator()(const Face_handle& face, Quality& quality) const {
      const Kernel::Point_2 p[3] = {face->vertex(0)->point(), face->vertex(1)->point(),
                                    face->vertex(2)->point()};
      const double area = CGAL::area(p[0], p[1], p[2]);
      const double l0 = CGAL::squared_distance(p[1], p[2]);
      const double l1 = CGAL::squared_distance(p[2], p[0]);
      const double l2 = CGAL::squared_distance(p[0], p[1]);
      quality.sin2 = 4 * area * area * std::min(l0, std::min(l1, l2)) / (l0 * l1 * l2);
      quality.area_ratio = area / (*size_)((p[0].x() + p[1].x() + p[2].x()) / 3,
                                           (p[0].y() + p[1].y() + p[2].y()) / 3);
      return (*this)(quality);
    }

   private:
    const Size* size_;
    double sin2_;
  };

  Is_bad is_bad_object() const { return Is_bad(size_, sin2_); }

 private:
  Size size_;
  double sin2_;
};

}  // namespace

CgalResult refine_with_cgal(const Pslg& pslg, const std::function<double(double, double)>& size,
                            double min_angle_deg) {
  Cdt cdt;
  std::vector<Cdt::Vertex_handle> vertices;
  for (Point p : pslg.points) vertices.push_back(cdt.insert({p.x, p.y}));
  for (const Segment& s : pslg.segments) cdt.insert_constraint(vertices[s.a], vertices[s.b]);
  std::vector<Kernel::Point_2> seeds;
  for (Point p : pslg.holes) seeds.emplace_back(p.x, p.y);

  const double sine = std::sin(min_angle_deg * 3.14159265358979323846 / 180);
  CGAL::Delaunay_mesher_2<Cdt, GradedCriteria> mesher(cdt, GradedCriteria(size, sine * sine));
  mesher.set_seeds(seeds.begin(), seeds.end());
  const auto start = std::chrono::steady_clock::now();
  mesher.refine_mesh();
  CgalResult result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (auto face : cdt.finite_face_handles()) result.triangles += face->is_in_domain() ? 1 : 0;
  return result;
}

}  // namespace weft::bench
