// SPDX-License-Identifier: Apache-2.0
// `weft check`: the independent checker judges a mesh file.
#include "checker/check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "client/base/text.h"
#include "client/call/mesh_request.h"
#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/formats/mesh_formats.h"

namespace weft::client {
namespace {

check::Domain to_checker(const Domain& domain, double snap) {
  check::Domain out;
  for (const Point& point : domain.points) out.points.push_back({point.x, point.y});
  for (const Domain::Segment& segment : domain.segments) {
    out.segments.push_back({segment.a, segment.b});
    out.markers.push_back(segment.marker);
  }
  for (const Point& hole : domain.holes) out.holes.push_back({hole.x, hole.y});
  for (const Domain::Region& region : domain.regions)
    out.regions.push_back({{region.at.x, region.at.y}, region.id, region.max_area});
  out.fill = domain.fill == Domain::Fill::kEvenOdd ? check::Fill::kEvenOdd : check::Fill::kSeeds;
  out.snap = snap;
  return out;
}

check::Mesh to_checker(const Mesh& mesh) {
  check::Mesh out;
  out.vertices.reserve(mesh.coordinates.size() / 2);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    out.vertices.push_back({mesh.coordinates[i], mesh.coordinates[i + 1]});
  out.triangles.reserve(mesh.triangles.size() / 3);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    out.triangles.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  out.regions = mesh.regions;
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e)
    out.edges.push_back({mesh.edges[2 * e], mesh.edges[2 * e + 1], mesh.edge_markers[e]});
  return out;
}

std::vector<check::Vec2> to_points(const google::protobuf::RepeatedField<double>& pairs) {
  std::vector<check::Vec2> points;
  for (int i = 0; i + 1 < pairs.size(); i += 2) points.push_back({pairs[i], pairs[i + 1]});
  return points;
}

template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> to_rows(
    const google::protobuf::RepeatedField<std::uint32_t>& numbers) {
  std::vector<std::array<std::uint32_t, N>> rows(static_cast<std::size_t>(numbers.size()) / N);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::copy_n(numbers.data() + N * i, N, rows[i].begin());
  return rows;
}

// Of a check::Raster or a check::RasterField.
template <class To, class From>
To to_grid(const From& raster) {
  return {
      {raster.x(), raster.y()}, raster.dx(),   raster.dy(),
      raster.columns(),         raster.rows(), {raster.values().begin(), raster.values().end()}};
}

check::NamedField to_checker(const v1::NamedField& field) {
  if (field.has_raster()) return {field.name(), to_grid<check::RasterField>(field.raster())};
  if (field.has_mesh())
    return {field.name(),
            check::MeshField{to_points(field.mesh().vertices()),
                             to_rows<3>(field.mesh().triangles()),
                             {field.mesh().values().begin(), field.mesh().values().end()}}};
  if (field.has_width()) return {field.name(), check::WidthField{}};
  const v1::Distance& distance = field.distance();
  return {field.name(), check::DistanceField{{distance.markers().begin(), distance.markers().end()},
                                             to_points(distance.points()),
                                             to_rows<2>(distance.segments())}};
}

check::SizeSpec to_checker(const v1::SizeField& size) {
  check::SizeSpec spec;
  if (size.has_constant()) spec.value = size.constant();
  if (size.has_expression()) spec.value = size.expression();
  if (size.has_raster()) spec.value = to_grid<check::Raster>(size.raster());
  if (size.measure() == v1::MEASURE_EDGE) spec.measure = check::Measure::kEdge;
  for (const v1::NamedField& field : size.fields()) spec.fields.push_back(to_checker(field));
  spec.gradation = size.gradation();
  for (const v1::SizeAt& at : size.at()) spec.at.push_back({at.marker(), at.max_edge()});
  return spec;
}

// Errors: kUsage for a constant that no triangle can fail.
Result<check::SizeSpec> read_size(const RequestOptions& options, const InputDomain& input) {
  const auto read = with_size(options, input.domain, input.projection.get());
  if (!read) return tl::unexpected(read.error());
  const v1::SizeField& size = *read->size_read;
  const std::string& text = options.edge.empty() ? options.size : options.edge;
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  // No area exceeds NaN or infinity: the check could not fail.
  if (!text.empty() && stop == end && problem != std::errc::invalid_argument &&
      !(problem == std::errc() && std::isfinite(number) && number > 0))
    return fail(ExitCode::kUsage, (options.edge.empty() ? "--size is " : "--edge is ") + text +
                                      "; it must be positive and finite");
  return to_checker(size);
}

}  // namespace

Result<ExitCode> run_check(const CheckOptions& options) {
  if (options.snap && !(std::isfinite(*options.snap) && *options.snap >= 0))
    return fail(ExitCode::kUsage,
                "--snap is " + shortest(*options.snap) + "; it must be finite and 0 or more");
  if (options.projection.wanted() && !options.projection.to_metres)
    return fail(ExitCode::kUsage,
                "a mesh is checked in the plane that it was made in: write it with --to-metres, "
                "and say --to-metres here, too");
  const auto input = read_input_domain(options.domain, options.size, options.projection);
  if (!input) return tl::unexpected(input.error());
  const auto mesh = read_mesh(options.mesh);
  if (!mesh) return tl::unexpected(mesh.error());
  check::Requirements requirements;
  requirements.min_angle_deg = options.min_angle_deg;
  requirements.allowed_unrefined = options.max_unrefined;
  auto size = read_size(options.size, *input);
  if (!size) return tl::unexpected(size.error());
  requirements.size = std::move(*size);
  const check::Report report = check::check(to_checker(input->domain, options.snap.value_or(0)),
                                            to_checker(*mesh), requirements);
  const auto printed =
      print(check::to_text(report) + (report.ok() ? "the mesh holds\n" : "the mesh fails\n"));
  if (!printed) return printed;
  return report.ok() ? ExitCode::kOk : ExitCode::kCheckFailed;
}

}  // namespace weft::client
