// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench load: many small requests at once, alone and beside jobs of a million triangles; and
// a mesh from the store.
#pragma once

#include <string>

namespace weft::bench {

struct LoadBenchOptions {
  std::string models;  // the folder of the .poly files
  std::string weftd;   // the program
  int threads = 2;
  int connections = 16;
  double seconds = 5;  // of each row
};

// Prints the tables of bench/README.md. Returns the exit code.
int run_load_bench(const LoadBenchOptions& options);

}  // namespace weft::bench
