// SPDX-License-Identifier: Apache-2.0
#include "client/commands/checker_input.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "files/base/text.h"

namespace weft::client {
namespace {

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
  spec.gradation_within = size.gradation_within();
  for (const v1::SizeAt& at : size.at()) spec.at.push_back({at.marker(), at.max_edge()});
  return spec;
}

}  // namespace

Result<check::SizeSpec> checker_size(const RequestOptions& options, const Domain& domain,
                                     const DomainProjection* projection) {
  const auto read = with_size(options, domain, projection);
  if (!read) return tl::unexpected(read.error());
  const v1::SizeField& size = read->asked.size();
  const std::string& text = options.edge.empty() ? options.size : options.edge;
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  // No area exceeds NaN or infinity, so the check could never fail.
  if (!text.empty() && stop == end && problem != std::errc::invalid_argument &&
      !(problem == std::errc() && std::isfinite(number) && number > 0))
    return fail(ExitCode::kUsage, (options.edge.empty() ? "--size is " : "--edge is ") + text +
                                      "; it must be positive and finite");
  return to_checker(size);
}

}  // namespace weft::client
