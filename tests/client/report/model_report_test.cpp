// SPDX-License-Identifier: Apache-2.0
#include "client/report/model_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace weft::client {
namespace {

using check::Model;
using check::ModelRule;

// A square of two triangles, of which each has two edges on land; its lower edge is open.
check::ModelReport square(std::vector<double> depths = {}) {
  check::Mesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}};
  mesh.edges = {{0, 1, 1}};
  const std::int32_t open = 1;
  return check::judge_for_models({.mesh = mesh, .open_markers = {&open, 1}, .depths = depths});
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ModelReport, NamesFaultsAndTheirPlaces) {
  const check::ModelReport report = square();
  const ModelView view{Model::kAdcirc, report, true};
  EXPECT_FALSE(view.holds());
  const std::string text = model_text(view);
  EXPECT_TRUE(has(text, "every vertex has a triangle: holds\n")) << text;
  EXPECT_TRUE(has(text, "two edges at least: fails, 1 time\n  at (0.5, 0)\n")) << text;
  EXPECT_TRUE(text.ends_with("the mesh fails for ADCIRC\n")) << text;
}

TEST(ModelReport, HoldsWithAdvice) {
  const check::ModelReport report = square();
  const ModelView view{Model::kTelemac, report, true};
  EXPECT_TRUE(view.holds());
  const std::string text = model_text(view);
  EXPECT_TRUE(has(text, "no triangle has two edges on land: advice, missed 1 time\n")) << text;
  EXPECT_TRUE(text.ends_with("the mesh holds for TELEMAC-2D\n")) << text;
}

TEST(ModelReport, JudgesOpenBoundariesOnlyIfSomeAreKnown) {
  const check::ModelReport report = square();
  const std::string text = model_text({Model::kAdcirc, report});
  EXPECT_FALSE(has(text, "two edges at least")) << text;
  EXPECT_TRUE(has(text, "open boundaries are not judged: no --open-boundary is given\n")) << text;
  EXPECT_FALSE(has(model_text({Model::kDelft3d, report}), "open")) << text;
}

TEST(ModelReport, EndsWithTheTimeStep) {
  check::ModelReport report = square({9.81, 0, 0, 0});
  EXPECT_TRUE(has(model_text({Model::kSchism, report, true, true}),
                  "time step at most 0.1019 s at a Courant number of 1: an edge of 1 m at "));
  report = square();
  EXPECT_TRUE(has(model_text({Model::kSchism, report, true}), "the mesh has no depths"));
}

TEST(ModelReport, HasTheSameInJson) {
  const check::ModelReport report = square({4, 4, 4, 4});
  const Json json = model_json({Model::kAdcirc, report, true, true});
  EXPECT_EQ(json["model"], "adcirc");
  EXPECT_FALSE(json["holds"]);
  EXPECT_EQ(json["rules"]["short-open"],
            (Json{{"grade", "fault"}, {"judged", true}, {"violations", 1}}));
  EXPECT_FALSE(json["rules"].contains("orthogonality"));
  EXPECT_EQ(json["violations"][0]["rule"], "short-open");
  EXPECT_NEAR(json["time_step"]["seconds"], 1 / std::sqrt(9.81 * 4), 1e-12);
}

TEST(ModelReport, SaysThatAMeshIsNone) {
  check::Mesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {0, 1}, {0, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const check::ModelReport report = check::judge_for_models({.mesh = mesh});
  const std::string text = model_text({Model::kDelft3d, report});
  EXPECT_TRUE(has(text, "one on each side: fails, 1 time\nnothing else is judged")) << text;
  EXPECT_FALSE(has(text, "link")) << text;
}

}  // namespace
}  // namespace weft::client
