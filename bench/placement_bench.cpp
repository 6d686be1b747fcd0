// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/placement_bench.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/models.h"
#include "tests/support/poly.h"

namespace weft::bench {
namespace {

struct Row {
  std::string name;
  MeshRequest request;
};

Pslg square(double side) {
  Pslg pslg;
  pslg.points = {{0, 0}, {side, 0}, {side, side}, {0, side}};
  for (std::uint32_t i = 0; i < 4; ++i) pslg.segments.push_back({i, (i + 1) % 4, 0});
  return pslg;
}

// 0.01 (1.5 + sin(x / 9) cos(y / 11)) on the nodes of a grid over the square of 100.
Raster waves_on_a_grid(std::uint32_t nodes) {
  const double step = 100.0 / (nodes - 1);
  Raster raster{{0, 0}, step, step, nodes, nodes, {}};
  for (std::uint32_t j = 0; j < nodes; ++j) {
    for (std::uint32_t i = 0; i < nodes; ++i)
      raster.values.push_back(0.01 * (1.5 + std::sin(i * step / 9) * std::cos(j * step / 11)));
  }
  return raster;
}

std::vector<Row> rows(const std::string& models) {
  const auto of_model = [&](const char* model) { return read_poly(models + "/" + model); };
  const auto sized = [](Pslg pslg, const std::string& size, double angle) {
    return MeshRequest{.pslg = std::move(pslg), .size = size, .min_angle_deg = angle};
  };
  const std::string pipe = "(0.4*sqrt((x-200)^2+(y-200)^2)+1)/";
  std::vector<Row> rows;
  for (const double angle : {20.0, 30.0}) {
    rows.push_back(
        {"cylinder, stepped", sized(of_model("cylinder.poly"), cylinder_size(1e6), angle)});
    rows.push_back({"pipe, smooth", sized(of_model("pipe.poly"), pipe + "300", angle)});
    rows.push_back({"coast, 1e-3", sized(of_model("us-east-coast.poly"), "1e-3", angle)});
    rows.push_back({"coast, 1e-4", sized(of_model("us-east-coast.poly"), "1e-4", angle)});
  }
  // Edges in degrees, the model's unit: 1 km and 4 km at the shore, 20 km far away.
  for (const auto& [name, edge] :
       {std::pair<const char*, std::string>{"coast, graded from 0.01", "min(0.01+0.15*shore, 0.2)"},
        {"coast, graded from 0.04", "min(0.04+0.15*shore, 0.2)"}}) {
    SizeSpec size{edge};
    size.measure = Measure::kEdge;
    size.fields.push_back({"shore", DistanceSpec{}});
    rows.push_back({name, {.pslg = of_model("us-east-coast.poly"), .size = size}});
  }
  rows.push_back({"key", sized(of_model("key.poly"), "0.02*abs(y-46)+0.1", 20)});
  rows.push_back(
      {"cylinder, stepped, 10 M", sized(of_model("cylinder.poly"), cylinder_size(1e7), 20)});
  rows.push_back({"pipe, smooth, 10 M", sized(of_model("pipe.poly"), pipe + "3000", 20)});
  const auto on_square = [&](const char* name, const char* size) {
    rows.push_back({name, sized(square(100), size, 20)});
  };
  on_square("hollow", "0.002+0.05*(1-exp(-((x-50)^2+(y-40)^2)/400))");
  on_square("long waves", "0.01*(1.5+sin(x/5)*cos(y/7))");
  on_square("slope", "0.001+0.0005*x+0.0002*y");
  on_square("two points", "0.001+0.01*min(hypot(x-20,y-30),hypot(x-70,y-60))");
  rows.push_back({"raster", {.pslg = square(100), .size = waves_on_a_grid(64)}});
  on_square("ring", "0.002+0.01*abs(hypot(x-50,y-50)-30)");
  on_square("short waves", "0.01*(1.2+sin(3*x)*sin(3*y))");
  return rows;
}

struct Figures {
  std::vector<double> seconds;
  Summary summary;
};

bool run(const MeshRequest& request, ThreadPool& pool, bool counts, Figures& figures) {
  Discard sink;
  Run mesh_run;
  mesh_run.set_threads(pool);
  const auto result = stream(request, sink, mesh_run);
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    return false;
  }
  figures.summary = *result;
  if (counts) figures.seconds.push_back(result->engine_seconds);
  return true;
}

}  // namespace

int run_placement_bench(const PlacementBenchOptions& options) {
  std::printf(
      "| domain, size | angle | threads | triangles | over the least | quality | 1st percentile "
      "| engine s | on a lattice | circumcentres: triangles | over the least | quality "
      "| 1st percentile | engine s | time |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (Row& row : rows(options.models)) {
    if (row.name.find(options.only) == std::string::npos) continue;
    for (const int threads : options.threads) {
      ThreadPool pool(threads);
      std::array<Figures, 2> of;
      std::vector<double> ratios;
      for (int i = 0; i <= options.runs; ++i) {
        for (const Placement placement : {Placement::kLattice, Placement::kCircumcentre}) {
          row.request.placement = placement;
          if (!run(row.request, pool, i > 0, of[placement == Placement::kLattice ? 0 : 1]))
            return 1;
        }
        if (i > 0) ratios.push_back(of[0].seconds.back() / of[1].seconds.back());
      }
      std::printf("| %s | %g | %d ", row.name.c_str(), row.request.min_angle_deg, threads);
      for (const Figures& f : of) {
        std::printf("| %llu | %.3f | %.3f | %.1f | %.4f ",
                    static_cast<unsigned long long>(f.summary.triangles), f.summary.ideal_ratio,
                    f.summary.mean_quality, f.summary.min_angle_p1_deg, median(f.seconds));
        if (&f == &of[0]) std::printf("| %.3f ", f.summary.lattice_share);
      }
      std::printf("| %.2f |\n", median(ratios));
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace weft::bench
