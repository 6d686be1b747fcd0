// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_text.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace weft::client {
namespace {

v1::Summary summary_with_warnings() {
  v1::Summary summary;
  v1::Unrefined& unrefined = *summary.mutable_unrefined();
  unrefined.set_edge_floor(7);
  unrefined.set_kept(2);
  unrefined.set_kept_x(8);
  unrefined.set_kept_y(9);
  unrefined.set_precision(1200);
  unrefined.set_too_large(200);
  unrefined.set_x(0.5);
  unrefined.set_y(-3);
  v1::Merging& merging = *summary.mutable_merging();
  merging.set_tolerance(0.001);
  merging.set_points(12);
  merging.set_segments(1);
  merging.set_farthest(0.0007);
  merging.set_farthest_x(1);
  merging.set_farthest_y(2);
  merging.set_vanished_faces(2);
  merging.set_vanished_x(4);
  merging.set_vanished_y(5);
  return summary;
}

TEST(MeshReport, HasAWarningOnce) {
  MeshReport report;
  report.warnings = {"a"};
  add_warnings({"b", "a", "b"}, report);
  EXPECT_EQ(report.warnings, (std::vector<std::string>{"a", "b"}));
}

TEST(MeshReport, WarnsOfTrianglesWithoutExemptionAndTellsWhatWasMerged) {
  const std::string text = summary_text(summary_with_warnings());
  EXPECT_EQ(
      text.substr(text.find('\n') + 1),
      "7 triangles miss a bound because edges would become too short\n"
      "2 triangles miss a bound because segments are kept as they are; the largest is at (8, 9)\n"
      "WARNING: 1,200 triangles without exemption, 200 above the bound on their area and 1,000 "
      "below the minimum angle, because double precision ends; the first is at (0.5, -3)\n"
      "merged within 0.001: 12 points moved, 1 segment bent, by 0.0007 at most, at (1, 2)\n"
      "2 faces of the input vanished, one at (4, 5)\n");
}

TEST(MeshReport, SaysNothingOfWhatDidNotHappen) {
  v1::Summary summary;
  summary.mutable_merging()->set_tolerance(1e-9);
  const std::string text = summary_text(summary);
  EXPECT_EQ(text.find('\n'), text.size() - 1);
}

TEST(MeshReport, WarnsOfSegmentsOutside) {
  v1::Summary summary;
  EXPECT_EQ(warnings_text(summary), "");
  EXPECT_EQ(summary_json(summary)["outside"], nullptr);
  v1::OutsideSegments& outside = *summary.mutable_outside();
  outside.set_segments(1200);
  outside.set_first(7);
  outside.set_x(0.5);
  EXPECT_EQ(warnings_text(summary),
            "WARNING: 1,200 segments lie outside of what is meshed, the first at (0.5, 0); weft "
            "lint shows where lines do not close\n");
  EXPECT_EQ(summary_json(summary)["outside"],
            (Json{{"segments", 1200}, {"first", 7}, {"at", {0.5, 0.0}}}));
  outside.set_segments(1);
  EXPECT_EQ(outside_warning(summary),
            "1 segment lies outside of what is meshed, at (0.5, 0); weft lint shows where lines do "
            "not close");
}

TEST(MeshReport, SpeaksOfOneAsOfOne) {
  v1::Summary summary;
  summary.mutable_unrefined()->set_small_input_angle(1);
  EXPECT_NE(summary_text(summary).find("\n1 triangle misses a bound because a small angle"),
            std::string::npos);
  v1::Unrefined unrefined;
  unrefined.set_streaming(1);
  EXPECT_EQ(
      unrefined_warning(unrefined),
      "WARNING: 1 triangle without exemption, 1 below the minimum angle, because the mesh around "
      "had been sent already; the first is at (0, 0)\n");
  v1::Merging merging;
  merging.set_points(1);
  merging.set_tolerance(0.5);
  merging.set_farthest(0.25);
  merging.set_vanished_faces(1);
  EXPECT_EQ(merging_text(merging),
            "merged within 0.5: 1 point moved, by 0.25 at most, at (0, 0)\n"
            "1 face of the input vanished, at (0, 0)\n");
}

TEST(MeshReport, GivesProgramsThePlacesIfThereAreAny) {
  const Json json = summary_json(summary_with_warnings());
  EXPECT_EQ(json["unrefined"]["precision"], 1200);
  EXPECT_EQ(json["unrefined"]["too_large"], 200);
  EXPECT_EQ(json["unrefined"]["at"], Json::parse("[0.5, -3.0]"));
  EXPECT_EQ(json["merging"]["farthest_at"], Json::parse("[1.0, 2.0]"));
  EXPECT_EQ(json["merging"]["vanished_at"], Json::parse("[4.0, 5.0]"));
  EXPECT_FALSE(summary_json({})["unrefined"].contains("at"));
  EXPECT_FALSE(summary_json({})["merging"].contains("farthest_at"));
}

TEST(MeshReport, TellsWhichSegmentsCostManyTrianglesAndWhatMergesThem) {
  v1::Summary summary;
  EXPECT_EQ(narrow_text(summary), "");
  EXPECT_TRUE(summary_json(summary)["narrow"].is_null());
  v1::NarrowPlace& narrow = *summary.mutable_narrow();
  narrow.set_segment(2);
  narrow.set_other(5);
  narrow.set_x(0);
  narrow.set_y(4);
  narrow.set_width(1.23e-5);
  narrow.set_triangles(95'000);
  narrow.set_in_all(189'999);
  narrow.set_widest(0.00021);
  EXPECT_EQ(narrow_text(summary),
            "at least 95,000 triangles lie between segments 2 and 5, 1.23e-05 apart at (0, 4): if "
            "they should be one, --snap 1.3e-05 merges them\n");
  narrow.set_in_all(190'000);
  EXPECT_EQ(
      narrow_text(summary),
      "at least 190,000 triangles lie where segments are up to 0.00021 apart, the most of them "
      "between segments 2 and 5, 1.23e-05 apart at (0, 4): if these should be one, --snap "
      "0.00022 merges them\n");
  EXPECT_EQ(summary_json(summary)["narrow"],
            Json::parse(R"({"segments": [2, 5], "at": [0.0, 4.0], "width": 1.23e-5,
                            "triangles": 95000, "in_all": 190000, "widest": 0.00021})"));
  for (const auto& [width, snap] : {std::pair{0.003, "0.0031 "}, {1.0, "1.1 "}, {99.5, "100 "}}) {
    narrow.set_widest(width);
    EXPECT_NE(narrow_text(summary).find(std::string("--snap ") + snap), std::string::npos) << width;
  }
}

TEST(MeshReport, TellsWhatWasSimplified) {
  v1::Summary summary;
  EXPECT_EQ(simplification_text(summary), "");
  EXPECT_TRUE(summary_json(summary)["simplification"].is_null());
  v1::Simplification& made = *summary.mutable_simplification();
  EXPECT_EQ(simplification_text(summary), "simplified: nothing was finer\n");
  made.set_points(2710);
  made.set_islands(1);
  made.set_waters(9);
  made.set_channels(38);
  made.set_cut_off(7);
  made.set_straits(1);
  made.set_area(3.73e8);
  made.set_farthest(998);
  for (const double at : {1, 2, 3, 4}) made.add_cuts(at);
  EXPECT_EQ(simplification_text(summary),
            "simplified: 2,710 points, 1 island and 9 waters dropped, 38 channels cut, 7 waters "
            "behind them dropped, 1 strait kept, area +3.73e+08, no line moved by more than 998\n");
  EXPECT_TRUE(summary_text(summary).ends_with(simplification_text(summary)));
  made.set_area(-2);
  EXPECT_NE(simplification_text(summary).find("area -2,"), std::string::npos);
  EXPECT_EQ(summary_json(summary)["simplification"],
            Json::parse(R"({"points": 2710, "islands": 1, "waters": 9, "channels": 38,
                            "cut_off": 7, "straits": 1, "area": -2.0, "farthest": 998.0,
                            "cuts": [[1.0, 2.0], [3.0, 4.0]]})"));
}

TEST(MeshReport, TellsTheAttributesThatIdsStandFor) {
  const std::vector<RegionValue> values = {{1, 0.35}, {3, -2.5}};
  EXPECT_EQ(region_values_text(values), "region 1 = 0.35\nregion 3 = -2.5\n");
  EXPECT_EQ(region_values_json(values), Json::parse(R"({"1": 0.35, "3": -2.5})"));
  std::vector<RegionValue> many;
  for (int id = 1; id <= 23; ++id) many.push_back({id, id + 0.5});
  EXPECT_TRUE(region_values_text(many).ends_with("region 20 = 20.5\nand 3 more regions\n"));
}

TEST(LayersText, SaysWhereTheyAreThinner) {
  v1::Summary summary;
  EXPECT_EQ(layers_text(summary), "");
  EXPECT_TRUE(summary_json(summary)["layers"].is_null());
  v1::LayerSummary& layers = *summary.mutable_layers();
  layers.set_triangles(3470);
  EXPECT_EQ(layers_text(summary), "layers: 3,470 triangles\n");
  layers.set_cut(2);
  layers.set_least_thickness(0.25);
  layers.set_x(1);
  EXPECT_EQ(layers_text(summary),
            "layers: 3,470 triangles, thinner than asked for at 2 corners for want of room, the "
            "least 0.25 thick at (1, 0)\n");
  EXPECT_EQ(summary_json(summary)["layers"]["at"], Json({1, 0}));
}

TEST(BudgetWarning, IsOfAMeshWithMoreTrianglesThanWereAllowed) {
  v1::Summary summary;
  summary.set_triangles(9580);
  EXPECT_EQ(budget_warning(summary, 0), std::nullopt);
  EXPECT_EQ(budget_warning(summary, 9580), std::nullopt);
  EXPECT_EQ(budget_warning(summary, 1000),
            "the mesh has 9,580 triangles, more than the 1,000 of --max-triangles, because the "
            "domain alone, without refinement, has that many");
}

TEST(MeshText, EndsWithTheWarningsThatJsonListsToo) {
  MeshReport report;
  EXPECT_FALSE(mesh_json(report, {}).contains("warnings"));
  report.warnings = {"one", "two"};
  EXPECT_TRUE(mesh_text(report, {}).ends_with("\nWARNING: one\nWARNING: two\n"));
  EXPECT_EQ(mesh_json(report, {})["warnings"], Json({"one", "two"}));
}

}  // namespace
}  // namespace weft::client
