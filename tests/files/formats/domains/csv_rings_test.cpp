// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/csv_rings.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/files/support/domain_text.h"

namespace weft::files {
namespace {

const std::vector<Point> kRectangle = {{0, 0}, {4, 0}, {4, 3}, {0, 3}};
const std::vector<Point> kHalves = {{0.5, 0.25}, {4.5, 0.25}, {4.5, 3.25}, {0.5, 3.25}};

class CsvRings : public DomainText {
 protected:
  CsvRings() : DomainText("d.csv") {}

  // The corners of each ring.
  std::vector<std::size_t> rings(const std::string& text) {
    const Domain domain = read(text);
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < domain.segments.size(); ++i)
      if (domain.segments[i].b < domain.segments[i].a)
        out.push_back(domain.segments[i].a - domain.segments[i].b + 1);
    return out;
  }
};

TEST_F(CsvRings, AreRefusedIfAllCommasOfNumbersMayGroupTheirDigits) {
  EXPECT_EQ(
      refusal("x,y\n0,0\n\"4,000\",0\n\"4,000\",\"3,000\"\n"),
      "d.csv:3:1: the commas of '4,000' and all the others may be decimal marks, or group the "
      "digits of thousands: write no commas in numbers, or separate columns by semicolons");
  // One that can only be a decimal mark decides.
  for (const char* clear : {"\"0,250\"", "\"4000,250\"", "\"4,25\""})
    EXPECT_EQ(rings(std::string("x,y\n0,0\n\"4,000\",0\n\"4,000\",") + clear + "\n").size(), 1U)
        << clear;
  EXPECT_EQ(read("x;y\n0;0\n4,000;0\n4,000;3,000\n").points[2], (Point{4, 3}));
}

TEST_F(CsvRings, AreInDegreesIfTheirColumnsSaySo) {
  const std::string rows = "\n4,52\n5,52\n5,53\n";
  for (const char* names : {"lon,lat", "Longitude,Latitude", "LON [deg],LAT [deg]", "long,lat"}) {
    const Domain domain = read(names + rows);
    ASSERT_TRUE(domain.system) << names;
    EXPECT_TRUE(domain.system->geographic) << names;
  }
  EXPECT_EQ(read("lat,lon\n52,4\n52,5\n53,5\n").system->name, "columns 'lon' and 'lat'");
  for (const char* names : {"x,y", "easting,northing", "lon,y", "x,lat"})
    EXPECT_FALSE(read(names + rows).system) << names;
  EXPECT_FALSE(read(rows).system);
}

TEST_F(CsvRings, ThatComeAgainAreOthersWithAWarning) {
  EXPECT_EQ(warnings("ring,x,y\n1,0,0\n1,9,0\n1,9,9\n2,1,0\n2,2,0\n2,2,1\n1,5,1\n1,6,1\n1,6,2\n"),
            std::vector<std::string>{
                "d.csv:8: a ring that ended before comes again; it is taken for another ring"});
  EXPECT_TRUE(warnings("ring,x,y\n1,0,0\n1,9,0\n1,9,9\n2,1,0\n2,2,0\n2,2,1\n").empty());
}

TEST_F(CsvRings, ThatACommentEndsAreAWarning) {
  const std::string ring = "0 0\n4 0\n4 4\n";
  EXPECT_EQ(warnings("# top\n" + ring + "# next\n# more\n7 0\n8 0\n8 1\n# end\n"),
            std::vector<std::string>{
                "d.csv:6: a line with nothing but a comment ends the ring before it"});
  EXPECT_TRUE(warnings(ring + "# next\n\n7 0 # here\n8 0\n8 1\n").empty());
}

TEST_F(CsvRings, ThatCrossEachOtherAreAWarning) {
  EXPECT_EQ(warnings("0 0\n4 0\n4 4\n0 4\n\n2 1\n6 1\n6 2\n2 2\n").size(), 1U);
  EXPECT_TRUE(warnings("0 0\n4 0\n4 4\n0 4\n\n4 1\n6 1\n6 2\n4 2\n").empty());
}

TEST_F(CsvRings, SeparateColumnsAsProgramsDo) {
  for (const char* text : {
           "0,0\n4,0\n4,3\n0,3\n",
           "0, 0\n4 ,0\n4 , 3\n 0,3 \n",
           "0;0\n4;0\n4;3\n0;3\n",
           "0\t0\n4\t0\n4\t3\n0\t3\n",
           "0 0\n 4   0\n4 3 # the third\n0 3\n",
           "0 \t0\n4 \t0\n4\t 3\n0\t3\n",
           "x y\n0\t0\n4\t0\n4\t3\n0\t3\n",
           "x,y\n0 0\n4 0\n4 3\n0 3\n",
           "\"X\";\"Y\"\n\"0\";\"0\"\n\"4\";\"0\"\n\"4\";\"3\"\n\"0\";\"3\"\n",
           "sep=;\nx;y\n0;0\n4;0\n4;3\n0;3\n",
           "0,0,\n4,0,\n4,3,\n0,3,\n",
           "x;y;;\n0;0;;\n4;0;;\n4;3;;\n0;3;;\n",
           "0.0D+00 0.0D+00\n4.0D+00 0.\n0.4D1 3.0d0\n0. 3.0\n",
       })
    EXPECT_EQ(read(text).points, kRectangle) << text;
}

TEST_F(CsvRings, KnowColumnsByTheirNames) {
  for (const char* text : {
           "X;Y\n0;0\n4;0\n4;3\n0;3\n",
           "LAT,LON\n0,0\n0,4\n3,4\n3,0\n",
           "Latitude\tLongitude\n0\t0\n0\t4\n3\t4\n3\t0\n",
           "id,Northing (m),Z,Easting [m],name\n1,0,5,0,a\n2,0,5,4,b c\n3,3,5,4,\n4,3,5,0,d\n",
           "POINT_X,POINT_Y\n0,0\n4,0\n4,3\n0,3\n",
       })
    EXPECT_EQ(read(text).points, kRectangle) << text;
}

TEST_F(CsvRings, NameTheColumnsThatAreIgnoredOnce) {
  EXPECT_EQ(warnings("id,x,y,Z\n1,0,0,5\n2,4,0,5\n3,4,3,5\n"),
            (std::vector<std::string>{"d.csv: these columns are ignored: 'id', 'Z'"}));
  EXPECT_EQ(warnings("x,y,depth\n0,0,5\n4,0,5\n4,3,5\n"),
            (std::vector<std::string>{"d.csv: this column is ignored: 'depth'"}));
  EXPECT_EQ(
      warnings("0 0 5\n4 0 5\n4 3 5\n"),
      (std::vector<std::string>{"d.csv:1: columns after the first two are ignored, because no "
                                "line names them"}));
  EXPECT_EQ(warnings("x,y,marker,ring\n0,0,1,1\n4,0,1,1\n4,3,1,1\n"), std::vector<std::string>{});
}

TEST_F(CsvRings, HaveDecimalCommasIfTheFileDecidesIt) {
  for (const char* text : {
           "x;y\n0,5;0,25\n4,5;0,25\n4,5;3,25\n0,5;3,25\n",
           "x\ty\n0,5\t0,25\n4,5\t0,25\n4,5\t3,25\n0,5\t3,25\n",
           "0,5\t0,25\n4,5\t0,25\n4,5\t3,25\n0,5\t3,25\n",
           "0,5 0,25\n4,5 0,25\n4,5 3,25\n0,5 3,25\n",
           "x,y\n\"0,5\",\"0,25\"\n\"4,5\",\"0,25\"\n\"4,5\",\"3,25\"\n\"0,5\",\"3,25\"\n",
       })
    EXPECT_EQ(read(text).points, kHalves) << text;
  const Domain empty_markers = read("x;y;marker\n0,1;0;\n10,2;0;\n10,9;10;\n0,8;10;\n");
  EXPECT_EQ(empty_markers.points, (std::vector<Point>{{0.1, 0}, {10.2, 0}, {10.9, 10}, {0.8, 10}}));
}

TEST_F(CsvRings, AreRefusedWithBothReadingsIfCommasMayBeBoth) {
  EXPECT_EQ(
      refusal("x,y,marker\n0,1,0,\n10,2,0,\n10,9,10,\n0,8,10,\n"),
      "d.csv:2:7: the line goes on after its 3 columns: its first two are '0' and '1', or with "
      "decimal commas '0,1' and '0'; write decimal points, or separate columns by semicolons");
  EXPECT_EQ(
      refusal("0,5,0,25\n4,5,0,25\n4,5,3,25\n0,5,3,25\n"),
      "d.csv:1:5: the line goes on after its 2 columns: its first two are '0' and '5', or with "
      "decimal commas '0,5' and '0,25'; write decimal points, or separate columns by "
      "semicolons");
  EXPECT_EQ(refusal("0.5,0.5,1\n"), "d.csv:1:9: the line goes on after its 2 columns");
}

TEST_F(CsvRings, AreRefusedIfPointsAndCommasAreDecimalMarks) {
  EXPECT_EQ(
      refusal("x;y\n0,5;0\n4;0.25\n4;3\n"),
      "d.csv:3:3: numbers have decimal points, '0.25' in line 3, and decimal commas, '0,5' in "
      "line 2");
  EXPECT_EQ(refusal("x;y\n1.234,5;0\n"), "d.csv:2:1: expected the x coordinate, found '1.234,5'");
}

TEST_F(CsvRings, EndAtEverythingThatPartsThem) {
  for (const char* end :
       {"", "# a hole", "NaN NaN", "nan\tNAN", "NA NA", "-nan(ind) -nan(ind)", ">", "> -Z5 hole",
        "-999 -999", "-9999.0 -9999.0", "-99999 -99999", "9999 9999"}) {
    const std::string text =
        "0 0\n10 0\n10 10\n0 10\n" + std::string(end) + "\n4 4\n6 4\n6 6\n" + end + "\n";
    const bool is_comment = end[0] == '#';
    EXPECT_EQ(rings(is_comment ? "0 0\n9 0\n\n" + text : text), (std::vector<std::size_t>{4, 3}))
        << end;
  }
  EXPECT_EQ(rings("x;y;m\n0;0;1\n10;0;1\n10;10;1\n0;10;1\n;;\n4;4;2\n6;4;2\n6;6;2\n;;\n"),
            (std::vector<std::size_t>{4, 3}));
  EXPECT_EQ(rings("NaN,NaN\n0,0\n10,0\n10,10\n0,10\nNaN,NaN\n4,4\n6,4\n6,6\nNaN,NaN\n"),
            (std::vector<std::size_t>{4, 3}));
  EXPECT_EQ(rings("x y marker\n0 0 1\n10 0 1\n10 10 1\n0 10 1\nNaN NaN\n4 4 1\n6 4 1\n6 6 1\n"),
            (std::vector<std::size_t>{4, 3}));
  EXPECT_EQ(rings("id,x,y\n1,0,0\n2,10,0\n3,10,10\n4,0,10\n5,,\n6,4,4\n7,6,4\n8,6,6\n"),
            (std::vector<std::size_t>{4, 3}));
  EXPECT_EQ(rings("ring,x,y\na,0,0\na,10,0\na,10,10\na,0,10\nb,4,4\nb,6,4\nb,6,6\n"),
            (std::vector<std::size_t>{4, 3}));
}

TEST_F(CsvRings, TellOfRowsThatAreTakenForEnds) {
  EXPECT_EQ(warnings("0 0\n10 0\n10 10\n-999 -999\n4 4\n6 4\n6 6\n-999 -999\n"),
            (std::vector<std::string>{
                "d.csv:4: the row (-999, -999) and 1 more like it are taken for ends of rings"}));
  EXPECT_EQ(warnings("0 0\n5000 0\n5000 5000\n0 5000\n-999 -999\n"),
            (std::vector<std::string>{"d.csv:5: the row (-999, -999) is taken for a corner"}));
  EXPECT_EQ(warnings("0 0\n999 0\n999 999\n0 999\n"), std::vector<std::string>{});
}

TEST_F(CsvRings, LeaveOutThoseWithoutAnArea) {
  EXPECT_EQ(
      warnings("0 0\n10 0\n10 10\n\n4 4\n4 4\n\n1 1\n2 2\n1 1\n"),
      (std::vector<std::string>{"d.csv: 2 rings without an area are left out, the first is the "
                                "ring from line 5"}));
}

TEST_F(CsvRings, RefuseHalfANumber) {
  EXPECT_EQ(refusal("0 0\n4 NaN\n4 3\n"),
            "d.csv:2:3: expected the y coordinate, a finite number, found 'NaN'");
  EXPECT_EQ(refusal("x,y\n0,0\n4,\n4,3\n"), "d.csv:3:3: the y coordinate is missing");
  EXPECT_EQ(refusal("0 0\n4.0X+00 1\n"), "d.csv:2:1: expected the x coordinate, found '4.0X+00'");
  EXPECT_EQ(refusal("x;y\n0;0\n4,0\n"),
            "d.csv:3:1: the line ends where the y coordinate should follow; semicolons separate "
            "columns here");
}

TEST_F(CsvRings, AreRefusedWithoutACorner) {
  for (const char* text :
       {"", "\xef\xbb\xbf", ">\n>\n", "NaN NaN\nNaN NaN\n", "x,y\n", "# no\n", ";;\n"})
    EXPECT_EQ(refusal(text), "d.csv: holds no geometry") << text;
}

TEST_F(CsvRings, TakeMarkersByNumberAndByName) {
  const Domain domain = read("x,y,marker\n0,0,\"west \"\"wall\"\"\"\n4,0,3.0\n4,3,\n0,3,-2\n");
  std::vector<std::int32_t> markers;
  for (const auto& segment : domain.segments) markers.push_back(segment.marker);
  EXPECT_EQ(markers, (std::vector<std::int32_t>{1, 3, 0, -2}));
  EXPECT_EQ(domain.names.markers, (NameTable{{1, "west \"wall\""}}));
  EXPECT_EQ(refusal("x,y,marker\n0,0,1.5\n"), "d.csv:2:5: expected the marker, found '1.5'");
  EXPECT_EQ(refusal("x,y,marker\n0,0,4294967296\n"),
            "d.csv:2:5: the marker is 4294967296, it must fit in 32 bits");
}

TEST_F(CsvRings, MayBeGeometriesInAColumnOfTheirOwn) {
  const std::string polygon = "POLYGON ((0 0,4 0,4 3,0 3,0 0))";
  for (const std::string& text : {
           "WKT,id,marker,region,max_area\n\"" + polygon + "\",1,3,7,0.5\n",
           "wkt_geom\tmarker\tregion\tmax_area\n" + polygon + "\t3\t7\t0,5\n",
           "MARKER;REGION;MAX_AREA;WKT\n3;7;0,5;" + polygon + "\n",
           ",geometry,marker,region,max_area,note\n0,\"" + polygon + "\",3.0,7,5D-1,\"a\nb\"\n",
       }) {
    const Domain domain = read(text);
    ASSERT_EQ(domain.points, kRectangle) << text;
    EXPECT_EQ(domain.segments[0].marker, 3) << text;
    EXPECT_EQ(domain.areas, (std::vector<Domain::Area>{{7, 0.5}})) << text;
  }
  EXPECT_EQ(read("WKT\n" + polygon + "\n").points, kRectangle);
  EXPECT_EQ(warnings("WKT,x,region\n\"" + polygon + "\",1,bay\nPOLYGON EMPTY,2,\n,3,\n"),
            (std::vector<std::string>{
                "d.csv: this column is ignored: 'x'",
                "d.csv: 2 empty geometries are left out, the first is line 3, geometry 0"}));
}

TEST_F(CsvRings, TellWhereAGeometryIsWrong) {
  EXPECT_EQ(refusal("id,WKT\n1,\"POLYGON((0 0,4 x,4 3,0 0))\"\n"),
            "d.csv:2:19: expected a finite number, found 'x'");
  EXPECT_EQ(refusal("WKT,max_area\nPOINT(1 1),-1\n"),
            "d.csv: line 2, column max_area is -1, not positive");
  EXPECT_EQ(refusal("WKT,note\nPOINT(1 1),\"a\n"),
            "d.csv:2:12: the quotation mark is not closed before a separator");
}

}  // namespace
}  // namespace weft::files
