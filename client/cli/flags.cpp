// SPDX-License-Identifier: Apache-2.0
#include "client/cli/flags.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "client/formats/domain_formats.h"
#include "client/formats/mesh_formats.h"

namespace weft::client {

CLI::Range seconds_range() {
  return {0.001, 1e9};
}

void add_timeout(CLI::App& command, std::optional<double>& seconds, const std::string& help) {
  command.add_option("--timeout", seconds, help)
      ->envname("WEFT_TIMEOUT")
      ->check(seconds_range())
      ->type_name("S");
}

void add_retries(CLI::App& command, std::uint32_t& retries) {
  command
      .add_option("--retries", retries,
                  "Maximum retries, with growing waits, while the server is unavailable or busy")
      ->envname("WEFT_RETRIES")
      ->capture_default_str()
      ->type_name("N");
}

void add_snap(CLI::App& command, std::optional<double>& snap, const std::string& help) {
  command.add_option("--snap", snap, help)->envname("WEFT_SNAP")->type_name("D");
}

void add_domain_and_request_options(CLI::App& command, std::filesystem::path& input,
                                    RequestOptions& request_options) {
  command
      .add_option("INPUT", input,
                  "Domain: " + domain_extensions() +
                      "; or a mesh, to mesh its domain anew: " + read_mesh_extensions())
      ->required();
  command
      .add_option("--size", request_options.size,
                  "Maximum area of a triangle, taken at its centroid: a number, an expression in x "
                  "and y, or a grid of areas in an .asc file (ESRI ASCII). Default: no bound")
      ->type_name("EXPR|FILE");
  command
      .add_option("--min-angle", request_options.min_angle_deg,
                  "Minimum angle of every triangle, in degrees, 0 to 36. Default: 20")
      ->envname("WEFT_MIN_ANGLE")
      ->type_name("DEG");
  command
      .add_option("--min-edge", request_options.min_edge,
                  "Shortest edge that refinement may make; angle and area give way to it")
      ->envname("WEFT_MIN_EDGE")
      ->type_name("LEN");
  static const std::map<std::string, v1::Placement> kPlacements = {
      {"lattice", v1::PLACEMENT_LATTICE}, {"circumcentre", v1::PLACEMENT_CIRCUMCENTRE}};
  command
      .add_option("--placement", request_options.placement,
                  "Where new points go in triangles that are too large: lattice follows the size "
                  "and makes a third fewer triangles, circumcentre makes a mesh without any "
                  "direction. Default: lattice")
      ->envname("WEFT_PLACEMENT")
      ->transform(CLI::CheckedTransformer(kPlacements).description(""))
      ->type_name("lattice|circumcentre");
  command
      .add_option("--optimise", request_options.optimise,
                  "Sweeps of smoothing, 0 to 16: vertices around angles below 48 degrees move to "
                  "where the smallest angle around them is largest. Default: 2 if the size makes "
                  "nearly all triangles, on a lattice with few faults or in a mesh below 100,000 "
                  "triangles; otherwise 0")
      ->envname("WEFT_OPTIMISE")
      ->type_name("N");
  add_snap(command, request_options.snap,
           "First merge points and segments of the domain that are nearer together than this. "
           "Default: only what double precision cannot keep apart");
  command
      .add_flag("--allow-unrefined", request_options.allow_unrefined,
                "Accept a mesh with triangles that miss a bound although neither the domain nor a "
                "flag forces them to. Default: such a mesh is an error")
      ->envname("WEFT_ALLOW_UNREFINED");
  command
      .add_option("--max-triangles", request_options.max_triangles,
                  "Stop refining at this number of triangles")
      ->envname("WEFT_CLIENT_MAX_TRIANGLES")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command
      .add_option("--max-seconds", request_options.max_seconds,
                  "Maximum time of work; then the call fails")
      ->envname("WEFT_CLIENT_MAX_SECONDS")
      ->check(seconds_range())
      ->type_name("S");
  command
      .add_option(
          "--threads", request_options.threads,
          "Threads of the server that compute; the mesh does not depend on them. Default: all")
      ->envname("WEFT_CLIENT_THREADS")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
}

void add_writing(CLI::App& command, MeshWriteOptions& writing) {
  command
      .add_option("--order", writing.order,
                  "Order of the triangles written: 2 writes six-node triangles with straight "
                  "sides, to .vtu, .msh and .node")
      ->envname("WEFT_ORDER")
      ->check(CLI::Range(1, 2))
      ->capture_default_str()
      ->type_name("1|2");
  static const std::map<std::string, MshVersion> kVersions = {{"2.2", MshVersion::k22},
                                                              {"4.1", MshVersion::k41}};
  command
      .add_option("--msh-version", writing.msh_version,
                  "Version of .msh files: 4.1, binary, or 2.2, text, for older programs. "
                  "Default: 4.1")
      ->envname("WEFT_MSH_VERSION")
      ->transform(CLI::CheckedTransformer(kVersions).description(""))
      ->type_name("2.2|4.1");
  command
      .add_option("--open-boundary", writing.open_boundaries,
                  "Marker of segments that ADCIRC's .14 and .grd files have as open boundary; the "
                  "others are land. May be repeated")
      ->allow_extra_args(false)
      ->type_name("MARKER");
}

void add_output(CLI::App& command, MeshOutputOptions& output) {
  command
      .add_option("-o,--output", output.files,
                  "File to write, may be repeated: " + written_mesh_extensions())
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_writing(command, output.writing);
  command
      .add_option("--draw", output.drawings, "Drawing to write, may be repeated: .png, .svg, .pdf")
      ->allow_extra_args(false)
      ->type_name("FILE");
  static const std::map<std::string, DrawColor> kColors = {
      {"angle", DrawColor::kAngle}, {"region", DrawColor::kRegion}, {"none", DrawColor::kNone}};
  command
      .add_option("--color", output.color,
                  "Colour of the triangles in drawings: by angle, by region or none")
      ->envname("WEFT_COLOR")
      ->transform(CLI::CheckedTransformer(kColors).description(""))
      ->type_name("angle|region|none");
  command
      .add_flag("--draw-quadtree", output.draw_quadtree,
                "Draw the leaves of the quadtree that guided refinement over the mesh")
      ->envname("WEFT_DRAW_QUADTREE");
}

void refuse_idle_flags(const CLI::App& command, std::span<char* const> words) {
  struct Pair {
    const char* flag;
    const char* other;
  };
  static constexpr Pair kNeeds[] = {{"--order", "--output"},
                                    {"--msh-version", "--output"},
                                    {"--open-boundary", "--output"},
                                    {"--color", "--draw"},
                                    {"--tls", "--server"},
                                    {"--tls-ca", "--server"},
                                    {"--tls-cert", "--server"},
                                    {"--tls-key", "--server"},
                                    {"--tls-server-name", "--server"},
                                    {"--token-file", "--server"},
                                    {"--insecure", "--server"}};
  static constexpr Pair kExcludes[] = {{"--interval", "--once"}};
  const auto is_given = [words](const std::string& flag) {
    return std::any_of(words.begin(), words.end(), [&flag](std::string_view word) {
      return word == flag || word.starts_with(flag + "=");
    });
  };
  for (const auto& [flag, other] : kNeeds) {
    const CLI::Option* const needed = command.get_option_no_throw(other);
    if (needed != nullptr && needed->count() == 0 && is_given(flag))
      throw CLI::RequiresError(flag, other);
  }
  for (const auto& [flag, other] : kExcludes)
    if (is_given(flag) && is_given(other)) throw CLI::ExcludesError(flag, other);
}

void add_json(CLI::App& command, bool& json, const std::string& help) {
  command.add_flag("--json", json, help);
}

void add_quiet(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet,-q", quiet, "Print no progress and no summary")->envname("WEFT_QUIET");
}

}  // namespace weft::client
