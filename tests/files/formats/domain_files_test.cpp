// SPDX-License-Identifier: Apache-2.0
// Domains from well-known text, shapefiles, tables of rings and meshes, and back to .poly.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "files/formats/derived/mesh_domain.h"
#include "files/formats/domain_formats.h"
#include "files/formats/domains/seeded.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/shapefile_writer.h"

namespace weft::files {
namespace {

class DomainFile : public ::testing::Test {
 protected:
  Domain read(const std::string& name, const std::string& text) {
    const auto domain = read_domain(folder_.write(name, text));
    EXPECT_TRUE(domain) << domain.error().message;
    return domain ? *domain : Domain{};
  }
  std::string refusal(const std::string& name, const std::string& text) {
    const auto domain = read_domain(folder_.write(name, text));
    return domain ? "it was read" : refusal_of(domain.error());
  }
  std::string refusal_of(const Error& error) {
    EXPECT_EQ(error.exit, ExitCode::kUnreadableInput);
    return error.message.substr(folder_.path().string().size() + 1);
  }
  static std::vector<std::int32_t> markers(const Domain& domain) {
    std::vector<std::int32_t> out;
    for (const auto& segment : domain.segments) out.push_back(segment.marker);
    return out;
  }
  TempFolder folder_;
};

TEST_F(DomainFile, WktHoldsGeometriesOfEveryKind) {
  const Domain domain = read("d.wkt",
                             "SRID=4326;POLYGON Z((0 0 9, 8 0 9, 8 8 9, 0 8 9, 0 0 9),\n"
                             " (1 1 0, 2 1 0, 2 2 0, 1 1 0));\n"
                             "multipoint(3 3, (4 4)) LineString EMPTY\n"
                             "GEOMETRYCOLLECTION(LINESTRINGM(5 5 1, 6 6 1), MULTIPOLYGON(EMPTY,"
                             "((20 0, 21 0, 20 1, 20 0))), POINT EMPTY)");
  EXPECT_EQ(domain.fill, Domain::Fill::kUnion);
  EXPECT_EQ(domain.points.size(), 4u + 3 + 2 + 2 + 3);
  EXPECT_EQ(domain.segments.size(), 4u + 3 + 1 + 3);
  EXPECT_TRUE(domain.point_places.locate(5).ends_with("d.wkt: line 2, geometry 0, ring 1[1]"))
      << domain.point_places.locate(5);
}

TEST_F(DomainFile, WktTellsWhereItIsWrong) {
  EXPECT_EQ(refusal("d.wkt", "POLYGON((0 0, 1 0,\n  1 x, 0 0))"),
            "d.wkt:2:5: expected a finite number, found 'x'");
  EXPECT_EQ(refusal("d.wkt", "POLYGON((0 0, 1 0, nan 1, 0 0))"),
            "d.wkt:1:20: expected a finite number, found 'nan'");
  EXPECT_EQ(refusal("d.wkt", "POLYGON((0 0, 1 0"),
            "d.wkt:1:18: expected ')', found the end of the file");
  EXPECT_EQ(refusal("d.wkt", "CIRCLE(0 0, 1 0)"),
            "d.wkt:1:7: expected a geometry of well-known text, found 'CIRCLE'");
  EXPECT_EQ(refusal("d.wkt", " \n"), "d.wkt: holds no geometry");
  std::string deep;
  for (int i = 0; i < 100; ++i) deep += "GEOMETRYCOLLECTION(";
  EXPECT_NE(refusal("d.wkt", deep).find("is nested deeper than 64 levels"), std::string::npos);
}

TEST_F(DomainFile, WktHasArcs) {
  using Arcs = std::vector<Domain::Arc>;
  // A half circle to the right, then a quarter to the left.
  const Domain line =
      read("d.wkt", "CIRCULARSTRING(0 0, 1 1, 2 0, 2.585786437626905 -1.414213562373095, 4 -2)");
  EXPECT_EQ(line.points, (std::vector<Point>{{0, 0}, {2, 0}, {4, -2}}));
  ASSERT_EQ(line.arcs.size(), 2u);
  EXPECT_EQ(line.arcs[0], (Domain::Arc{0, -1}));
  EXPECT_NEAR(line.arcs[1].bulge, std::tan(std::numbers::pi / 8), 1e-15);
  const Domain circle = read("d.wkt", "CURVEPOLYGON Z (CIRCULARSTRING Z (-1 0 9, 1 0 9, -1 0 9))");
  EXPECT_EQ(circle.segments.size(), 2u);
  EXPECT_EQ(circle.arcs, (Arcs{{0, 1}, {1, 1}}));
  EXPECT_TRUE(circle.warnings.empty());
  ASSERT_EQ(circle.areas.size(), 1u);
  // A slot with a round hole in it.
  const Domain slot =
      read("d.wkt",
           "CURVEPOLYGON(COMPOUNDCURVE((0 -1, 4 -1), CIRCULARSTRING(4 -1, 5 0, 4 1), (4 1, 0 1),"
           "CIRCULARSTRING(0 1, -1 0, 0 -1)), CIRCULARSTRING(1 0, 2 0.5, 3 0, 2 -0.5, 1 0))");
  EXPECT_EQ(slot.segments.size(), 6u);
  ASSERT_EQ(slot.arcs.size(), 4u);
  EXPECT_EQ(slot.arcs[0], (Domain::Arc{1, 1}));
  EXPECT_TRUE(slot.warnings.empty());
  const Domain several =
      read("d.wkt",
           "MULTISURFACE(((9 0, 10 0, 9 1, 9 0)), CURVEPOLYGON(CIRCULARSTRING(-1 0, 1 0, -1 0)))"
           "MULTICURVE((0 5, 1 5), CIRCULARSTRING(1 5, 2 6, 3 5), EMPTY, COMPOUNDCURVE((3 5, 4 5)))"
           "CIRCULARSTRING EMPTY COMPOUNDCURVE EMPTY CURVEPOLYGON EMPTY "
           "CIRCULARSTRING(0 9, 1 9, 5 9)");
  EXPECT_EQ(several.areas.size(), 2u);
  EXPECT_EQ(several.arcs, (Arcs{{3, 1}, {4, 1}, {6, -1}}));
  ASSERT_EQ(several.warnings.size(), 1u);
  EXPECT_EQ(several.warnings[0].count, 4u);
}

TEST_F(DomainFile, WktTellsWhereItsArcsAreWrong) {
  const auto of_string = [this](const std::string& positions) {
    return refusal("d.wkt", "CIRCULARSTRING(" + positions + ")");
  };
  const std::string place = "this circular string has ";
  EXPECT_EQ(of_string("0 0, 1 1"),
            "d.wkt:1:25: " + place + "2 positions; arcs by three points each have 3, 5, 7, ...");
  EXPECT_EQ(of_string("0 0, 0 0, 1 1"),
            "d.wkt:1:30: " + place + "an arc two of whose points are (0, 0)");
  EXPECT_EQ(of_string("0 0, 3 0, 1 0"),
            "d.wkt:1:30: " + place +
                "an arc whose points lie on one line, (3, 0) outside of "
                "the others");
  EXPECT_EQ(refusal("d.wkt", "COMPOUNDCURVE((0 0, 1 1), (1 2, 3 3))"),
            "d.wkt:1:37: this compound curve has a part that begins at (1, 2), where the part "
            "before it ends at (1, 1)");
  EXPECT_EQ(refusal("d.wkt", "COMPOUNDCURVE(POLYGON((0 0, 1 1)))"),
            "d.wkt:1:22: expected a curve, found 'POLYGON'");
  EXPECT_EQ(refusal("d.wkt", "MULTISURFACE(LINESTRING(0 0, 1 1))"),
            "d.wkt:1:24: expected a polygon, found 'LINESTRING'");
  EXPECT_EQ(refusal("d.wkt", "POLYGON(CIRCULARSTRING(0 0, 1 1, 2 0))"),
            "d.wkt:1:9: expected '(', found 'CIRCULARSTRING'");
}

TEST_F(DomainFile, RingsOfArcsThatCrossAreToldOfByTheirEdges) {
  const auto warning = [this](const std::string& wkt) {
    const Domain domain = read("d.wkt", wkt);
    EXPECT_EQ(domain.warnings.size(), 1u);
    return domain.warnings.empty() ? "" : domain.warnings[0].text;
  };
  // The arc crosses the side below it, its chord does not.
  EXPECT_EQ(
      warning("CURVEPOLYGON(COMPOUNDCURVE((-9 0, 9 0, 9 3, 3 3), CIRCULARSTRING(3 3, 2 -1, 1 3),"
              "(1 3, -9 3, -9 0)))"),
      "line 1, geometry 0, ring 0 is a ring that crosses itself: edge 0 from (-9, 0) to (9, 0) "
      "crosses edge 3 from (3, 3) to (1, 3)");
  EXPECT_EQ(warning("CURVEPOLYGON((0 0, 4 0, 4 4, 0 4, 0 0), CIRCULARSTRING(1 1, 3 1, 1 1),"
                    "CIRCULARSTRING(1.5 1, 2.5 1, 1.5 1))")
                .substr(0, 74),
            "line 1, geometry 0, ring 2 is a hole that is outside of its polygon or in ");
}

TEST_F(DomainFile, RingsOfWktAreClosedWithAWarning) {
  const Domain domain = read("d.wkt", "\nPOLYGON((0 0, 1 0, 1 1, 0 1))");
  EXPECT_EQ(domain.segments.size(), 4u);
  ASSERT_EQ(domain.warnings.size(), 1u);
  EXPECT_TRUE(domain.warnings[0].sentence().ends_with(
      "d.wkt: line 2, geometry 0, ring 0 is a ring that is not "
      "closed: it starts at (0, 0) and ends "
      "at (0, 1); a segment closes it"));
}

TEST_F(DomainFile, CsvRingsEndAtBlankLinesAndAtANewNumber) {
  const Domain plain = read("d.csv", "0,0\n4,0\n4,4\n0,4\n0,0\n\n# a hole\n1 , 1\n2,1\n2,2\n");
  EXPECT_EQ(plain.points.size(), 7u);
  EXPECT_EQ(plain.segments.size(), 7u);
  EXPECT_EQ(plain.fill, Domain::Fill::kUnion);
  const Domain named = read(
      "d.csv", "Ring,LAT,lon,marker\n1,0,10,5\n1,0,14,6\n1,4,14,7\n2,1,11,8\n2,1,12,8\n2,2,12,8\n");
  EXPECT_EQ(named.points[1], (Point{14, 0}));
  EXPECT_EQ(markers(named), (std::vector<std::int32_t>{5, 6, 7, 8, 8, 8}));
}

TEST_F(DomainFile, CsvRingsHaveArcsByTheirBulges) {
  const Domain slot = read("d.csv", "x,y,bulge\n0,-1,\n4,-1,1\n4,1,0\n0,1,1\n\n1,0,-1\n3,0,-1\n");
  EXPECT_EQ(slot.segments.size(), 6u);
  EXPECT_EQ(slot.arcs, (std::vector<Domain::Arc>{{1, 1}, {3, 1}, {4, -1}, {5, -1}}));
  EXPECT_TRUE(slot.warnings.empty());
  EXPECT_EQ(read("d.csv", "x;y;Bulge\n0;0;0,5\n2;0;0\n2;2;\n").arcs,
            (std::vector<Domain::Arc>{{0, 0.5}}));
  EXPECT_EQ(refusal("d.csv", "x,y,bulge\n0,0,b\n"), "d.csv:2:5: expected the bulge, found 'b'");
  EXPECT_EQ(refusal("d.csv", "x,y,bulge\n0,0,2e6\n"),
            "d.csv:2:5: the bulge is 2e+06, magnitudes go up to 1e6");
  EXPECT_EQ(refusal("d.csv", "x,y,bulge\n0,0\n"),
            "d.csv:2:3: the line ends where the bulge should follow");
}

TEST_F(DomainFile, CsvRingsTellWhereTheyAreWrong) {
  EXPECT_EQ(refusal("d.csv", "x,y\n0,0\n1,a\n"), "d.csv:3:3: expected the y coordinate, found 'a'");
  EXPECT_EQ(refusal("d.csv", "x,y\n0,0\n1\n"),
            "d.csv:3:1: the line ends where the y coordinate should follow");
  EXPECT_EQ(refusal("d.csv", "x,z\n"),
            "d.csv:1:1: the columns x and y must be there, or WKT; there are 'x', 'z'");
  EXPECT_EQ(refusal("d.csv", "x,x\n"), "d.csv:1:1: the column 'x' comes twice");
  EXPECT_EQ(refusal("d.csv", "lon,y,X\n"), "d.csv:1:1: the columns 'lon' and 'X' mean the same");
  EXPECT_EQ(refusal("d.csv", "\n"), "d.csv: holds no geometry");
}

TEST_F(DomainFile, ShapefilesBringTheirAttributes) {
  write_sample_shapefile(folder_ / "d");
  const auto domain = read_domain(folder_ / "d.shp");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->fill, Domain::Fill::kUnion);
  EXPECT_EQ(markers(*domain), (std::vector<std::int32_t>{3, 3, 3, 3, 3, 3, 3, 4, 4, 4}));
  ASSERT_EQ(domain->areas.size(), 2u);
  EXPECT_EQ(domain->areas[0].region, 7);
  EXPECT_EQ(domain->areas[0].max_area, 0.5);
  EXPECT_TRUE(domain->point_places.locate(5).ends_with("d.shp: record 0, ring 1[1]"));
  std::filesystem::remove(folder_ / "d.dbf");
  EXPECT_EQ(markers(read_domain(folder_ / "d.shp").value()), std::vector<std::int32_t>(10, 0));
}

TEST_F(DomainFile, ShapefilesHaveTheCoordinateSystemBesideThem) {
  write_sample_shapefile(folder_ / "d");
  EXPECT_EQ(read_domain(folder_ / "d.shp")->system, std::nullopt);
  folder_.write("d.prj", R"(PROJCS["WGS_1984_UTM_Zone_18N",GEOGCS["GCS_WGS_1984"]])");
  const auto plane = read_domain(folder_ / "d.shp")->system;
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->name, "WGS_1984_UTM_Zone_18N");
  EXPECT_FALSE(plane->geographic);
  EXPECT_TRUE(plane->definition.starts_with("PROJCS["));
  folder_.write("d.prj", R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984"]])");
  EXPECT_TRUE(read_domain(folder_ / "d.shp")->system->geographic);
  folder_.write("d.prj", "\"");
  EXPECT_EQ(read_domain(folder_ / "d.shp")->system, std::nullopt);
}

TEST_F(DomainFile, ShapefilesNeedNoIndex) {
  write_sample_shapefile(folder_ / "d");
  const auto with_index = read_domain(folder_ / "d.shp");
  std::filesystem::remove(folder_ / "d.shx");
  const auto domain = read_domain(folder_ / "d.shp");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points, with_index->points);
  EXPECT_EQ(domain->segments, with_index->segments);
  EXPECT_EQ(domain->areas, with_index->areas);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "d.shx"));
}

TEST_F(DomainFile, ShapefilesTellWhatIsWrong) {
  EXPECT_EQ(refusal_of(read_domain(folder_.write("d.shp", "no shapes")).error()),
            "d.shp: is not a shapefile, or it or the .shx beside it is damaged");
  EXPECT_EQ(refusal_of(read_domain(folder_ / "none.shp").error()),
            "none.shp: No such file or directory");
}

TEST_F(DomainFile, AMeshIsADomainWithItsSegmentsAndRegions) {
  ASSERT_TRUE(write_files(square_mesh(4).view(), folder_ / "m.msh"));
  const auto domain = read_domain(folder_ / "m.msh");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->fill, Domain::Fill::kEvenOdd);
  EXPECT_EQ(domain->points.size(), 16u + 3);
  EXPECT_EQ(domain->segments.size(), 16u + 2 * 4);  // between the regions twice
  ASSERT_EQ(domain->regions.size(), 1u);
  EXPECT_EQ(domain->regions[0].id, 7);
  EXPECT_GT(domain->regions[0].at.x, 2);
}

TEST_F(DomainFile, AMeshOfLinesIsFilledBetweenThem) {
  const Domain domain =
      read("m.msh",
           "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 "
           "0\n$EndNodes\n$Elements\n3\n1 1 2 5 1 1 2\n2 1 2 6 1 2 3\n3 1 2 7 1 3 "
           "1\n$EndElements\n");
  EXPECT_EQ(domain.fill, Domain::Fill::kSeeds);
  EXPECT_EQ(domain.points.size(), 3u);
  EXPECT_EQ(markers(domain), (std::vector<std::int32_t>{5, 7, 6}));
}

TEST_F(DomainFile, HolesGetSeedsAndWhatIsSharedIsWrittenOnce) {
  // A ring in a ring in a ring, a second polygon that shares a side with the first, a line.
  const Domain polygons = read("d.wkt",
                               "POLYGON((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 8 1, 8 8, 1 8, 1 1))\n"
                               "POLYGON((2 2, 7 2, 7 7, 2 7, 2 2), (3 3, 6 3, 6 6, 3 6, 3 3))\n"
                               "POLYGON((9 0, 12 0, 12 9, 9 9, 9 0)) LINESTRING(9.5 1, 11 2)");
  const auto domain = seeded(polygons);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->fill, Domain::Fill::kSeeds);
  EXPECT_EQ(domain->points.size(), 16u + 2 + 2);
  EXPECT_EQ(domain->segments.size(), 16u + 3 + 1);
  ASSERT_EQ(domain->holes.size(), 2u);
  const auto within = [](Point p, double low, double high) {
    return p.x > low && p.x < high && p.y > low && p.y < high;
  };
  int moat = 0;
  int pond = 0;
  for (const Point hole : domain->holes) {
    moat += within(hole, 1, 8) && !within(hole, 2, 7);
    pond += within(hole, 3, 6);
  }
  EXPECT_EQ(moat, 1);
  EXPECT_EQ(pond, 1);
}

TEST_F(DomainFile, ArcsOfAreasAreSaidToBecomeChords) {
  Domain disk;
  disk.points = {{1, 0}, {-1, 0}};
  disk.segments = {{.a = 0, .b = 1, .area = 1}, {.a = 1, .b = 0, .area = 1}};
  disk.areas.emplace_back();
  disk.arcs = {{0, 1}, {1, 1}};
  disk.fill = Domain::Fill::kUnion;
  const auto domain = seeded(disk);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments.size(), 180u);
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_EQ(domain->warnings[0].kind, WarningKind::kNotWritten);
  EXPECT_EQ(domain->warnings[0].count, 2u);
  EXPECT_EQ(domain->warnings[0].text,
            "2 arcs are written as chords of 2 degrees, because the format has no areas; a .pb "
            "file keeps both");
}

TEST_F(DomainFile, HolesThatShareACornerGetASeedEach) {
  const auto domain = seeded(read("d.wkt",
                                  "POLYGON((0 0, 9 0, 9 9, 0 9, 0 0), (1 1, 4 1, 4 4, 1 4, 1 1),"
                                  "(4 4, 7 4, 7 7, 4 7, 4 4))"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 11u);
  EXPECT_EQ(domain->holes.size(), 2u);
}

TEST_F(DomainFile, PolygonsThatOverlapGetSeedsForEachFace) {
  const Domain polygons = read("d.geojson", R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "properties": {"region": 1, "marker": 8}, "geometry": {"type": "Polygon",
        "coordinates": [[[0, 0], [6, 0], [6, 6], [0, 6], [0, 0]]]}},
      {"type": "Feature", "properties": {"region": 2, "max_area": 0.5}, "geometry": {"type":
        "Polygon", "coordinates": [[[4, 2], [9, 2], [9, 4], [4, 4], [4, 2]]]}},
      {"type": "Feature", "properties": {"marker": 5}, "geometry": {"type": "LineString",
        "coordinates": [[0, 0], [3, 0]]}},
      {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 5]}}]})");
  const auto domain = seeded(polygons);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 4u + 4 + 2 + 1 + 1);  // two crossings, one point of the line
  EXPECT_TRUE(domain->holes.empty());
  EXPECT_TRUE(domain->areas.empty());
  std::multiset<std::int32_t> regions;
  for (const Domain::Region& region : domain->regions) regions.insert(region.id);
  EXPECT_EQ(regions, (std::multiset<std::int32_t>{1, 2, 2}));
  std::multiset<std::int32_t> markers;
  for (const Domain::Segment& segment : domain->segments) markers.insert(segment.marker);
  EXPECT_EQ(markers, (std::multiset<std::int32_t>{5, 8, 8, 8, 8, 8, 8, 0, 0, 0, 0, 0, 0}));
}

TEST_F(DomainFile, HeightsThatAreNotThereAreDropped) {
  for (const char* text :
       {"POLYGON Z ((0 0 NaN, 4 0 nan, 4 3 NAN, 0 3 -nan, 0 0 1.#QNAN))",
        "POLYGON ZM ((0 0 nan 1, 4 0 1 nan, 4 3 nan nan, 0 3 2 2, 0 0 nan 1))"}) {
    const auto domain = read_domain(folder_.write("d.wkt", text));
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->points.size(), 4u);
    EXPECT_TRUE(domain->warnings.empty());
  }
  const auto json = read_domain(folder_.write(
      "d.geojson",
      R"({"type": "Feature", "properties": {"max_area": NaN, "name": "NaN \" NaN"}, "geometry":
          {"type": "Polygon", "coordinates": [[[0, 0, NaN], [4, 0, Infinity], [4, 3, -Infinity],
           [0, 3, NaN], [0, 0, NaN]]]}})"));
  ASSERT_TRUE(json) << json.error().message;
  EXPECT_EQ(json->points.size(), 4u);
  EXPECT_FALSE(json->areas[0].max_area);
  EXPECT_FALSE(read_domain(folder_.write("d.wkt", "POLYGON ((0 nan, 4 0, 4 3, 0 nan))")));
  EXPECT_FALSE(read_domain(
      folder_.write("d.json", R"({"type": "LineString", "coordinates": [[0, NaN], [1, 1]]})")));
}

}  // namespace
}  // namespace weft::files
