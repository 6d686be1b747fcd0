// SPDX-License-Identifier: Apache-2.0
#include "checker/report.h"

#include <gtest/gtest.h>

#include "checker/text.h"
#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

TEST(Report, HasOneLinePerViolation) {
  Problem problem = block(3);
  problem.mesh.edges[0].marker = 5;
  const std::string text = to_text(problem.check());
  EXPECT_NE(text.find("\nmarkers: listed edge 0 (0, 1) from (0, 0) to (1, 0) has the marker 5, its "
                      "segment has 1\n"),
            std::string::npos)
      << text;
}

TEST(Report, ListsTheFirstFewAndCountsTheRest) {
  Problem problem = block(4);
  for (Mesh::Edge& edge : problem.mesh.edges) edge.marker = 5;
  problem.requirements.listed_violations = 3;
  const Report report = problem.check();
  EXPECT_EQ(report.violations.size(), 3u);
  EXPECT_EQ(report.total(Rule::kMarkers), 16u);
  EXPECT_NE(to_text(report).find("markers: and 13 more\n"), std::string::npos);
}

TEST(Report, SaysWhatWasNotJudged) {
  Problem problem = block(3);
  problem.mesh.triangles[0][0] = 99;
  EXPECT_NE(to_text(problem.check()).find("not judged: orientation conformity overlap"),
            std::string::npos)
      << to_text(problem.check());
}

TEST(Report, StatesTheFacts) {
  EXPECT_EQ(
      to_text(block(1).check()),
      "triangles 2, vertices 4, edges on segments 4\n"
      "angles 53.13010235415598 to 63.43494882292201 degrees, area 1\n"
      "largest area over its bound 1\n"
      "exempt because of small input angles 0 (0 with the corner, 0 on its shells), unrefined 0\n");
}

TEST(ReportText, WritesDoublesThatReadBack) {
  EXPECT_EQ(say(0.1, " ", 1.0 / 3, " ", 1e300, " ", Vec2{-0.5, 2}),
            "0.1 0.3333333333333333 1e+300 (-0.5, 2)");
}

TEST(Findings, MergeKeepsTheLimit) {
  Findings first(2), second(2);
  first.add(Rule::kArea, [] { return "one"; });
  for (int i = 0; i < 5; ++i) second.add(Rule::kArea, [] { return "two"; });
  first.merge(second);
  Report report;
  first.write_to(report);
  EXPECT_EQ(report.violations.size(), 2u);
  EXPECT_EQ(report.total(Rule::kArea), 6u);
}

}  // namespace
}  // namespace weft::check::testing
