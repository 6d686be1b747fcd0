// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/lattice_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/size/lattice/lattice.h"
#include "tests/engine/refine/row_ground.h"

namespace weft {
namespace {

constexpr double kJitter = 1e-4;

TEST(LatticeRectangle, IsTheLargestASpacingInsideItsBox) {
  for (const double spacing : {0.21, 0.37, 0.05}) {
    for (const double shift : {0.0, 0.1, 17.3, -23.9}) {
      const Box box{shift, -2 * shift, shift + 10, 10 - 2 * shift};
      const auto rectangle = LatticeRectangle::in(box, spacing, kJitter);
      ASSERT_TRUE(rectangle);
      double least = spacing;
      double lowest = 10;
      double highest = 10;
      for (std::uint32_t j = 0; j < rectangle->rows; ++j) {
        for (std::uint32_t i = 0; i < rectangle->columns; ++i) {
          const Point p = rectangle->at(i, j);
          least = std::min(least, room_in(box, p));
          lowest = std::min(lowest, p.y - box.min_y);
          highest = std::min(highest, box.max_y - p.y);
        }
      }
      EXPECT_GE(least, spacing * (1 - 2 * kJitter));
      EXPECT_LE(lowest, spacing * (1 + kRowRise + kJitter));
      EXPECT_LE(highest, spacing * (1 + kRowRise + kJitter));
      EXPECT_GT(rectangle->columns, 10 / spacing - 4.5);
    }
  }
}

// So the rows meet what refinement places around them.
TEST(LatticeRectangle, HasThePointsThatRefinementPlaces) {
  for (const double degrees : {20.0, 30.0, 31.5}) {
    const LatticeShape shape = LatticeShape::for_angle(degrees);
    UniformLattice lattice;
    for (const double bound : {0.02, 0.0123}) {
      const double spacing = std::sqrt(lattice_spacing2(bound, shape));
      const auto rectangle = LatticeRectangle::in({-5, -7, 5, 3}, spacing, shape.jitter);
      ASSERT_TRUE(rectangle);
      for (std::uint32_t j = 0; j < rectangle->rows; ++j) {
        for (std::uint32_t i = 0; i < rectangle->columns; ++i) {
          const Point p = rectangle->at(i, j);
          ASSERT_EQ(lattice.nearest({p.x + 0.2 * spacing, p.y - 0.1 * spacing}, bound, shape).at,
                    p);
          ASSERT_EQ(rectangle->place_of(p), j * rectangle->columns + i);
          ASSERT_EQ(rectangle->place_of({p.x, p.y + 1e-6}), kNone);
        }
      }
      EXPECT_EQ(rectangle->place_of({-5.0, -7.0}), kNone);
    }
  }
}

TEST(LatticeRectangle, IsNoneIfItWouldBeTooSmallTooLargeOrRoundedTooMuch) {
  EXPECT_TRUE(LatticeRectangle::in({0, 0, 14, 12}, 1, kJitter));
  EXPECT_FALSE(LatticeRectangle::in({0, 0, 11, 12}, 1, kJitter));
  EXPECT_FALSE(LatticeRectangle::in({0, 0, 14, 9}, 1, kJitter));
  EXPECT_TRUE(LatticeRectangle::in({0, 0, 200, 200}, 1, kJitter));
  EXPECT_FALSE(LatticeRectangle::in({0, 0, 300, 300}, 1, kJitter));
  EXPECT_FALSE(LatticeRectangle::in({0, 0, 1e30, 1e30}, 1e-30, kJitter));
  EXPECT_TRUE(LatticeRectangle::in({1e12, 0, 1e12 + 14, 12}, 1, kJitter));
  EXPECT_FALSE(LatticeRectangle::in({1e14, 0, 1e14 + 14, 12}, 1, kJitter));
  EXPECT_FALSE(LatticeRectangle::in({0, 0, 14, 12}, 1, 0.1));
}

TEST(LatticeRectangle, HasARingThatGoesRoundIt) {
  const auto rectangle = LatticeRectangle::in({0, 0, 14, 17}, 1, 0);
  std::vector<std::uint32_t> ring;
  rectangle->append_ring(ring);
  ASSERT_EQ(ring.size(), 2 * (rectangle->columns + rectangle->rows - 2));
  double doubled = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto at = [&](std::size_t n) {
      const std::uint32_t place = ring[n % ring.size()];
      return rectangle->at(place % rectangle->columns, place / rectangle->columns);
    };
    EXPECT_NEAR(distance2(at(k), at(k + 1)), 1, 1e-9);
    doubled += at(k).x * at(k + 1).y - at(k).y * at(k + 1).x;
  }
  EXPECT_NEAR(doubled / 2, rectangle->triangles() * kEquilateral, 1e-9);
}

// A ring of vertices on the ground.
struct Ringed : RowGround {
  explicit Ringed(const Pslg& pslg = square(10), const Box& box = {1, 1, 9, 9})
      : RowGround(pslg), rows(mesh) {
    const auto rectangle = LatticeRectangle::in(box, spacing(), quality.lattice.jitter);
    EXPECT_TRUE(rectangle);
    rows.begin(slots, ownership);
    rows.lay_out(*rectangle);
    std::uint32_t t = kNone;
    for_alive([&](std::uint32_t u) {
      if (rows.locate(rows.ring_point(0), u) == u) t = u;
    });
    for (std::size_t k = 0; k < rows.ring_size(); ++k) {
      rows.set_ring_vertex(k, vertex_near(t, rows.ring_point(k)));
      near = t;
    }
  }

  // The vertex at p, which is made if need be; `t` becomes a triangle of it.
  std::uint32_t vertex_near(std::uint32_t& t, Point p) {
    for (;;) {
      const std::uint32_t at = rows.locate(p, t);
      const std::uint32_t v = rows.vertex_at(p, at);
      if (v != kNone) {
        t = at;
        return v;
      }
      const auto placing = refiner.place(at, p, 0);
      if (placing == decltype(refiner)::Placing::kPlaced) {
        t = refiner.placed();
        return mesh.triangles[t].vertex[0];
      }
      if (placing == decltype(refiner)::Placing::kRefused) {
        ADD_FAILURE();
        return kNone;
      }
    }
  }

  // A triangle inside the ring.
  std::uint32_t inside() const { return rows.locate({5, 5}, near); }

  // Expects that there are no rows, and that the mesh stays as it was.
  void expect_refusal() {
    const auto before = copy();
    EXPECT_FALSE(rows.fill(near));
    EXPECT_EQ(copy(), before);
  }

  LatticeRows rows;
  std::uint32_t near = kNone;
};

TEST(LatticeRows, ReplaceWhatIsInsideTheirRing) {
  Ringed ground;
  const std::size_t before = ground.alive();
  const auto gain = ground.rows.fill(ground.near);
  ASSERT_TRUE(gain);
  ground.expect_sound();
  EXPECT_EQ(static_cast<std::int64_t>(ground.alive()),
            static_cast<std::int64_t>(before) + gain->triangles);
  EXPECT_GT(gain->vertices, 1000u);
  for (const std::uint32_t* t = ground.rows.begin_made(); t != ground.rows.end_made(); ++t) {
    ASSERT_EQ(ground.mesh.owner_of_triangle(*t), ground.slots.owner());
    ASSERT_NEAR(ground.area_of(*t), ground.quality.lattice.area_ratio * RowGround::kBound, 1e-4);
  }
}

TEST(LatticeRows, KeepTheVerticesThatAreThere) {
  Ringed ground;
  std::vector<std::uint32_t> there;
  ground.for_alive([&](std::uint32_t t) {
    const auto& v = ground.mesh.triangles[t].vertex;
    there.insert(there.end(), v, v + 3);
  });
  ASSERT_TRUE(ground.rows.fill(ground.near));
  std::vector<std::uint32_t> now;
  ground.for_alive([&](std::uint32_t t) {
    const auto& v = ground.mesh.triangles[t].vertex;
    now.insert(now.end(), v, v + 3);
  });
  for (auto* vertices : {&there, &now}) {
    std::sort(vertices->begin(), vertices->end());
    vertices->erase(std::unique(vertices->begin(), vertices->end()), vertices->end());
  }
  EXPECT_TRUE(std::includes(now.begin(), now.end(), there.begin(), there.end()));
}

TEST(LatticeRows, LeaveAVertexOffTheLatticeAlone) {
  Ringed ground;
  std::uint32_t t = ground.near;
  ground.vertex_near(t, {5.001, 5.003});
  ground.expect_refusal();
}

TEST(LatticeRows, LeaveASegmentAlone) {
  Ringed ground;
  const std::uint32_t t = ground.inside();
  const HalfEdge across = ground.mesh.triangles[t].neighbor[0];
  ground.mesh.triangles[t].flags |= 1;
  ground.mesh.triangles[triangle_of(across)].flags |= 1u << edge_of(across);
  ground.expect_refusal();
}

TEST(LatticeRows, LeaveAloneWhatAnotherTaskHasDeferred) {
  Ringed ground;
  ground.mesh.triangles[ground.inside()].set_deferred(true);
  ground.expect_refusal();
}

TEST(LatticeRows, StayAwayFromAVertexCloseBeyondTheirRing) {
  Ringed ground;
  const Point a = ground.rows.ring_point(10);
  const Point b = ground.rows.ring_point(11);
  std::uint32_t t = ground.near;
  ground.vertex_near(t, {0.5 * (a.x + b.x), a.y - 0.25 * ground.spacing()});
  ground.expect_refusal();
}

TEST(LatticeRows, NeedAllOfTheirRing) {
  Ringed ground;
  std::uint32_t t = ground.near;
  const Point a = ground.rows.ring_point(10);
  const Point b = ground.rows.ring_point(11);
  ground.vertex_near(t, {0.5 * (a.x + b.x), a.y});  // on an edge of it
  ground.expect_refusal();
}

TEST(LatticeRows, FindTheirWayOnlyThroughWhatIsOwnedAndNotAcrossSegments) {
  Pslg pslg = square(10);
  add_segment(pslg, {0, 5}, {10, 5});
  RowGround ground(pslg);
  LatticeRows rows(ground.mesh);
  rows.begin(ground.slots, ground.ownership);
  std::size_t reached = 0;
  std::size_t all = 0;
  ground.for_alive([&](std::uint32_t t) {
    const bool above = ground.corner(t, 0).y + ground.corner(t, 1).y + ground.corner(t, 2).y > 15;
    const std::uint32_t found = rows.locate({4.9, 7.1}, t);
    EXPECT_EQ(found != kNone, above);
    if (found != kNone) {
      EXPECT_EQ(rows.locate({4.9, 7.1}, found), found);
    }
    ++all;
    reached += above;
  });
  EXPECT_GT(reached, 10u);
  EXPECT_LT(reached, all);
  const Box upper{-1, 7, 11, 11};
  rows.begin(ground.slots, OwnsBox{upper, upper});
  ground.for_alive([&](std::uint32_t t) { EXPECT_EQ(rows.locate({4.9, 5.1}, t), kNone); });
}

}  // namespace
}  // namespace weft
