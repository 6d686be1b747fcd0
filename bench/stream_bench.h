// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench stream: a mesh from a real weftd, over a unix socket and over TCP.
#pragma once

#include <string>
#include <vector>

namespace weft::bench {

struct StreamBenchOptions {
  std::string models;                       // the folder of the .poly files
  std::string weftd;                        // the program
  std::vector<double> triangles{1e6, 1e7};  // of each mesh, about
  int threads = 2;
  int runs = 5;  // after one warm-up; the median is printed
  // The table of memory instead of that of transports: each mesh once for a reader that keeps up,
  // and once for one that sleeps now and then.
  bool memory = false;
};

// Prints a table of bench/README.md. Returns the exit code.
int run_stream_bench(const StreamBenchOptions& options);

}  // namespace weft::bench
