// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_quality.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <numeric>

#include "client/report/quality_report.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

// An equilateral triangle of side 2, the right-angled one with legs 1, and a degenerate one.
Mesh three_triangles() {
  Mesh mesh;
  mesh.coordinates = {0, 0, 2, 0, 1, std::sqrt(3), 10, 0, 11, 0, 10, 1, 20, 0, 21, 0, 22, 0};
  mesh.triangles = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  mesh.regions = {0, 0, 0};
  return mesh;
}

std::uint64_t sum(const Histogram& histogram) {
  return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t{0});
}

TEST(Histogram, CountsFromABoundToBelowTheNext) {
  Histogram histogram({0, 1, 2});
  for (const double value : {-5.0, 0.0, 1.0, 1.5, 2.0, 9.0}) histogram.add(value);
  EXPECT_EQ(histogram.counts, (std::vector<std::uint64_t>{2, 4}));
}

TEST(MeshQuality, MeasuresAnglesAndAspects) {
  const MeshQuality quality = measure_quality(three_triangles().view(), {});
  EXPECT_EQ(quality.figures.triangles, 3u);
  EXPECT_NEAR(quality.figures.area, std::sqrt(3) + 0.5, 1e-12);
  EXPECT_EQ(quality.figures.min_angle_deg, 0);
  EXPECT_EQ(quality.figures.max_angle_deg, 180);
  EXPECT_EQ(quality.figures.ideal_ratio, 0);
  EXPECT_EQ(sum(quality.min_angles), 3u);
  EXPECT_EQ(sum(quality.angles), 9u);
  EXPECT_FALSE(quality.areas_over_bound);
  ASSERT_EQ(quality.worst_by_angle.size(), 3u);
  EXPECT_EQ(quality.worst_by_angle[0].triangle, 2u);
  EXPECT_TRUE(std::isinf(quality.worst_by_angle[0].aspect));
  // Circumradius sqrt(2)/2, inradius 1 - sqrt(2)/2.
  EXPECT_EQ(quality.worst_by_angle[1].triangle, 1u);
  EXPECT_NEAR(quality.worst_by_angle[1].aspect, std::sqrt(0.5) / 2 / (1 - std::sqrt(0.5)), 1e-12);
  EXPECT_NEAR(quality.worst_by_angle[1].at.x, 31.0 / 3, 1e-12);
  EXPECT_NEAR(quality.worst_by_angle[2].aspect, 1, 1e-12);
}

TEST(MeshQuality, MeasuresAreasOverTheirBounds) {
  // Triangles beyond x = 15 have no bound.
  const MakeAreaBound bound = [] {
    return [](Point p) { return p.x > 15 ? 0 : p.x > 5 ? 0.25 : 2; };
  };
  const MeshQuality quality = measure_quality(three_triangles().view(), bound);
  ASSERT_TRUE(quality.areas_over_bound);
  EXPECT_EQ(sum(*quality.areas_over_bound), 2u);
  ASSERT_EQ(quality.worst_by_area.size(), 2u);
  EXPECT_EQ(quality.worst_by_area[0].triangle, 1u);
  EXPECT_EQ(quality.worst_by_area[0].area_over_bound, 2);
  EXPECT_NEAR(quality.figures.ideal_ratio, 2 / (2 + std::sqrt(3) / 2), 1e-12);
}

TEST(MeshQuality, IsTheSameInManyBlocks) {
  // 2 * 600^2 triangles, all alike, are several blocks.
  const MeshQuality quality = measure_quality(square_mesh(600).view(), {});
  EXPECT_EQ(quality.figures.triangles, 720'000u);
  EXPECT_EQ(quality.figures.area, 360'000);
  EXPECT_EQ(sum(quality.aspects), 720'000u);
  ASSERT_EQ(quality.worst_by_angle.size(), MeshQuality::kWorst);
  for (std::size_t i = 0; i < MeshQuality::kWorst; ++i)
    EXPECT_EQ(quality.worst_by_angle[i].triangle, i);
}

TEST(MeshQuality, OfNothingIsNothing) {
  const MeshQuality quality = measure_quality(Mesh().view(), {});
  EXPECT_EQ(quality.figures.triangles, 0u);
  EXPECT_NE(quality_text(quality, true).find("  none\n"), std::string::npos);
}

TEST(QualityReport, DrawsBarsInUnicodeOrAscii) {
  const MeshQuality quality = measure_quality(three_triangles().view(), {});
  const std::string unicode = quality_text(quality, true);
  EXPECT_NE(unicode.find("█"), std::string::npos) << unicode;
  const std::string ascii = quality_text(quality, false);
  EXPECT_NE(ascii.find("#"), std::string::npos) << ascii;
  for (const char c : ascii) ASSERT_LT(static_cast<unsigned char>(c), 128);
  EXPECT_NE(ascii.find("\n  triangle 2 at (21, 0): 0 degrees, aspect inf\n"), std::string::npos)
      << ascii;
}

TEST(QualityReport, HasTheFiguresOfMeshForPrograms) {
  const Json json = quality_json(measure_quality(three_triangles().view(), {}));
  const Json figures = figures_json({});
  EXPECT_EQ(figures.size(), 9u);
  for (const auto& [key, value] : figures.items()) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["histograms"]["min_angle_deg"]["counts"].size() + 1,
            json["histograms"]["min_angle_deg"]["bounds"].size());
  EXPECT_FALSE(json["histograms"].contains("area_over_bound"));
  EXPECT_EQ(json["worst"]["by_angle"][0]["triangle"], 2);
}

TEST(Locale, IsThatOfTheStrongestVariable) {
  ::setenv("LANG", "en_GB.UTF-8", 1);
  ::unsetenv("LC_CTYPE");
  ::unsetenv("LC_ALL");
  EXPECT_TRUE(locale_is_utf8());
  ::setenv("LC_ALL", "C", 1);
  EXPECT_FALSE(locale_is_utf8());
  ::setenv("LC_ALL", "", 1);
  ::setenv("LC_CTYPE", "C.utf8", 1);
  EXPECT_TRUE(locale_is_utf8());
}

}  // namespace
}  // namespace weft::client
