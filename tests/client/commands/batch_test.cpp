// SPDX-License-Identifier: Apache-2.0
// What `weft batch` reads and writes; with a real server: tests/e2e/batch_test.cpp.
#include <gtest/gtest.h>

#include <fstream>

#include "client/batch/batch_report.h"
#include "client/batch/lock_file.h"
#include "client/batch/manifest.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

v1::Summary summary_of(std::uint64_t triangles, double min_angle = 20.5) {
  v1::Summary summary;
  summary.set_triangles(triangles);
  summary.set_vertices(triangles / 2);
  summary.set_min_angle_deg(min_angle);
  summary.set_max_angle_deg(130);
  summary.set_engine_version("2");
  summary.set_sha256(std::string(32, static_cast<char>(triangles)));
  return summary;
}

std::optional<std::string> violation(const char* gate, const v1::Summary& summary) {
  return QualityGate::parse(gate)->violation(summary);
}

TEST(QualityGate, PassesOnTheBoundItself) {
  EXPECT_FALSE(violation("min-angle=20.5", summary_of(100)));
  EXPECT_FALSE(violation("max-angle=130", summary_of(100)));
  EXPECT_FALSE(violation("min-triangles=100", summary_of(100)));
  EXPECT_FALSE(violation("max-triangles=100", summary_of(100)));
  EXPECT_FALSE(violation("max-vertices=50", summary_of(100)));
}

TEST(QualityGate, NamesFigureValueAndBoundWhereAMeshFails) {
  EXPECT_EQ(violation("min-angle=21", summary_of(100)), "min-angle is 20.5, less than 21");
  EXPECT_EQ(violation("max-angle=129", summary_of(100)), "max-angle is 130, more than 129");
  EXPECT_EQ(violation("min-triangles=101", summary_of(100)), "min-triangles is 100, less than 101");
  EXPECT_EQ(violation("max-triangles=99", summary_of(100)), "max-triangles is 100, more than 99");
  EXPECT_EQ(violation("max-vertices=49", summary_of(100)), "max-vertices is 50, more than 49");
}

TEST(QualityGate, ExemptsWhatTheInputForces) {
  v1::Summary summary = summary_of(100);
  summary.mutable_unrefined()->set_small_input_angle(7);
  EXPECT_FALSE(violation("max-unrefined=0", summary));
  summary.mutable_unrefined()->set_budget(2);
  summary.mutable_unrefined()->set_edge_floor(1);
  EXPECT_EQ(violation("max-unrefined=2", summary), "max-unrefined is 3, more than 2");
  summary.mutable_unrefined()->set_precision(4);
  summary.mutable_unrefined()->set_streaming(8);
  EXPECT_EQ(violation("max-unrefined=14", summary), "max-unrefined is 15, more than 14");
}

TEST(QualityGate, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(QualityGate::parse("min-angle").error().message,
            "'min-angle' is not FIGURE=BOUND, such as min-angle=20");
  EXPECT_NE(QualityGate::parse("angle=20").error().message.find("'angle' is not a figure"),
            std::string::npos);
  EXPECT_EQ(QualityGate::parse("min-angle=20x").error().message,
            "min-angle: '20x' is not a number");
}

class Manifest : public ::testing::Test {
 protected:
  Result<std::vector<BatchMesh>> read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_manifest(path_);
  }
  // The message, less the name of the file.
  std::string error(const std::string& text) {
    const auto meshes = read(text);
    if (meshes) return "read";
    EXPECT_EQ(meshes.error().exit, ExitCode::kUnreadableInput);
    EXPECT_TRUE(meshes.error().message.starts_with(path_));
    return meshes.error().message.substr(path_.size());
  }

  TempFolder folder_;
  const std::string path_ = (folder_ / "m.yaml").string();
};

TEST_F(Manifest, TakesTheFlagsOfMeshAndPathsFromWhereItLies) {
  const auto meshes = read(R"(
meshes:
  - {name: a, input: in/a.poly, size: x + 1, min-angle: 25, min-edge: 0.5, placement: circumcentre, max-triangles: 9,
     optimise: 3, snap: 0.125, allow-unrefined: true, max-seconds: 4, output: [o/a.vtu, o/a.msh], draw: a.png, color: angle, order: 2,
     require: {min-angle: 25}}
  - {name: b, input: /b.geojson, size: depth.asc}
)");
  ASSERT_TRUE(meshes) << meshes.error().message;
  ASSERT_EQ(meshes->size(), 2u);
  const BatchMesh& a = meshes->front();
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.input, folder_ / "in/a.poly");
  EXPECT_EQ(a.request_options.size, "x + 1");
  const v1::GenerateMeshRequest& asked = a.request_options.asked;
  EXPECT_EQ(asked.quality().min_angle_deg(), 25);
  EXPECT_EQ(asked.quality().min_edge(), 0.5);
  EXPECT_EQ(asked.quality().placement(), v1::PLACEMENT_CIRCUMCENTRE);
  EXPECT_EQ(asked.quality().optimise(), 3u);
  EXPECT_EQ(asked.domain().snap(), 0.125);
  EXPECT_TRUE(asked.allow_unrefined());
  EXPECT_EQ(asked.budget().max_triangles(), 9u);
  EXPECT_EQ(asked.budget().max_seconds(), 4);
  EXPECT_EQ(meshes->back().request_options.asked.ByteSizeLong(), 0u);
  EXPECT_EQ(a.output.files.back(), folder_ / "o/a.msh");
  EXPECT_EQ(a.output.drawings.front(), folder_ / "a.png");
  EXPECT_EQ(a.output.drawing.color, DrawColor::kAngle);
  EXPECT_EQ(a.output.writing.order, 2);
  ASSERT_EQ(a.gates.size(), 1u);
  EXPECT_EQ(meshes->back().input, "/b.geojson");
  EXPECT_EQ(meshes->back().request_options.size, (folder_ / "depth.asc").string());
  EXPECT_TRUE(meshes->back().output.empty());
}

TEST_F(Manifest, GivesDefaultsToMeshesThatSayNothingElse) {
  const auto meshes = read(R"(
defaults: {min-angle: 30, require: {min-angle: 30, max-triangles: 10}}
meshes:
  - {name: a, input: a.poly}
  - {name: b, input: b.poly, min-angle: 20, require: {min-angle: 20}}
)");
  ASSERT_TRUE(meshes) << meshes.error().message;
  EXPECT_EQ(meshes->front().request_options.asked.quality().min_angle_deg(), 30);
  EXPECT_EQ(meshes->back().request_options.asked.quality().min_angle_deg(), 20);
  EXPECT_EQ(meshes->back().gates.size(), 2u);
  for (const QualityGate& gate : meshes->back().gates)
    EXPECT_EQ(gate.violation(summary_of(11, 20)).has_value(), gate.figure() == "max-triangles");
}

TEST_F(Manifest, TakesDefaultsThatOneOfItsMeshesHasNoUseFor) {
  const auto meshes = read(R"(
defaults: {draw-quadtree: true, open-boundary: [1, 2]}
meshes:
  - {name: a, input: a.poly, output: a.14}
  - {name: b, input: b.poly, draw: b.png, open-boundary: 3}
)");
  ASSERT_TRUE(meshes) << meshes.error().message;
  EXPECT_FALSE(meshes->front().output.draw_quadtree);
  EXPECT_TRUE(meshes->back().output.draw_quadtree);
  EXPECT_EQ(meshes->front().output.writing.open_boundaries, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(meshes->back().output.writing.open_boundaries, (std::vector<std::int32_t>{3}));
}

TEST_F(Manifest, HasNamesAsTablesOrAsTheFlagDoes) {
  const auto meshes = read(R"(
meshes:
  - {name: a, input: a.poly, names: {marker: {2: inlet, -3: "the wall"}, region: {1: fluid}}}
  - {name: b, input: b.poly, names: [marker=2:in:let], output: b.14, open-boundary: [in, 3]}
)");
  ASSERT_TRUE(meshes) << meshes.error().message;
  Names names;
  ASSERT_TRUE(set_names(meshes->front().request_options.names, names));
  EXPECT_EQ(names.markers, (NameTable{{2, "inlet"}, {-3, "the wall"}}));
  EXPECT_EQ(names.regions, (NameTable{{1, "fluid"}}));
  ASSERT_EQ(meshes->back().request_options.names.size(), 1u);
  EXPECT_EQ(meshes->back().request_options.names[0].name, "in:let");
  EXPECT_EQ(meshes->back().output.writing.open_boundaries, (std::vector<std::int32_t>{3}));
  EXPECT_EQ(meshes->back().output.writing.open_boundary_names, (std::vector<std::string>{"in"}));
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    names: {2: inlet}\n"),
            ":4: names: not a table of ids to names");
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    names: {marker: {x: inlet}}\n"),
            ":4: names: 'marker=x:inlet' is not a name of a marker or a region, such as "
            "marker=2:inlet");
}

TEST_F(Manifest, NamesLineAndKeyOfWhatItDoesNotUnderstand) {
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    siez: 1\n"),
            ":4: 'siez' is not a key here: did you mean `size`?");
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    wondrous: 1\n"),
            ":4: 'wondrous' is not a key here");
  EXPECT_EQ(error("defaults: {min-agle: 20}\nmeshes: [{name: a, input: a.poly}]\n"),
            ":1: 'min-agle' is not a key here: did you mean `min-angle`?");
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    min-angle: [20]\n"),
            ":4: min-angle: not a single value");
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    min-angle: much\n"),
            ":4: min-angle: 'much' is not a number");
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    max-triangles: -5\n"),
            ":4: max-triangles: '-5' is not a count");
  EXPECT_EQ(error("meshes:\n  - name: a\n    input: a.poly\n    order: 3\n"),
            ":4: order: '3' is not 1 or 2");
  EXPECT_EQ(
      error("meshes:\n  - name: a\n    input: a.poly\n    require: {angle: 1}\n").substr(0, 24),
      ":4: require: 'angle' is ");
  EXPECT_EQ(error("meshes:\n  - {name: a, input: a.poly}\n  - {name: a, input: b.poly}\n"),
            ":3: 'a' names two meshes");
  EXPECT_EQ(error("meshes:\n  - {input: a.poly}\n"), ":2: a mesh without a name");
  EXPECT_EQ(error("meshes:\n  - {name: a}\n"), ":2: a: a mesh without an input");
  EXPECT_EQ(error("meshes: []\n"), ":1: meshes: not a list of at least one mesh");
  EXPECT_EQ(error("mesh: []\n"), ":1: 'mesh' is not a key here; the keys are defaults and meshes");
  EXPECT_EQ(error("defaults: {name: a}\nmeshes: [{input: a.poly}]\n"),
            ":1: 'name' is not a key here: did you mean `names`?");
  EXPECT_NE(error("meshes:\n  - {name: a, input: a.poly, output: a.xyz}\n").find(":2: output: "),
            std::string::npos);
}

TEST_F(Manifest, SurvivesWhatIsNoYaml) {
  EXPECT_NE(error("meshes: [{"), "read");
  EXPECT_NE(error("a: &a [*a]\nmeshes: *a\n"), "read");
  EXPECT_NE(error(std::string("\0\xff\xfe{[", 5)), "read");
  EXPECT_NE(error(std::string(100'000, '[')), "read");
  EXPECT_NE(error(""), "read");
  EXPECT_EQ(read_manifest(folder_ / "none.yaml").error().message,
            (folder_ / "none.yaml").string() + ": cannot be read");
}

TEST(LockFile, ReadsBackWhatItWrote) {
  const TempFolder folder;
  LockFile lock;
  lock.add("b", summary_of(2));
  lock.add("a", summary_of(1));
  ASSERT_TRUE(write_lock_file(folder / "m.lock", lock));
  const auto read = read_lock_file(folder / "m.lock");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->engine_version, "2");
  ASSERT_EQ(read->meshes.size(), 2u);
  for (const char* name : {"a", "b"}) EXPECT_FALSE(lock.change(name, *read)) << name;
}

TEST(LockFile, TellsWhatChanged) {
  LockFile then;
  then.add("a", summary_of(1));
  LockFile now;
  now.add("a", summary_of(2));
  now.add("b", summary_of(2));
  now.engine_version = "3";
  EXPECT_EQ(then.change("a", now),
            "the mesh has changed: 2 triangles, 1 before; digest 020202020202, 010101010101 "
            "before; engine version 3, 2 before");
  EXPECT_EQ(then.change("b", now), "the mesh is not locked yet");
}

TEST(LockFile, NamesAFileThatIsNone) {
  const TempFolder folder;
  std::ofstream(folder / "m.lock") << "{\"meshes\": 3}";
  const auto read = read_lock_file(folder / "m.lock");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().exit, ExitCode::kUnreadableInput);
  EXPECT_TRUE(
      read.error().message.starts_with((folder / "m.lock").string() + ": not a lock file: "));
}

std::vector<BatchOutcome> three_outcomes() {
  return {{.name = "good", .summary = summary_of(1000), .drawing = "/r/pictures/good.png"},
          {.name = "<b|ad>", .summary = summary_of(2), .failures = {"too \"small\"", "changed"}},
          {.name = "none", .error = Error{ExitCode::kUnreadableInput, "none.poly:\n\x01gone"}}};
}

TEST(BatchReport, CountsErrorsAndFailuresApart) {
  const std::string xml = junit_xml(three_outcomes());
  EXPECT_NE(xml.find("tests=\"3\" failures=\"1\" errors=\"1\""), std::string::npos) << xml;
  EXPECT_NE(xml.find("<failure message=\"too &quot;small&quot;\" />"), std::string::npos) << xml;
  EXPECT_NE(xml.find("name=\"&lt;b|ad>\""), std::string::npos) << xml;
  EXPECT_EQ(xml.find('\x01'), std::string::npos);
}

TEST(BatchReport, ShowsAPageWithPicturesNamedFromWhereItLies) {
  const std::string page = markdown_summary(three_outcomes(), "/r");
  EXPECT_NE(page.find("1 of 3 passed."), std::string::npos) << page;
  EXPECT_NE(page.find("| good | passed | 1,000 | 500 |"), std::string::npos) << page;
  EXPECT_NE(page.find("| \\<b\\|ad> | failed: too \"small\"; changed |"), std::string::npos)
      << page;
  EXPECT_NE(page.find("![good](<pictures/good.png>)"), std::string::npos) << page;
  EXPECT_NE(page.find("| none | error: none.poly: ?gone |"), std::string::npos) << page;
}

}  // namespace
}  // namespace weft::client
