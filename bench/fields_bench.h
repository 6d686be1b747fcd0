// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench fields: what the fields of a size cost (engine/size/fields/).
#pragma once

#include <string>

namespace weft::bench {

struct FieldsBenchOptions {
  std::string models;  // the folder of the .poly files
  std::string only;    // part of a row's name; empty runs all
  int threads = 1;     // of the build
  int runs = 5;        // of which the fastest counts
};

// Prints a table. Returns the exit code.
int run_fields_bench(const FieldsBenchOptions& options);

}  // namespace weft::bench
