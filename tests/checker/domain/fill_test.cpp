// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/fill.h"

#include <gtest/gtest.h>

namespace weft::check {
namespace {

class Filled {
 public:
  Filled& line(Vec2 p, Vec2 q) {
    const auto a = static_cast<std::uint32_t>(domain.points.size());
    domain.points.insert(domain.points.end(), {p, q});
    domain.segments.push_back({a, a + 1});
    return *this;
  }
  Filled& box(double low, double high) {
    return line({low, low}, {high, low})
        .line({high, low}, {high, high})
        .line({high, high}, {low, high})
        .line({low, high}, {low, low});
  }
  FaceRole at(Vec2 p) {
    const BentDomain bent = unbent(domain);
    std::vector<Vec2> points = domain.points;
    std::vector<SegmentEnds> segments = domain.segments;
    for (const std::array<Vec2, 2>& link : bent.links) {
      const auto first = static_cast<std::uint32_t>(points.size());
      points.insert(points.end(), link.begin(), link.end());
      segments.push_back({first, first + 1});
    }
    const Arrangement arrangement(points, segments, find_contacts(points, segments, 1000),
                                  domain.segments.size());
    return fill_faces(bent, arrangement, findings)[arrangement.locate(p).face];
  }

  Domain domain;
  Findings findings{10};
};

TEST(Fill, KeepsEveryBoundedFace) {
  Filled nested;
  nested.box(0, 10).box(2, 8);
  EXPECT_TRUE(nested.at({1, 1}).kept);
  EXPECT_TRUE(nested.at({5, 5}).kept);
  EXPECT_FALSE(nested.at({11, 5}).kept);
}

TEST(Fill, CarvesTheFaceOfAHoleSeedUpToItsSegments) {
  Filled nested;
  nested.box(0, 10).box(2, 8).box(4, 6);
  nested.domain.holes = {{3, 3}};
  EXPECT_TRUE(nested.at({1, 1}).kept);
  EXPECT_FALSE(nested.at({7, 7}).kept);
  EXPECT_TRUE(nested.at({5, 5}).kept);
}

// The box is an area of its own.
Filled& add_area(Filled& filled, double low, double high, const Area& area) {
  filled.box(low, high);
  filled.domain.areas.push_back(area);
  filled.domain.segment_areas.resize(filled.domain.segments.size(),
                                     static_cast<std::uint32_t>(filled.domain.areas.size()));
  return filled;
}

TEST(Fill, KeepsWhatAnAreaCoversWithTheRegionOfTheSmallestAndTheLeastBound) {
  Filled areas;
  areas.domain.fill = Fill::kUnion;
  add_area(areas, 0, 10, {.region = 1, .max_area = 2});
  add_area(areas, 2, 6, {.region = 2, .max_area = 3});
  add_area(areas, 4, 12, {.region = 3});
  EXPECT_EQ(areas.at({1, 1}), (FaceRole{.kept = true, .region = 1, .max_area = 2}));
  EXPECT_EQ(areas.at({5, 5}), (FaceRole{.kept = true, .region = 2, .max_area = 2}));
  EXPECT_EQ(areas.at({8, 8}), (FaceRole{.kept = true, .region = 3, .max_area = 2}));
  EXPECT_EQ(areas.at({11, 11}), (FaceRole{.kept = true, .region = 3}));
  EXPECT_FALSE(areas.at({13, 13}).kept);
  areas.domain.areas[0].priority = 1;
  EXPECT_EQ(areas.at({5, 5}).region, 1);
  areas.domain.areas[1].is_hole = true;
  EXPECT_FALSE(areas.at({5, 5}).kept);
}

TEST(Fill, LeavesTheRegionOpenOfAreasOfOneSizeUpToRounding) {
  Filled areas;
  areas.domain.fill = Fill::kUnion;
  add_area(areas, 0, 10, {.region = 1});
  add_area(areas, 1, 11 + 1e-14, {.region = 2});
  EXPECT_EQ(areas.at({5, 5}), (FaceRole{.kept = true, .region = 1}));
  add_area(areas, 2, 12 + 1e-8, {.region = 3});
  EXPECT_TRUE(areas.at({5, 5}).is_region_open);
  EXPECT_FALSE(areas.at({0.5, 0.5}).is_region_open);
}

TEST(Fill, TakesOpenSegmentsForNoBoundary) {
  Filled open;
  open.line({0, 0}, {4, 0}).line({4, 0}, {4, 4}).line({4, 4}, {0, 4});
  EXPECT_FALSE(open.at({2, 2}).kept);
}

TEST(Fill, EvenOddAlternatesWithDepth) {
  Filled nested;
  nested.box(0, 10).box(2, 8).box(4, 6);
  nested.domain.fill = Fill::kEvenOdd;
  EXPECT_TRUE(nested.at({1, 1}).kept);
  EXPECT_FALSE(nested.at({3, 3}).kept);
  EXPECT_TRUE(nested.at({5, 5}).kept);
  EXPECT_FALSE(nested.at({11, 5}).kept);
}

TEST(Fill, EvenOddCancelsCoincidentSegments) {
  Filled twice;
  twice.box(0, 10).box(2, 8).box(2, 8);
  twice.domain.fill = Fill::kEvenOdd;
  EXPECT_TRUE(twice.at({5, 5}).kept);
  Filled thrice;
  thrice.box(0, 10).box(2, 8).box(2, 8).box(2, 8);
  thrice.domain.fill = Fill::kEvenOdd;
  EXPECT_FALSE(thrice.at({5, 5}).kept);
}

TEST(Fill, EvenOddOfTwoBoxesThatShareASideKeepsBoth) {
  Filled both;
  both.box(0, 4);
  both.line({4, 0}, {8, 0}).line({8, 0}, {8, 4}).line({8, 4}, {4, 4}).line({4, 4}, {4, 0});
  both.domain.fill = Fill::kEvenOdd;
  EXPECT_TRUE(both.at({2, 2}).kept);
  EXPECT_TRUE(both.at({6, 2}).kept);
}

TEST(Fill, EvenOddLeadsNoPathThroughAGapThatRoundingHasOpened) {
  Filled gap;
  gap.line({0, 0}, {4, 0}).line({4, 0}, {4, 4}).line({4, 4}, {1, 4}).line({1, 4}, {1, 1e-15});
  gap.domain.fill = Fill::kEvenOdd;
  EXPECT_TRUE(gap.at({2, 2}).kept);
  EXPECT_FALSE(gap.at({2, 2}).open);
}

// Two walls so near that they become one are no obstacle, but the one of the two has no end to
// close it.
TEST(Fill, EvenOddIsOpenWhereASliverDecides) {
  Filled doubled;
  doubled.box(0, 4).line({0, 1e-15}, {4, 1e-15});
  doubled.domain.fill = Fill::kEvenOdd;
  EXPECT_TRUE(doubled.at({2, 2}).open);
  Filled closed;
  closed.box(0, 4);
  closed.line({4, 1e-15}, {8, 1e-15}).line({8, 1e-15}, {8, 4}).line({8, 4}, {4, 4});
  closed.line({4, 4}, {4 - 1e-15, 1e-15}).line({4 - 1e-15, 1e-15}, {4, 1e-15});
  closed.domain.fill = Fill::kEvenOdd;
  EXPECT_FALSE(closed.at({2, 2}).open);
  EXPECT_FALSE(closed.at({6, 2}).open);
  EXPECT_TRUE(closed.at({2, 2}).kept);
  EXPECT_TRUE(closed.at({6, 2}).kept);
}

TEST(Fill, EvenOddCarvesHoleSeedsOnTop) {
  Filled apart;
  apart.box(0, 4).box(6, 9);
  apart.domain.fill = Fill::kEvenOdd;
  apart.domain.holes = {{7, 7}};
  EXPECT_TRUE(apart.at({2, 2}).kept);
  EXPECT_FALSE(apart.at({8, 8}).kept);
}

TEST(Fill, EvenOddKeepsBothSidesOfALineThroughAPolygon) {
  Filled crossed;
  crossed.box(0, 4).line({-1, 2}, {5, 2});
  crossed.domain.fill = Fill::kEvenOdd;
  EXPECT_TRUE(crossed.at({2, 1}).kept);
  EXPECT_TRUE(crossed.at({2, 3}).kept);
}

TEST(Fill, TheLastRegionSeedOfAFaceWins) {
  Filled nested;
  nested.box(0, 10).box(2, 8);
  nested.domain.regions = {{{1, 1}, 7, 0.5}, {{3, 3}, 8, std::nullopt}, {{9, 9}, 9, 0.25}};
  EXPECT_EQ(nested.at({1, 5}).region, 9);
  EXPECT_EQ(nested.at({1, 5}).max_area, 0.25);
  EXPECT_EQ(nested.at({5, 5}).region, 8);
  EXPECT_TRUE(std::isinf(nested.at({5, 5}).max_area));
}

TEST(Fill, WithoutSeedsTheRegionIsZero) {
  Filled plain;
  EXPECT_EQ(plain.box(0, 1).at({0.5, 0.5}).region, 0);
}

TEST(Fill, ASeedOnASegmentIsAViolation) {
  Filled box;
  box.box(0, 10).domain.holes = {{5, 0}};
  EXPECT_TRUE(box.at({5, 5}).kept);
  EXPECT_EQ(box.findings.total(Rule::kDomain), 1u);
}

}  // namespace
}  // namespace weft::check
