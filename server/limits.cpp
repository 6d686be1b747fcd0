// SPDX-License-Identifier: Apache-2.0
#include "server/limits.h"

#include <fmt/format.h>

#include <string_view>

namespace weft::server {
namespace {

template <class Number>
std::optional<Failure> over(std::string_view field, std::string_view unit, Number value,
                            Number limit) {
  if (value <= limit) return std::nullopt;
  return Failure{Reason::kLimitExceeded, std::string(field),
                 fmt::format("{}: {} {}; this server's limit is {}", field, value, unit, limit)};
}

}  // namespace

std::optional<Failure> check_seed_count(std::uint64_t seeds, const Limits& limits) {
  if (seeds <= limits.max_seeds) return std::nullopt;
  return Failure{Reason::kLimitExceeded, "domain.regions",
                 fmt::format("the domain has {} hole and region seeds; this server's limit is {}",
                             seeds, limits.max_seeds)};
}

std::optional<Failure> check_limits(const v1::GenerateMeshRequest& request, const Limits& limits) {
  const v1::Domain& domain = request.domain();
  const v1::Budget& budget = request.budget();
  const auto count = [](int size, int width) { return static_cast<std::uint64_t>(size / width); };

  if (auto f = over("domain.points", "points", count(domain.points_size(), 2), limits.max_points))
    return f;
  if (auto f = over("domain.segments", "segments", count(domain.segments_size(), 2),
                    limits.max_segments))
    return f;
  if (auto f =
          check_seed_count(count(domain.holes_size(), 2) + count(domain.regions_size(), 1), limits))
    return f;
  if (auto f = over("size.expression", "bytes", std::uint64_t{request.size().expression().size()},
                    limits.max_expression_bytes))
    return f;
  if (auto f = over("size.raster.values", "values", count(request.size().raster().values_size(), 1),
                    limits.max_raster_values))
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
