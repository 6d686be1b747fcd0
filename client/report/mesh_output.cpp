// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_output.h"

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <new>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "client/base/text.h"
#include "client/formats/mesh_formats.h"

namespace weft::client {
namespace {

// Refuses unknown extensions, names given twice, and outputs that would replace the input.
Result<void> check_names(const MeshOutputOptions& options,
                         const std::optional<std::filesystem::path>& input) {
  if (options.empty())
    return fail(ExitCode::kUsage, "nothing to write: give -o FILE or --draw FILE");
  if (options.draw_quadtree && options.drawings.empty())
    return fail(ExitCode::kUsage, "--draw-quadtree needs a drawing: give --draw FILE, too");
  std::vector<std::filesystem::path> files;
  for (const auto& output : options.files) {
    if (auto ok = check_writable(output, options.writing); !ok) return ok;
    for (auto& file : mesh_files(output)) files.push_back(std::move(file));
  }
  const auto writes = [&options](std::initializer_list<std::string_view> extensions) {
    return std::any_of(options.files.begin(), options.files.end(), [&](const auto& file) {
      return std::find(extensions.begin(), extensions.end(), lower_extension(file)) !=
             extensions.end();
    });
  };
  if (!options.writing.open_boundaries.empty() && !writes({".14", ".grd"}))
    return fail(ExitCode::kUsage, "--open-boundary is for ADCIRC: give an output .14 or .grd");
  if (options.writing.msh_version != MshVersion::k41 && !writes({".msh"}))
    return fail(ExitCode::kUsage, "--msh-version is for Gmsh: give an output .msh");
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
    if (input && std::filesystem::equivalent(file, *input, ignored))
      return fail(ExitCode::kUsage, file.string() + ": would replace the input");
    if (!seen.insert(std::filesystem::absolute(file, ignored).lexically_normal()).second)
      return fail(ExitCode::kUsage, file.string() + ": would be written twice");
  }
  return {};
}

// All files of the outputs, then the drawings, in the order of the options.
Result<std::vector<OutputFile>> open_files(const MeshOutputOptions& options,
                                           const std::stop_token& stop) {
  std::vector<std::filesystem::path> names;
  for (const auto& output : options.files)
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

// What a drawing of the quadtree shows, or why it shows none.
std::string quadtree_text(const v1::Summary& summary) {
  if (summary.leaves() == 0) return "no quadtree to draw: one task refined the mesh\n";
  const std::string leaves = "quadtree of " + with_separators(summary.leaves()) +
                             (summary.leaves() == 1 ? " leaf" : " leaves");
  return leaves + (summary.leaf_boxes().empty() ? ", too many to be drawn\n" : "\n");
}

// Longitude and latitude of the vertices; kUnwritableOutput if there is no room for them.
Result<ScratchArray<double>> bring_back(const DomainProjection& projection, const MeshView& mesh) {
  try {
    return projection.to_lonlat(mesh);
  } catch (const std::system_error& failure) {
    return fail(ExitCode::kUnwritableOutput,
                std::string("the mesh cannot be projected: ") + failure.code().message());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::kUnwritableOutput, "the mesh cannot be projected: not enough memory");
  }
}

}  // namespace

Result<MeshOutput> MeshOutput::open(const MeshOutputOptions& options,
                                    const std::optional<std::filesystem::path>& input,
                                    const std::stop_token& stop) {
  if (auto ok = check_names(options, input); !ok) return tl::unexpected(ok.error());
  auto files = open_files(options, stop);
  if (!files) return tl::unexpected(files.error());
  return MeshOutput(options, std::move(*files), stop);
}

MeshOutput::MeshOutput(MeshOutputOptions options, std::vector<OutputFile> files,
                       std::stop_token stop)
    : options_(std::move(options)), files_(std::move(files)), stop_(std::move(stop)) {
  if (options_.drawings.empty()) return;
  if (options_.projection.wanted()) options_.drawing.unit = DrawnUnit::kMetres;
  drawing_ = std::make_unique<Drawing>(options_.drawing);
}

Result<std::unique_ptr<MeshSpool>> MeshOutput::make_spool() {
  const auto folder = files_.front().target().parent_path();
  MeshSpoolOptions options{.vertices_only = options_.files.empty(), .on_piece = {}, .stop = stop_};
  if (drawing_)
    options.on_piece = [drawing = drawing_.get()](const MeshView& piece) { drawing->add(piece); };
  return MeshSpool::create(folder.empty() ? "." : folder, std::move(options));
}

Result<void> MeshOutput::write(const MeshView& arrived, const v1::Summary& summary) {
  MeshView mesh = arrived;
  ScratchArray<double> lonlat;
  if (projection_ && !projection_->to_metres() && !options_.files.empty()) {
    auto brought = bring_back(*projection_, mesh);
    if (!brought) return tl::unexpected(brought.error());
    lonlat = std::move(*brought);
    mesh.coordinates = lonlat.values();
  }
  std::span<OutputFile> rest = files_;
  for (const auto& name : options_.files) {
    const std::size_t count = mesh_files(name).size();
    write_mesh(*mesh_format(name), mesh, rest.first(count), options_.writing);
    rest = rest.subspan(count);
  }
  std::span<const double> leaves;
  if (options_.draw_quadtree)
    leaves = {summary.leaf_boxes().data(), static_cast<std::size_t>(summary.leaf_boxes_size())};
  for (std::size_t i = 0; i < options_.drawings.size(); ++i) {
    if (auto drawn = drawing_->draw(*draw_format(options_.drawings[i]), leaves, rest[i]); !drawn)
      return drawn;
  }
  return commit(files_);
}

std::string MeshOutput::text(const v1::Summary& summary) const {
  std::string text = options_.draw_quadtree ? quadtree_text(summary) : "";
  std::size_t rank = 0;
  for (const WorstTriangle& worst : drawing_ ? drawing_->worst() : std::vector<WorstTriangle>()) {
    const Point at = centroid(worst.triangle);
    char angle[32];
    std::snprintf(angle, sizeof angle, "%.2f", worst.angle_deg);
    text += "worst " + std::to_string(++rank) + ": " + angle + " degrees, triangle " +
            std::to_string(worst.triangle.id) + " at " + coordinates(at.x, at.y) + "\n";
  }
  for (const OutputFile& file : files_) {
    std::error_code ignored;
    text += "wrote " + file.target().string() + ", " +
            bytes_text(std::filesystem::file_size(file.target(), ignored)) + "\n";
  }
  return text;
}

}  // namespace weft::client
