// SPDX-License-Identifier: Apache-2.0
// Subject: the estimate against what runs make and take: never below what the meshes of the
// benchmarks take with a reader that stalls, and not far above.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>
#include <thread>

#include "tests/support/poly.h"
#include "weft/weft.h"

namespace weft {
namespace {

// Of what any run takes, however small its mesh.
constexpr double kFixed = 2e6;

// Takes a chunk in kEvery only when the run has come to rest, so that all fragments that may wait
// do. The peak then hardly depends on how fast the threads are.
class Stalling : public ChunkSink {
 public:
  explicit Stalling(const weft::Run& run) : run_(run) {}
  bool accept(Chunk&& chunk) override {
    if (chunk.index % kEvery == 1) wait_for_rest();
    return true;
  }

 private:
  static constexpr std::uint32_t kEvery = 1024;

  void wait_for_rest() const {
    constexpr std::chrono::milliseconds kRest{300};  // on a busy machine a thread may wait, too
    std::uint64_t before = 0;
    do {
      before = run_.pulse();
      std::this_thread::sleep_for(kRest);
    } while (run_.pulse() != before);
  }

  const Run& run_;
};

Pslg square(double side) {
  return {.points = {{0, 0}, {side, 0}, {side, side}, {0, side}},
          .segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
}

struct Case {
  std::string name;
  std::string model;  // empty: a square of side 100
  std::string size;   // empty: none
  double angle = 20;
  bool on_lattice = true;
  bool raster = false;
  bool region = false;
  std::uint32_t rows = 0;  // of layers along all of the square

  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

Raster waves() {
  constexpr int kNodes = 64;
  constexpr double kStep = 100.0 / (kNodes - 1);
  Raster raster{.dx = kStep, .dy = kStep, .columns = kNodes, .rows = kNodes};
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i)
      raster.values.push_back(0.01 * (1.5 + std::sin(i * kStep / 9) * std::cos(j * kStep / 11)));
  return raster;
}

MeshRequest request_of(const Case& c) {
  MeshRequest request;
  request.pslg = c.model.empty() ? square(100) : read_poly(model(c.model + ".poly"));
  if (c.raster) request.size = waves();
  if (!c.size.empty()) request.size = c.size;
  if (c.region) request.pslg.regions.push_back({.at = {50, 50}, .max_area = 0.01});
  if (c.rows > 0) request.layers = {{.marker = 0, .first = 1e-4, .ratio = 1, .rows = c.rows}};
  request.min_angle_deg = c.angle;
  if (!c.on_lattice) request.placement = Placement::kCircumcentre;
  return request;
}

class EstimateLaw : public ::testing::TestWithParam<Case> {};

TEST_P(EstimateLaw, IsNotBelowThePeakNorFarAbove) {
  const MeshRequest request = request_of(GetParam());
  const Estimate expected = estimate(request);
  const auto bytes = static_cast<double>(expected.bytes);
  ThreadPool pool(2);
  weft::Run run;
  run.set_threads(pool);
  Stalling sink(run);
  const auto summary = stream(request, sink, run);
  ASSERT_TRUE(summary) << summary.error().message;
  const auto peak = static_cast<double>(summary->peak_bytes);
  RecordProperty("triangles", std::to_string(summary->triangles));
  RecordProperty("estimate_over_peak", std::to_string(bytes / peak));
  EXPECT_GE(bytes, peak) << summary->triangles << " triangles";
  EXPECT_LE(bytes, 2 * peak + kFixed) << summary->triangles << " triangles";
  EXPECT_GE(expected.triangles, summary->triangles);
  EXPECT_LE(static_cast<double>(expected.triangles), 2.5 * static_cast<double>(summary->triangles));
}

const std::string kPipe = "(0.4*sqrt((x-200)^2+(y-200)^2)+1)";
const std::string kWake = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? ";

INSTANTIATE_TEST_SUITE_P(
    Benchmarks, EstimateLaw,
    ::testing::Values(
        Case{"pipe", "pipe", kPipe}, Case{"pipe30", "pipe", kPipe, 30},
        Case{"key", "key", "0.02*abs(y-46)+0.1"}, Case{"key30", "key", "0.02*abs(y-46)+0.1", 30},
        Case{"pipe1M", "pipe", kPipe + "/300"}, Case{"pipe1M30", "pipe", kPipe + "/300", 30},
        Case{"pipe10M", "pipe", kPipe + "/3000"},
        Case{"cylinder1M", "cylinder", kWake + "0.0012 : 0.01"},
        Case{"cylinder1M30", "cylinder", kWake + "0.0012 : 0.01", 30},
        Case{"cylinder1M33", "cylinder", kWake + "0.0012 : 0.01", 33},
        Case{"cylinder10M", "cylinder", kWake + "0.00012 : 0.001"},
        Case{"cylinder10M30", "cylinder", kWake + "0.00012 : 0.001", 30},
        Case{"cylinderEven1M", "cylinder", "4e-3"},
        Case{"cylinderEven1MCircumcentres", "cylinder", "4e-3", 20, false},
        Case{"cylinderEven10M", "cylinder", "4e-4"}, Case{"coast", "us-east-coast", ""},
        Case{"coast30", "us-east-coast", "", 30}, Case{"coast1e3", "us-east-coast", "1e-3"},
        Case{"coast1e4", "us-east-coast", "1e-4"},
        Case{"coast1e4at30", "us-east-coast", "1e-4", 30},
        Case{"hollow", "", "0.002+0.05*(1-exp(-((x-50)^2+(y-40)^2)/400))"},
        Case{"longWaves", "", "0.01*(1.5+sin(x/5)*cos(y/7))"},
        Case{"slope", "", "0.001+0.0005*x+0.0002*y"},
        Case{"twoPoints", "", "0.001+0.01*min(hypot(x-20,y-30),hypot(x-70,y-60))"},
        Case{"ring", "", "0.002+0.01*abs(hypot(x-50,y-50)-30)"},
        Case{"shortWaves", "", "0.01*(1.2+sin(3*x)*sin(3*y))"},
        Case{.name = "raster", .model = "", .size = "", .raster = true},
        Case{.name = "region", .model = "", .size = "", .region = true},
        Case{.name = "layers", .model = "", .size = "1", .rows = 200},
        Case{.name = "layersFine", .model = "", .size = "1e-4+1e-3*y", .rows = 100},
        Case{.name = "layersFew", .model = "", .size = "0.01", .rows = 8}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace weft
