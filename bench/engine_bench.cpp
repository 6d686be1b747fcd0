// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/engine_bench.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bench/cgal_mesh_2.h"
#include "bench/models.h"
#include "tests/support/poly.h"

namespace weft::bench {
namespace {

// How often CGAL runs on a row: it takes 5 s for 1 M triangles.
enum class Cgal { kNever, kOnce, kMedian };

struct Row {
  const char* name;
  const char* model;
  double min_angle_deg;
  SizeSpec size;
  std::function<double(double, double)> compiled_size;  // the same function, for CGAL
  Cgal cgal;
};

double unbounded(double, double) {
  return std::numeric_limits<double>::infinity();
}
double key(double, double y) {
  return 0.02 * std::fabs(y - 46) + 0.1;
}

Row pipe(const char* name, double angle, double scale, Cgal cgal) {
  return {name,
          "pipe.poly",
          angle,
          "(0.4*sqrt((x-200)^2+(y-200)^2)+1)/" + shortest_text(scale),
          [scale](double x, double y) {
            return (0.4 * std::sqrt((x - 200) * (x - 200) + (y - 200) * (y - 200)) + 1) / scale;
          },
          cgal};
}
Row cylinder(const char* name, double angle, double triangles, Cgal cgal) {
  return {name,
          "cylinder.poly",
          angle,
          cylinder_size(triangles),
          [triangles](double x, double y) {
            const bool fine = (x >= 0 && std::fabs(y) < 5) || (x < 0 && x * x + y * y < 25);
            return fine ? 1200 / triangles : 1e4 / triangles;
          },
          cgal};
}
Row constant(const char* name, const char* model, double angle, double size, Cgal cgal) {
  return {name, model, angle, size, [size](double, double) { return size; }, cgal};
}

std::vector<Row> rows() {
  const SizeSpec key_size = "0.02*abs(y-46)+0.1";
  return {
      pipe("pipe", 20, 1, Cgal::kMedian),
      pipe("pipe", 30, 1, Cgal::kMedian),
      {"key", "key.poly", 20, key_size, key, Cgal::kMedian},
      {"key", "key.poly", 30, key_size, key, Cgal::kMedian},
      pipe("pipe, smooth, 1 M", 20, 300, Cgal::kOnce),
      pipe("pipe, smooth, 1 M", 30, 300, Cgal::kOnce),
      pipe("pipe, smooth, 10 M", 20, 3000, Cgal::kOnce),
      pipe("pipe, smooth, 10 M", 30, 3000, Cgal::kNever),
      cylinder("cylinder, stepped, 1 M", 20, 1e6, Cgal::kOnce),
      cylinder("cylinder, stepped, 1 M", 30, 1e6, Cgal::kOnce),
      cylinder("cylinder, stepped, 10 M", 20, 1e7, Cgal::kOnce),
      cylinder("cylinder, stepped, 10 M", 30, 1e7, Cgal::kNever),
      constant("cylinder, constant, 1 M", "cylinder.poly", 20, 4e-3, Cgal::kOnce),
      constant("cylinder, constant, 1 M", "cylinder.poly", 30, 4e-3, Cgal::kOnce),
      constant("cylinder, constant, 10 M", "cylinder.poly", 20, 4e-4, Cgal::kOnce),
      constant("cylinder, constant, 10 M", "cylinder.poly", 30, 4e-4, Cgal::kNever),
      {"coast", "us-east-coast.poly", 20, {}, unbounded, Cgal::kMedian},
      {"coast", "us-east-coast.poly", 30, {}, unbounded, Cgal::kMedian},
      constant("coast, 1e-3", "us-east-coast.poly", 20, 1e-3, Cgal::kOnce),
      constant("coast, 1e-4", "us-east-coast.poly", 20, 1e-4, Cgal::kOnce),
  };
}

struct Figures {
  double refine_work = 0;  // seconds: size field, coarse phase, leaves' rounds
  double engine = 0;
  Summary summary;
};

// On `threads` threads of a pool; 0 is the kernel by itself.
std::optional<Figures> measure(const Row& row, const Pslg& pslg, int threads, int runs) {
  MeshRequest request{.pslg = pslg, .size = row.size, .min_angle_deg = row.min_angle_deg};
  if (threads == 0) request.leaf_triangles = std::numeric_limits<double>::infinity();
  ThreadPool pool(std::max(1, threads));
  Figures figures;
  std::vector<double> refine;
  std::vector<double> engine;
  for (int run = 0; run <= runs; ++run) {
    Discard sink;
    Run mesh_run;
    mesh_run.set_threads(pool);
    const auto result = stream(request, sink, mesh_run);
    if (!result) {
      std::fprintf(stderr, "%s: %s\n", row.name, result.error().message.c_str());
      return std::nullopt;
    }
    figures.summary = *result;
    if (run == 0) continue;
    // The coarse phase of a mesh of one leaf is its refinement.
    const double rounds = result->leaves.empty() ? 0 : result->refine_seconds;
    refine.push_back(result->size_seconds + result->coarse_seconds + rounds);
    engine.push_back(result->engine_seconds);
  }
  figures.refine_work = median(refine);
  figures.engine = median(engine);
  return figures;
}

std::optional<CgalResult> measure_cgal(const Row& row, const Pslg& pslg, int runs) {
  if (row.cgal == Cgal::kNever) return std::nullopt;
  if (row.cgal == Cgal::kOnce) return refine_with_cgal(pslg, row.compiled_size, row.min_angle_deg);
  CgalResult result;
  std::vector<double> seconds;
  for (int run = 0; run <= runs; ++run) {
    result = refine_with_cgal(pslg, row.compiled_size, row.min_angle_deg);
    if (run > 0) seconds.push_back(result.seconds);
  }
  result.seconds = median(seconds);
  return result;
}

}  // namespace

int run_engine_bench(const EngineBenchOptions& options) {
  std::printf(
      "| domain, size | angle | triangles | threads | refine work s | engine s | Mtri/s "
      "| speed-up | bytes/tri | CGAL triangles | CGAL s | CGAL / refine |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  std::vector<int> threads = options.threads;
  if (options.with_kernel) threads.insert(threads.begin(), 0);
  for (const Row& row : rows()) {
    if (std::string(row.name).find(options.only) == std::string::npos) continue;
    const Pslg pslg = read_poly(options.models + "/" + row.model);
    std::optional<double> one_thread;
    // The contenders run one after the other: memory that another one has just given back is slow
    // to touch.
    std::optional<CgalResult> theirs;
    if (options.with_cgal) theirs = measure_cgal(row, pslg, options.runs);
    for (const int count : threads) {
      const auto ours = measure(row, pslg, count, options.runs);
      if (!ours) return 1;
      if (count == 1) one_thread = ours->engine;
      const auto triangles = static_cast<double>(ours->summary.triangles);
      std::printf("| %s | %g | %llu | %s | %.4f | %.4f | %.2f | ", row.name, row.min_angle_deg,
                  static_cast<unsigned long long>(ours->summary.triangles),
                  count == 0 ? "kernel alone" : std::to_string(count).c_str(), ours->refine_work,
                  ours->engine, triangles / ours->engine * 1e-6);
      if (one_thread && count > 0) std::printf("%.2f ", *one_thread / ours->engine);
      std::printf("| %.1f | ", static_cast<double>(ours->summary.peak_bytes) / triangles);
      if (theirs && count == 1) {
        std::printf("%llu | %.3f | %.0f |\n", static_cast<unsigned long long>(theirs->triangles),
                    theirs->seconds, theirs->seconds / ours->refine_work);
      } else {
        std::printf("| | |\n");
      }
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace weft::bench
