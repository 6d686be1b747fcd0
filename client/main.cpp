// SPDX-License-Identifier: Apache-2.0
// weft: the command line of the meshing service. This file knows the flags; commands/ does the
// work.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <string>

#include "client/commands/commands.h"
#include "client/connect_flags.h"
#include "client/signals.h"

namespace {

using namespace weft::client;

constexpr char kExitCodes[] = R"(Exit codes:
  0        all went well
  1        a fault of weft itself
  2        the command line is wrong
  3        `weft check` ran, and the mesh fails
  4        the input is missing, unreadable or malformed
  5        the output cannot be written; nothing is left behind
  6        the private weftd could not be found or started
  64 + n   the call to the server ended with gRPC status n: 67 the request is
           wrong, 68 a deadline passed, 72 a limit was exceeded, 78 the server is
           absent or went away, 79 the stream was damaged, 80 the token is
           missing or wrong
  128 + n  stopped by signal n

Flags that name a variable in their help, such as (Env:WEFT_SERVER), are also read
from it. WEFT_WEFTD is the weftd that is started where no server is named.)";

constexpr char kMeshExamples[] = R"(Input:  .poly (Triangle), .geojson, .json
Output: .vtu, .msh (Gmsh 4.1), .node (Triangle's .node, .ele and .poly)

Examples:
  weft mesh coast.geojson -o coast.vtu --size 0.001
  weft mesh pipe.poly -o pipe.msh --size '0.4*hypot(x-200, y-200) + 1' --min-angle 30
  weft mesh key.poly -o key.vtu -o key.node --draw key.png --color angle
  weft mesh cylinder.poly --size 1e-2 --draw cylinder.png --draw-quadtree
  weft mesh key.poly -o key.vtu --server mesh.example.org:7421 --json)";

constexpr char kCheckExamples[] = R"(Give the bounds that the mesh was made with.

Example:
  weft check pipe.msh --domain pipe.poly --size '0.4*hypot(x-200, y-200) + 1' --min-angle 30)";

const CLI::Range kSeconds(0.001, 1e9);

void add_mesh(CLI::App& app, MeshOptions& options) {
  CLI::App& mesh = *app.add_subcommand("mesh", "Mesh a domain and write the mesh to files");
  mesh.footer(kMeshExamples);
  mesh.add_option("INPUT", options.input, "Domain: .poly, .geojson or .json")->required();
  mesh.add_option("-o,--output", options.outputs,
                  "File to write: .vtu, .msh or .node; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE");
  mesh.add_option("--size", options.wishes.size,
                  "Upper bound on the area of a triangle at its centroid: a number or an "
                  "expression in x and y. Default: no bound")
      ->type_name("EXPR");
  mesh.add_option("--min-angle", options.wishes.min_angle_deg,
                  "Lower bound on every angle, in degrees, 0 to 34. Default: 20")
      ->envname("WEFT_MIN_ANGLE")
      ->type_name("DEG");
  mesh.add_option("--min-edge", options.wishes.min_edge, "Make no edge shorter than this")
      ->envname("WEFT_MIN_EDGE")
      ->type_name("LEN");
  mesh.add_option("--max-triangles", options.wishes.max_triangles,
                  "Stop refining at this number of triangles")
      ->envname("WEFT_MAX_TRIANGLES")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  mesh.add_option("--max-seconds", options.wishes.max_seconds, "Give up when the work takes longer")
      ->envname("WEFT_MAX_SECONDS")
      ->check(kSeconds)
      ->type_name("S");
  mesh.add_option(
          "--threads", options.wishes.threads,
          "Threads that compute; the mesh does not depend on it. Default: all of the server")
      ->envname("WEFT_THREADS")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  add_server_flags(mesh, options.server);
  mesh.add_option("--timeout", options.timeout_seconds,
                  "Give up when the whole call takes longer. Default: never")
      ->envname("WEFT_TIMEOUT")
      ->check(kSeconds)
      ->type_name("S");
  mesh.add_option("--draw", options.drawings,
                  "Drawing to write: .png, .svg or .pdf; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE");
  static const std::map<std::string, DrawColor> kColors = {
      {"angle", DrawColor::kAngle}, {"region", DrawColor::kRegion}, {"none", DrawColor::kNone}};
  mesh.add_option("--color", options.color, "Colour triangles of drawings by angle, region or none")
      ->envname("WEFT_COLOR")
      ->transform(CLI::CheckedTransformer(kColors).description(""))
      ->type_name("angle|region|none");
  mesh.add_flag("--draw-quadtree", options.wishes.quadtree,
                "Draw the leaves of the quadtree that guided refinement over the mesh")
      ->envname("WEFT_DRAW_QUADTREE");
  mesh.add_flag("--json", options.json, "Print one JSON object on standard output");
  mesh.add_flag("--quiet,-q", options.quiet, "No progress and no summary")->envname("WEFT_QUIET");
}

void add_check(CLI::App& app, CheckOptions& options) {
  CLI::App& check = *app.add_subcommand("check", "Judge a mesh by the independent checker");
  check.footer(kCheckExamples);
  check.add_option("MESH", options.mesh, "Mesh: .vtu, .msh or .node")->required();
  check.add_option("--domain", options.domain, "Domain that was meshed: .poly, .geojson or .json")
      ->required()
      ->type_name("INPUT");
  check.add_option("--size", options.size, "Bound on the area, as given to `weft mesh`")
      ->type_name("EXPR");
  check.add_option("--min-angle", options.min_angle_deg, "Bound on the angles, in degrees")
      ->envname("WEFT_MIN_ANGLE")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str()
      ->type_name("DEG");
  check
      .add_option("--max-unrefined", options.max_unrefined,
                  "Triangles that may miss a bound, as `weft mesh` counted them (edge floor and "
                  "budget; small input angles are excused anyway)")
      ->capture_default_str()
      ->type_name("N");
}

void add_server_command(CLI::App& app, const char* name, const char* help, ServerOptions& options) {
  CLI::App& command = *app.add_subcommand(name, help);
  add_server_flags(command, options.server);
  command.add_option("--timeout", options.timeout_seconds, "Give up after this many seconds")
      ->envname("WEFT_TIMEOUT")
      ->check(kSeconds)
      ->capture_default_str()
      ->type_name("S");
}

int run(int argc, char** argv) {
  CLI::App app("Graded, guaranteed-quality Delaunay meshes of planar domains.", "weft");
  app.set_version_flag("--version", "weft " WEFT_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  MeshOptions mesh;
  CheckOptions check;
  std::filesystem::path info;
  ServerOptions server;
  add_mesh(app, mesh);
  add_check(app, check);
  app.add_subcommand("info", "Say what a mesh or a domain holds")
      ->add_option("FILE", info, "Mesh or domain")
      ->required();
  add_server_command(app, "health", "Ask whether the server takes work", server);
  add_server_command(app, "server-info", "Say what the server is and what it admits", server);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }

  Signals signals;
  const auto command = [&]() -> Result<ExitCode> {
    const CLI::App* chosen = app.get_subcommands().front();
    if (chosen->get_name() == "mesh") return run_mesh(mesh, signals.stop());
    if (chosen->get_name() == "check") return run_check(check);
    if (chosen->get_name() == "info") return run_info(info);
    if (chosen->get_name() == "health") return run_health(server, signals.stop());
    return run_server_info(server, signals.stop());
  };
  const Result<ExitCode> result = command();
  if (signals.received() != 0) {
    std::fputs("weft: interrupted, nothing was written\n", stderr);
    signals.die();
  }
  if (result) return static_cast<int>(*result);
  std::fprintf(stderr, "weft: %s\n", result.error().message.c_str());
  return static_cast<int>(result.error().exit);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
    return static_cast<int>(ExitCode::kInternal);
  }
}
