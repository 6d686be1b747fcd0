// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/geojson.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/files/support/temp_folder.h"
#include "tests/support/paths.h"

namespace weft::files {
namespace {

class GeoJson : public ::testing::Test {
 protected:
  Result<Domain> read(std::string_view text) {
    return read_geojson(folder_.write("map.geojson", text));
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

TEST_F(GeoJson, ReadsAPolygonWithAHoleAsAnArea) {
  const auto domain = read(R"({"type": "Polygon", "coordinates": [
      [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [1, 2], [2, 2, 99], [1, 1]]]})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 7u);
  EXPECT_EQ(domain->points[6], (Point{2, 2}));
  EXPECT_EQ(domain->segments, (std::vector<Domain::Segment>{{0, 1, 0, 1},
                                                            {1, 2, 0, 1},
                                                            {2, 3, 0, 1},
                                                            {3, 0, 0, 1},
                                                            {4, 5, 0, 1},
                                                            {5, 6, 0, 1},
                                                            {6, 4, 0, 1}}));
  EXPECT_EQ(domain->fill, Domain::Fill::kUnion);
  EXPECT_EQ(domain->areas, std::vector<Domain::Area>(1));
  EXPECT_TRUE(domain->holes.empty());
}

TEST_F(GeoJson, MarksTheSegmentsOfAFeature) {
  const auto domain = read(R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "geometry": null, "properties": {"marker": 9}},
      {"type": "Feature", "properties": {"marker": -5, "region": "Maine"}, "geometry":
        {"type": "LineString", "coordinates": [[0, 0], [1, 0], [0, 1], [0, 0]]}},
      {"type": "Feature", "properties": null, "geometry":
        {"type": "MultiLineString", "coordinates": [[[5, 5], [6, 6]]]}}]})");
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->segments.size(), 4u);
  EXPECT_EQ(domain->segments[0].marker, -5);
  EXPECT_EQ(domain->segments[3].marker, 0);
  EXPECT_EQ(domain->fill, Domain::Fill::kSeeds);
  EXPECT_TRUE(domain->regions.empty());
}

TEST_F(GeoJson, KeepsLinesBesidePolygonsOutOfTheirBorders) {
  const auto domain = read(R"({"type": "GeometryCollection", "geometries": [
      {"type": "LineString", "coordinates": [[1, 1], [3, 3]]},
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]]},
      {"type": "MultiPoint", "coordinates": [[2, 1], [3, 1]]}]})");
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->segments.size(), 5u);
  EXPECT_EQ(domain->segments[0].area, 0u);
  EXPECT_EQ(domain->segments[4].area, 1u);
  EXPECT_EQ(domain->fill, Domain::Fill::kUnion);
  EXPECT_EQ(domain->points.size(), 8u);
}

TEST_F(GeoJson, MakesAnAreaOfEachPolygon) {
  const auto domain = read(R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "properties": {"region": 3, "max_area": 0.5}, "geometry": {"type":
        "MultiPolygon", "coordinates": [
          [[[0, 0], [9, 0], [9, 9], [8, 9], [8, 1], [1, 1], [1, 9], [0, 9], [0, 0]]],
          [[[20, 0], [30, 0], [25, 8], [20, 0]]]]}},
      {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": []}},
      {"type": "Feature", "properties": {"max_area": 2}, "geometry": {"type": "Polygon",
        "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}}]})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_TRUE(domain->regions.empty());
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{3, 0.5}, {3, 0.5}, {std::nullopt, 2}}));
  EXPECT_EQ(domain->segments.back().area, 3u);
  EXPECT_TRUE(
      domain->area_places.locate(1).ends_with("features[0].geometry.coordinates[1], area 0"));
}

TEST_F(GeoJson, BoundsTheAreasOfARegionByALengthOfEdgesToo) {
  const auto bound = [&](const std::string& properties) {
    const auto domain = read(R"({"type": "Feature", "properties": )" + properties +
                             R"(, "geometry": {"type": "Polygon",
                             "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}})");
    return domain && !domain->areas.empty() ? domain->areas[0].max_area : std::nullopt;
  };
  EXPECT_NEAR(bound(R"({"max_edge": 2})").value(), std::sqrt(3), 1e-12);
  EXPECT_NEAR(bound(R"({"max_edge": 2, "max_area": 9})").value(), std::sqrt(3), 1e-12);
  EXPECT_EQ(bound(R"({"max_edge": 2, "max_area": 1})"), 1);
  EXPECT_EQ(bound("{}"), std::nullopt);
}

TEST_F(GeoJson, DropsPositionsThatRepeatAndKeepsTheirNumbers) {
  const auto domain = read(R"({"type": "Polygon", "coordinates":
      [[[0, 0], [4, 0], [4, 0], [4, 4], [0, 0], [0, 0]]]})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 3u);
  EXPECT_TRUE(domain->point_places.locate(2).ends_with("map.geojson: coordinates[0][3]"));
  EXPECT_TRUE(domain->segment_places.locate(2).ends_with("coordinates[0], edge from [3]"));
}

TEST_F(GeoJson, ReadsTheCoast) {
  const auto domain = read_geojson(std::string(weft::testing::kModels) + "/us-east-coast.geojson");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 9370u);
}

TEST_F(GeoJson, ClosesRingsAndTellsOfTheFirstFive) {
  std::string more;
  for (int i = 0; i < 6; ++i) more += ", [[[9, 9], [9, 8], [8, 8], [8, 9]]]";
  const auto domain = read(R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "properties": {"marker": 3}, "geometry": {"type": "MultiPolygon",
        "coordinates": [[[[0, 0], [4, 0], [4, 4], [0, 4]]])" +
                           more + "]}}]}");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments[3], (Domain::Segment{3, 0, 3, 1}));
  EXPECT_TRUE(domain->segment_places.locate(3).ends_with("[0][0], edge from [3]"));
  ASSERT_EQ(domain->warnings.size(), 6u);
  EXPECT_TRUE(domain->warnings[0].sentence().ends_with(
      "map.geojson: features[0].geometry.coordinates[0][0] is a ring that is not closed: it starts "
      "at (0, 0) and ends at (0, 4); a segment closes it"));
  EXPECT_TRUE(domain->warnings[5].sentence().ends_with("map.geojson: 2 more rings are not closed"));
}

TEST_F(GeoJson, WarnsOfARingThatCrossesItselfAndNamesTheEdges) {
  const auto domain = read(R"({"type": "Feature", "properties": {"region": 7}, "geometry":
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]]]}})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments.size(), 4u);
  EXPECT_EQ(domain->areas.size(), 1u);
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_TRUE(domain->warnings[0].sentence().ends_with(
      "map.geojson: geometry.coordinates[0] is a ring that crosses itself: edge 0 from (0, 0) to "
      "(4, 4) crosses edge 2 from (4, 0) to (0, 4)"))
      << domain->warnings[0].sentence();
}

TEST_F(GeoJson, WarnsOfHolesThatParityDoesNotTakeForHoles) {
  const auto warnings = [this](const std::string& holes) {
    const auto domain = read(R"({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9],
        [0, 0]], [[1, 1], [3, 1], [3, 3], [1, 1]])" +
                             holes + "]}");
    EXPECT_TRUE(domain) << domain.error().message;
    std::string text;
    for (const std::string& warning : sentences(domain->warnings))
      text += warning.substr(warning.find("map.geojson"));
    return text;
  };
  EXPECT_EQ(warnings(",[[3, 3], [4, 3], [4, 4], [3, 3]]"), "");
  EXPECT_EQ(warnings(",[[20, 1], [21, 1], [21, 2], [20, 1]]"),
            "map.geojson: coordinates[2] is a hole that is outside of its polygon or in another "
            "hole, at (20, 1); what an odd number of the rings encloses is meshed");
  EXPECT_EQ(warnings(",[[2, 1], [5, 1], [2, 4], [2, 1]]"),
            "map.geojson: coordinates[2] is a ring that crosses another of its polygon: "
            "coordinates[1], near (2, 1); what an odd number of the rings encloses is meshed");
}

TEST_F(GeoJson, TellsOfACoordinateSystemThatIsNotWgs84) {
  std::optional<CoordinateSystem> system;
  const auto told = [&](const std::string& crs) {
    const auto domain = read(R"({"type": "Polygon", "crs": )" + crs +
                             R"(, "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 0]]]})");
    EXPECT_TRUE(domain) << domain.error().message;
    EXPECT_LE(domain->warnings.size(), 1u);
    system = domain->system;
    return domain->warnings.empty()
               ? ""
               : domain->warnings[0].sentence().substr(domain->warnings[0].sentence().find("map."));
  };
  const auto named = [&told](const std::string& name) {
    return told(R"({"type": "name", "properties": {"name": ")" + name + R"("}})");
  };
  EXPECT_EQ(named("urn:ogc:def:crs:EPSG::32618"),
            "map.geojson: its crs is 'urn:ogc:def:crs:EPSG::32618', not WGS 84 as GeoJSON's is; "
            "coordinates are taken as they are");
  EXPECT_FALSE(system);
  EXPECT_TRUE(told(R"({"type": "link", "properties": {"href": "http://x"}})")
                  .starts_with(R"(map.geojson: its crs is '{"properties":{"href":"http://x")"));
  EXPECT_EQ(told("7"),
            "map.geojson: its crs is '7', not WGS 84 as GeoJSON's is; coordinates are "
            "taken as they are");
  for (const char* name : {"urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:OGC::CRS84",
                           "EPSG:4326", "urn:ogc:def:crs:EPSG::4326"}) {
    EXPECT_EQ(named(name), "") << name;
    EXPECT_EQ(system, (CoordinateSystem{name, true, kLonLat}));
  }
  EXPECT_TRUE(named("EPSG:4269").ends_with("coordinates are taken as they are"));
  EXPECT_EQ(system, (CoordinateSystem{"EPSG:4269", true, kLonLat}));
  named(R"(\u001b[2JEPSG:4326)");
  EXPECT_EQ(system, (CoordinateSystem{"?[2JEPSG:4326", true, kLonLat}));
  EXPECT_EQ(told("null"), "");
  EXPECT_FALSE(system);
}

TEST_F(GeoJson, CountsThePolygonsOfRingsThatOverlap) {
  std::string polygons;
  for (int i = 0; i < 8; ++i)
    polygons += std::string(i == 0 ? "" : ",") +
                "[[[0, 0], [4, 4], [4, 0], [0, 0]], [[9, 9], [8, 8], [9, 8], [9, 9]]]";
  const auto domain = read(R"({"type": "MultiPolygon", "coordinates": [)" + polygons + "]}");
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->warnings.size(), 6u);
  EXPECT_TRUE(domain->warnings[5].sentence().ends_with(
      "map.geojson: 3 more polygons have rings that overlap"));
}

TEST_F(GeoJson, CountsTheRingsThatCrossThemselves) {
  std::string rings;
  for (int i = 0; i < 8; ++i)
    rings += std::string(i == 0 ? "" : ",") + "[[[0, 0], [4, 4], [4, 0], [0, 4], [0, 0]]]";
  const auto domain = read(R"({"type": "MultiPolygon", "coordinates": [)" + rings + "]}");
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->warnings.size(), 6u);
  EXPECT_TRUE(
      domain->warnings[5].sentence().ends_with("map.geojson: 3 more rings cross themselves"));
}

TEST_F(GeoJson, LeavesOutWhatHasNoAreaAndNoLengthAndCountsIt) {
  const auto domain = read(R"({"type": "GeometryCollection", "geometries": [
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]],
        [[1, 1], [1, 1], [1, 1], [1, 1]], [], [[1, 1], [2, 2], [2, 2], [1, 1]]]},
      null, {"type": "Polygon", "coordinates": []}, {"type": "MultiPolygon", "coordinates": [[]]},
      {"type": "LineString", "coordinates": [[1, 1], [1, 1]]}]})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments.size(), 4u);
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_TRUE(domain->warnings[0].sentence().ends_with(
      "map.geojson: 3 rings without an area, 1 line without a length and 3 empty geometries are "
      "left out, the first is geometries[0].coordinates[1]"))
      << domain->warnings[0].sentence();
}

TEST_F(GeoJson, LeavesOutTheHolesOfARingThatIsLeftOut) {
  const auto domain = read(R"({"type": "MultiPolygon", "coordinates": [
      [[[0, 0], [4, 0], [0, 0]], [[1, 1], [2, 1], [2, 2], [1, 1]]],
      [[[9, 9], [10, 9], [10, 10], [9, 9]]]]})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->points.size(), 3u);
  EXPECT_EQ(domain->points[0], (Point{9, 9}));
}

TEST_F(GeoJson, SaysWhatItLeftOutIfNothingIsLeft) {
  EXPECT_EQ(refusal(R"({"type": "Polygon", "coordinates": [[[0, 0], [4, 4], [0, 0]]]})"),
            "map.geojson: holds no geometry: 1 ring without an area is left out: coordinates[0]");
  EXPECT_EQ(refusal(R"({"type": "LineString", "coordinates": [[0, 0], [0, 0]]})"),
            "map.geojson: holds no geometry: 1 line without a length is left out: coordinates");
}

TEST_F(GeoJson, TakesATextThatIsANumberForThatNumber) {
  const auto domain = read(R"({"type": "Feature", "properties":
      {"marker": "3", "region": " 7 ", "max_area": "1.0e-1"}, "geometry":
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 0]]]}})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments[0].marker, 3);
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{7, 0.1}}));
  EXPECT_TRUE(domain->names.empty());
}

TEST_F(GeoJson, TakesPropertiesInCapitalsUnlessTheyAreThereInSmallLetters) {
  const auto domain = read(R"({"type": "Feature", "properties":
      {"MARKER": 4, "marker": 3, "Region": "inlet", "MAX_AREA": "0.5", "Max_Area": 9}, "geometry":
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 0]]]}})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments[0].marker, 3);
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{1, 0.5}}));
  EXPECT_EQ(domain->names.regions, (NameTable{{1, "inlet"}}));
}

TEST_F(GeoJson, TakesATextOfBlanksForNothing) {
  const auto domain = read(R"({"type": "Feature", "properties":
      {"marker": "", "region": " ", "max_area": ""}, "geometry":
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 0]]]}})");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->areas, std::vector<Domain::Area>(1));
  EXPECT_TRUE(domain->names.empty());
}

TEST_F(GeoJson, RefusesWrongTypes) {
  EXPECT_EQ(
      refusal("[]"),
      "map.geojson: is a list, and GeoJSON is an object: write {\"type\": \"GeometryCollection\", "
      "\"geometries\": [...]} around geometries, or {\"type\": \"FeatureCollection\", "
      "\"features\": [...]} around features");
  EXPECT_EQ(refusal("{}"), "map.geojson: has no string \"type\"");
  EXPECT_EQ(
      refusal(R"({"type": "Topology"})"),
      "map.geojson: has the type 'Topology', which is not GeoJSON's; TopoJSON is read from files "
      "named .topojson");
  EXPECT_EQ(refusal(R"({"type": "Polygon"})"), "map.geojson: has no array \"coordinates\"");
  EXPECT_EQ(refusal(R"({"type": "Polygon", "coordinates": [7]})"),
            "map.geojson: coordinates[0] is not an array of positions");
  EXPECT_EQ(refusal(R"({"type": "LineString", "coordinates": [[0, 0], ["a", 1]]})"),
            "map.geojson: coordinates[1] is not a position [x, y]");
  EXPECT_EQ(refusal(R"({"type": "FeatureCollection", "features": []})"),
            "map.geojson: holds no geometry");
}

TEST_F(GeoJson, RefusesPropertiesThatCannotBeMeant) {
  const auto with = [this](const std::string& properties) {
    return refusal(R"({"type": "Feature", "properties": )" + properties +
                   R"(, "geometry": {"type": "Point", "coordinates": [0, 0]}})");
  };
  EXPECT_EQ(with(R"({"marker": 1.5})"),
            "map.geojson: properties.marker is 1.5, not an integer of 32 bits");
  EXPECT_EQ(with(R"({"region": 1e10})"),
            "map.geojson: properties.region is 1e+10, not an integer of 32 bits");
  EXPECT_EQ(with(R"({"max_area": 0})"), "map.geojson: properties.max_area is 0, not positive");
  EXPECT_EQ(with(R"({"max_edge": -1})"), "map.geojson: properties.max_edge is -1, not positive");
  EXPECT_EQ(with(R"({"max_edge": "0,05"})"),
            "map.geojson: properties.max_edge is '0,05', not a number");
  EXPECT_EQ(with(R"({"max_area": "-1"})"), "map.geojson: properties.max_area is -1, not positive");
  EXPECT_EQ(with(R"({"marker": "1.5"})"),
            "map.geojson: properties.marker is 1.5, not an integer of 32 bits");
  EXPECT_EQ(with(R"({"max_area": true})"),
            "map.geojson: properties.max_area is true, not a number");
}

TEST_F(GeoJson, SaysWhereTheTextIsNotJson) {
  EXPECT_TRUE(refusal("{\n  \"type\": oops}").starts_with("map.geojson:2:11: syntax error"))
      << refusal("{\n  \"type\": oops}");
  EXPECT_TRUE(refusal("").starts_with("map.geojson:1:1: syntax error"));
}

TEST_F(GeoJson, RefusesADepthBomb) {
  EXPECT_EQ(refusal(std::string(1'000'000, '[')), "map.geojson:1:65: nested deeper than 64 levels");
}

TEST_F(GeoJson, BracketsInStringsAreNoDepth) {
  const auto domain = read(R"({"type": "Point", "coordinates": [1, 2], "name": ")" +
                           std::string(1000, '[') + R"(\"[["})");
  EXPECT_TRUE(domain) << domain.error().message;
}

TEST_F(GeoJson, RefusesGiantNumbers) {
  EXPECT_TRUE(refusal(R"({"type": "Point", "coordinates": [1e999, 2]})")
                  .find("number overflow parsing '1e999'") != std::string::npos);
  EXPECT_EQ(refusal(R"({"type": "Point", "coordinates": [1e200, 2]})"),
            "map.geojson: coordinates is (1e+200, 2), magnitudes go up to 1e50");
}

TEST_F(GeoJson, SaysWhatAListAndJsonOfEsriAre) {
  EXPECT_TRUE(refusal(R"([{"type": "Point", "coordinates": [0, 0]}])")
                  .starts_with("map.geojson: is a list, and GeoJSON is an object: write {\"type\": "
                               "\"GeometryCollection\", \"geometries\": [...]}"))
      << refusal(R"([{"type": "Point", "coordinates": [0, 0]}])");
  const std::string of_esri = refusal(
      R"({"geometryType": "esriGeometryPolygon", "features": [{"geometry": {"rings": []}}]})");
  EXPECT_TRUE(of_esri.starts_with("map.geojson: is JSON of Esri, not GeoJSON: ")) << of_esri;
}

TEST_F(GeoJson, JudgesRingsOfDegreesOnTheSphere) {
  const auto read_degrees = [this](const std::string& rings) {
    const auto path =
        folder_.write("map.geojson", R"({"type": "Polygon", "coordinates": [)" + rings + "]}");
    const auto domain = read_geojson(path, /*lonlat=*/true);
    EXPECT_TRUE(domain) << domain.error().message;
    return *domain;
  };
  const std::string box = "[[177,-19],[-178,-19],[-178,-16],[177,-16],[177,-19]]";
  for (const char* hole : {"[[179,-18],[-179,-18],[-179,-17],[179,-17],[179,-18]]",
                           "[[178,-18],[179,-18],[179,-17],[178,-17],[178,-18]]",
                           "[[-179.5,-18],[-179,-18],[-179,-17],[-179.5,-17],[-179.5,-18]]",
                           "[[181,-18],[181.5,-18],[181.5,-17],[181,-17],[181,-18]]"})
    EXPECT_TRUE(read_degrees(box + "," + hole).warnings.empty()) << hole;
  EXPECT_EQ(
      read_degrees(box + ",[[170,-18],[171,-18],[171,-17],[170,-17],[170,-18]]").warnings.size(),
      1u);
  EXPECT_EQ(read_degrees("[[179,0],[-179,2],[-179,0],[179,2],[179,0]]").warnings.size(), 1u);
  // Around a pole, closed at the meridian where it begins.
  for (const char* cap : {"[[-180,80],[-90,80],[0,80],[90,80],[180,80],[-180,80]]",
                          "[[0,80],[90,75],[180,80],[270,85],[360,80]]",
                          "[[180,-80],[90,-80],[0,-80],[-90,-80],[-180,-80],[180,-80]]"}) {
    const Domain domain = read_degrees(cap);
    EXPECT_TRUE(domain.warnings.empty()) << cap;
    EXPECT_EQ(domain.points.size(), 4u) << cap;
  }
  // A box around the Earth is none.
  EXPECT_EQ(read_degrees("[[-180,-60],[180,-60],[180,60],[-180,60],[-180,-60]]").points.size(), 4u);
}

TEST_F(GeoJson, TellsOfARegionThatALineCannotHave) {
  const auto domain = read(
      R"({"type": "Feature", "properties": {"region": 3}, "geometry": {"type": "LineString",
          "coordinates": [[0, 0], [4, 0], [4, 3], [0, 0]]}})");
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_TRUE(domain->warnings[0].sentence().find(
                  "geometry.coordinates is a line, and has a region") != std::string::npos)
      << domain->warnings[0].sentence();
}

}  // namespace
}  // namespace weft::files
