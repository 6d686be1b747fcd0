// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench scaling: a recorded run on one thread, and what it would take on 2 to 128.
#pragma once

#include <string>
#include <vector>

namespace weft::bench {

struct ScalingBenchOptions {
  std::string models;                       // the folder of the .poly files
  std::vector<double> triangles{1e6, 1e7};  // of each mesh, about
  int runs = 5;  // per mesh, after one warm-up; of each task and stage the fastest is kept
  double extrapolate_to = 1e8;  // triangles; 0 leaves it out
};

// Prints tables. Returns the exit code.
int run_scaling_bench(const ScalingBenchOptions& options);

}  // namespace weft::bench
