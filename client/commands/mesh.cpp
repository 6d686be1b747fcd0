// SPDX-License-Identifier: Apache-2.0
// `weft mesh`: reads a domain, has it meshed, writes files and drawings.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <utility>

#include "client/commands/commands.h"
#include "client/formats/mesh_formats.h"
#include "client/progress_bar.h"
#include "client/text.h"

namespace weft::client {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

// When each step was done.
struct Times {
  Clock::time_point start = Clock::now();
  Clock::time_point read;
  Clock::time_point connected;
  Clock::time_point received;
  Clock::time_point written;
};

// Refuses unknown extensions, names given twice, and outputs that would replace the input.
Result<void> check_names(const MeshOptions& options) {
  if (options.outputs.empty() && options.drawings.empty())
    return fail(ExitCode::kUsage, "nothing to write: give -o FILE or --draw FILE");
  if (options.wishes.quadtree && options.drawings.empty())
    return fail(ExitCode::kUsage, "--draw-quadtree needs a drawing: give --draw FILE, too");
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  std::vector<std::filesystem::path> files;
  for (const auto& output : options.outputs) {
    if (!mesh_format(output) || output.extension() == ".ele") return unknown_mesh_format(output);
    for (auto& file : mesh_files(output)) files.push_back(std::move(file));
  }
  for (const auto& drawing : options.drawings) {
    if (!draw_format(drawing))
      return fail(ExitCode::kUsage, drawing.string() + ": the extension " +
                                        in_quotes(drawing.extension().string()) +
                                        " is not that of a drawing: .png, .svg, .pdf");
    files.push_back(drawing);
  }
  std::set<std::filesystem::path> seen;
  for (const auto& file : files) {
    std::error_code ignored;
    if (std::filesystem::equivalent(file, options.input, ignored))
      return fail(ExitCode::kUsage, file.string() + ": would replace the input");
    if (!seen.insert(std::filesystem::absolute(file, ignored).lexically_normal()).second)
      return fail(ExitCode::kUsage, file.string() + ": would be written twice");
  }
  return {};
}

// All files of the outputs, then the drawings, in the order of the options.
Result<std::vector<OutputFile>> open_files(const MeshOptions& options,
                                           const std::stop_token& stop) {
  std::vector<std::filesystem::path> names;
  for (const auto& output : options.outputs)
    for (auto& file : mesh_files(output)) names.push_back(std::move(file));
  names.insert(names.end(), options.drawings.begin(), options.drawings.end());
  std::vector<OutputFile> files;
  for (const auto& name : names) {
    auto file = OutputFile::create(name, stop);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
  }
  return files;
}

Result<void> write_files(const MeshOptions& options, const MeshView& mesh,
                         const v1::Summary& summary, std::vector<OutputFile>& files) {
  std::span<OutputFile> rest = files;
  for (const auto& output : options.outputs) {
    const std::size_t count = mesh_files(output).size();
    write_mesh(*mesh_format(output), mesh, rest.first(count));
    rest = rest.subspan(count);
  }
  std::span<const double> leaves;
  if (options.wishes.quadtree)
    leaves = {summary.leaf_boxes().data(), static_cast<std::size_t>(summary.leaf_boxes_size())};
  for (std::size_t i = 0; i < options.drawings.size(); ++i) {
    const DrawOptions how{
        .format = *draw_format(options.drawings[i]), .color = options.color, .boxes = leaves};
    if (auto drawn = draw(mesh, how, rest[i]); !drawn) return drawn;
  }
  return commit(files);
}

std::string json_report(const MeshReport& report, const Times& times) {
  const v1::Summary& summary = report.summary;
  const v1::Unrefined& unrefined = summary.unrefined();
  const v1::Timings& timings = summary.timings();
  const nlohmann::ordered_json json = {
      {"vertices", summary.vertices()},
      {"triangles", summary.triangles()},
      {"edges", summary.edges()},
      {"chunks", summary.chunks()},
      {"area", summary.area()},
      {"min_angle_deg", summary.min_angle_deg()},
      {"max_angle_deg", summary.max_angle_deg()},
      {"unrefined",
       {{"small_input_angle", unrefined.small_input_angle()},
        {"edge_floor", unrefined.edge_floor()},
        {"budget", unrefined.budget()}}},
      {"digest", hex(summary.sha256())},
      {"engine_version", report.accepted.engine_version()},
      {"threads", summary.threads()},
      {"engine_seconds", timings.engine_seconds()},
      {"first_chunk_seconds", report.first_chunk_seconds},
      {"total_seconds", seconds_between(times.start, times.written)},
      {"peak_engine_bytes", summary.peak_engine_bytes()},
      {"bytes_received", report.bytes_received},
      {"insertions", summary.insertions()},
      {"exact_predicates", summary.exact_predicates()},
      {"leaves", summary.leaves()},
      {"deferred", summary.deferred()},
      {"rounds", summary.rounds()},
      {"seconds",
       {{"triangulate", timings.triangulate_seconds()},
        {"size", timings.size_seconds()},
        {"prelude", timings.prelude_seconds()},
        {"refine", timings.refine_seconds()},
        {"emit", timings.emit_seconds()},
        {"engine", timings.engine_seconds()}}},
      {"timings",
       {{"triangulate_seconds", timings.triangulate_seconds()},
        {"size_seconds", timings.size_seconds()},
        {"refine_seconds", timings.refine_seconds()},
        {"emit_seconds", timings.emit_seconds()},
        {"read_seconds", seconds_between(times.start, times.read)},
        {"connect_seconds", seconds_between(times.read, times.connected)},
        {"stream_seconds", report.stream_seconds},
        {"write_seconds", seconds_between(times.received, times.written)}}}};
  return json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// What a drawing of the quadtree shows, or why it shows none.
std::string quadtree_text(const v1::Summary& summary) {
  if (summary.leaves() == 0) return "no quadtree to draw: one task refined the mesh\n";
  const std::string leaves = "quadtree of " + with_separators(summary.leaves()) +
                             (summary.leaves() == 1 ? " leaf" : " leaves");
  return leaves + (summary.leaf_boxes().empty() ? ", too many to be drawn\n" : "\n");
}

std::string text_report(const MeshReport& report, bool wants_quadtree, const Times& times,
                        const std::vector<OutputFile>& files) {
  const v1::Summary& summary = report.summary;
  const v1::Unrefined& unrefined = summary.unrefined();
  char angles[64];
  std::snprintf(angles, sizeof angles, "%.2f to %.2f degrees", summary.min_angle_deg(),
                summary.max_angle_deg());
  std::string text = with_separators(summary.triangles()) + " triangles, " +
                     with_separators(summary.vertices()) + " vertices, angles " + angles + "\n";
  const auto missed = [&text](std::uint64_t count, const char* why) {
    if (count > 0) text += with_separators(count) + " triangles miss a bound: " + why + "\n";
  };
  missed(unrefined.small_input_angle(), "a small angle of the input forces it");
  missed(unrefined.edge_floor(), "edges would become too short");
  missed(unrefined.budget(), "the most triangles allowed were reached");
  text += "engine " + seconds_text(summary.timings().engine_seconds()) + " on " +
          std::to_string(summary.threads()) + (summary.threads() == 1 ? " thread" : " threads") +
          ", total " + seconds_text(seconds_between(times.start, times.written)) + ", received " +
          bytes_text(report.bytes_received) + "\n";
  if (wants_quadtree) text += quadtree_text(summary);
  for (const OutputFile& file : files) {
    std::error_code ignored;
    text += "wrote " + file.target().string() + ", " +
            bytes_text(std::filesystem::file_size(file.target(), ignored)) + "\n";
  }
  return text;
}

}  // namespace

Result<ExitCode> run_mesh(const MeshOptions& options, std::stop_token stop) {
  Times times;
  if (auto ok = check_names(options); !ok) return tl::unexpected(ok.error());
  auto files = open_files(options, stop);
  if (!files) return tl::unexpected(files.error());
  const auto domain = read_domain(options.input);
  if (!domain) return tl::unexpected(domain.error());
  times.read = Clock::now();

  const auto connection = connect(options.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  times.connected = Clock::now();

  const auto folder = files->front().target().parent_path();
  const auto spool = MeshSpool::create(folder.empty() ? "." : folder);
  if (!spool) return tl::unexpected(spool.error());
  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  const MeshCallOptions call{
      .timeout_seconds = options.timeout_seconds,
      .on_progress = [&progress](const v1::Progress& p) { progress.update(p); }};
  auto report = call_generate_mesh(*connection, *domain, options.wishes, call, **spool, stop);
  if (!report) {
    Error error = report.error();
    constexpr int kUnavailable = 14;
    if (connection->server && error.exit == exit_code_of_status(kUnavailable))
      error.message += "\n  its last lines:\n" + connection->server->last_log_lines();
    return tl::unexpected(error);
  }
  times.received = Clock::now();

  auto mesh = (*spool)->view();
  if (!mesh) return tl::unexpected(mesh.error());
  mesh->input_point_markers = domain->point_markers;
  if (!options.drawings.empty()) progress.say("drawing");
  if (auto written = write_files(options, *mesh, report->summary, *files); !written)
    return tl::unexpected(written.error());
  times.written = Clock::now();
  progress.clear();

  if (options.json) return print(json_report(*report, times));
  return options.quiet ? ExitCode::kOk
                       : print(text_report(*report, options.wishes.quadtree, times, *files));
}

}  // namespace weft::client
