// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/in2d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/files/support/domain_text.h"

namespace weft::files {
namespace {

// A square of 4 by 4 with a disk of the radius 1, of two domains; numbers have gaps.
const std::string kDiskInSquare = R"(splinecurves2dv2
# grading
5
points
1  -2 -2
2   2 -2
3   2  2
4  -2  2

# the disk
11  1  0
12  1  1
13  0  1
14 -1  1
15 -1  0
16 -1 -1
17  0 -1
18  1 -1
segments
1 0 2 1 2 -bc=3
1 0 2 2 3 -bcname=outlet
1 0 2 3 4 -bc=wall
1 0 2 4 1 -bc=5 -bcname=inlet
2 1 3 11 12 13
2 1 3 13 14 15
2 1 3 15 16 17
2 1 3 17 18 11
materials
1 air -maxh=0.5
2 iron
)";

class In2dFile : public DomainText {
 protected:
  In2dFile() : DomainText("d.in2d") {}
};

TEST_F(In2dFile, IsAnAreaForEachDomain) {
  const Domain domain = read(kDiskInSquare);
  EXPECT_TRUE(domain.warnings.empty());
  EXPECT_EQ(domain.fill, Domain::Fill::kUnion);
  EXPECT_EQ(domain.points.size(), 8u);
  ASSERT_EQ(domain.areas.size(), 2u);
  EXPECT_EQ(domain.areas[0].region, 1);
  EXPECT_NEAR(domain.areas[0].max_area.value_or(0), std::sqrt(3) / 4 * 0.25, 1e-12);
  EXPECT_EQ(domain.areas[1].region, 2);
  EXPECT_EQ(domain.areas[1].max_area, std::nullopt);
  EXPECT_EQ(domain.names.regions, (NameTable{{1, "air"}, {2, "iron"}}));
  // The disk's border is there twice, once for each domain.
  ASSERT_EQ(domain.segments.size(), 12u);
  ASSERT_EQ(domain.arcs.size(), 8u);
  for (const Domain::Arc& arc : domain.arcs)
    EXPECT_NEAR(arc.bulge, std::tan(std::numbers::pi / 8), 1e-15);
  EXPECT_EQ(domain.segments[4].area, 2u);
  EXPECT_EQ(domain.segments[5].area, 1u);
  EXPECT_EQ(domain.segments[4].a, domain.segments[5].a);
  EXPECT_EQ(domain.segments[10].b, domain.segments[4].a);
  EXPECT_TRUE(domain.segment_places.locate(3).ends_with("d.in2d:23"));
  EXPECT_TRUE(domain.point_places.locate(4).ends_with("d.in2d:11"));
}

TEST_F(In2dFile, HasMarkersByNumberAndByName) {
  const Domain domain = read(kDiskInSquare);
  const auto marker = [&](std::size_t s) { return domain.segments[s].marker; };
  EXPECT_EQ(marker(0), 3);
  EXPECT_EQ(domain.names.markers, (NameTable{{1, "outlet"}, {2, "wall"}, {5, "inlet"}}));
  EXPECT_EQ(marker(1), 1);
  EXPECT_EQ(marker(2), 2);
  EXPECT_EQ(marker(3), 5);
  EXPECT_EQ(marker(4), 0);
}

TEST_F(In2dFile, HasCurvesThatAreNoCirclesAsBiarcs) {
  const auto closed_by = [&](const std::string& curve, const std::string& end) {
    return read(
        "splinecurves2dv2 5\npoints\n1 0 0\n2 4 0\n3 4 1\n4 2 3\n5 4 2\n6 2 2\nsegments\n1 0 2 1 "
        "2\n"
        "1 0 " +
        curve + "\n1 0 2 " + end + " 1\n");
  };
  const Domain circle = closed_by("4 2 5 6", "6");
  ASSERT_EQ(circle.arcs.size(), 1u);
  const Domain other = closed_by("3 2 3 4", "4");
  EXPECT_GT(other.arcs.size(), 1u);
  EXPECT_LT(other.arcs.size(), 60u);
  const Domain polyline = closed_by("discretepoints 3 4 0 5 1 2 3", "4");
  EXPECT_TRUE(polyline.arcs.empty());
  EXPECT_EQ(polyline.segments.size(), 4u);
}

TEST_F(In2dFile, HasSplinesByTheirControlPoints) {
  // A parabola from (0, 0) to (2, 0) with the tangents (1, 1) and (1, -1), and one whose flags are
  // on the line below.
  const auto of_spline = [&](const std::string& spline) {
    return read(
        "splinecurves2dv2 5\npoints\n1 0 0\n2 2 0\nsegments\n1 0 2 1 2\n1 0 bsplinepoints " +
        spline);
  };
  const Domain parabola = of_spline("3 3\n2 0\n1 1\n0 0\n-bc=7\n# end\n");
  EXPECT_GT(parabola.arcs.size(), 3u);
  EXPECT_LT(parabola.arcs.size(), 30u);
  for (const Domain::Arc& arc : parabola.arcs) EXPECT_GT(arc.bulge, 0);
  EXPECT_EQ(parabola.segments.back().marker, 7);
  double top = 0;
  for (const Point p : parabola.points) top = std::max(top, p.y);
  EXPECT_NEAR(top, 0.5, 1e-9);
  EXPECT_EQ(of_spline("4 2 2 0 2 1 0 1 0 0\n").segments.size(), 4u);
  EXPECT_FALSE(of_spline("5 4 2 0 2 1 1 1 0 1 0 0\n").arcs.empty());
}

TEST_F(In2dFile, MayHaveCountsInThePlaceOfSections) {
  const std::string corners = "0 0 1\n2 0 1\n2 1 1\n0 1 0.1\n";
  const std::string numbered = "4\n1 0 0 1\n2 2 0\n3 2 1\n4 0 1 0.1\n";
  const std::string segments =
      "4\n1 0 2 1 2 1 -bc=1\n1 0 2 2 3 1\n1 0 2 3 4 1\n1 0 2 4 1 1 -bc=2\n";
  const Domain first = read("splinecurves2d\n2\n\n4\n" + corners + "\n" + segments);
  const Domain second =
      read("splinecurves2dnew\n2\n\n" + numbered + "\n" + segments + "\n1\n1 copper -maxh=0.1\n");
  for (const Domain& domain : {first, second}) {
    EXPECT_EQ(domain.segments.size(), 4u);
    EXPECT_EQ(domain.segments[3].marker, 2);
    ASSERT_EQ(domain.areas.size(), 1u);
    ASSERT_EQ(domain.warnings.size(), 1u);
    EXPECT_TRUE(domain.warnings[0].text.ends_with("'a factor of refinement'"));
  }
  EXPECT_EQ(second.names.regions, (NameTable{{1, "copper"}}));
}

TEST_F(In2dFile, TellsOfWhatHasNoEffect) {
  const std::string square =
      "splinecurves2dv2\n1\npoints\n1 0 0 -maxh=0.1\n2 1 0\n3 1 1\n4 0 1\n9 5 5\nsegments\n"
      "1 0 2 1 2 -hpref\n1 0 2 2 3 -maxh=0.2\n1 0 2 3 4\n1 0 2 4 1\n";
  EXPECT_EQ(warnings(square),
            (std::vector<std::string>{
                "d.in2d:4: sizes and refinements other than -maxh of a material are left out: "
                "'-hpref', '-maxh'",
                "d.in2d:8: 1 point is left out: no segment has it"}));
}

TEST_F(In2dFile, IsRefusedWithThePlaceOfItsFault) {
  const auto with = [](const std::string& segments) {
    return "splinecurves2dv2\n1\npoints\n1 0 0\n2 1 0\n3 1 1\nsegments\n" + segments;
  };
  EXPECT_EQ(refusal("splinecurves3d\n"),
            "d.in2d:1:1: expected 'splinecurves2dv2', 'splinecurves2dnew' or 'splinecurves2d', "
            "found 'splinecurves3d'");
  EXPECT_EQ(refusal("splinecurves2dv2\n1\nedges\n"),
            "d.in2d:3:1: expected 'points', 'segments' or 'materials', found 'edges'");
  EXPECT_EQ(refusal("splinecurves2dv2\n1\npoints\n1 0 0\n1 1 0\n"),
            "d.in2d:5:5: the point 1 is there twice");
  EXPECT_EQ(refusal("splinecurves2dv2\n1\npoints\n1 0 1e99\n"),
            "d.in2d:4:5: the point is (0, 1e+99), magnitudes go up to 1e50");
  EXPECT_EQ(refusal(with("1 0 2 1 4\n")), "d.in2d:8:9: there is no point 4 above");
  EXPECT_EQ(
      refusal(with("1 0 5 1 2\n")),
      "d.in2d:8:5: expected a segment of type 2, 3, 4, discretepoints or bsplinepoints, found '5'");
  EXPECT_EQ(refusal(with("1 0 bsplinepoints 2 3 0 0 1 1\n")),
            "d.in2d:8:21: the order is 3, it is from 2 to 4, and at most the number of points");
  EXPECT_EQ(refusal(with("-1 0 2 1 2\n")), "d.in2d:8:1: the domain on the left is -1");
  EXPECT_EQ(refusal(with("1 0 discretepoints 1 0 0\n")),
            "d.in2d:8:20: a curve has two points at least");
  EXPECT_EQ(refusal(with("1 0 3 1 2 1\n")), "d.in2d:8:11: the curve ends where it begins");
  EXPECT_EQ(refusal(with("1 0 2 1 2 x\n")), "d.in2d:8:11: expected a flag, found 'x'");
  EXPECT_EQ(refusal(with("1 0 2 1 2 -bc=\n")), "d.in2d:8:11: expected a value after -bc=");
  EXPECT_EQ(refusal(with("1 0 2 1 2 -bc=3000000000\n")),
            "d.in2d:8:11: the boundary condition is 3000000000, it must fit in 32 bits");
  for (const std::string size : {"0", "-1", "x", "1e-300", "1e300"})
    EXPECT_EQ(refusal(with("1 0 2 1 2\n1 0 2 2 3\nmaterials\n1 x -maxh=" + size + "\n")),
              "d.in2d:11:5: expected a positive number after -maxh=, found '" + size + "'");
  EXPECT_EQ(refusal(with("1 0 2 1 2\n1 0 2 2 3\n")),
            "d.in2d:4: the border of domain 1 is not closed: an odd number of its segments ends at "
            "(0, 0)");
  EXPECT_EQ(refusal("splinecurves2dv2\n1\npoints\n1 0 0\n"), "d.in2d: holds no segments");
  EXPECT_EQ(refusal(with("1 0 4 1 2 3\n1 0 2 3 1\n")), "it was read");
  EXPECT_EQ(refusal("splinecurves2dv2\n1\npoints\n1 0 0\n2 1 0\n3 1 2\nsegments\n1 0 4 1 2 3\n"),
            "d.in2d:8:11: the tangents of an arc of a circle have the lengths 1 and 2");
  EXPECT_EQ(refusal("splinecurves2d\n1\n1\n0 0 1\n1\n"),
            "d.in2d:5:1: the number of segments is 1, more than the rest of the file can hold");
}

}  // namespace
}  // namespace weft::files
