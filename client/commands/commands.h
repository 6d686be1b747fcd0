// SPDX-License-Identifier: Apache-2.0
// The commands of `weft`. Each prints its result on stdout and returns the exit code; the caller
// prints errors.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "checker/models/model_rules.h"
#include "client/batch/quality_gate.h"
#include "client/call/connect_options.h"
#include "client/call/mesh_call.h"
#include "client/report/mesh_output.h"
#include "files/base/data_path.h"
#include "files/base/error.h"
#include "files/formats/layer_options.h"
#include "files/geo/projection_options.h"

namespace weft::client {

struct MeshOptions {
  DataPath input;
  LayerOptions layers;
  MeshOutputOptions output;
  RequestOptions request_options;
  CallOptions calls;
  bool lint = false;  // prints the domain's faults first
  bool json = false;
  bool quiet = false;
  bool no_picture = false;  // at the end, on a terminal that shows pictures
};
Result<ExitCode> run_mesh(const MeshOptions& options, std::stop_token stop);

struct SizeOptions {
  DataPath input;
  LayerOptions layers;
  std::vector<std::filesystem::path> grids;  // to write
  std::uint32_t cells = 256;                 // along the longer side of the domain
  RequestOptions request_options;
  ProjectionOptions projection;
  CallOptions calls;
  bool json = false;
  bool quiet = false;
};
Result<ExitCode> run_size(const SizeOptions& options, std::stop_token stop);

struct BatchOptions {
  std::filesystem::path manifest;
  CallOptions calls;               // the time-out is that of each mesh
  std::uint32_t jobs = 4;          // meshes at a time
  std::vector<QualityGate> gates;  // of all meshes, in addition to their own
  std::filesystem::path lock;      // empty: beside the manifest
  bool locked = false;             // check against the lock file, do not write it
  std::filesystem::path junit;     // empty: none
  std::filesystem::path summary;   // empty: none
  bool quiet = false;
};
// kCheckFailed if a mesh fails a gate or is not the locked one.
Result<ExitCode> run_batch(const BatchOptions& options, std::stop_token stop);

struct DrawMeshOptions {
  DataPath mesh;
  std::vector<std::filesystem::path> drawings;
  DrawOptions drawing;
  RequestOptions size;  // the bound on areas; only size_rows are read
  bool lonlat = false;  // the mesh is in longitude and latitude
  bool quiet = false;
};
// kUsage for colours by bounds without a size, or a size that nothing is coloured by.
Result<ExitCode> run_draw(const DrawMeshOptions& options, std::stop_token stop);

struct CheckOptions {
  DataPath mesh;
  std::filesystem::path domain;  // empty: the mesh is judged for a model alone
  LayerOptions layers;
  RequestOptions size;  // how large triangles may be; the rest is not looked at
  double min_angle_deg = 20;
  std::optional<double> snap;
  std::optional<double> simplify;
  PolygonFill fill = PolygonFill::kUnion;
  std::uint64_t max_unrefined = 0;
  ProjectionOptions projection;  // of the domain, whose mesh is in metres, or of the mesh
  std::optional<check::Model> model;
  MeshWriteOptions writing;  // of it, the open boundaries
  bool json = false;
};
// kUsage with neither a domain nor a model, kCheckFailed if a rule is violated.
Result<ExitCode> run_check(const CheckOptions& options);

struct ConvertOptions {
  DataPath input;
  DataPath output;
  LayerOptions layers;   // of a domain
  RequestOptions names;  // of a mesh; only name_rows are read
  MeshWriteOptions writing;
  bool json = false;
  bool quiet = false;
};
Result<ExitCode> run_convert(const ConvertOptions& options, std::stop_token stop);

struct RemeshOptions {
  DataPath mesh;
  std::filesystem::path within;  // polygons
  LayerOptions layers;           // of these
  RequestOptions request_options;
  MeshOutputOptions output;
  CallOptions calls;
  bool json = false;
  bool quiet = false;
};
Result<ExitCode> run_remesh(const RemeshOptions& options, std::stop_token stop);

struct StitchMeshOptions {
  std::vector<DataPath> meshes;  // two at least
  std::vector<DataPath> files;   // to write
  double tolerance = 0;          // 0: see StitchOptions
  bool json = false;
  bool quiet = false;
};
Result<ExitCode> run_stitch(const StitchMeshOptions& options, std::stop_token stop);

struct InfoOptions {
  DataPath file;
  LayerOptions layers;   // of a domain
  bool quality = false;  // of a mesh: histograms and the worst triangles
  RequestOptions size;   // the bound on areas; only size_rows are read
  bool json = false;     // of the quality
};
// kUsage for the quality of a domain.
Result<ExitCode> run_info(const InfoOptions& options);

struct LintOptions {
  DataPath file;
  LayerOptions layers;
  std::optional<double> snap;
  PolygonFill fill = PolygonFill::kUnion;
  bool lonlat = false;               // the domain is in longitude and latitude
  std::vector<std::string> ignored;  // kinds of faults
  std::vector<std::filesystem::path> layer_files;
  std::vector<std::filesystem::path> drawings;
  DrawOptions drawing;
  bool json = false;
};
// kCheckFailed if there is a fault.
Result<ExitCode> run_lint(const LintOptions& options, std::stop_token stop);

struct ServerOptions {
  ConnectOptions server;
  double timeout_seconds = 10;
};
Result<ExitCode> run_health(const ServerOptions& options, std::stop_token stop);
Result<ExitCode> run_server_info(const ServerOptions& options, std::stop_token stop);

// Writes to standard output, or to standard error; returns an error if that fails.
Result<ExitCode> print(const std::string& text, std::FILE* to = stdout);

}  // namespace weft::client
