// SPDX-License-Identifier: Apache-2.0
#include "server/wire/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "server/wire/names.h"
#include "weft/weft.h"

namespace weft::server {
namespace {

template <class Number>
std::optional<Failure> over(std::string_view field, std::string_view unit, Number value,
                            Number limit) {
  if (value <= limit) return std::nullopt;
  return Failure{Reason::kLimitExceeded, std::string(field),
                 fmt::format("{}: {} {}; this server's limit is {}", field, value, unit, limit)};
}

// Counts of what takes memory.
struct Amounts {
  std::uint64_t points = 0;
  std::uint64_t segments = 0;
  std::uint64_t markers = 0;
  std::uint64_t borders = 0;  // segments' areas
  std::uint64_t arcs = 0;     // segments' numbers or bulges, whichever are more
  std::uint64_t seeds = 0;
  std::uint64_t names = 0;
  std::uint64_t expression_bytes = 0;
  std::uint64_t raster_values = 0;
  std::uint64_t sizes_at = 0;
  std::uint64_t kept = 0;      // markers of segments
  std::uint64_t periodic = 0;  // pairs of sides
  std::uint64_t layers = 0;
  std::uint64_t sample_points = 0;
  // Summed over all fields that the size may name.
  std::uint64_t fields = 0;
  std::uint64_t field_points = 0;
  std::uint64_t field_segments = 0;
  std::uint64_t field_markers = 0;
  std::uint64_t field_triangles = 0;
  std::uint64_t field_values = 0;
};

std::optional<Failure> check(const Amounts& amounts, const Limits& limits) {
  if (auto f = over("domain.points", "points", amounts.points, limits.max_points)) return f;
  if (auto f = over("domain.segments", "segments", amounts.segments, limits.max_segments)) return f;
  if (auto f = over("domain.segment_markers", "markers", amounts.markers, limits.max_segments))
    return f;
  if (auto f = over("domain.segment_areas", "areas", amounts.borders, limits.max_segments))
    return f;
  if (auto f = over("domain.arc_segments", "arcs", amounts.arcs, limits.max_segments)) return f;
  if (amounts.seeds > limits.max_seeds)
    return Failure{Reason::kLimitExceeded, "domain.regions",
                   fmt::format("the domain has {} hole and region seeds and areas; this server's "
                               "limit is {}",
                               amounts.seeds, limits.max_seeds)};
  if (auto f =
          over("domain.marker_names", "names of markers and regions", amounts.names, kMaxNames))
    return f;
  if (auto f =
          over("size.expression", "bytes", amounts.expression_bytes, limits.max_expression_bytes))
    return f;
  if (auto f =
          over("size.raster.values", "values", amounts.raster_values, limits.max_raster_values))
    return f;
  if (auto f = over("size.at", "markers", amounts.sizes_at, std::uint64_t{kMaxSizesAt})) return f;
  if (auto f =
          over("quality.keep.markers", "markers", amounts.kept, std::uint64_t{kMaxKeptMarkers}))
    return f;
  if (auto f = over("quality.periodic", "pairs of sides", amounts.periodic,
                    std::uint64_t{kMaxPeriodicPairs}))
    return f;
  if (auto f = over("quality.layers", "layers", amounts.layers, std::uint64_t{kMaxLayers}))
    return f;
  if (auto f =
          over("sample_points", "points", amounts.sample_points, std::uint64_t{kMaxSamplePoints}))
    return f;
  const auto of_fields = [](std::string_view unit, std::uint64_t value, std::uint64_t limit) {
    return over("size.fields", unit, value, limit);
  };
  if (auto f = of_fields("fields", amounts.fields, kMaxSizeFields)) return f;
  if (auto f = of_fields("points", amounts.field_points, limits.max_points)) return f;
  if (auto f = of_fields("segments", amounts.field_segments, limits.max_segments)) return f;
  if (auto f = of_fields("markers", amounts.field_markers, limits.max_segments)) return f;
  // A triangulation has at most twice as many triangles as points.
  if (auto f = of_fields("triangles", amounts.field_triangles, 2 * limits.max_points)) return f;
  return of_fields("raster values", amounts.field_values, limits.max_raster_values);
}

}  // namespace

std::optional<Failure> check_limits(const WireScan& scan, const Limits& limits) {
  const auto of_domain = [&](int field) { return scan.count(*v1::Domain::descriptor(), field); };
  const Amounts amounts{
      .points = of_domain(v1::Domain::kPointsFieldNumber) / 2,
      .segments = of_domain(v1::Domain::kSegmentsFieldNumber) / 2,
      .markers = of_domain(v1::Domain::kSegmentMarkersFieldNumber),
      .borders = of_domain(v1::Domain::kSegmentAreasFieldNumber),
      .arcs = std::max(of_domain(v1::Domain::kArcSegmentsFieldNumber),
                       of_domain(v1::Domain::kArcBulgesFieldNumber)),
      .seeds = of_domain(v1::Domain::kHolesFieldNumber) / 2 +
               of_domain(v1::Domain::kRegionsFieldNumber) +
               of_domain(v1::Domain::kAreasFieldNumber),
      .names = of_domain(v1::Domain::kMarkerNamesFieldNumber) +
               of_domain(v1::Domain::kRegionNamesFieldNumber),
      .expression_bytes =
          scan.count(*v1::SizeField::descriptor(), v1::SizeField::kExpressionFieldNumber),
      .raster_values = scan.count(*v1::Raster::descriptor(), v1::Raster::kValuesFieldNumber),
      .sizes_at = scan.count(*v1::SizeField::descriptor(), v1::SizeField::kAtFieldNumber),
      .kept = scan.count(*v1::Keep::descriptor(), v1::Keep::kMarkersFieldNumber),
      .periodic = scan.count(*v1::Quality::descriptor(), v1::Quality::kPeriodicFieldNumber),
      .layers = scan.count(*v1::Quality::descriptor(), v1::Quality::kLayersFieldNumber),
      .sample_points = scan.count(*v1::GenerateMeshRequest::descriptor(),
                                  v1::GenerateMeshRequest::kSamplePointsFieldNumber) /
                       2,
      .fields = scan.count(*v1::SizeField::descriptor(), v1::SizeField::kFieldsFieldNumber),
      .field_points =
          scan.count(*v1::Distance::descriptor(), v1::Distance::kPointsFieldNumber) / 2 +
          scan.count(*v1::FieldMesh::descriptor(), v1::FieldMesh::kVerticesFieldNumber) / 2,
      .field_segments =
          scan.count(*v1::Distance::descriptor(), v1::Distance::kSegmentsFieldNumber) / 2,
      .field_markers = scan.count(*v1::Distance::descriptor(), v1::Distance::kMarkersFieldNumber),
      .field_triangles =
          scan.count(*v1::FieldMesh::descriptor(), v1::FieldMesh::kTrianglesFieldNumber) / 3,
      .field_values =
          scan.count(*v1::FieldRaster::descriptor(), v1::FieldRaster::kValuesFieldNumber)};
  return check(amounts, limits);
}

std::optional<Failure> check_limits(const v1::GenerateMeshRequest& request, const Limits& limits) {
  const v1::Domain& domain = request.domain();
  const v1::Budget& budget = request.budget();
  const auto count = [](int size, int width) { return static_cast<std::uint64_t>(size / width); };
  Amounts amounts{
      .points = count(domain.points_size(), 2),
      .segments = count(domain.segments_size(), 2),
      .markers = count(domain.segment_markers_size(), 1),
      .borders = count(domain.segment_areas_size(), 1),
      .arcs = std::max(count(domain.arc_segments_size(), 1), count(domain.arc_bulges_size(), 1)),
      .seeds = count(domain.holes_size(), 2) + count(domain.regions_size(), 1) +
               count(domain.areas_size(), 1),
      .names = count(domain.marker_names_size(), 1) + count(domain.region_names_size(), 1),
      .expression_bytes = request.size().expression().size(),
      .raster_values = count(request.size().raster().values_size(), 1),
      .sizes_at = count(request.size().at_size(), 1),
      .kept = count(request.quality().keep().markers_size(), 1),
      .periodic = count(request.quality().periodic_size(), 1),
      .layers = count(request.quality().layers_size(), 1),
      .sample_points = count(request.sample_points_size(), 2)};
  for (const v1::NamedField& field : request.size().fields()) {
    amounts.fields += 1;
    amounts.field_points += count(field.distance().points_size(), 2);
    amounts.field_points += count(field.mesh().vertices_size(), 2);
    amounts.field_segments += count(field.distance().segments_size(), 2);
    amounts.field_markers += count(field.distance().markers_size(), 1);
    amounts.field_triangles += count(field.mesh().triangles_size(), 3);
    amounts.field_values += count(field.raster().values_size(), 1);
  }
  if (auto f = check(amounts, limits)) return f;
  if (auto f = over("domain.marker_names", "bytes of names of markers and regions",
                    name_bytes(domain), kMaxNameBytes))
    return f;
  if (auto f = over("budget.max_triangles", "triangles", std::uint64_t{budget.max_triangles()},
                    limits.max_triangles))
    return f;
  if (auto f =
          over("budget.max_bytes", "bytes", std::uint64_t{budget.max_bytes()}, limits.max_bytes))
    return f;
  return over("budget.max_seconds", "seconds", budget.max_seconds(), limits.max_seconds);
}

}  // namespace weft::server
