// SPDX-License-Identifier: Apache-2.0
// Domains by OGR. That the formats are read: tests/client/read_others.py.
#include "files/formats/domains/ogr.h"

#include <gdal.h>
#include <gtest/gtest.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdlib.h>

#include <map>

#include "files/formats/domain_formats.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

struct SampleFeature {
  std::string wkt;
  std::map<std::string, std::string> fields{};
};

struct SampleLayer {
  std::string name;
  std::vector<SampleFeature> features;
  std::string crs = "EPSG:32618";  // or empty
};

class OgrFile : public ::testing::Test {
 protected:
  // Fields are of integers, but for "kind" and those of names, which are texts.
  std::filesystem::path write(const std::string& name, const char* driver,
                              const std::vector<SampleLayer>& layers) {
    GDALAllRegister();
    const auto path = folder_ / name;
    GDALDatasetH file =
        GDALCreate(GDALGetDriverByName(driver), path.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
    for (const SampleLayer& sample : layers) {
      OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
      if (!sample.crs.empty()) OSRSetFromUserInput(crs, sample.crs.c_str());
      OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
      OGRLayerH layer = GDALDatasetCreateLayer(
          file, sample.name.c_str(), sample.crs.empty() ? nullptr : crs, wkbUnknown, nullptr);
      OSRDestroySpatialReference(crs);
      for (const auto& [field, type] : {std::pair{"marker", OFTInteger64},
                                        {"region", OFTInteger64},
                                        {"max_area", OFTInteger64},
                                        {"kind", OFTString},
                                        {"marker_name", OFTString},
                                        {"region_name", OFTString}}) {
        OGRFieldDefnH made = OGR_Fld_Create(field, type);
        OGR_L_CreateField(layer, made, TRUE);
        OGR_Fld_Destroy(made);
      }
      for (const SampleFeature& sampled : sample.features) {
        OGRFeatureH feature = OGR_F_Create(OGR_L_GetLayerDefn(layer));
        for (const auto& [field, value] : sampled.fields)
          OGR_F_SetFieldString(feature, OGR_F_GetFieldIndex(feature, field.c_str()), value.c_str());
        std::string wkt = sampled.wkt;
        char* text = wkt.data();
        OGRGeometryH geometry = nullptr;
        EXPECT_EQ(OGR_G_CreateFromWkt(&text, nullptr, &geometry), OGRERR_NONE);
        OGR_F_SetGeometryDirectly(feature, geometry);
        EXPECT_EQ(OGR_L_CreateFeature(layer, feature), OGRERR_NONE);
        OGR_F_Destroy(feature);
      }
    }
    GDALClose(file);
    return path;
  }
  // An archive of files of this test's folder: pairs of the name in the archive, and theirs.
  std::filesystem::path archive(
      const std::vector<std::pair<std::string, std::string>>& files) const {
    std::filesystem::path path = folder_ / "d.zip";
    std::filesystem::remove(path);
    for (const auto& [name, source] : files) {
      const std::string contents = contents_of(folder_ / source);
      VSILFILE* file = VSIFOpenL(("/vsizip/" + path.string() + "/" + name).c_str(), "wb");
      EXPECT_EQ(VSIFWriteL(contents.data(), 1, contents.size(), file), contents.size());
      VSIFCloseL(file);
    }
    return path;
  }
  std::string refusal(const std::filesystem::path& path, const LayerOptions& layers = {},
                      ExitCode exit = ExitCode::kUnreadableInput) {
    const auto domain = read_domain(path, layers);
    if (domain) return "it was read";
    EXPECT_EQ(domain.error().exit, exit);
    const std::string& text = domain.error().message;
    return text.substr(folder_.path().string().size() + 1);
  }
  static std::vector<std::int32_t> markers(const Result<Domain>& domain) {
    std::vector<std::int32_t> out;
    EXPECT_TRUE(domain) << domain.error().message;
    if (domain)
      for (const auto& segment : domain->segments) out.push_back(segment.marker);
    return out;
  }
  TempFolder folder_;
};

const SampleFeature kSquare = {"POLYGON((0 0, 8 0, 8 8, 0 8, 0 0), (1 1, 2 1, 2 2, 1 1))",
                               {{"marker", "3"}, {"region", "7"}, {"max_area", "2"}}};
const SampleFeature kWall = {"LINESTRING Z(4 4 1, 5 5 2)", {{"marker", "4"}, {"kind", "wall"}}};

TEST_F(OgrFile, BringsPolygonsLinesPointsAndTheirAttributes) {
  const auto path = write("d.gpkg", "GPKG",
                          {{"d",
                            {kSquare,
                             kWall,
                             {"GEOMETRYCOLLECTION(POINT(6 6), MULTIPOINT(7 7, 6 7))"},
                             {"POINT EMPTY"},
                             {"MULTIPOLYGON(EMPTY)"}}}});
  const auto domain = read_domain(path);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->fill, Domain::Fill::kUnion);
  EXPECT_EQ(domain->points.size(), 4u + 3 + 2 + 3);
  EXPECT_EQ(markers(domain), (std::vector<std::int32_t>{3, 3, 3, 3, 3, 3, 3, 4}));
  ASSERT_EQ(domain->areas.size(), 1u);
  EXPECT_EQ(domain->areas[0].region, 7);
  EXPECT_EQ(domain->areas[0].max_area, 2);
  EXPECT_EQ(domain->system->name, "WGS 84 / UTM zone 18N");
  EXPECT_FALSE(domain->system->geographic);
  EXPECT_TRUE(domain->system->definition.starts_with("PROJCRS["));
  EXPECT_TRUE(domain->point_places.locate(5).ends_with("d.gpkg: layer 'd', feature 1, ring 1[1]"))
      << domain->point_places.locate(5);
}

TEST_F(OgrFile, NamesMarkersAndRegions) {
  SampleFeature square = kSquare;
  square.fields["marker_name"] = "quay";
  square.fields["region_name"] = "basin";
  const auto domain = read_domain(write(
      "d.gpkg", "GPKG", {{"d", {square, {"LINESTRING(3 3, 4 4)", {{"marker_name", "wall"}}}}}}));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers.size(), 2u);
  EXPECT_EQ(domain->names.markers.at(3), "quay");
  EXPECT_EQ(domain->names.markers.at(domain->segments.back().marker), "wall");
  EXPECT_EQ(domain->names.regions.at(7), "basin");
}

TEST_F(OgrFile, HasArcsAsTheyAre) {
  for (const auto& [name, driver] : {std::pair{"d.gpkg", "GPKG"}, {"d.gml", "GML"}}) {
    const auto domain = read_domain(write(
        name, driver,
        {{"d",
          {{"CURVEPOLYGON(COMPOUNDCURVE((0 -1, 4 -1), CIRCULARSTRING(4 -1, 5 0, 4 1), (4 1, 0 1),"
            "CIRCULARSTRING(0 1, -1 0, 0 -1)), CIRCULARSTRING(1 0, 2 0.5, 3 0, 2 -0.5, 1 0))"},
           {"MULTISURFACE(((9 0, 10 0, 9 1, 9 0)))"},
           {"MULTICURVE((0 5, 1 5), CIRCULARSTRING(1 5, 2 6, 3 5))"}}}}));
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_TRUE(domain->warnings.empty());
    EXPECT_EQ(domain->areas.size(), 2u);
    ASSERT_EQ(domain->arcs.size(), 5u) << name;
    EXPECT_EQ(domain->arcs[0], (Domain::Arc{1, 1}));
    EXPECT_EQ(domain->arcs[4], (Domain::Arc{10, -1}));
  }
}

TEST_F(OgrFile, TellsWhereItsArcsAreWrong) {
  EXPECT_EQ(refusal(write("d.gpkg", "GPKG", {{"d", {{"CIRCULARSTRING(0 0, 3 0, 1 0)"}}}})),
            "d.gpkg: layer 'd', feature 1 has an arc whose points lie on one line, (3, 0) outside "
            "of the others");
}

TEST_F(OgrFile, IsReadInPartByLayerAndCondition) {
  const auto path = write("d.gpkg", "GPKG",
                          {{"land", {kSquare, kWall}},
                           {"pier", {{"LINESTRING(1 4, 2 4)", {{"marker", "6"}}}}},
                           {"empty", {}}});
  EXPECT_EQ(refusal(path),
            "d.gpkg: has 2 layers; name those that are meant by --layer; there are 'land', 'pier'");
  EXPECT_EQ(markers(read_domain(path, {.layers = {"pier"}})), std::vector<std::int32_t>{6});
  EXPECT_EQ(markers(read_domain(
                path, {.layers = {"land", "pier"}, .where = "kind = 'wall' OR marker > 5"})),
            (std::vector<std::int32_t>{4, 6}));
  EXPECT_EQ(refusal(path, {.layers = {"sea"}}),
            "d.gpkg: has no layer 'sea'; there are 'land', 'pier', 'empty'");
  EXPECT_EQ(refusal(path, {.layers = {"empty"}}), "d.gpkg: holds no geometry");
  EXPECT_TRUE(refusal(path, {.layers = {"land"}, .where = "kind =="})
                  .starts_with("d.gpkg: layer 'land', --where 'kind ==' cannot be read: "))
      << refusal(path, {.layers = {"land"}, .where = "kind =="});
}

TEST_F(OgrFile, OfAFormatThatWeftReadsItselfIsReadInPart) {
  const auto path = write("d.geojson", "GeoJSON", {{"d", {kSquare, kWall}, "EPSG:4326"}});
  EXPECT_EQ(markers(read_domain(path)).size(), 8u);
  EXPECT_EQ(markers(read_domain(path, {.where = "marker = 4"})), std::vector<std::int32_t>{4});
  EXPECT_EQ(refusal(folder_.write("d.poly", ""), {.where = "marker = 4"}, ExitCode::kUsage),
            "d.poly: --layer, --where and --attribute are for files with layers and attributes: "
            ".geojson, .json, .shp, .gpkg, .fgb, .kml, .kmz, .gml, .dxf, .dgn, .tab, .mif, .gmt, "
            ".geojsonl, .topojson, .zip");
}

TEST_F(OgrFile, HasPropertiesInTheAttributesThatAreNamed) {
  const SampleFeature hole = {"POLYGON((9 0, 9 1, 10 0, 9 0))",
                              {{"kind", "pond"}, {"region", "5"}}};
  const auto path = write("d.shp", "ESRI Shapefile", {{"d", {kSquare, hole}}});
  const auto domain = read_domain(path, {.attributes = {{"region", "KIND"}, {"marker", "region"}}});
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(markers(domain), (std::vector<std::int32_t>{7, 7, 7, 7, 7, 7, 7, 5, 5, 5}));
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{std::nullopt, 2}, {.region = 1}}));
  EXPECT_EQ(domain->names.regions, (std::map<std::int32_t, std::string>{{1, "pond"}}));
  const auto bounded = read_domain(path, {.attributes = {{"max_edge", "region"}}});
  ASSERT_TRUE(bounded) << bounded.error().message;
  EXPECT_NEAR(*bounded->areas[1].max_area, 10.83, 0.01);
  EXPECT_EQ(refusal(path, {.attributes = {{"region", "use"}}}),
            "d.shp: has no attribute 'use'; there are 'marker', 'region', 'max_area', 'kind', "
            "'marker_nam', 'region_nam'");
}

TEST_F(OgrFile, HasLayersOfOneCoordinateSystem) {
  const auto path =
      write("d.gpkg", "GPKG", {{"a", {kSquare}}, {"b", {kWall}, "EPSG:4326"}, {"c", {kWall}}});
  EXPECT_EQ(refusal(path, {.layers = {"a", "b"}}),
            "d.gpkg: layer 'b' has another coordinate system than the layer before it");
  EXPECT_TRUE(read_domain(path, {.layers = {"a", "c"}}));
  const auto degrees = read_domain(path, {.layers = {"b"}});
  ASSERT_TRUE(degrees);
  EXPECT_EQ(degrees->system->name, "WGS 84");
  EXPECT_TRUE(degrees->system->geographic);
}

TEST(CoordinateSystems, AreTheSameIfPlacesAre) {
  const CoordinateSystem utm{"WGS 84 / UTM zone 18N", false, "EPSG:32618"};
  const CoordinateSystem by_esri{
      "WGS_1984_UTM_Zone_18N", false,
      R"(PROJCS["WGS_1984_UTM_Zone_18N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",)"
      R"(SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],)"
      R"(UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],)"
      R"(PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],)"
      R"(PARAMETER["Central_Meridian",-75.0],PARAMETER["Scale_Factor",0.9996],)"
      R"(PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])"};
  const CoordinateSystem next{"WGS 84 / UTM zone 19N", false, "EPSG:32619"};
  const CoordinateSystem degrees{"WGS 84", true, "EPSG:4326"};
  const CoordinateSystem other_degrees{"NAD27", true, "EPSG:4267"};
  EXPECT_TRUE(are_same(utm, by_esri));
  EXPECT_TRUE(are_same(degrees, other_degrees));
  EXPECT_FALSE(are_same(utm, next));
  EXPECT_FALSE(are_same(utm, degrees));
  EXPECT_FALSE(are_same(utm, {"none", false, "no system"}));
}

TEST_F(OgrFile, TellsWhereItIsWrong) {
  const auto one = [this](const SampleFeature& feature) {
    std::filesystem::remove(folder_ / "d.gpkg");
    return refusal(write("d.gpkg", "GPKG", {{"d", {feature}}}));
  };
  EXPECT_EQ(one({"POINT(1 1)", {{"marker", "4294967296"}}}),
            "d.gpkg: layer 'd', feature 1, field marker is 4294967296, not an integer of 32 bits");
  EXPECT_EQ(one({"POINT(1 1)", {{"max_area", "-1"}}}),
            "d.gpkg: layer 'd', feature 1, field max_area is -1, not positive");
  EXPECT_EQ(one({"LINESTRING(1 1, 1 1)"}),
            "d.gpkg: holds no geometry: 1 line without a length is left out: layer 'd', feature 1");
  EXPECT_EQ(refusal(folder_ / "none.gpkg"), "none.gpkg: No such file or directory");
}

TEST_F(OgrFile, TakesATextThatIsANumberForThatNumberAndLeavesOutEmptyGeometries) {
  const auto domain = read_domain(folder_.write(
      "d.gmt",
      "# @VGMT1.0 @GPOLYGON\n# @Nmarker|region|max_area\n# @Tstring|string|string\n# FEATURE_DATA\n"
      ">\n# @D3|7|0.5\n# @P\n0 0\n4 0\n4 3\n0 0\n>\n# @D3|7|0.5\n# @P\n9 9\n9 9\n9 9\n9 9\n"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments.size(), 3u);
  EXPECT_EQ(domain->segments[0].marker, 3);
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{7, 0.5}}));
  ASSERT_EQ(domain->warnings.size(), 1u);
}

TEST_F(OgrFile, WarnsOfARingThatCrossesItself) {
  const auto domain = read_domain(
      write("d.gpkg", "GPKG", {{"d", {{"MULTIPOLYGON(((0 0, 2 2, 2 0, 0 2, 0 0)))"}}}}));
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_TRUE(domain->warnings[0].sentence().ends_with(
      "d.gpkg: layer 'd', feature 1, part 0, ring 0 is a ring that crosses itself: edge 0 from "
      "(0, 0) to (2, 2) crosses edge 2 from (2, 0) to (0, 2)"))
      << domain->warnings[0].sentence();
}

TEST_F(OgrFile, IsFoundInAnArchive) {
  write("land.shp", "ESRI Shapefile", {{"land", {kSquare}}});
  write("pier.shp", "ESRI Shapefile", {{"pier", {kWall}}});
  write("land.gpkg", "GPKG", {{"land", {kSquare}}});
  folder_.write("notes.txt", "by their owner");
  std::vector<std::pair<std::string, std::string>> files = {
      {"a b/notes.txt", "notes.txt"},    {"a b/land.shp", "land.shp"},
      {"a b/land.shx", "land.shx"},      {"a b/land.dbf", "land.dbf"},
      {"__MACOSX/._d.shp", "notes.txt"}, {"._d.shp", "notes.txt"}};
  const auto domain = read_domain(archive(files));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments.size(), 7u);
  EXPECT_TRUE(
      domain->point_places.locate(0).ends_with("d.zip: layer 'land', feature 0, ring 0[0]"));

  for (const char* name : {"pier.shp", "pier.shx", "pier.dbf"})
    files.emplace_back(std::string("a b/") + name, name);
  EXPECT_EQ(refusal(archive(files)),
            "d.zip: has 2 layers; name those that are meant by --layer; there are 'land', 'pier'");
  const auto pier = read_domain(folder_ / "d.zip", {.layers = {"pier"}});
  ASSERT_TRUE(pier) << pier.error().message;
  EXPECT_EQ(pier->segments.size(), 1u);

  for (const auto& [name, source] :
       {std::pair{"a b/land.gpkg", "land.gpkg"}, {"c.shp", "land.shp"}}) {
    auto more = files;
    more.emplace_back(name, source);
    EXPECT_EQ(refusal(archive(more)),
              "d.zip: holds several files that are read as a domain, take one out of it: "
              "'a b/land.shp', 'a b/pier.shp', '" +
                  std::string(name) + "'");
  }
  EXPECT_EQ(refusal(archive({{"notes.txt", "notes.txt"}, {"d.zip", "notes.txt"}})),
            "d.zip: holds no file that is read as a domain");
  EXPECT_TRUE(refusal(folder_.write("d.zip", "PK")).starts_with("d.zip: is damaged, or no ZIP"));
}

TEST_F(OgrFile, OfTopologyIsMadeOfItsArcs) {
  const auto domain = read_domain(folder_.write(
      "d.topojson",
      R"({"type": "Topology", "arcs": [[[1, 0], [0, 2]], [[1, 2], [-1, 0], [0, -2], [1, 0]],
          [[1, 0], [1, 0], [0, 2], [-1, 0]]], "transform": {"scale": [2, 1], "translate": [10, 0]},
          "objects": {"d": {"type": "GeometryCollection", "geometries": [
            {"type": "Polygon", "arcs": [[0, 1]], "properties": {"region": 1}},
            {"type": "Polygon", "arcs": [[2, -1]], "properties": {"region": 2}}]}}})"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{.region = 1}, {.region = 2}}));
  EXPECT_EQ(domain->points[0], (Point{12, 0}));
  EXPECT_EQ(domain->points.size(), 8u);
}

// OpenSCAD wrote such drawings up to version 2021.01.
TEST_F(OgrFile, OfADrawingNeedsNoHeader) {
  std::string lines;
  for (const char* line :
       {"10\n0\n20\n0\n11\n4\n21\n0", "10\n4\n20\n0\n11\n0\n21\n3", "10\n0\n20\n3\n11\n0\n21\n0"})
    lines += std::string("  0\nLINE\n  8\n0\n") + line + "\n";
  const std::string drawing =
      "  0\nSECTION\n  2\nBLOCKS\n  0\nENDSEC\n  0\nSECTION\n  2\nENTITIES\n" + lines +
      "  0\nENDSEC\n  0\nEOF\n";
  for (const char* before : {"", "999\nplate\n"}) {
    const auto path = folder_.write("d.dxf", before + drawing);
    EXPECT_EQ(markers(read_domain(path)).size(), 3u) << before;
    EXPECT_EQ(markers(read_domain(archive({{"plate/d.dxf", "d.dxf"}}))).size(), 3u) << before;
  }
  folder_.write("d.dxf", drawing.substr(0, 30));
  EXPECT_EQ(refusal(archive({{"d.dxf", "d.dxf"}})),
            "d.zip:6: expected ENDSEC of the section 'BLOCKS', found the end of the file");
}

// What is in a file decides nothing but the domain.
TEST_F(OgrFile, IsReadInTheFormatOfItsNameAlone) {
  const std::string vrt =
      "<OGRVRTDataSource><OGRVRTLayer name='d'><SrcDataSource>/etc/passwd</SrcDataSource>"
      "</OGRVRTLayer></OGRVRTDataSource>";
  for (const char* name : {"d.gpkg", "d.kml", "d.gml", "d.fgb", "d.tab"})
    EXPECT_TRUE(refusal(folder_.write(name, vrt))
                    .starts_with(std::string(name) + ": is damaged, or of another format: "))
        << name;
  const auto remote = read_domain("/vsicurl/http://192.0.2.1/d.gpkg");
  ASSERT_FALSE(remote);
  EXPECT_EQ(remote.error().message, "/vsicurl/http://192.0.2.1/d.gpkg: No such file or directory");
}

TEST_F(OgrFile, IsTheSameWhateverTheEnvironmentAsksOfGdal) {
  const auto path =
      write("d.gpkg", "GPKG", {{"d", {{"CIRCULARSTRING(0 0, 1 1, 2 0, 1 -1, 0 0)"}}}});
  for (const auto& [name, value] : {std::pair{"OGR_ARC_STEPSIZE", "45"},
                                    {"OGR_ARC_MAX_GAP", "0.5"},
                                    {"OGR_STROKE_CURVE", "TRUE"}}) {
    ::setenv(name, value, 1);
    const auto domain = read_domain(path);
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->arcs, (std::vector<Domain::Arc>{{0, -1}, {1, -1}})) << name;
    ::unsetenv(name);
  }
}

TEST_F(OgrFile, LeavesNothingBesideItself) {
  const auto path = write("d.gml", "GML", {{"d", {kSquare}}});
  std::filesystem::remove(folder_ / "d.xsd");
  EXPECT_EQ(markers(read_domain(path)).size(), 7u);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"d.gml"});
}

}  // namespace
}  // namespace weft::files
