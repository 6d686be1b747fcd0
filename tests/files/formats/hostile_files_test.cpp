// SPDX-License-Identifier: Apache-2.0
// Files that were damaged on the way, or made to do damage: reading gives an error or a valid mesh,
// and never crashes, hangs or takes all memory. The sanitizers watch.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "files/formats/domain_formats.h"
#include "files/formats/domains/seeded.h"
#include "tests/files/support/dxf_text.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/shapefile_writer.h"

namespace weft::files {
namespace {

// Damages the file in a few hundred ways and has each read.
void damage(const std::filesystem::path& path, const std::function<bool()>& read) {
  const std::string whole = contents_of(path);
  const auto write = [&path](const std::string& text) {
    std::filesystem::remove(path);  // some file systems flush what is truncated
    std::ofstream(path, std::ios::binary) << text;
  };
  std::mt19937 random(99);
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  constexpr std::string_view kNasty[] = {"-1",    "4294967296",
                                         "nan",   "99999999999999999999",
                                         "1e999", "\"",
                                         "[",     "<",
                                         "$",     "\xff\xff\xff\xff\xff\xff\xff\x7f"};
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string text = whole;
    switch (round % 4) {
      case 0:
        text.resize(below(text.size()));
        break;
      case 1:
        for (int k = 0; k < 4; ++k) text[below(text.size())] = static_cast<char>(below(256));
        break;
      case 2: {
        const std::string_view nasty = kNasty[below(std::size(kNasty))];
        text.replace(below(text.size()), nasty.size(), nasty);
        break;
      }
      case 3:
        text.erase(below(text.size()), below(40));
        break;
    }
    write(text);
    refused += !read();
  }
  EXPECT_GT(refused, 50);
  write(whole);
  EXPECT_TRUE(read());
}

class HostileMesh : public ::testing::TestWithParam<const char*> {};

TEST_P(HostileMesh, IsRefusedOrRead) {
  TempFolder folder;
  Mesh mesh = square_mesh(3);
  mesh.names.markers = {{1, "inlet"}, {2, "out & let"}, {3, "w\u00e4nd"}};
  mesh.names.regions = {{7, "fluid"}};
  for (const char* name : {"m.node", "m.vtu", "m.msh", "m.14", "m.su2", "m.mesh", "m.npz", "m.obj",
                           "m.off", "m.2dm", "m.nc", "m.vol", "m.mfem", "m.inp"})
    ASSERT_TRUE(write_files(mesh.view(), folder / name));
  const std::filesystem::path path = folder / GetParam();
  damage(path, [&path] {
    const auto read = read_mesh(path.extension() == ".poly"
                                    ? std::filesystem::path(path).replace_extension(".node")
                                    : path);
    if (!read) return false;
    for (const std::uint32_t v : read->triangles) EXPECT_LT(v, read->coordinates.size() / 2);
    EXPECT_EQ(read->regions.size(), read->triangles.size() / 3);
    EXPECT_EQ(read->edge_markers.size(), read->edges.size() / 2);
    return true;
  });
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileMesh,
                         ::testing::Values("m.node", "m.ele", "m.poly", "m.vtu", "m.msh", "m.14",
                                           "m.su2", "m.mesh", "m.npz", "m.obj", "m.off", "m.2dm",
                                           "m.nc", "m.vol", "m.mfem", "m.inp"));

TEST(HostileMesh, OfGmsh22IsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder / "m.msh";
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(path, {}).value());
  write_mesh(*mesh_format(path), square_mesh(3).view(), files, {.msh_version = MshVersion::k22});
  ASSERT_TRUE(commit(files));
  damage(path, [&path] { return read_mesh(path).has_value(); });
}

TEST(HostileDomain, PolyIsRefusedOrRead) {
  TempFolder folder;
  const auto path =
      folder.write("d.poly",
                   "3 2 1 1\n1 0 0 1 1\n2 1 0 1 1\n3 0 1 1 1\n3 1\n1 1 2 5\n2 2 3 6\n3 3 1 7\n"
                   "1\n1 0.1 0.1\n1\n1 0.2 0.2 3 0.5\n");
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, GeoJsonIsRefusedOrRead) {
  TempFolder folder;
  const auto path =
      folder.write("d.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
      "properties": {"marker": 3, "region": "bay", "max_area": 0.5}, "geometry": {"type":
      "MultiPolygon", "coordinates": [[[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]],
      [[1, 1], [2, 1], [2, 2], [1, 1]]]]}}, {"type": "Feature", "properties": null, "geometry":
      {"type": "LineString", "coordinates": [[0.5, 0.5], [3.5, 0.5]]}}]})");
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, WktIsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder.write(
      "d.wkt",
      "MULTIPOLYGON(((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 1)), ((9 0, 12 0, 9 1, 9 0)));\n"
      "GEOMETRYCOLLECTION(LINESTRING(0.5 0.5, 3.5 0.5), POINT Z(3 3 3))\n"
      "MULTISURFACE(CURVEPOLYGON(COMPOUNDCURVE((20 0, 24 0), CIRCULARSTRING(24 0, 25 1, 24 2, 22 "
      "4, "
      "20 2), (20 2, 20 0)), CIRCULARSTRING(21 1, 23 1, 21 1)))\n");
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, CsvIsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder.write("d.csv",
                                 "ring,x,y,marker,bulge\n1,0,0,1,\n1,4,0,2,0.5\n1,4,4,3,0\n2,1,1,5,"
                                 "0\n2,2,1,5,1\n2,2,2,5,-1\n");
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, CsvOfGeometriesIsRefusedOrRead) {
  TempFolder folder;
  const auto path =
      folder.write("d.csv",
                   "WKT,id,marker,max_area\n\"POLYGON((0 0,4 0,4 4,0 0),(1 1,2 1,2 2,1 "
                   "1))\",1,\"west \"\"wall\"\"\",0.5\n\"LINESTRING(0.5 0.5,3.5 0.5)\",2,7,\n");
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, CsvOfUtf16IsRefusedOrRead) {
  TempFolder folder;
  std::string text = "\xff\xfe";
  for (const char c : std::string_view("X;Y;Z\r\n0,5;0;1\r\n4,5;0;1\r\n4;3D0;1\r\nNaN;NaN;\r\n>\r\n"
                                       "-999;-999;0\r\n1;1;1\r\n2;1;1\r\n2;2;1\r\n"))
    text += {c, '\0'};
  const auto path = folder.write("d.csv", text);
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, DrawingIsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder.write(
      "d.dxf",
      drawing("0 LWPOLYLINE 8 a 70 1 10 0 20 0 42 1 10 4 20 0 10 4 20 2 0 ARC 10 0 20 0 40 "
              "1 50 30 51 200 0 INSERT 2 b 41 -1 42 2 50 30 70 2 44 3 0 ELLIPSE 10 0 20 0 "
              "11 2 21 0 40 0.5 41 0 42 3 0 SPLINE 71 2 40 0 40 0 40 0 40 1 40 1 40 1 41 1 "
              "41 2 41 1 10 1 20 0 10 1 20 1 10 0 20 1 0 HATCH 91 1 92 1 93 2 72 2 10 0 20 "
              "0 40 2 50 0 51 180 73 1 72 1 10 -2 20 0 11 2 21 0 97 0 75 0 ",
              "0 BLOCK 2 b 10 1 20 1 0 CIRCLE 10 0 20 0 40 1 0 ENDBLK "));
  damage(path, [&path] {
    const auto domain = read_domain(path);
    return domain && seeded(*domain).has_value();
  });
}

TEST(HostileDomain, GeometryOfNetgenIsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder.write("d.in2d",
                                 "splinecurves2dv2\n"
                                 "5\n"
                                 "points\n"
                                 "1 -2 -2\n"
                                 "2 2 -2\n"
                                 "3 0 2\n"
                                 "11 1 0\n"
                                 "12 1 1\n"
                                 "13 0 1\n"
                                 "14 -1 0 2 -maxh=0.1\n"
                                 "segments\n"
                                 "1 0 2 1 2 -bc=3\n"
                                 "1 0 discretepoints 3 2 -2 1.5 1 0 2 -bcname=in\n"
                                 "1 0 3 3 14 1 -bc=wall -maxh=0.2\n"
                                 "2 1 4 11 12 13\n"
                                 "2 1 2 13 11 -hpref\n"
                                 "materials\n"
                                 "1 air -maxh=0.5\n"
                                 "2 iron\n");
  damage(path, [&path] {
    const auto domain = read_domain(path);
    return domain && seeded(*domain).has_value();
  });
}

TEST(HostileDomain, ModelOfFemmIsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder.write("d.fem",
                                 "[Format]      =  4.0\n"
                                 "[LengthUnits] =  inches\n"
                                 "[Comment]     =  \"a # b\"\n"
                                 "[BdryProps]   = 2\n"
                                 "  <BeginBdry>\n"
                                 "    <BdryName> = \"A = 0\"\n"
                                 "    <BdryType> = 0\n"
                                 "  <EndBdry>\n"
                                 "  <BeginBdry>\n"
                                 "    <BdryName> = \"seam\"\n"
                                 "    <BdryType> = 4\n"
                                 "  <EndBdry>\n"
                                 "[BlockProps]  = 1\n"
                                 "  <BeginBlock>\n"
                                 "    <BlockName> = \"M-19 Steel\"\n"
                                 "    <BHPoints> = 2\n"
                                 "      0\t0\n"
                                 "      1.5\t200\n"
                                 "  <EndBlock>\n"
                                 "[NumPoints] = 5\n"
                                 "-2\t0\t0\t0\n"
                                 "2\t0\t0\t0\n"
                                 "-1\t-1\t0\t0\n"
                                 "1\t-1\t0\t0\n"
                                 "0\t1\t0\t0\n"
                                 "[NumSegments] = 3\n"
                                 "2\t3\t-1\t2\t0\t0\n"
                                 "3\t4\t0.1\t0\t0\t0\n"
                                 "4\t2\t-1\t0\t0\t0\n"
                                 "[NumArcSegments] = 2\n"
                                 "1\t0\t180\t2.5\t1\t0\t0\t2.5\n"
                                 "0\t1\t90\t2.5\t1\t0\t0\t2.5\n"
                                 "[NumHoles] = 1\n"
                                 "0\t0\t0\n"
                                 "[NumBlockLabels] = 1\n"
                                 "0\t1.5\t1\t0.2\t0\t0\t0\t1\t2\n");
  damage(path, [&path] { return read_domain(path).has_value(); });
}

TEST(HostileDomain, ShapefileIsRefusedOrRead) {
  TempFolder folder;
  write_sample_shapefile(folder / "d");
  for (const char* part : {"d.shp", "d.shx", "d.dbf"})
    damage(folder / part, [&folder] { return read_domain(folder / "d.shp").has_value(); });
  std::filesystem::remove(folder / "d.shx");
  damage(folder / "d.shp", [&folder] { return read_domain(folder / "d.shp").has_value(); });
}

TEST(HostileDomain, MeshIsRefusedOrRead) {
  TempFolder folder;
  const auto path = folder / "m.14";
  ASSERT_TRUE(write_files(square_mesh(3).view(), path));
  damage(path, [&path] {
    const auto domain = read_domain(path);
    return domain && seeded(*domain).has_value();
  });
}

}  // namespace
}  // namespace weft::files
