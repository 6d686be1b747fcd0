// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench placement: the lattice beside circumcentres (engine/refine/steiner_point.h).
#pragma once

#include <string>
#include <vector>

namespace weft::bench {

struct PlacementBenchOptions {
  std::string models;  // the folder of the .poly files
  std::string only;    // part of a row's name; empty runs all
  std::vector<int> threads{1};
  int runs = 5;  // of each in turn, after one warm-up
};

// Prints the table of bench/README.md. Returns the exit code.
int run_placement_bench(const PlacementBenchOptions& options);

}  // namespace weft::bench
