// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench engine: our refinement on several threads beside CGAL's, on the models.
#pragma once

#include <string>
#include <vector>

namespace weft::bench {

struct EngineBenchOptions {
  std::string models;  // the folder of the .poly files
  std::string only;    // part of a row's name; empty runs all
  std::vector<int> threads{1, 2};
  bool with_kernel = false;  // also the kernel by itself: one leaf, no schedule
  int runs = 5;              // after one warm-up; the median is printed
  bool with_cgal = true;
};

// Prints the table of bench/README.md. Returns the exit code.
int run_engine_bench(const EngineBenchOptions& options);

}  // namespace weft::bench
