// SPDX-License-Identifier: Apache-2.0
#include "server/http/formats.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace weft::server {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

TEST(HttpFormats, AreReadByOwnReadersAlone) {
  for (const char* own : {"poly", "geojson", "wkt", "csv", "dxf", "in2d", "fem", "zip"})
    EXPECT_TRUE(holds(read_formats(), own)) << own;
  for (const char* other : {"gpkg", "kml", "gml", "shp", "vtu", "msh"})
    EXPECT_FALSE(holds(read_formats(), other)) << other;
}

TEST(HttpFormats, AreWrittenIfTheyAreOneFile) {
  for (const char* one : {"vtu", "msh", "geojson", "nc", "14", "stl"})
    EXPECT_TRUE(holds(written_formats(), one)) << one;
  for (const char* other : {"xdmf", "foam", "node", "ele"})
    EXPECT_FALSE(holds(written_formats(), other)) << other;
}

TEST(HttpFormats, AreToldByNameThenTypeThenBytes) {
  EXPECT_EQ(format_read("coast.POLY", "text/csv", "{"), ".poly");
  EXPECT_EQ(format_read("coast.gpkg", "text/csv", "{"), "");
  EXPECT_EQ(format_read("coast.vtu", "", "{"), "");
  EXPECT_EQ(format_read("coast", "Text/CSV; charset=utf-8", "{"), ".csv");
  EXPECT_EQ(format_read("coast.txt", "application/x-www-form-urlencoded", "{"), ".geojson");
  EXPECT_EQ(format_read("", "", "\xef\xbb\xbf \r\n{\"type\""), ".geojson");
  EXPECT_EQ(format_read("", "", "MultiPolygon (((0 0"), ".wkt");
  EXPECT_EQ(format_read("", "", "SRID=4326;POLYGON((0 0"), ".wkt");
  EXPECT_EQ(format_read("", "", "  0\r\nSECTION\r\n"), ".dxf");
  EXPECT_EQ(format_read("", "", "999\nmade by me\n0\nSECTION\n"), ".dxf");
  EXPECT_EQ(format_read("", "", "AutoCAD Binary DXF\r\n"), ".dxf");
  EXPECT_EQ(format_read("", "", "PK\x03\x04"), ".zip");
  EXPECT_EQ(format_read("", "application/zip", "x"), ".zip");
  EXPECT_EQ(format_read("", "", "splinecurves2dv2\n"), ".in2d");
  EXPECT_EQ(format_read("", "", "# a box\n4 2 0 0\n1 0 0\n"), ".poly");
  EXPECT_EQ(format_read("", "", "0,0\n1,0\n"), ".csv");
  EXPECT_EQ(format_read("", "", "x y\n0 0\n"), ".csv");
  EXPECT_EQ(format_read("", "", ""), "");
}

TEST(HttpFormats, AreWantedByAccept) {
  EXPECT_EQ(format_wanted(""), ".vtu");
  EXPECT_EQ(format_wanted("*/*"), ".vtu");
  EXPECT_EQ(format_wanted("text/html, Application/Geo+JSON;q=0.9, */*"), ".geojson");
  EXPECT_EQ(format_wanted("model/stl"), ".stl");
  EXPECT_EQ(format_wanted("text/html"), "");
  EXPECT_EQ(media_type(".stl"), "model/stl");
  EXPECT_EQ(media_type(".vtu"), "application/octet-stream");
}

}  // namespace
}  // namespace weft::server
