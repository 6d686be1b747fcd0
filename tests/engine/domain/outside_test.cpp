// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/outside.h"

#include <gtest/gtest.h>

#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

OutsideSegments outside_of(const Pslg& pslg) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  if (domain) return domain->outside;
  ADD_FAILURE() << domain.error().field << ": " << domain.error().message;
  return {};
}

void expect_outside(const Pslg& pslg, std::uint64_t segments, std::uint32_t first, Point at) {
  const OutsideSegments outside = outside_of(pslg);
  EXPECT_EQ(outside.segments, segments);
  EXPECT_EQ(outside.first, first);
  EXPECT_EQ(outside.at, at);
}

TEST(OutsideSegments, IsNothingOfWhatBoundsTheMeshOrLiesInIt) {
  Pslg pslg = square(4);
  add_box(pslg, {1, 1}, {3, 3});
  add_segment(pslg, {3.5, 3.5}, {3.6, 3.6});
  add_segment(pslg, {3.5, 0.5}, {9, 0.5});  // in part
  pslg.holes = {{2, 2}};
  expect_outside(pslg, 0, 0, {});
  expect_outside(square(), 0, 0, {});
}

TEST(OutsideSegments, AreLinesThatDoNotCloseAndThoseInHoles) {
  Pslg pslg;
  add_segment(pslg, {0, 0}, {9, 0});
  add_segment(pslg, {9, 0}, {9, 9});
  add_segment(pslg, {9, 9}, {0, 9});
  add_segment(pslg, {0, 9}, {0, 0.001});  // a gap
  add_box(pslg, {2, 2}, {7, 7});
  expect_outside(pslg, 4, 0, {0, 0});
  pslg.points[0] = {0, 0.001};
  expect_outside(pslg, 0, 0, {});
  pslg.holes = {{3, 3}};
  add_segment(pslg, {5, 5}, {6, 6});
  expect_outside(pslg, 1, 8, {5, 5});
}

TEST(OutsideSegments, CountsOneOfSeveralThatCoincide) {
  Pslg pslg = square(4);
  add_box(pslg, {0, 0}, {4, 4});
  expect_outside(pslg, 0, 0, {});
  add_segment(pslg, {6, 6}, {7, 6});
  add_segment(pslg, {7, 6}, {6, 6});
  add_segment(pslg, {6.5, 5}, {6.5, 7});  // crosses both
  expect_outside(pslg, 2, 8, {6, 6});
}

TEST(OutsideSegments, AreNoPiecesThatMergingBent) {
  Pslg pslg = square(4);
  pslg.snap = 0.1;
  add_segment(pslg, {0.5, 0.02}, {3.5, 0.03});  // onto the side
  expect_outside(pslg, 0, 0, {});
}

TEST(OutsideSegments, AreNoBordersOfAreas) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {9, 9});
  add_box(pslg, {1, 1}, {2, 2});  // a hole
  add_box(pslg, {2, 1}, {3, 2});  // beside it
  add_area(pslg, 0, {});
  pslg.fill = Fill::kUnion;
  expect_outside(pslg, 0, 0, {});
}

TEST(OutsideSegments, AreLinesBesideAnArea) {
  Pslg pslg;
  add_area_box(pslg, {0, 0}, {2, 2});
  add_segment(pslg, {1, 1}, {1, 1.5});
  add_segment(pslg, {3, 1}, {4, 1});
  pslg.fill = Fill::kUnion;
  expect_outside(pslg, 1, 5, {3, 1});
}

}  // namespace
}  // namespace weft
