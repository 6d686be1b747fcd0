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
};

// Prints the table of bench/README.md. Returns the exit code.
int run_stream_bench(const StreamBenchOptions& options);

}  // namespace weft::bench
