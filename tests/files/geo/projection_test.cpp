// SPDX-License-Identifier: Apache-2.0
#include "files/geo/projection.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::files {
namespace {

class Projections : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Projection::available()) GTEST_SKIP() << "built without PROJ";
  }
  static std::string refusal(const std::string& name) {
    const auto made = Projection::make(name);
    EXPECT_FALSE(made) << name;
    if (made) return "";
    EXPECT_EQ(made.error().exit, ExitCode::kUsage);
    return made.error().message;
  }
};

TEST_F(Projections, HaveLongitudeFirstAndMetresEastAndNorth) {
  // The figures are of another implementation: the US Army's formulas for UTM, to a centimetre.
  const auto utm = Projection::make("EPSG:32618");
  ASSERT_TRUE(utm) << utm.error().message;
  const Point at = utm->forward({-75, 0});
  EXPECT_NEAR(at.x, 500'000, 1e-6);
  EXPECT_NEAR(at.y, 0, 1e-6);
  // A degree of the meridian at the equator is 110,574 m, less UTM's 0.04 %.
  EXPECT_NEAR(utm->forward({-75, 1}).y, 110'574.3886 * 0.9996, 0.01);
  const Point back = utm->inverse(utm->forward({-74, 40.6}));
  EXPECT_NEAR(back.x, -74, 1e-12);
  EXPECT_NEAR(back.y, 40.6, 1e-12);
}

TEST_F(Projections, TellWhatTheyDoToLengthsAndAngles) {
  const auto utm = Projection::make("EPSG:32618").value().distortion_at({-75, 40});
  EXPECT_NEAR(utm.least_scale, 0.9996, 1e-7);
  EXPECT_NEAR(utm.greatest_scale, 0.9996, 1e-7);
  EXPECT_NEAR(utm.angle_deg, 0, 1e-4);
  // Plate carrée at 60 degrees: twice as long to the east as on the ground.
  const auto plate = Projection::make("+proj=eqc +R=6371000").value().distortion_at({10, 60});
  EXPECT_NEAR(plate.least_scale, 1, 1e-6);
  EXPECT_NEAR(plate.greatest_scale, 2, 1e-6);
  EXPECT_NEAR(plate.angle_deg, 2 * std::asin(1 / 3.0) * 180 / M_PI, 1e-4);
}

TEST_F(Projections, AreRefusedWithTheNameAndTheReason) {
  EXPECT_EQ(refusal("EPSG:1"), "'EPSG:1' is not a projection that PROJ knows");
  EXPECT_EQ(refusal("?"), "'?' is not a projection that PROJ knows");
  EXPECT_EQ(refusal(""), "'' is not a projection that PROJ knows");
  EXPECT_EQ(refusal("EPSG:4326"),
            "'EPSG:4326' is not a projected coordinate reference system, such as EPSG:32618");
  EXPECT_EQ(refusal("EPSG:2263"),
            "'EPSG:2263' is in units of the US survey foot, but sizes and lengths are in metres: "
            "name a projection in metres");
}

TEST(ProjectionsWithoutProj, AreRefused) {
  if (Projection::available()) GTEST_SKIP() << "built with PROJ";
  EXPECT_EQ(Projection::make("EPSG:32618").error().message,
            "'EPSG:32618' needs PROJ, and this weft was built without PROJ");
}

}  // namespace
}  // namespace weft::files
