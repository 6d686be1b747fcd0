// SPDX-License-Identifier: Apache-2.0
// `weft size`: what a size asks for on a grid over the domain, without a mesh.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/commands/mesh_into.h"
#include "client/report/json_line.h"
#include "client/report/mesh_text.h"
#include "client/report/progress_bar.h"
#include "client/report/projection_report.h"
#include "files/base/atomic_file.h"
#include "files/base/text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/raster.h"

namespace weft::client {
namespace {

// Square cells over the domain, `most` along the longer side.
Raster cells_over(const Domain& domain, std::uint32_t most) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
  const auto add = [&](Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  };
  std::ranges::for_each(domain.points, add);
  for (const Domain::Arc& arc : domain.arcs) {
    const auto& segment = domain.segments[arc.segment];
    std::ranges::for_each(
        chord_corners(domain.points[segment.a], domain.points[segment.b], arc.bulge), add);
  }
  const double width = high.x - low.x;
  const double height = high.y - low.y;
  const double side = std::max(width, height) / most;
  const auto cells = [&](double length) {
    const double count = std::ceil(length / side * (1 - 1e-9));
    return count >= 1 ? static_cast<std::uint32_t>(std::min<double>(count, most)) : 1;
  };
  Raster grid{.x = low.x + side / 2, .y = low.y + side / 2, .dx = side, .dy = side};
  grid.columns = cells(width);
  grid.rows = cells(height);
  return grid;
}

void ask_for_size_at(const Raster& grid, v1::GenerateMeshRequest& request) {
  for (std::uint32_t row = 0; row < grid.rows; ++row)
    for (std::uint32_t column = 0; column < grid.columns; ++column) {
      request.add_sample_points(grid.x + column * grid.dx);
      request.add_sample_points(grid.y + row * grid.dy);
    }
}

double edge_of_area(double area) {
  return std::sqrt(area * 4 / std::sqrt(3.0));
}

// Lengths of edges in the domain, in ascending order; none is where nothing bounds it.
std::vector<double> lengths_of(const Raster& grid) {
  std::vector<double> lengths;
  for (const double length : grid.values)
    if (std::isfinite(length)) lengths.push_back(length);
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

// Three digits are enough for people.
std::string rounded(double value) {
  if (value < 1000 || value > 1e15) return digits(value, 3);
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return with_separators(static_cast<std::uint64_t>(std::round(value / unit) * unit));
}

std::string size_text(const std::vector<double>& lengths, const MeshReport& report) {
  std::string text = "no bound at any cell";
  if (!lengths.empty()) {
    text = "edges of " + rounded(lengths.front());
    if (lengths.back() > (1 + 1e-9) * lengths.front())
      text += " to " + rounded(lengths.back()) + ", in half of the area up to " +
              rounded(lengths[lengths.size() / 2]);
  }
  text += "; about " + rounded(static_cast<double>(report.summary.expected_triangles())) +
          " triangles\n";
  if (report.projection) text += projection_text(*report.projection);
  for (const std::string& warning : report.warnings) text += "WARNING: " + warning + "\n";
  return text;
}

Json size_json(const Raster& grid, const std::vector<double>& lengths, const MeshReport& report) {
  Json json = {{"expected_triangles", report.summary.expected_triangles()},
               {"cells", lengths.size()},
               {"least_edge", nullptr},
               {"median_edge", nullptr},
               {"largest_edge", nullptr},
               {"cell", grid.dx}};
  if (!lengths.empty()) {
    json["least_edge"] = lengths.front();
    json["median_edge"] = lengths[lengths.size() / 2];
    json["largest_edge"] = lengths.back();
  }
  if (report.projection) json["projection"] = projection_json(*report.projection);
  if (!report.warnings.empty()) json["warnings"] = report.warnings;
  return json;
}

}  // namespace

Result<ExitCode> run_size(const SizeOptions& options, std::stop_token stop) {
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  std::vector<OutputFile> files;
  for (const auto& name : options.grids) {
    if (!is_raster_path(name))
      return fail(ExitCode::kUsage, name.string() + ": the grid is written to .asc");
    auto file = OutputFile::create(name, stop);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
  }
  const auto input =
      read_input_domain(options.input, options.request_options, options.projection, options.layers);
  if (!input) return tl::unexpected(input.error());
  auto request = with_size(options.request_options, input->domain, input->projection.get());
  if (!request) return tl::unexpected(request.error());
  Raster grid = cells_over(input->domain, options.cells);
  ask_for_size_at(grid, request->asked);

  const auto connection = connect_for_mesh(options.calls.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  const MeshCallOptions call = shown_call(options.calls, progress, input->projection.get());
  const auto report = mesh_into(
      *connection, *input, *request, call, nullptr, [] {}, stop);
  if (!report) return tl::unexpected(report.error());
  progress.clear();
  if (report->summary.sampled_bounds_size() != request->asked.sample_points_size() / 2)
    return fail(ExitCode::kDataLoss, "the server samples no sizes; it is older than this weft");

  grid.values.reserve(static_cast<std::size_t>(report->summary.sampled_bounds_size()));
  for (const double bound : report->summary.sampled_bounds())
    grid.values.push_back(edge_of_area(bound));
  for (OutputFile& file : files) write_raster(grid, file);
  if (auto committed = commit(files); !committed) return tl::unexpected(committed.error());
  const std::vector<double> lengths = lengths_of(grid);
  if (options.json) return print(json_line(size_json(grid, lengths, *report)));
  if (options.quiet) return ExitCode::kOk;
  return print(size_text(lengths, *report));
}

}  // namespace weft::client
