// SPDX-License-Identifier: Apache-2.0
#include "files/lint/domain_lint.h"

#include <gtest/gtest.h>

#include "files/formats/domain_formats.h"
#include "tests/files/lint/faulty_domains.h"
#include "tests/files/support/temp_folder.h"
#include "tests/support/paths.h"

namespace weft::files {
namespace {

class DomainLint : public ::testing::Test {
 protected:
  Lint lint(const std::string& name, std::string_view text, const LintSettings& settings = {}) {
    const auto file = folder_.write(name, text);
    return lint_domain(read_domain(file).value(), file.string(), settings).value();
  }
  static std::string counted(const Lint& lint) {
    std::string text;
    for (const auto& [kind, total] : lint.counts)
      text += (text.empty() ? "" : ", ") + kind + " " + std::to_string(total);
    return text;
  }
  static const Finding& only(const Lint& lint, const std::string& kind) {
    for (const Finding& finding : lint.findings)
      if (finding.kind == kind) return finding;
    ADD_FAILURE() << "no " << kind;
    return lint.findings.front();
  }
  TempFolder folder_;
};

TEST_F(DomainLint, NamesOneOfEachFaultOfAPolyFile) {
  const Lint found = lint("yard.poly", kFaultyYard);
  EXPECT_EQ(counted(found),
            "open-end 1, gap 1, crossing 1, junction 1, overlap 1, near-points 1, near-segment 1, "
            "small-angle 1, duplicate-point 1, duplicate-segment 2, zero-length 1, seed-outside 1, "
            "seed-on-segment 1, seed-shared 1");
  EXPECT_EQ(found.total, 15U);
  EXPECT_EQ(only(found, "open-end").text,
            "no other segment touches this end of the segment at line 43");
  EXPECT_EQ(only(found, "gap").text,
            "a gap of 0.01 between the end of the segment at line 39 and that of the segment at "
            "line 42");
  EXPECT_EQ(only(found, "gap").remedy, "--snap 0.011 closes it");
  EXPECT_EQ(only(found, "crossing").text, "the segment at line 44 crosses the segment at line 46");
  EXPECT_EQ(only(found, "crossing").at, (Point{7.5, 7.5}));
  EXPECT_EQ(only(found, "junction").text,
            "the point at line 12 lies on the inside of the segment at line 39");
  EXPECT_EQ(only(found, "near-points").remedy, "--snap 0.00015 merges them");
  EXPECT_EQ(only(found, "near-segment").text,
            "the point at line 28 is 0.0002 off the segment at line 39");
  EXPECT_EQ(only(found, "small-angle").text,
            "the segment at line 68 and the segment at line 70 meet at 0.573 degrees");
  EXPECT_EQ(only(found, "seed-shared").text,
            "the hole seed at line 79 is in the face of the hole seed at line 78, which counts");
  EXPECT_EQ(only(found, "seed-on-segment").offenders,
            (std::vector<std::string>{"line 81", "line 57"}));
}

TEST_F(DomainLint, NamesFaultsOfPolygonsByTheirFeatures) {
  const Lint found = lint("site.geojson", kFaultySite);
  EXPECT_EQ(counted(found),
            "open-end 1, crossing 1, self-crossing 1, area-overlap 1, sliver 1, warning 1");
  EXPECT_EQ(only(found, "area-overlap").text,
            "the polygon at features[0].geometry.coordinates and the polygon at "
            "features[1].geometry.coordinates overlap on an area of 8");
  EXPECT_EQ(only(found, "crossing").text,
            "the segment at features[0].geometry.coordinates[0], edge from [2] crosses the segment "
            "at features[4].geometry.coordinates, edge from [0]");
  EXPECT_EQ(only(found, "warning").text,
            "1 ring without an area is left out: features[0].geometry.coordinates[1]");
  EXPECT_EQ(only(found, "warning").warning, "left-out");
  EXPECT_FALSE(only(found, "warning").at);
}

TEST_F(DomainLint, NamesPointsOfAnotherFileByThatFile) {
  folder_.write("a.node", "5 2 0 0\n1 0 0\n2 9 0\n3 9 9\n4 5 0\n5 5 5\n");
  const Lint found = lint("a.poly", "0 2 0 0\n6 0\n1 1 2\n2 2 3\n3 3 1\n4 4 5\n5 5 2\n6 1 4\n0\n");
  const Finding& junction = only(found, "junction");
  EXPECT_NE(junction.text.find("a.node:6 lies on the inside of"), std::string::npos)
      << junction.text;
}

TEST_F(DomainLint, LeavesIgnoredKindsOut) {
  const Lint found =
      lint("site.geojson", kFaultySite, {.ignored = {"open-end", "sliver", "warning"}});
  EXPECT_EQ(counted(found), "crossing 1, self-crossing 1, area-overlap 1");
  EXPECT_EQ(found.findings.size(), 3U);
  EXPECT_TRUE(is_fault_kind("open-end") && is_fault_kind("warning"));
  EXPECT_FALSE(is_fault_kind("open-ends"));
}

// A metre is 9e-6 degrees.
TEST_F(DomainLint, SnapsInMetresForADomainInDegrees) {
  constexpr char kCoast[] =
      "5 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n5 0 0.0001\n4 0\n1 1 2\n2 2 3\n"
      "3 3 4\n4 4 5\n0\n";
  EXPECT_EQ(only(lint("a.poly", kCoast), "gap").remedy, "--snap 0.00011 closes it");
  EXPECT_EQ(only(lint("a.poly", kCoast, {.lonlat = true}), "gap").remedy, "--snap 12 closes it");
  EXPECT_EQ(lint("a.poly", kCoast, {.snap = 8, .lonlat = true}).total, 1U);
  EXPECT_EQ(lint("a.poly", kCoast, {.snap = 12, .lonlat = true}).total, 0U);

  // Two metres and a millimetre: the latter is merged by itself.
  constexpr char kPlot[] =
      "4 2 0 0\n1 0 0\n2 2e-5 0\n3 2e-5 2e-5\n4 1e-8 1e-10\n3 0\n1 1 2\n2 2 3\n3 3 4\n0\n";
  EXPECT_EQ(lint("a.poly", kPlot).total, 1U);
  EXPECT_EQ(lint("a.poly", kPlot, {.lonlat = true}).total, 0U);
  EXPECT_EQ(lint("a.poly", kPlot, {.snap = 1e-4, .lonlat = true}).total, 1U);
}

// At 60 degrees, a degree of longitude is half as long as one of latitude.
TEST_F(DomainLint, MeasuresDegreesOnTheGround) {
  const Lint found = lint("a.poly",
                          "5 2 0 0\n1 10 60\n2 10.01 60\n3 10.01 60.01\n4 10.00001 60\n"
                          "5 10.00985 60.005\n4 0\n1 4 2\n2 2 3\n3 3 1\n4 2 5\n0\n",
                          {.lonlat = true});
  EXPECT_EQ(counted(found), "open-end 1, gap 1, small-angle 1");
  const Finding& gap = only(found, "gap");
  EXPECT_TRUE(gap.text.starts_with("a gap of 0.556 m between the end of ")) << gap.text;
  EXPECT_EQ(gap.at, (Point{10, 60}));
  EXPECT_EQ(gap.to, (Point{10.00001, 60}));
  EXPECT_EQ(gap.remedy, "--snap 0.59 closes it");
  EXPECT_NEAR(only(found, "small-angle").measure.value(), 0.859, 1e-3);
}

// The end's own segment is 0.04 long.
TEST_F(DomainLint, OffersNoSnapThatMergesSegments) {
  const Lint found = lint("a.poly",
                          "6 2 0 0\n1 0 0\n2 50 0\n3 50 50\n4 0 50\n5 0 0.06\n6 0 0.04\n"
                          "5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 5\n5 1 6\n0\n");
  EXPECT_EQ(only(found, "gap").text.substr(0, 13), "a gap of 0.02");
  EXPECT_EQ(only(found, "gap").remedy, "join them");
  EXPECT_EQ(found.total, 1U);
}

TEST_F(DomainLint, RefusesCoordinatesThatCannotBeComputedWith) {
  Domain domain;
  domain.points = {{1e200, 0}, {0, 0}};
  domain.segments = {{0, 1}};
  const auto refused = lint_domain(domain, "a.poly", {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit, ExitCode::kUnreadableInput);
  EXPECT_EQ(refused.error().message.substr(0, 14), "a.poly: point ");
}

TEST_F(DomainLint, RefusesArcsThatAreTooManyChords) {
  Domain domain;
  domain.points = {{0, 0}, {1, 0}};
  for (std::uint32_t i = 0; i < 45'000; ++i) {
    domain.segments.push_back({0, 1});
    domain.arcs.push_back({i, 1});
  }
  const auto refused = lint_domain(domain, "vias.dxf", {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "vias.dxf: the domain's 45,000 arcs are 4,050,000 chords of 2 degrees, and at most "
            "4,000,000 are made");
}

TEST_F(DomainLint, ModelsHaveNoFaults) {
  for (const char* name :
       {"cylinder.poly", "key.poly", "pipe.poly", "us-east-coast.poly", "us-east-coast.geojson"}) {
    const auto file = std::filesystem::path(testing::kModels) / name;
    const Lint found = lint_domain(read_domain(file).value(), file.string(), {}).value();
    EXPECT_EQ(counted(found), "") << name;
  }
}

TEST_F(DomainLint, FindsNoDuplicatesInAMeshWithEdgesInside) {
  const Lint found = lint("two.msh",
                          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n"
                          "3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n$Elements\n5\n"
                          "1 1 2 4 1 2 5\n2 2 2 1 1 1 2 5\n3 2 2 1 1 1 5 4\n4 2 2 2 1 2 3 6\n"
                          "5 2 2 2 1 2 6 5\n$EndElements\n");
  EXPECT_EQ(counted(found), "");
  EXPECT_EQ(counted(lint("d.poly",
                         "4 2 0 0\n1 0 0\n2 1 0\n3 0 1\n4 1 1\n5 0\n1 1 2\n2 2 4\n"
                         "3 4 3\n4 3 1\n5 1 3\n0\n")),
            "duplicate-segment 1");
}

TEST_F(DomainLint, JudgesDegreesBeyondTheDateLineAndAroundThePoles) {
  const auto degrees = [this](const std::string& rings) {
    const auto file =
        folder_.write("map.geojson", R"({"type": "Polygon", "coordinates": [)" + rings + "]}");
    return lint_domain(read_domain(file, {.lonlat = true}).value(), file.string(), {.lonlat = true})
        .value();
  };
  EXPECT_EQ(counted(degrees("[[177,-19],[-178,-19],[-178,-16],[177,-16],[177,-19]],"
                            "[[179,-18],[-179,-18],[-179,-17],[179,-17],[179,-18]]")),
            "");
  EXPECT_EQ(counted(degrees("[[-180,80],[-90,80],[0,80],[90,80],[180,80],[-180,80]],"
                            "[[170,85],[-170,85],[-170,86],[170,86],[170,85]]")),
            "");
  // Antarctica as it is drawn on maps.
  EXPECT_EQ(counted(degrees("[[-180,-90],[-180,-80],[-90,-75],[0,-80],[90,-75],[180,-80],[180,-90],"
                            "[-180,-90]]")),
            "");
  const Lint crossing = degrees("[[179,0],[-179,2],[-179,0],[179,2],[179,0]]");
  EXPECT_EQ(counted(crossing), "self-crossing 1");
  EXPECT_EQ(only(crossing, "self-crossing").at, (Point{-180, 1}));
}

}  // namespace
}  // namespace weft::files
