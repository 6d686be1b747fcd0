// SPDX-License-Identifier: Apache-2.0
#include "client/report/check_report.h"

#include <gtest/gtest.h>

namespace weft::client {
namespace {

// A unit square of two triangles, right-angled.
check::Domain square_domain() {
  check::Domain domain;
  domain.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  domain.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  return domain;
}

check::Mesh checked_mesh() {
  check::Mesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  return mesh;
}

struct Checked {
  check::Requirements requirements;
  check::Report report;
};

Checked checked(double min_angle_deg, const char* size, std::uint64_t allowed = 0) {
  Checked out;
  out.requirements.min_angle_deg = min_angle_deg;
  out.requirements.size = std::string(size);
  out.requirements.allowed_unrefined = allowed;
  out.report = check::check(square_domain(), checked_mesh(), out.requirements);
  return out;
}

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(CheckReport, HasASentenceAboutEachProperty) {
  const auto [requirements, report] = checked(20, "0.7");
  EXPECT_EQ(check_text(report, requirements),
            "2 triangles, 4 vertices, 4 edges on segments, area 1\n"
            "the domain is well formed: holds\n"
            "the size is positive and finite at every centroid: holds\n"
            "corners, regions and coordinates are valid: holds\n"
            "triangles are counter-clockwise: holds\n"
            "an edge has at most two triangles, one on each side: holds\n"
            "triangles do not overlap: holds\n"
            "the edges listed are those on segments: holds\n"
            "segments are chains of edges: holds\n"
            "points of the domain are vertices: holds\n"
            "edges carry the markers of their segments: holds\n"
            "the triangles cover the domain and nothing else: holds\n"
            "triangles carry the regions that they lie in: holds\n"
            "the triangulation is Delaunay, but for the edges on segments: holds\n"
            "angles at least 45 degrees, 20 required: holds\n"
            "area at most 0.7143 of its bound: holds\n"
            "the mesh holds\n");
}

TEST(CheckReport, NamesTheWorstTriangleOfWhatFails) {
  const auto [requirements, report] = checked(46, "x < 0.5 ? 0.3 : 0.25");
  const std::string text = check_text(report, requirements);
  EXPECT_TRUE(
      has_line(text,
               "angles at least 45 degrees, 46 required: fails, 2 times; the worst is triangle "
               "0 at (0.666667, 0.333333)"))
      << text;
  EXPECT_TRUE(has_line(text,
                       "area at most 2 of its bound: fails, 2 times; the worst is triangle 0 at "
                       "(0.666667, 0.333333)"))
      << text;
  EXPECT_NE(text.find("\n  triangle 1 (0, 2, 3) at (0, 0), (1, 1), (0, 1) has the area 0.5, the "),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("the mesh fails\n"));
}

TEST(CheckReport, RoundsNoFailureToItsBound) {
  const auto [requirements, report] = checked(45.000004, "0.499999");
  const std::string text = check_text(report, requirements);
  EXPECT_NE(text.find("angles at least 45 degrees, 45.000004 required: fails"), std::string::npos)
      << text;
  EXPECT_NE(text.find("area at most 1.000002 of its bound: fails"), std::string::npos) << text;
}

TEST(CheckReport, SaysWhatMayMissABound) {
  const auto [requirements, report] = checked(20, "0.25", 7);
  const std::string text = check_text(report, requirements);
  EXPECT_TRUE(
      has_line(text,
               "2 triangles miss a bound; at most 7 may. The first is triangle 0 at (0.666667, "
               "0.333333)"))
      << text;
  EXPECT_TRUE(has_line(text, "area at most 2 of its bound: missed, as allowed")) << text;
  EXPECT_TRUE(text.ends_with("the mesh holds\n"));
}

TEST(CheckReport, SaysWhatWasNotJudged) {
  check::Mesh mesh = checked_mesh();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const check::Requirements requirements;
  const std::string text =
      check_text(check::check(square_domain(), mesh, requirements), requirements);
  EXPECT_NE(text.find("\ntriangles are counter-clockwise: fails, 1 time\n  triangle 0 "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("\nnot judged, because other rules fail: conformity, overlap, "),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("degrees"), std::string::npos) << text;
}

TEST(CheckReport, SaysOfLengthsOnlyIfTheyAreAsked) {
  check::Requirements requirements;
  requirements.size.at = {{0, 0.5}};
  const std::string text =
      check_text(check::check(square_domain(), checked_mesh(), requirements), requirements);
  EXPECT_NE(
      text.find("\nedges are at most as long as the sizes at their markers: fails, 4 times\n"),
      std::string::npos)
      << text;
  const auto [others, report] = checked(20, "0.7");
  EXPECT_EQ(check_text(report, others).find("as long as"), std::string::npos);
}

TEST(CheckReport, TakesRoundingForNoMiss) {
  const auto [requirements, report] = checked(45 + 5e-8, "0.49999999975");
  const std::string text = check_text(report, requirements);
  EXPECT_TRUE(has_line(text, "angles at least 45 degrees, 45.00000005 required: holds")) << text;
  EXPECT_TRUE(has_line(text, "area at most 1 of its bound: holds")) << text;
}

TEST(CheckReport, GivesProgramsExactFigures) {
  const auto [requirements, report] = checked(20, "0.7");
  const Json json = check_json(report, requirements);
  EXPECT_EQ(json["holds"], true);
  EXPECT_EQ(json["area_over_bound"]["ratio"], 0.5 / 0.7);
  EXPECT_EQ(json["area_over_bound"]["triangle"], 0);
  EXPECT_EQ(json["angle"]["bound_deg"], 20);
  EXPECT_EQ(json["angle"]["deg"], report.facts.min_angle_deg);
  EXPECT_EQ(json["rules"].size(), check::kRules);
  EXPECT_EQ(json["rules"]["area"], (Json{{"judged", true}, {"violations", 0}}));
  EXPECT_EQ(json["violations"], Json::array());
}

}  // namespace
}  // namespace weft::client
