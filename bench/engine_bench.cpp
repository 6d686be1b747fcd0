// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/engine_bench.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "bench/cgal_mesh_2.h"
#include "engine/engine.h"
#include "tests/support/poly.h"

namespace weft::bench {
namespace {

struct Row {
  const char* name;
  const char* model;
  double min_angle_deg;
  SizeSpec size;
  double (*compiled_size)(double, double);  // the same function, for CGAL
};

double unbounded(double, double) {
  return std::numeric_limits<double>::infinity();
}
double pipe(double x, double y) {
  return 0.4 * std::sqrt((x - 200) * (x - 200) + (y - 200) * (y - 200)) + 1;
}
double key(double, double y) {
  return 0.02 * std::fabs(y - 46) + 0.1;
}
double cylinder(double x, double y) {
  return (x >= 0 && std::fabs(y) < 5) || (x < 0 && x * x + y * y < 25) ? 1.2e-3 : 1e-2;
}

std::vector<Row> rows() {
  const SizeSpec pipe_size{.expression = "0.4*sqrt((x-200)^2+(y-200)^2)+1"};
  const SizeSpec key_size{.expression = "0.02*abs(y-46)+0.1"};
  const SizeSpec cylinder_size{.expression =
                                   "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2"};
  return {
      {"pipe", "pipe.poly", 20, pipe_size, pipe},
      {"pipe", "pipe.poly", 30, pipe_size, pipe},
      {"key", "key.poly", 20, key_size, key},
      {"key", "key.poly", 30, key_size, key},
      {"cylinder", "cylinder.poly", 20, cylinder_size, cylinder},
      {"cylinder", "cylinder.poly", 30, cylinder_size, cylinder},
      {"cylinder, 2e-3",
       "cylinder.poly",
       20,
       {.constant = 2e-3},
       [](double, double) { return 2e-3; }},
      {"coast", "us-east-coast.poly", 20, {}, unbounded},
      {"coast", "us-east-coast.poly", 30, {}, unbounded},
      {"coast, 1e-3",
       "us-east-coast.poly",
       20,
       {.constant = 1e-3},
       [](double, double) { return 1e-3; }},
      {"coast, 1e-4",
       "us-east-coast.poly",
       20,
       {.constant = 1e-4},
       [](double, double) { return 1e-4; }},
  };
}

struct Discard : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

}  // namespace

int run_engine_bench(const EngineBenchOptions& options) {
  std::printf(
      "| domain, size | angle | triangles | refine s | Mtri/s | engine s | bytes/tri "
      "| CGAL triangles | CGAL s | ratio |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& row : rows()) {
    if (std::string(row.name).find(options.only) == std::string::npos) continue;
    const MeshRequest request{.pslg = read_poly(options.models + "/" + row.model),
                              .size = row.size,
                              .min_angle_deg = row.min_angle_deg};
    std::vector<double> refine;
    std::vector<double> engine;
    std::vector<double> cgal;
    Summary summary;
    CgalResult theirs;
    // One contender after the other: memory that the other has just given back is slow to touch.
    for (int run = 0; run <= options.runs; ++run) {
      Discard sink;
      ExecutionContext context;
      const auto result = generate_mesh(request, sink, context);
      if (!result) {
        std::fprintf(stderr, "%s: %s\n", row.name, result.error().message.c_str());
        return 1;
      }
      summary = *result;
      if (run == 0) continue;
      refine.push_back(summary.size_seconds + summary.prelude_seconds + summary.refine_seconds);
      engine.push_back(summary.engine_seconds);
    }
    for (int run = 0; options.with_cgal && run <= options.runs; ++run) {
      theirs = refine_with_cgal(request.pslg, row.compiled_size, row.min_angle_deg);
      if (run > 0) cgal.push_back(theirs.seconds);
    }
    const double ours = median(refine);
    const auto triangles = static_cast<double>(summary.triangles);
    std::printf("| %s | %g | %llu | %.4f | %.2f | %.4f | %.1f |", row.name, row.min_angle_deg,
                static_cast<unsigned long long>(summary.triangles), ours, triangles / ours * 1e-6,
                median(engine), static_cast<double>(summary.peak_bytes) / triangles);
    if (options.with_cgal) {
      std::printf(" %llu | %.3f | %.0f |\n", static_cast<unsigned long long>(theirs.triangles),
                  median(cgal), median(cgal) / ours);
    } else {
      std::printf(" | | |\n");
    }
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace weft::bench
