// SPDX-License-Identifier: Apache-2.0
#include "client/mesh_request.h"

#include <charconv>
#include <cmath>
#include <string>
#include <utility>

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

void fill(const Domain& domain, v1::Domain& out) {
  auto* points = out.mutable_points();
  points->Reserve(static_cast<int>(2 * domain.points.size()));
  for (const Point& point : domain.points) {
    points->AddAlreadyReserved(point.x);
    points->AddAlreadyReserved(point.y);
  }
  bool marked = false;
  auto* segments = out.mutable_segments();
  segments->Reserve(static_cast<int>(2 * domain.segments.size()));
  for (const Domain::Segment& segment : domain.segments) {
    segments->AddAlreadyReserved(segment.a);
    segments->AddAlreadyReserved(segment.b);
    marked |= segment.marker != 0;
  }
  if (marked)
    for (const Domain::Segment& segment : domain.segments) out.add_segment_markers(segment.marker);
  for (const Point& hole : domain.holes) {
    out.add_holes(hole.x);
    out.add_holes(hole.y);
  }
  for (const Domain::Region& region : domain.regions) {
    v1::Region& seed = *out.add_regions();
    seed.set_x(region.at.x);
    seed.set_y(region.at.y);
    seed.set_id(region.id);
    if (region.max_area) seed.set_max_area(*region.max_area);
  }
  out.set_fill(domain.fill == Domain::Fill::kEvenOdd ? v1::FILL_EVEN_ODD : v1::FILL_SEEDS);
}

void fill(const SizeGrid& grid, v1::Raster& out) {
  out.set_x(grid.x);
  out.set_y(grid.y);
  out.set_dx(grid.dx);
  out.set_dy(grid.dy);
  out.set_columns(grid.columns);
  out.set_rows(grid.rows);
  out.mutable_values()->Add(grid.values.begin(), grid.values.end());
}

}  // namespace

Result<MeshWishes> with_size_grid(MeshWishes wishes) {
  if (!is_size_grid_path(wishes.size)) return wishes;
  auto grid = read_size_grid(wishes.size);
  if (!grid) return tl::unexpected(grid.error());
  wishes.size_grid = std::make_shared<const SizeGrid>(std::move(*grid));
  return wishes;
}

Result<void> check_sendable(const Domain& domain) {
  // A message of gRPC ends at 2 GiB.
  constexpr std::size_t kMostPoints = std::size_t{1} << 26;
  if (domain.points.size() <= kMostPoints && domain.segments.size() <= kMostPoints) return {};
  return fail(ExitCode::kUnreadableInput,
              "the domain has " + std::to_string(domain.points.size()) + " points and " +
                  std::to_string(domain.segments.size()) + " segments, a request takes " +
                  std::to_string(kMostPoints) + " of each");
}

v1::GenerateMeshRequest make_request(const Domain& domain, const MeshWishes& wishes) {
  v1::GenerateMeshRequest request;
  fill(domain, *request.mutable_domain());
  if (wishes.size_grid) {
    fill(*wishes.size_grid, *request.mutable_size()->mutable_raster());
  } else if (const auto constant = as_number(wishes.size)) {
    request.mutable_size()->set_constant(*constant);
  } else if (!wishes.size.empty()) {
    request.mutable_size()->set_expression(wishes.size);
  }
  if (wishes.min_angle_deg) request.mutable_quality()->set_min_angle_deg(*wishes.min_angle_deg);
  if (wishes.min_edge) request.mutable_quality()->set_min_edge(*wishes.min_edge);
  if (wishes.placement) request.mutable_quality()->set_placement(*wishes.placement);
  if (wishes.optimise) request.mutable_quality()->set_optimise(*wishes.optimise);
  if (wishes.max_triangles) request.mutable_budget()->set_max_triangles(*wishes.max_triangles);
  if (wishes.max_seconds) request.mutable_budget()->set_max_seconds(*wishes.max_seconds);
  if (wishes.threads) request.set_threads(*wishes.threads);
  if (wishes.snap) request.mutable_domain()->set_snap(*wishes.snap);
  request.set_allow_unrefined(wishes.allow_unrefined);
  request.set_want_quadtree(wishes.quadtree);
  request.set_no_cache(wishes.no_cache);
  return request;
}

}  // namespace weft::client
