// SPDX-License-Identifier: GPL-3.0-or-later
// weft-bench: figures, not tests. Their tables are in bench/README.md.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>

#include "bench/engine_bench.h"
#include "bench/fields_bench.h"
#include "bench/load_bench.h"
#include "bench/placement_bench.h"
#include "bench/scaling_bench.h"
#include "bench/stream_bench.h"
#include "weft/weft.h"

namespace {

void add_models(CLI::App* command, std::string& models) {
  command->add_option("--models", models, "Folder of the models")
      ->default_str("tests/models")
      ->default_val("tests/models");
}

}  // namespace

int main(int argc, char** argv) {
  weft::keep_memory_at_most(std::uint64_t{1} << 30);  // as a weftd that may take 16 GiB
  CLI::App app{"Benchmarks of weft; the tables are in bench/README.md."};
  app.require_subcommand(1);
  app.footer(
      "Examples:\n  weft-bench engine --only cylinder --threads 1,2\n"
      "  weft-bench scaling --triangles 1e6,1e7\n"
      "  weft-bench stream\n  weft-bench stream --memory --triangles 1e6,1e7,1e8\n"
      "  weft-bench load --connections 16");
  int exit_code = 0;

  weft::bench::EngineBenchOptions engine;
  CLI::App* const engine_command =
      app.add_subcommand("engine", "Our refinement beside CGAL Mesh_2 on the models");
  add_models(engine_command, engine.models);
  engine_command->add_option("--only", engine.only, "Only rows with this in their name");
  engine_command->add_option("--runs", engine.runs, "Runs after the warm-up; the median counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  engine_command->add_option("--threads", engine.threads, "Numbers of threads")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->default_str("1,2");
  engine_command->add_flag("--kernel", engine.with_kernel,
                           "Also the kernel alone: one leaf, no schedule");
  engine_command->add_flag("!--no-cgal", engine.with_cgal, "Leave CGAL out");
  engine_command->callback([&] { exit_code = weft::bench::run_engine_bench(engine); });

  weft::bench::PlacementBenchOptions placement;
  CLI::App* const placement_command =
      app.add_subcommand("placement", "Points on a lattice beside circumcentres, in turn");
  add_models(placement_command, placement.models);
  placement_command->add_option("--only", placement.only, "Only rows with this in their name");
  placement_command->add_option("--runs", placement.runs, "Runs after the warm-up; medians count")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  placement_command->add_option("--threads", placement.threads, "Numbers of threads")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024))
      ->default_str("1");
  placement_command->callback([&] { exit_code = weft::bench::run_placement_bench(placement); });

  weft::bench::FieldsBenchOptions fields;
  CLI::App* const fields_command =
      app.add_subcommand("fields", "Time and memory of the fields that a size may name");
  add_models(fields_command, fields.models);
  fields_command->add_option("--only", fields.only, "Only rows with this in their name");
  fields_command->add_option("--runs", fields.runs, "Runs of each; the fastest counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  fields_command->add_option("--threads", fields.threads, "Threads that build")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  fields_command->callback([&] { exit_code = weft::bench::run_fields_bench(fields); });

  weft::bench::ScalingBenchOptions scaling;
  CLI::App* const scaling_command = app.add_subcommand(
      "scaling", "Tasks recorded on one thread, and what they would take on up to 128");
  add_models(scaling_command, scaling.models);
  scaling_command->add_option("--triangles", scaling.triangles, "Sizes of the meshes")
      ->delimiter(',')
      ->check(CLI::Range(1e4, 1e9))
      ->default_str("1e6,1e7");
  scaling_command
      ->add_option("--runs", scaling.runs,
                   "Runs after the warm-up; of each task the fastest counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  scaling_command
      ->add_option("--extrapolate-to", scaling.extrapolate_to,
                   "Triangles, from the last two of the sizes; 0 leaves it out")
      ->default_str("1e8");
  scaling_command->callback([&] { exit_code = weft::bench::run_scaling_bench(scaling); });

  weft::bench::StreamBenchOptions stream;
  stream.weftd = (std::filesystem::path(argv[0]).parent_path() / "weftd").string();
  CLI::App* const stream_command =
      app.add_subcommand("stream", "From a weftd over a unix socket and TCP");
  add_models(stream_command, stream.models);
  stream_command->add_option("--weftd", stream.weftd, "The server; default: beside weft-bench");
  stream_command->add_option("--triangles", stream.triangles, "Sizes of the meshes")
      ->delimiter(',')
      ->check(CLI::Range(1e4, 4e9))
      ->default_str("1e6,1e7");
  stream_command->add_flag("--memory", stream.memory,
                           "How much memory the server takes, once for each mesh and reader");
  stream_command->add_option("--threads", stream.threads, "Of the server")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  stream_command->add_option("--runs", stream.runs, "Runs after the warm-up; the median counts")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  stream_command->callback([&] { exit_code = weft::bench::run_stream_bench(stream); });

  weft::bench::LoadBenchOptions load;
  load.weftd = stream.weftd;
  CLI::App* const load_command =
      app.add_subcommand("load", "Many small requests at once, and a mesh from the store");
  add_models(load_command, load.models);
  load_command->add_option("--weftd", load.weftd, "The server; default: beside weft-bench");
  load_command->add_option("--threads", load.threads, "Of the server")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  load_command->add_option("--connections", load.connections, "At once")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  load_command->add_option("--seconds", load.seconds, "Of each row")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  load_command->callback([&] { exit_code = weft::bench::run_load_bench(load); });

  CLI11_PARSE(app, argc, argv);
  return exit_code;
}
