// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_request.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "client/call/request_rows.h"
#include "files/formats/field_raster.h"
#include "files/formats/raster.h"
#include "files/message/domain_message.h"

namespace weft::client {
namespace {

// The value of a text that is nothing but a finite number.
std::optional<double> as_number(const std::string& text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

v1::SizeField to_size(const std::string& text) {
  v1::SizeField size;
  if (const auto constant = as_number(text))
    size.set_constant(*constant);
  else if (!text.empty())
    size.set_expression(text);
  return size;
}

Result<v1::SizeField> read_size(const std::string& text) {
  if (!is_raster_path(text)) return to_size(text);
  const auto raster = read_raster(text);
  if (!raster) return tl::unexpected(raster.error());
  v1::SizeField size;
  v1::Raster& out = *size.mutable_raster();
  out.set_x(raster->x);
  out.set_y(raster->y);
  out.set_dx(raster->dx);
  out.set_dy(raster->dy);
  out.set_columns(raster->columns);
  out.set_rows(raster->rows);
  out.mutable_values()->Add(raster->values.begin(), raster->values.end());
  return size;
}

// The error about what the request has at `field`, with the option that set it.
tl::unexpected<Error> fault_at(const std::string& field, const RequestOptions& options,
                               const Error& error) {
  const std::string option = option_of(field, options);
  return fail(error.exit, (option.empty() ? "" : option + ": ") + error.message);
}

// Adds the fields to the size, and what there is to say of them to the warnings. Rasters share the
// limit of a server: false, and not all are there, if they have more values together; each has
// `most` at most.
Result<bool> fill_fields(const Domain& domain, const DomainProjection* projection,
                         std::uint64_t most, RequestOptions& options, v1::SizeField& size) {
  std::uint64_t values = 0;
  for (const FieldOption& field : options.fields) {
    const std::string path = "size.fields[" + std::to_string(size.fields_size()) + "]";
    v1::NamedField& filled = *size.add_fields();
    auto warnings = fill(field, domain, projection, most, filled);
    if (!warnings) return fault_at(path, options, warnings.error());
    std::move(warnings->begin(), warnings->end(), std::back_inserter(options.warnings));
    values += static_cast<std::uint64_t>(filled.raster().values_size());
    if (values > kMaxFieldValues) return false;
  }
  return true;
}

}  // namespace

Result<RequestOptions> with_size(const RequestOptions& given, const Domain& domain,
                                 const DomainProjection* projection) {
  RequestOptions options = given;
  const bool by_edge = !options.edge.empty();
  if (by_edge && !options.size.empty())
    return fail(ExitCode::kUsage,
                "--size and --edge exclude each other: give the area of triangles or the length of "
                "edges");
  auto size = read_size(by_edge ? options.edge : options.size);
  if (!size) return fault_at("size", options, size.error());
  if (by_edge) size->set_measure(v1::MEASURE_EDGE);
  size->MergeFrom(given.asked.size());
  const auto rasters = std::count_if(
      options.fields.begin(), options.fields.end(),
      [](const auto& field) { return std::holds_alternative<FieldOption::Raster>(field.kind); });
  const auto sharers = static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(rasters, 1));
  for (const std::uint64_t most : {kMaxFieldValues, kMaxFieldValues / sharers}) {
    size->clear_fields();
    options.warnings = given.warnings;
    auto fits = fill_fields(domain, projection, most, options, *size);
    if (!fits) return tl::unexpected(fits.error());
    if (*fits) break;
  }
  if (size->ByteSizeLong() != 0) *options.asked.mutable_size() = std::move(*size);
  if (const auto fault = fill(options.markers, domain.names.markers, options.asked))
    return fault_at(fault->field, options, fault->error);
  return options;
}

Result<void> check_sendable(const Domain& domain) {
  // A message of gRPC ends at 2 GiB.
  constexpr std::size_t kMaxPoints = std::size_t{1} << 26;
  if (domain.points.size() <= kMaxPoints && domain.segments.size() <= kMaxPoints) return {};
  return fail(ExitCode::kUnreadableInput,
              "the domain has " + std::to_string(domain.points.size()) + " points and " +
                  std::to_string(domain.segments.size()) + " segments, a request takes " +
                  std::to_string(kMaxPoints) + " of each");
}

Names names_of(const v1::Domain& domain) {
  NameReader names("the server");
  for (const v1::Name& name : domain.marker_names())
    names.add(NameKind::kMarker, name.id(), name.name());
  for (const v1::Name& name : domain.region_names())
    names.add(NameKind::kRegion, name.id(), name.name());
  return names.take();
}

v1::GenerateMeshRequest make_request(const Domain& domain, const RequestOptions& request_options) {
  v1::GenerateMeshRequest request = request_options.asked;
  const v1::Domain asked = request.domain();  // its `snap`
  request.mutable_domain()->ParseFromString(domain_message(domain));
  request.mutable_domain()->MergeFrom(asked);
  if (!request_options.size.empty() && request.size().field_case() == v1::SizeField::FIELD_NOT_SET)
    request.mutable_size()->MergeFrom(to_size(request_options.size));
  return request;
}

}  // namespace weft::client
