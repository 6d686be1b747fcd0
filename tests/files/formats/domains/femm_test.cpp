// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/femm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/files/support/domain_text.h"

namespace weft::files {
namespace {

const std::string kHead = R"([Format]      =  4.0
[Frequency]   =  0
[Precision]   =  1e-8
[MinAngle]    =  30
[Depth]       =  1
[LengthUnits] =  meters
[ProblemType] =  planar
[Coordinates] =  cartesian
[Comment]     =  "A coil # in air."
[PointProps]   = 0
)";
const std::string kBoundaries = R"([BdryProps]   = 2
  <BeginBdry>
    <BdryName> = "A = 0"
    <BdryType> = 0
    <A_0> = 0
  <EndBdry>
  <BeginBdry>
    <BdryName> = "seam"
    <BdryType> = 3
  <EndBdry>
)";
const std::string kMaterials = R"([BlockProps]  = 3
  <BeginBlock>
    <BlockName> = "Air"
    <Mu_x> = 1
    <BHPoints> = 0
  <EndBlock>
  <BeginBlock>
    <BlockName> = "M-19 Steel"
    <BHPoints> = 2
      0	0
      1.5	200
  <EndBlock>
  <BeginBlock>
    <BlockName> = "Copper"
    <BHPoints> = 0
  <EndBlock>
[CircuitProps]  = 0
)";
// A disk of the radius 2 in which a square has a hole.
const std::string kShapes = R"([NumPoints] = 10
-2	0	0	0
2	0	0	0
-1	-1	0	0
1	-1	0	0
1	1	0	0
-1	1	0	0
-0.5	-0.5	0	0
0.5	-0.5	0	0
0.5	0.5	0	0
-0.5	0.5	0	0
[NumSegments] = 8
2	3	-1	0	0	0
3	4	-1	0	0	0
4	5	-1	2	0	0
5	2	-1	0	0	0
6	7	-1	0	0	1
7	8	-1	0	0	1
8	9	-1	0	0	1
9	6	-1	0	0	1
[NumArcSegments] = 2
1	0	180	2.5	1	0	0	2.5
0	1	180	2.5	1	0	0	2.5
[NumHoles] = 1
0	0	0
)";
const std::string kLabels = R"([NumBlockLabels] = 2
0	1.5	1	-1	0	0	0	1	0
0	0.75	2	0.2	0	0	0	1	0
)";

class FemmFile : public DomainText {
 protected:
  FemmFile() : DomainText("d.fem") {}
};

TEST_F(FemmFile, IsItsSegmentsArcsAndLabels) {
  const Domain domain = read(kHead + kBoundaries + kMaterials + kShapes + kLabels);
  EXPECT_TRUE(domain.warnings.empty());
  EXPECT_EQ(domain.fill, Domain::Fill::kSeeds);
  EXPECT_EQ(domain.points.size(), 10u);
  ASSERT_EQ(domain.segments.size(), 10u);
  EXPECT_EQ(domain.segments[2], (Domain::Segment{4, 5, 2}));
  EXPECT_EQ(domain.segments[8], (Domain::Segment{1, 0, 1}));
  EXPECT_EQ(domain.arcs, (std::vector<Domain::Arc>{{8, 1}, {9, 1}}));
  EXPECT_EQ(domain.names.markers, (NameTable{{1, "A = 0"}, {2, "seam"}}));
  EXPECT_EQ(domain.names.regions, (NameTable{{1, "Air"}, {2, "M-19 Steel"}}));
  EXPECT_EQ(domain.holes, (std::vector<Point>{{0, 0}}));
  ASSERT_EQ(domain.regions.size(), 2u);
  EXPECT_EQ(domain.regions[0], (Domain::Region{{0, 1.5}, 1, std::nullopt}));
  EXPECT_EQ(domain.regions[1].id, 2);
  // The size is the diameter of a circle.
  EXPECT_NEAR(domain.regions[1].max_area.value_or(0), std::numbers::pi * 0.01, 1e-15);
  EXPECT_TRUE(domain.segment_places.locate(8).ends_with("d.fem:59"));
  EXPECT_TRUE(domain.region_places.locate(1).ends_with("d.fem:65"));
}

TEST_F(FemmFile, HasArcsByTheirAngle) {
  const Domain domain = read("[NumPoints] = 2\n1 0\n0 1\n[NumArcSegments] = 1\n0 1 90 5\n");
  ASSERT_EQ(domain.arcs.size(), 1u);
  EXPECT_NEAR(domain.arcs[0].bulge, std::tan(std::numbers::pi / 8), 1e-15);
}

TEST_F(FemmFile, TellsOfWhatHasNoEffect) {
  std::string millimeters = kHead;
  millimeters.replace(millimeters.find("meters"), 6, "millimeters");
  EXPECT_EQ(warnings(millimeters + kShapes.substr(0, kShapes.find("[NumSegments]"))),
            (std::vector<std::string>{
                "d.fem: its coordinates are in millimeters, and so are those of the mesh"}));
  const std::string sized =
      kBoundaries + kMaterials +
      "[NumPoints] = 3\n0 0\n1 0\n0 1\n[NumSegments] = 3\n0 1 0.1 0\n1 2 0.1 0\n2 0 -1 2\n";
  const std::string of_sizes =
      ": segments have a size of their own, which has no effect: --edge-at gives a marker one";
  EXPECT_EQ(warnings(sized + "[NumBlockLabels] = 1\n0.1 0.1 1 -1 0 0 0 1 2\n"),
            (std::vector<std::string>{
                "d.fem:33" + of_sizes,
                "d.fem:37: a label is the default of faces without one, which has no effect: their "
                "region is 0"}));
  // Type 3 is periodic in electrostatics, and a label has fewer columns there.
  EXPECT_EQ(warnings(sized + "[NumBlockLabels] = 1\n0.1 0.1 1 -1 0 2\n", "d.fee"),
            (std::vector<std::string>{
                "d.fee:9: a boundary property is periodic, 'seam': its edges have its marker, but "
                "those of both sides need not match",
                "d.fee:33" + of_sizes,
                "d.fee:37: a label is the default of faces without one, which has no effect: their "
                "region is 0"}));
  EXPECT_EQ(warnings(sized, "d.feh").size(), 1u);
  EXPECT_EQ(warnings(sized, "d.fec").size(), 2u);
}

TEST_F(FemmFile, HasOneRegionOfMaterialsOfOneName) {
  const Domain domain = read(
      "<BeginBlock>\n<BlockName> = \"Iron\"\n<BeginBlock>\n<BlockName> = \"Air\"\n<BeginBlock>\n"
      "<BlockName> = \"Iron\"\n[NumPoints] = 1\n0 0\n[NumBlockLabels] = 2\n1 1 3\n2 2 2\n");
  EXPECT_EQ(domain.regions[0].id, 1);
  EXPECT_EQ(domain.regions[1].id, 2);
  EXPECT_EQ(domain.names.regions, (NameTable{{1, "Iron"}, {2, "Air"}}));
  EXPECT_TRUE(domain.warnings.empty());
}

TEST_F(FemmFile, HasNamesOfWindows) {
  const Domain domain = read(
      "<BeginBdry>\n<BdryName> = \"Au\xdf"
      "en\"\n<EndBdry>\n[NumPoints] = 2\n0 0\n1 0\n"
      "[NumSegments] = 1\n0 1 -1 1\n");
  EXPECT_EQ(domain.names.markers, (NameTable{{1,
                                              "Au\xc3\x9f"
                                              "en"}}));
}

TEST_F(FemmFile, IsRefusedWithThePlaceOfItsFault) {
  EXPECT_EQ(refusal("Frequency 0\n"),
            "d.fem:1:1: expected a line like '[NumPoints] = 4', found 'Frequency 0'");
  EXPECT_EQ(refusal(kHead), "d.fem: holds no points");
  EXPECT_EQ(refusal("[NumPoints] = x\n"), "d.fem:1:1: expected a number from 0 on, found 'x'");
  EXPECT_EQ(refusal("[NumPoints] = 2\n0 0\n"),
            "d.fem:3: the file ends where a row of that list should follow");
  EXPECT_EQ(refusal("[NumPoints] = 1\n0 y\n"), "d.fem:2:3: expected the y coordinate, found 'y'");
  const std::string points = "[NumPoints] = 2\n0 0\n1 0\n";
  EXPECT_EQ(refusal(points + "[NumSegments] = 1\n0 2\n"),
            "d.fem:5:3: there is no point 2 above, numbers count from 0");
  EXPECT_EQ(refusal(points + "[NumSegments] = 1\n0 1 -1 1\n"),
            "d.fem:5:8: there is no boundary property 1 above");
  EXPECT_EQ(refusal(points + "[NumArcSegments] = 1\n0 1 360 5\n"),
            "d.fem:5:5: the angle of an arc is between 0 and 360 degrees, not 360");
  EXPECT_EQ(refusal(points + "[NumArcSegments] = 1\n0 0 90 5\n"),
            "d.fem:5:5: the arc ends where it begins");
  EXPECT_EQ(refusal(points + "[NumBlockLabels] = 1\n0 0 4\n"),
            "d.fem:5:5: there is no material 4 above");
  EXPECT_EQ(refusal(points + "[NumBlockLabels] = 1\n0 0 0 1e-300\n"),
            "d.fem:5:7: the mesh size is 1e-300, and its square no number");
  EXPECT_EQ(refusal("<BdryName> = \"x\"\n"),
            "d.fem:1:1: expected the beginning of a property before '<bdryname>'");
}

}  // namespace
}  // namespace weft::files
