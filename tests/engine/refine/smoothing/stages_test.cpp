// SPDX-License-Identifier: Apache-2.0
// What refinement in stages saves, and where it changes nothing. The checker judges every mesh.
#include "engine/refine/smoothing/stages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/sound.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

Summary meshed(MeshRequest request, std::uint32_t sweeps) {
  request.sweeps = sweeps;
  return sound(request).summary;
}

const MeshRequest kRing{.pslg = square(20), .size = "0.002+0.05*abs(hypot(x-10,y-10)-6)"};
const MeshRequest kWaves{.pslg = square(20), .size = "0.03*(1.2+sin(3*x)*sin(3*y))"};

TEST(Stages, MakeFewerAndBetterTrianglesWhereNoLatticeFollowsTheSize) {
  for (MeshRequest request : {kRing, kWaves}) {
    for (const double angle : {0.0, 20.0, 25.0, 30.0}) {
      SCOPED_TRACE(angle);
      request.min_angle_deg = angle;
      const Summary at_once = meshed(request, 0), in_stages = meshed(request, 2);
      EXPECT_LE(in_stages.ideal_ratio, 0.93 * at_once.ideal_ratio);
      EXPECT_GE(in_stages.mean_quality, 0.01 + at_once.mean_quality);
      EXPECT_GE(in_stages.min_angle_p1_deg, 5 + at_once.min_angle_p1_deg);
    }
  }
}

TEST(Stages, AskForLargeAnglesInTheLastOne) {
  MeshRequest request = kWaves;
  const double at_20 = meshed(request, 2).ideal_ratio;
  request.min_angle_deg = 30;
  EXPECT_LE(meshed(request, 2).ideal_ratio, 1.05 * at_20);
}

TEST(Stages, ServeBoundsWithoutALatticeToo) {
  const MeshRequest request{.pslg = square(20), .size = 0.02, .min_angle_deg = 33};
  EXPECT_LE(meshed(request, 2).ideal_ratio, 0.9 * meshed(request, 0).ideal_ratio);
}

TEST(Stages, ChangeNothingWhereALatticeFollowsTheSize) {
  const MeshRequest even{.pslg = read_poly(model("key.poly")), .size = 0.3};
  const MeshRequest exponential{.pslg = square(20), .size = "0.002*exp(0.2*x)"};
  for (const MeshRequest& request : {even, exponential})
    EXPECT_EQ(meshed(request, 0).triangles, meshed(request, 2).triangles);
}

// A hundred times finer in a wavy band that is thinner than the triangles around it.
TEST(Stages, DoNotMissThinPlacesThatAreFiner) {
  for (const double shift : {0.0, 0.3, 0.6, 0.9, 1.2, 1.5}) {
    SCOPED_TRACE(shift);
    MeshRequest request{.pslg = square(4),
                        .size = "abs(y-1-0.3*sin(4*x+" + std::to_string(shift) +
                                ")) < 0.1 ? 1e-3 : 0.1*(1.2+sin(3*x)*sin(3*y))"};
    const auto in_band = [&](std::uint32_t sweeps) {
      request.sweeps = sweeps;
      const Sound made = sound(request);
      double count = 0;
      for (const auto& t : made.mesh.mesh.triangles) {
        double x = 0, y = 0;
        for (const std::uint32_t v : t) {
          x += made.mesh.mesh.vertices[v].x / 3;
          y += made.mesh.mesh.vertices[v].y / 3;
        }
        count += std::fabs(y - 1 - 0.3 * std::sin(4 * x + shift)) < 0.1;
      }
      return count;
    };
    EXPECT_GE(in_band(2), 0.85 * in_band(0));
  }
}

}  // namespace
}  // namespace weft
