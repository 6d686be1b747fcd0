// SPDX-License-Identifier: Apache-2.0
#include "client/report/marker_warnings.h"

#include <gtest/gtest.h>

namespace weft::client {
namespace {

using Texts = std::vector<std::string>;

Domain domain_with(const std::vector<std::int32_t>& markers) {
  Domain domain;
  for (const std::int32_t marker : markers) domain.segments.push_back({0, 1, marker});
  return domain;
}

TEST(MarkerWarnings, FindEveryMarkerOfTheMesh) {
  Mesh mesh;
  mesh.edge_markers = {3, 3, 1, 3, 0};
  EXPECT_EQ(markers_of(mesh.view()), (std::set<std::int32_t>{0, 1, 3}));
}

TEST(MarkerWarnings, NameOpenBoundariesThatMatchNothing) {
  EXPECT_EQ(open_boundary_warnings({1, 2}, std::vector<std::int32_t>{1}), Texts());
  EXPECT_EQ(open_boundary_warnings({1, 2}, std::vector<std::int32_t>{1, 7}),
            Texts{"no edge of the mesh carries marker 7 of --open-boundary"});
}

TEST(MarkerWarnings, NameMarkersThatOtherSegmentsHide) {
  EXPECT_EQ(hidden_marker_warnings({0, 1, 2}, domain_with({1, 2, 0})), Texts());
  EXPECT_EQ(hidden_marker_warnings({1}, domain_with({0, 1, 5, 5})),
            Texts{"no edge of the mesh carries marker 5 of the input: other segments lie on "
                  "theirs, or they are not part of what is meshed"});
  const Texts many = hidden_marker_warnings({}, domain_with({1, 2, 3, 4, 5, 6, 7}));
  ASSERT_EQ(many.size(), 1);
  EXPECT_TRUE(many[0].starts_with("no edge of the mesh carries markers 1, 2, 3, 4, 5 and 2 more "))
      << many[0];
}

TEST(MarkerWarnings, NameRegionsThatOthersHide) {
  Domain domain;
  domain.regions = {{{1, 1}, 7, {}}, {{2, 2}, 8, {}}, {{3, 3}, 0, {}}};
  domain.areas = {{9, {}}, {{}, {}}, {10, {}, true}};
  Mesh mesh;
  mesh.regions = {7, 8, 9, 7};
  EXPECT_EQ(hidden_region_warnings(mesh.view(), domain), Texts());
  mesh.regions = {7, 0};
  EXPECT_EQ(hidden_region_warnings(mesh.view(), domain),
            Texts{"no triangle of the mesh carries regions 8, 9 of the input: another seed or a "
                  "smaller polygon decides where it is, or it is not part of what is meshed"});
}

TEST(MarkerWarnings, NameTheFirstSegmentsThatContradictEachOther) {
  Domain domain;
  domain.points = {{0, 0}, {4, 0}, {1, 0}, {9, 0}, {4, 1}};
  const auto warnings = [&domain](std::vector<Domain::Segment> segments) {
    domain.segments = std::move(segments);
    return contradicting_marker_warnings(domain);
  };
  const std::string said =
      "segments that lie on each other have different markers, of which edges carry the first: ";
  EXPECT_EQ(warnings({{0, 1, 5}, {1, 0, 6}}),
            Texts{said + "5 of the segment 0, 6 of the segment 1"});
  EXPECT_EQ(warnings({{0, 4, 1}, {0, 1, 5, 1}, {3, 2, 6, 2}, {0, 1, 7, 2}}),
            Texts{said + "5 of the segment 1, 6 of the segment 2, and 2 more"});
  EXPECT_EQ(warnings({{0, 1, 5}, {1, 3, 6}, {2, 4, 7}, {0, 1, 5}, {1, 2, 0}, {1, 1, 8}}), Texts());
  EXPECT_EQ(warnings({{0, 1, 5, 1}, {0, 1, 6}}), Texts());  // a line on a border
}

}  // namespace
}  // namespace weft::client
