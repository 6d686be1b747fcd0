// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/edge_constraints.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace weft {
namespace {

TEST(EdgeConstraints, TakesTheEndsInAnyOrder) {
  EdgeConstraints edges;
  edges.add(7, 3, {.segment = 5, .marker = 2, .marker_segment = 5, .odd = true});
  EXPECT_EQ(edges.at(3, 7).segment, 5u);
  EXPECT_EQ(edges.take(7, 3).marker, 2);
  EXPECT_EQ(edges.size(), 0u);
}

TEST(EdgeConstraints, MergesToTheLowestSegmentAndItsFirstMarker) {
  EdgeConstraints edges;
  edges.add(0, 1, {.segment = 5, .marker = 8, .marker_segment = 5, .odd = true});
  edges.add(1, 0, {.segment = 2, .marker = 0, .marker_segment = kNone, .odd = true});
  EXPECT_EQ(edges.at(0, 1).segment, 2u);
  EXPECT_EQ(edges.at(0, 1).marker, 8);
  EXPECT_FALSE(edges.at(0, 1).odd);
  edges.add(0, 1, {.segment = 4, .marker = 9, .marker_segment = 4, .odd = true});
  EXPECT_EQ(edges.at(0, 1).segment, 2u);
  EXPECT_EQ(edges.at(0, 1).marker, 9);
  EXPECT_TRUE(edges.at(0, 1).odd);
  EXPECT_EQ(edges.size(), 1u);
}

TEST(EdgeConstraints, AgreesWithAnOrderedMap) {
  std::mt19937 random(11);
  EdgeConstraints edges;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> expected;
  for (std::uint32_t step = 0; step < 200000; ++step) {
    const std::uint32_t a = random() % 200, b = a + 1 + random() % 100;
    const auto entry = expected.find({a, b});
    if (entry == expected.end()) {
      edges.add(a, b, {.segment = step, .marker = 0, .marker_segment = kNone, .odd = true});
      expected[{a, b}] = step;
    } else {
      ASSERT_EQ(edges.take(b, a).segment, entry->second);
      expected.erase(entry);
    }
    ASSERT_EQ(edges.size(), expected.size());
  }
  for (const auto& [edge, segment] : expected)
    ASSERT_EQ(edges.at(edge.first, edge.second).segment, segment);
}

}  // namespace
}  // namespace weft
