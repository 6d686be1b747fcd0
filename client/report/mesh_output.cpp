// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_output.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
#include <new>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "client/drawing/cairo_library.h"
#include "client/report/marker_warnings.h"
#include "files/base/text.h"
#include "files/formats/bed.h"
#include "files/formats/derived/mesh_parts.h"
#include "files/formats/derived/renumbered_mesh.h"
#include "files/formats/mesh_formats.h"
#include "wire/marker_options.h"

namespace weft::client {
namespace {

// Checks that the files exist before a mesh is made.
Result<void> check_nodal(const MeshOutputOptions& options) {
  for (const NodalOption& option : options.writing.nodal)
    for (const auto& source : option.sources)
      if (const auto* raster = std::get_if<RasterPath>(&source))
        if (auto found = must_be_raster_file(raster->file); !found) return found;
  return {};
}

bool has_open_boundaries(const DataPath& file) {
  return mesh_format(file)->open_boundaries;
}

tl::unexpected<Error> no_depths(const MeshWriteOptions& writing) {
  return fail(ExitCode::kUsage, "--open-boundary deeper:" + shortest(*writing.open_deeper) +
                                    " needs the depths at the vertices: give --nodal depth=FILE");
}

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
  if (options.writing.opens_boundaries() &&
      std::none_of(options.files.begin(), options.files.end(), has_open_boundaries))
    return fail(ExitCode::kUsage,
                "--open-boundary is for ADCIRC and SCHISM: give an output .14, .grd or .gr3");
  const auto& nodal = options.writing.nodal;
  if (options.writing.open_deeper && !options.has_values &&
      std::none_of(nodal.begin(), nodal.end(),
                   [](const NodalOption& option) { return Bed::is_bed(option.name); }))
    return no_depths(options.writing);
  if (options.writing.msh_version != MshVersion::k41 && !writes({".msh"}))
    return fail(ExitCode::kUsage, "--msh-version is for Gmsh: give an output .msh");
  if (auto ok = check_nodal(options); !ok) return ok;
  if (options.writing.parts)
    if (auto ok = check_can_divide(); !ok) return ok;
  if (!options.drawings.empty())
    if (auto ok = load_cairo(); !ok) return ok;
  if (!options.drawings.empty() && options.drawing.color == DrawColor::kBound &&
      !options.area_bound)
    return fail(ExitCode::kUsage,
                "--color bound needs the bounds: draw the mesh by `weft draw MESH --color bound "
                "--size EXPR`");
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

// Opens all files of the outputs, then the drawings, in the order of the options.
Result<std::vector<OutputFile>> open_files(const MeshOutputOptions& options,
                                           const std::stop_token& stop) {
  std::vector<OutputFile> files;
  const auto open = [&](const std::filesystem::path& name, bool in_own_folder) -> Result<void> {
    auto file = OutputFile::create(
        name, stop,
        options.make_folders || in_own_folder ? MissingFolders::kMake : MissingFolders::kRefuse);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
    return {};
  };
  for (const auto& output : options.files)
    for (const auto& file : mesh_files(output))
      if (auto opened = open(file, file.parent_path() != output.parent_path()); !opened)
        return tl::unexpected(opened.error());
  for (const auto& drawing : options.drawings)
    if (auto opened = open(drawing, false); !opened) return tl::unexpected(opened.error());
  return files;
}

std::string parts_text(const MeshParts& parts, std::uint32_t count) {
  return "parts " + with_separators(count) + ", of " + with_separators(parts.least) + " to " +
         with_separators(parts.most) + " triangles, " + with_separators(parts.cut) +
         " edges between them\n";
}

// What a drawing of the quadtree shows, or why it shows none.
std::string quadtree_text(const v1::Summary& summary) {
  if (summary.leaves() == 0) return "no quadtree to draw: one task refined the mesh\n";
  const std::string leaves = "quadtree of " + with_separators(summary.leaves()) +
                             (summary.leaves() == 1 ? " leaf" : " leaves");
  return leaves + (summary.leaf_boxes().empty() ? ", too many to be drawn\n" : "\n");
}

}  // namespace

std::FILE* MeshOutputOptions::text_stream() const {
  return std::ranges::find(files, DataPath(kStandardOutput)) == files.end() ? stdout : stderr;
}

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
  drawing_ = std::make_unique<Drawing>(options_.drawing, options_.area_bound);
}

Result<std::unique_ptr<MeshSpool>> MeshOutput::make_spool() {
  MeshSpoolOptions options{.vertices_only = options_.files.empty(), .on_piece = {}, .stop = stop_};
  if (drawing_ || other_drawing_ != nullptr)
    options.on_piece = [drawings =
                            std::array{drawing_.get(), other_drawing_}](const MeshView& piece) {
      for (Drawing* const drawing : drawings)
        if (drawing != nullptr) drawing->add(piece);
    };
  return MeshSpool::create(files_.front().folder(), std::move(options));
}

Result<void> MeshOutput::find_markers(const NameTable& markers,
                                      std::span<const std::int32_t> open_in_file) {
  return find_open_boundaries(options_.writing, markers, open_in_file);
}

void MeshOutput::set_periodic(const v1::Quality& quality) {
  options_.writing.periodic = wire::periodic_sides(quality);
}

Result<void> MeshOutput::set_domain(const Domain& domain,
                                    std::shared_ptr<const DomainProjection> projection) {
  projection_ = std::move(projection);
  plane_ = {projection_ ? projection_->name() : "", projection_ ? std::nullopt : domain.system};
  if (domain.points.empty()) return {};
  const auto [west, east] = std::ranges::minmax_element(domain.points, {}, &Point::x);
  const auto [south, north] = std::ranges::minmax_element(domain.points, {}, &Point::y);
  for (const NodalOption& option : options_.writing.nodal)
    if (auto ok = check_nodal_sources(option, {west->x, south->y, east->x, north->y}, plane_); !ok)
      return ok;
  return {};
}

Result<void> MeshOutput::write(const MeshView& arrived, const v1::Summary& summary) {
  if (!options_.files.empty())
    if (auto written = write_files(arrived); !written) return written;
  std::span<OutputFile> drawings(files_);
  drawings = drawings.last(options_.drawings.size());
  if (drawing_) drawing_->name_regions(arrived.names->regions);
  std::span<const double> leaves;
  if (options_.draw_quadtree)
    leaves = {summary.leaf_boxes().data(), static_cast<std::size_t>(summary.leaf_boxes_size())};
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    if (auto drawn = drawing_->draw(*draw_format(options_.drawings[i]), leaves, drawings[i]);
        !drawn)
      return drawn;
  }
  return commit(files_);
}

Result<MeshView> MeshOutput::opened(const MeshView& mesh, std::optional<DeepBoundary>& deep) {
  const MeshWriteOptions& writing = options_.writing;
  if (!writing.open_deeper) return mesh;
  if (!Bed(mesh).is_known()) return no_depths(writing);
  deep = deep_boundary(mesh, *writing.open_deeper, writing.open_boundaries);
  for (std::string& warning : deep_boundary_warnings(*deep, *writing.open_deeper))
    warnings_.push_back(std::move(warning));
  MeshView view = mesh;
  view.edges = deep->edges;
  view.edge_markers = deep->markers;
  return view;
}

Result<void> MeshOutput::write_files(const MeshView& arrived) try {
  MeshView plane = arrived;  // as the values are sampled
  std::optional<RenumberedMesh> renumbered;
  if (options_.writing.renumbering == Renumbering::kReverseCuthillMcKee) {
    renumbered.emplace(arrived);
    plane = renumbered->view();
    text_ += "bandwidth " + with_separators(renumbered->bandwidth_before()) + ", " +
             with_separators(renumbered->bandwidth()) + " once renumbered\n";
  }
  MeshParts parts;
  if (options_.writing.parts) {
    auto divided = divide(plane, *options_.writing.parts);
    if (!divided) return tl::unexpected(divided.error());
    parts = std::move(*divided);
    text_ += parts_text(parts, *options_.writing.parts);
  }
  MeshView mesh = plane;
  if (options_.writing.parts) mesh.parts = parts.of;
  ScratchArray<double> lonlat;
  if (projection_) mesh.unit = CoordinateUnit::kMetres;
  if (projection_ && !projection_->to_metres()) {
    auto brought = projection_->to_lonlat(mesh);
    if (!brought) return tl::unexpected(brought.error());
    lonlat = std::move(*brought);
    mesh.coordinates = lonlat.values();
    mesh.unit = CoordinateUnit::kDegrees;
  }
  std::vector<SampledValues> sampled;
  std::vector<VertexValues> vertex_values(plane.vertex_values.begin(), plane.vertex_values.end());
  for (const NodalOption& option : options_.writing.nodal) {
    auto values = sample_nodal(option, plane, plane_, mesh.coordinates);
    if (!values) return tl::unexpected(values.error());
    warnings_.insert(warnings_.end(), values->warnings.begin(), values->warnings.end());
    vertex_values.push_back({option.name, values->values.values()});
    sampled.push_back(std::move(*values));
  }
  mesh.vertex_values = vertex_values;
  std::optional<DeepBoundary> deep;
  const auto opened_mesh = opened(mesh, deep);
  if (!opened_mesh) return tl::unexpected(opened_mesh.error());
  MeshWriteOptions writing = options_.writing;
  if (deep) writing.open_boundaries.push_back(deep->marker);
  std::span<OutputFile> rest = files_;
  for (const auto& name : options_.files) {
    const std::size_t count = mesh_files(name).size();
    const std::size_t straight =
        write_mesh(*mesh_format(name), has_open_boundaries(name) ? *opened_mesh : mesh,
                   rest.first(count), writing);
    if (straight > 0)
      warnings_.push_back(name.string() + ": " + with_separators(straight) +
                          (straight == 1 ? " side on an arc is" : " sides on arcs are") +
                          " straight, because a triangle would turn over");
    rest = rest.subspan(count);
    const auto lost = not_carried(name, mesh);
    warnings_.insert(warnings_.end(), lost.begin(), lost.end());
  }
  return {};
} catch (const std::system_error& failure) {
  return fail(ExitCode::kUnwritableOutput,
              std::string("the mesh cannot be written: ") + failure.code().message());
} catch (const std::bad_alloc&) {
  return fail(ExitCode::kUnwritableOutput, "the mesh cannot be written: not enough memory");
}

std::string MeshOutput::text(const v1::Summary& summary) const {
  std::string text = text_ + (options_.draw_quadtree ? quadtree_text(summary) : "");
  std::size_t rank = 0;
  for (const WorstTriangle& worst : drawing_ ? drawing_->worst() : std::vector<WorstTriangle>()) {
    const Point at = centroid(worst.triangle);
    char angle[32];
    std::snprintf(angle, sizeof angle, "%.2f", worst.angle_deg);
    text += "worst " + std::to_string(++rank) + ": " + angle + " degrees, triangle " +
            std::to_string(worst.triangle.id) + " at " + coordinates(at.x, at.y) + "\n";
  }
  for (const OutputFile& file : files_) {
    text += "wrote " + file.target().string() + ", " + bytes_text(file.size()) + "\n";
  }
  return text;
}

}  // namespace weft::client
