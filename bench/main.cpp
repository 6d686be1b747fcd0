// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench: figures, not tests. Their tables are in bench/README.md.
#include <CLI/CLI.hpp>

#include "bench/engine_bench.h"

int main(int argc, char** argv) {
  CLI::App app{"Benchmarks of weft; the tables are in bench/README.md."};
  app.require_subcommand(1);
  app.footer("Example:\n  weft-bench engine --models tests/models --only cylinder");

  weft::bench::EngineBenchOptions engine;
  CLI::App* const engine_command =
      app.add_subcommand("engine", "Our refinement beside CGAL Mesh_2 on the models");
  engine_command->add_option("--models", engine.models, "Folder of the models")
      ->default_str("tests/models")
      ->default_val("tests/models");
  engine_command->add_option("--only", engine.only, "Only rows with this in their name");
  engine_command->add_option("--runs", engine.runs, "Runs after the warm-up; the median counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  engine_command->add_flag("!--no-cgal", engine.with_cgal, "Leave CGAL out");

  CLI11_PARSE(app, argc, argv);
  return weft::bench::run_engine_bench(engine);
}
