// SPDX-License-Identifier: Apache-2.0
// A coarse mesh to be filled with rows of its lattice.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "engine/domain/domain.h"
#include "engine/domain/triangulation/predicates.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/refiner.h"
#include "tests/engine/domain/shapes.h"

namespace weft {

// A square of side 10, and what else there is, as owner 0; a task of owner 1 that owns all of it
// has begun. The lattice has a spacing of about 0.21.
struct RowGround {
  static constexpr double kBound = 0.02;
  static constexpr Box kSquare{0, 0, 10, 10};
  static constexpr Box kEverywhere{-1, -1, 11, 11};

  explicit RowGround(const Pslg& pslg = square(10), double min_angle_deg = 20, double min_edge = 0)
      : domain(*triangulate(pslg, context)),
        quality(quality_for(min_angle_deg, min_edge)),
        corners(*AcuteCorners::build(domain, quality, context)),
        mesh(*MeshStore::from(domain, 1'000'000, 0, context)),
        earlier(Slots::of_domain(domain)),
        refiner(refinement(), quality, area) {
    constexpr double kCoarseness = 40;
    Refiner<OwnsAll, ConstantArea> coarse(refinement(), quality, area.again(kCoarseness));
    coarse.begin(earlier, OwnsAll{}, kEverywhere);
    EXPECT_FALSE(coarse.queue_all());
    EXPECT_FALSE(coarse.run());
    refiner.begin(slots, ownership, kEverywhere);
  }

  static QualityBounds quality_for(double min_angle_deg, double min_edge) {
    QualityBounds quality = QualityBounds::from(min_angle_deg, min_edge, 1e-9);
    quality.lattice = LatticeShape::for_angle(min_angle_deg);
    return quality;
  }
  RefinementContext refinement() {
    return {mesh, corners, domain.regions, limits, context, 0, 10'000'000};
  }
  double spacing() const { return std::sqrt(lattice_spacing2(kBound, quality.lattice)); }

  // Queues the triangles that are too large, and returns them.
  std::vector<BadTriangle> queue_bad() {
    std::vector<BadTriangle> bad;
    for_alive([&](std::uint32_t t) {
      if (area_of(t) <= kBound) return;
      mesh.triangles[t].set_badness(kLarge);
      bad.push_back({t, mesh.triangles[t].vertex[0]});
      refiner.queue(bad.back());
    });
    return bad;
  }

  template <class F>
  void for_alive(F&& f) const {
    for (const Slots* owned : {&earlier, &slots}) {
      owned->for_triangles([&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t t = first; t < last; ++t) {
          if (!mesh.triangles[t].dead()) f(t);
        }
      });
    }
  }
  std::size_t alive() const {
    std::size_t n = 0;
    for_alive([&](std::uint32_t) { ++n; });
    return n;
  }
  // All triangles, for comparison.
  std::vector<std::uint32_t> copy() const {
    std::vector<std::uint32_t> words;
    for_alive([&](std::uint32_t t) {
      std::uint32_t copied[sizeof(Triangle) / 4];
      std::memcpy(copied, &mesh.triangles[t], sizeof copied);
      words.push_back(t);
      words.insert(words.end(), std::begin(copied), std::end(copied));
    });
    return words;
  }

  Point corner(std::uint32_t t, std::uint32_t i) const {
    return mesh.vertices[mesh.triangles[t].vertex[i]];
  }
  double area_of(std::uint32_t t) const {
    const Point a = corner(t, 0);
    const Point b = corner(t, 1);
    const Point c = corner(t, 2);
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
  }

  // Fails the test unless the mesh is a constrained Delaunay triangulation of the square whose
  // links agree.
  void expect_sound() const {
    double area = 0;
    std::size_t faults = 0;
    for_alive([&](std::uint32_t t) {
      const Triangle& triangle = mesh.triangles[t];
      area += area_of(t);
      faults += orientation_exact(corner(t, 0), corner(t, 1), corner(t, 2)) <= 0;
      faults += triangle.deferred();
      for (std::uint32_t i = 0; i < 3; ++i) {
        const HalfEdge across = triangle.neighbor[i];
        if (across == kNone) {
          faults += !triangle.on_segment(i);
          continue;
        }
        const std::uint32_t u = triangle_of(across);
        const std::uint32_t j = edge_of(across);
        const Triangle& other = mesh.triangles[u];
        faults += other.dead() || other.neighbor[j] != half_edge(t, i) ||
                  other.vertex[kNext[j]] != triangle.vertex[kPrevious[i]] ||
                  other.vertex[kPrevious[j]] != triangle.vertex[kNext[i]] ||
                  other.on_segment(j) != triangle.on_segment(i) || other.region != triangle.region;
        faults += !triangle.on_segment(i) &&
                  in_circle_exact(corner(t, 0), corner(t, 1), corner(t, 2), corner(u, j));
      }
    });
    EXPECT_EQ(faults, 0u);
    EXPECT_NEAR(area, 100, 1e-9);
  }

  ExecutionContext context;
  EdgeLimits limits;
  Domain domain;
  QualityBounds quality;
  AcuteCorners corners;
  MeshStore mesh;
  Slots earlier;
  Slots slots{1};
  ConstantArea area{kBound};
  OwnsBox ownership{kEverywhere, kEverywhere};
  Refiner<OwnsBox, ConstantArea> refiner;
};

}  // namespace weft
