// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_poly.h"

#include <gtest/gtest.h>

#include "tests/files/support/temp_folder.h"
#include "tests/support/paths.h"

namespace weft::files {
namespace {

constexpr char kSquare[] =
    "# a square with a hole and two regions\n"
    "4 2 1 1\n"
    "1  0 0   3.5 11\n"
    "2  1 0   3.5 12   # a comment\n"
    "\n"
    "3  1 1   3.5 13\n"
    "4  0 1e0 3.5 -14\n"
    "4 1\n"
    "1  1 2 21\n"
    "2  2 3 22\n"
    "3  3 4 23\n"
    "4  4 1 -24\n"
    "1\n"
    "1  0.5 0.25\n"
    "2\n"
    "1  0.1 0.1 7 0.5\n"
    "2  0.9 0.9 -8 -1\n";

class TrianglePoly : public ::testing::Test {
 protected:
  Result<Domain> read(std::string_view text) {
    return read_triangle_poly(folder_.write("box.poly", text));
  }
  // What is said of a text that must be refused, less the folder.
  std::string refusal(std::string_view text) {
    const auto domain = read(text);
    if (domain) return "it was read";
    EXPECT_EQ(domain.error().exit, ExitCode::kUnreadableInput);
    return domain.error().message.substr(folder_.path().string().size() + 1);
  }
  TempFolder folder_;
};

TEST_F(TrianglePoly, TellsOfMarkersThatTheHeaderOfSegmentsDenies) {
  const std::string text = kSquare;
  const std::size_t header = text.find("\n4 1\n") + 3;
  const auto domain = read(text.substr(0, header) + "0" + text.substr(header + 1));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments[0].marker, 0);
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_TRUE(domain->warnings[0].sentence().ends_with(
      "box.poly:9: what follows the points of segments is ignored, because their header says that "
      "they have 0 markers"))
      << domain->warnings[0].sentence();
  EXPECT_TRUE(read(kSquare)->warnings.empty());
}

TEST_F(TrianglePoly, HasWholeNumbersThatAreWrittenAsReals) {
  const auto domain = read(
      "3.0 2.0 0 0\n1.0 0 0\n2.0e+00 1 0\n3 1 1\n3 1\n"
      "1 1.0 2 5.0\n2 2 3 5\n3 3 1 5\n0\n");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments[0], (Domain::Segment{0, 1, 5, 0}));
  EXPECT_NE(refusal("3 2 0 0\n1.5 0 0\n2 1 0\n3 1 1\n0\n0\n"), "it was read");
}

TEST_F(TrianglePoly, ReadsPointsSegmentsHolesAndRegions) {
  const auto domain = read(kSquare);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points, (std::vector<Point>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
  EXPECT_EQ(domain->point_markers, (std::vector<std::int32_t>{11, 12, 13, -14}));
  EXPECT_EQ(domain->segments,
            (std::vector<Domain::Segment>{{0, 1, 21}, {1, 2, 22}, {2, 3, 23}, {3, 0, -24}}));
  EXPECT_EQ(domain->holes, (std::vector<Point>{{0.5, 0.25}}));
  EXPECT_EQ(domain->regions,
            (std::vector<Domain::Region>{{{0.1, 0.1}, 7, 0.5}, {{0.9, 0.9}, -8, std::nullopt}}));
  EXPECT_EQ(domain->fill, Domain::Fill::kSeeds);
}

TEST_F(TrianglePoly, KnowsTheLineOfEachElement) {
  const auto domain = read(kSquare);
  ASSERT_TRUE(domain);
  EXPECT_TRUE(domain->point_places.locate(1).ends_with("box.poly:4"));
  EXPECT_TRUE(domain->point_places.locate(2).ends_with("box.poly:6"));
  EXPECT_TRUE(domain->segment_places.locate(3).ends_with("box.poly:12"));
  EXPECT_TRUE(domain->hole_places.locate(0).ends_with("box.poly:14"));
  EXPECT_TRUE(domain->region_places.locate(1).ends_with("box.poly:17"));
}

TEST_F(TrianglePoly, CountsFromZeroWhereTheFirstPointDoes) {
  const auto domain = read("3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments.back(), (Domain::Segment{2, 0, 0}));
  EXPECT_TRUE(domain->point_markers.empty());
}

TEST_F(TrianglePoly, TakesPointsFromTheNodeFileBesideIt) {
  folder_.write("box.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n");
  const auto domain = read("0 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 3u);
  EXPECT_TRUE(domain->point_places.locate(2).ends_with("box.node:4"));
}

TEST_F(TrianglePoly, SaysThatTheNodeFileIsMissing) {
  EXPECT_EQ(refusal("0 2 0 0\n0\n0\n"), "box.node: No such file or directory");
}

TEST_F(TrianglePoly, ReadsTheModels) {
  for (const char* name : {"pipe", "key", "cylinder", "us-east-coast"}) {
    const auto domain =
        read_triangle_poly(std::string(weft::testing::kModels) + "/" + name + ".poly");
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->points.size(), domain->segments.size()) << name;
  }
}

TEST_F(TrianglePoly, RefusesASegmentThatNamesNoPoint) {
  EXPECT_EQ(refusal("1 2 0 0\n1 0 0\n1 0\n1 1 2\n0\n"),
            "box.poly:4:5: the segment's second point is 2, the numbers run from 1 to 1");
  EXPECT_EQ(refusal("1 2 0 0\n1 0 0\n1 0\n1 0 1\n0\n"),
            "box.poly:4:3: the segment's first point is 0, the numbers run from 1 to 1");
}

TEST_F(TrianglePoly, RefusesCoordinatesThatAreNotFinite) {
  EXPECT_EQ(refusal("1 2 0 0\n1 nan 0\n0\n0\n"),
            "box.poly:2:3: expected the x coordinate, a finite number, found 'nan'");
  EXPECT_EQ(refusal("1 2 0 0\n1 0 -inf\n0\n0\n"),
            "box.poly:2:5: expected the y coordinate, a finite number, found '-inf'");
  EXPECT_EQ(refusal("1 2 0 0\n1 0 1e999\n0\n0\n"),
            "box.poly:2:5: expected the y coordinate, a finite number, found '1e999'");
}

TEST_F(TrianglePoly, GivesAttributesThatAreNoIntegersIdsOfTheirOwnAndKeepsTheValues) {
  const auto domain = read(
      "1 2 0 0\n1 0 0\n0\n0\n6\n1 0 0 0.7 1\n2 0 0 2 1\n3 0 0 0.35 1\n4 0 0 0.7 1\n"
      "5 0 0 -8 1\n6 0 0 1e12 1\n");
  ASSERT_TRUE(domain) << domain.error().message;
  std::vector<std::int32_t> ids;
  for (const auto& region : domain->regions) ids.push_back(region.id);
  EXPECT_EQ(ids, (std::vector<std::int32_t>{3, 2, 1, 3, -8, 4}));
  EXPECT_EQ(domain->region_values, (std::vector<RegionValue>{{1, 0.35}, {3, 0.7}, {4, 1e12}}));
}

TEST_F(TrianglePoly, TakesALoneValueForTheAttributeAndTheMaximumArea) {
  const auto domain = read("1 2 0 0\n1 0 0\n0\n0\n3\n1 0 0 3\n2 0 0 -3\n3 0 0 0.25\n");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->regions, (std::vector<Domain::Region>{
                                 {{0, 0}, 3, 3.0}, {{0, 0}, -3, std::nullopt}, {{0, 0}, 1, 0.25}}));
  EXPECT_EQ(domain->region_values, (std::vector<RegionValue>{{1, 0.25}}));
}

TEST_F(TrianglePoly, WritesTheValuesThatWereRead) {
  const auto domain = read(
      "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n2\n"
      "1 0.1 0.1 0.35 -1\n2 0.2 0.2 100000 0.5\n");
  ASSERT_TRUE(domain) << domain.error().message;
  auto file = OutputFile::create(folder_ / "again.poly", {});
  ASSERT_TRUE(file) << file.error().message;
  write_triangle_poly(*domain, *file);
  std::vector<OutputFile> files;
  files.push_back(std::move(*file));
  ASSERT_TRUE(commit(files));
  const auto again = read_triangle_poly(folder_ / "again.poly");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->regions, domain->regions);
  EXPECT_EQ(again->region_values, domain->region_values);
}

TEST_F(TrianglePoly, RefusesARegionWithoutAnyValue) {
  EXPECT_EQ(refusal("1 2 0 0\n1 0 0\n0\n0\n1\n1 0 0\n"),
            "box.poly:6:5: the line ends where the region's attribute should follow");
}

TEST_F(TrianglePoly, RefusesATruncatedFileAndSaysWhereItEnds) {
  const std::string text = kSquare;
  // At line ends; the file may end before the regions.
  for (std::size_t end = 0; end < text.size(); ++end) {
    if (end > 0 && text[end - 1] != '\n') continue;
    const auto domain = read(text.substr(0, end));
    const bool complete = text.substr(0, end).ends_with("0.25\n");
    EXPECT_EQ(domain.has_value(), complete) << text.substr(0, end);
    if (!domain) {
      const std::string& said = domain.error().message;
      EXPECT_TRUE(said.find("the file ends where") != std::string::npos ||
                  said.find("more than the rest of the file can hold") != std::string::npos)
          << said;
    }
  }
}

TEST_F(TrianglePoly, RefusesCountsThatTheFileCannotHold) {
  EXPECT_EQ(refusal("4000000000 2 0 0\n1 0 0\n"),
            "box.poly:1:1: the point count is 4000000000, more than the rest of the file can hold");
  EXPECT_EQ(refusal("-1 2 0 0\n"), "box.poly:1:1: the point count is negative: -1");
}

TEST_F(TrianglePoly, RefusesThreeDimensions) {
  EXPECT_EQ(refusal("1 3 0 0\n1 0 0 0\n"), "box.poly:1:3: the dimension is 3, it must be 2");
}

TEST_F(TrianglePoly, TakesAnyNumbersOfPointsInAnyOrder) {
  const auto domain = read("3 2 0 0\n70 0 0\n-3 1 0\n12 0 1\n3 0\n1 70 -3\n2 -3 12\n3 12 70\n0\n");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments, (std::vector<Domain::Segment>{{0, 1, 0}, {1, 2, 0}, {2, 0, 0}}));
}

TEST_F(TrianglePoly, RefusesANumberOfNoPointAndOneOfTwo) {
  EXPECT_EQ(refusal("2 2 0 0\n1 0 0\n3 0 1\n1 0\n1 1 2\n0\n"),
            "box.poly:5:5: the segment's second point is 2, which no point has; the numbers are "
            "from 1 to 3");
  EXPECT_EQ(refusal("2 2 0 0\n1 0 0\n1 0 1\n0\n0\n"),
            "box.poly:3:1: the point number is 1, as that of another one before it");
}

TEST_F(TrianglePoly, TakesMarkersOfWhichTheHeadersDoNotTell) {
  const auto domain = read("3\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2 5\n2 2 3\n3 3 1 -6\n0\n");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments, (std::vector<Domain::Segment>{{0, 1, 5}, {1, 2, 0}, {2, 0, -6}}));
  EXPECT_TRUE(domain->point_markers.empty());
  const auto marked = read("2 2 1\n1 0 0 0.5 7\n2 1 0 0.5 8\n0\n0\n");
  ASSERT_TRUE(marked) << marked.error().message;
  EXPECT_EQ(marked->point_markers, (std::vector<std::int32_t>{7, 8}));
  const auto one_without = read("2\n1 0 0 7\n2 1 0\n0\n0\n");
  ASSERT_TRUE(one_without) << one_without.error().message;
  EXPECT_TRUE(one_without->point_markers.empty());
}

TEST_F(TrianglePoly, ShowsGarbageAsEscapes) {
  EXPECT_EQ(refusal(std::string_view("\x7f"
                                     "ELF\x02\x01\x00\x00\n",
                                     9)),
            "box.poly:1:1: expected the point count, found '\\x7fELF\\x02\\x01\\x00\\x00'");
}

TEST_F(TrianglePoly, RefusesTextAfterTheRegions) {
  EXPECT_EQ(refusal(std::string(kSquare) + "17\n"),
            "box.poly:18:1: the file goes on after its last region");
}

TEST_F(TrianglePoly, NamesAMissingFile) {
  const auto domain = read_triangle_poly(folder_ / "none.poly");
  ASSERT_FALSE(domain);
  EXPECT_TRUE(domain.error().message.ends_with("none.poly: No such file or directory"));
}

TEST_F(TrianglePoly, RefusesAFolder) {
  const auto domain = read_triangle_poly(folder_.path());
  ASSERT_FALSE(domain);
  EXPECT_TRUE(domain.error().message.ends_with("is not a regular file"));
}

}  // namespace
}  // namespace weft::files
