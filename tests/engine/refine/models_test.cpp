// SPDX-License-Identifier: Apache-2.0
// The models of tests/models with their grading functions, each judged by the independent checker.
#include <gtest/gtest.h>

#include "tests/support/collected_mesh.h"
#include "tests/support/poly.h"
#include "weft/weft.h"

namespace weft {
namespace {

constexpr const char* kPipeSize = "0.4*sqrt((x-200)^2+(y-200)^2)+1";
constexpr const char* kKeySize = "0.02*abs(y-46)+0.1";
constexpr const char* kCylinderSize = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2";

struct Case {
  const char* name;
  const char* model;
  SizeSpec size;
  double min_angle_deg;
  std::uint64_t most_triangles;  // Triangle's count and a little more
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Models : public testing::TestWithParam<Case> {};

TEST_P(Models, AreMeshedWithinBounds) {
  const Case& c = GetParam();
  MeshRequest request{
      .pslg = read_poly(model(c.model)), .size = c.size, .min_angle_deg = c.min_angle_deg};
  CollectedMesh mesh;
  weft::Run run;
  const auto summary = stream(request, mesh, run);
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(verdict(request, mesh, *summary), "");
  EXPECT_LE(summary->triangles, c.most_triangles);
  EXPECT_EQ(summary->unrefined.edge_floor, 0u);
  EXPECT_EQ(summary->unrefined.budget, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    OfThePaper, Models,
    testing::Values(Case{"Pipe", "pipe.poly", kPipeSize, 20, 3'750},
                    Case{"Key", "key.poly", kKeySize, 20, 7'200},
                    Case{"Cylinder", "cylinder.poly", kCylinderSize, 20, 970'000},
                    Case{"Coast20", "us-east-coast.poly", {}, 20, 20'000},
                    Case{"Coast30", "us-east-coast.poly", {}, 30, 40'000},
                    Case{"CoastFine", "us-east-coast.poly", 1e-3, 20, 500'000}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace weft
