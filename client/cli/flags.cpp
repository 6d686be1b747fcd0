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

void add_snap(CLI::App& command, std::optional<double>& snap, const std::string& help) {
  command.add_option("--snap", snap, help)->envname("WEFT_SNAP")->type_name("D");
}

void add_domain_and_wishes(CLI::App& command, std::filesystem::path& input, MeshWishes& wishes) {
  command
      .add_option("INPUT", input,
                  "Domain: " + domain_extensions() +
                      "; or a mesh, to mesh its domain anew: " + read_mesh_extensions())
      ->required();
  command
      .add_option(
          "--size", wishes.size,
          "Upper bound on the area of a triangle at its centroid: a number, an expression in "
          "x and y, or a grid of such bounds as .asc (ESRI ASCII). Default: no bound")
      ->type_name("EXPR|FILE");
  command
      .add_option("--min-angle", wishes.min_angle_deg,
                  "Lower bound on every angle, in degrees, 0 to 36. Default: 20")
      ->envname("WEFT_MIN_ANGLE")
      ->type_name("DEG");
  command.add_option("--min-edge", wishes.min_edge, "Make no edge shorter than this")
      ->envname("WEFT_MIN_EDGE")
      ->type_name("LEN");
  static const std::map<std::string, v1::Placement> kPlacements = {
      {"lattice", v1::PLACEMENT_LATTICE}, {"circumcentre", v1::PLACEMENT_CIRCUMCENTRE}};
  command
      .add_option("--placement", wishes.placement,
                  "Where points go that split triangles larger than their bound: to a lattice that "
                  "follows the size, for a third fewer triangles, or to circumcentres, for a mesh "
                  "without any direction. Default: lattice")
      ->envname("WEFT_PLACEMENT")
      ->transform(CLI::CheckedTransformer(kPlacements).description(""))
      ->type_name("lattice|circumcentre");
  command
      .add_option("--optimise", wishes.optimise,
                  "Sweeps of smoothing, 0 to 16: vertices around angles below 48 degrees move to "
                  "where the smallest angle around them is largest. Default: 2 if the size makes "
                  "nearly all triangles, on a lattice; otherwise 0")
      ->envname("WEFT_OPTIMISE")
      ->type_name("N");
  add_snap(command, wishes.snap,
           "Merge points and segments of the domain that are nearer together than this first. "
           "Default: only what double precision cannot keep apart");
  command
      .add_flag("--allow-unrefined", wishes.allow_unrefined,
                "Take a mesh with triangles that miss a bound though neither the domain nor a flag "
                "excuses them; without it, such a mesh is an error")
      ->envname("WEFT_ALLOW_UNREFINED");
  command
      .add_option("--max-triangles", wishes.max_triangles,
                  "Stop refining at this number of triangles")
      ->envname("WEFT_MAX_TRIANGLES")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command.add_option("--max-seconds", wishes.max_seconds, "Give up when the work takes longer")
      ->envname("WEFT_MAX_SECONDS")
      ->check(seconds_range())
      ->type_name("S");
  command
      .add_option(
          "--threads", wishes.threads,
          "Threads that compute; the mesh does not depend on it. Default: all of the server")
      ->envname("WEFT_THREADS")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
}

void add_writing(CLI::App& command, MeshWriteOptions& writing) {
  command
      .add_option("--order", writing.order,
                  "2 writes six-node triangles, with straight sides, to .vtu, .msh and .node")
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
      .add_option("--draw", output.drawings,
                  "Drawing to write: .png, .svg or .pdf; may be repeated")
      ->allow_extra_args(false)
      ->type_name("FILE");
  static const std::map<std::string, DrawColor> kColors = {
      {"angle", DrawColor::kAngle}, {"region", DrawColor::kRegion}, {"none", DrawColor::kNone}};
  command
      .add_option("--color", output.color, "Colour triangles of drawings by angle, region or none")
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
  command.add_flag("--quiet,-q", quiet, "No progress and no summary")->envname("WEFT_QUIET");
}

}  // namespace weft::client
