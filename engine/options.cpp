// SPDX-License-Identifier: Apache-2.0
#include "engine/options.h"

#include <cmath>
#include <string>
#include <utility>

#include "engine/base/text.h"

namespace weft {
namespace {

std::optional<Error> check_bounds(const MeshRequest& request) {
  const auto bad = [](const std::string& field, const std::string& value, const char* range) {
    return Error{ErrorCode::kBadOption, field, field + " is " + value + "; it must be " + range};
  };
  if (!(request.min_angle_deg >= 0 && request.min_angle_deg <= kMaxMinAngleDeg)) {
    const std::string range = "from 0 to " + text(kMaxMinAngleDeg) + " degrees";
    return bad("quality.min_angle_deg", text(request.min_angle_deg), range.c_str());
  }
  if (!(request.min_edge >= 0 && std::isfinite(request.min_edge)))
    return bad("quality.min_edge", text(request.min_edge), "0 or more, and finite");
  if (request.sweeps.value_or(0) > kMaxSweeps) {
    const std::string range = "from 0 to " + std::to_string(kMaxSweeps) + " sweeps";
    return bad("quality.optimise", std::to_string(*request.sweeps), range.c_str());
  }
  if (request.size.constant.has_value() + request.size.expression.has_value() +
          request.size.raster.has_value() >
      1) {
    return Error{ErrorCode::kBadOption, "size",
                 "the size is more than one of a constant, an expression and a raster"};
  }
  return std::nullopt;
}

// The size that is the same everywhere.
std::optional<Error> check_size(double value, const char* field) {
  if (value > 0 && std::isfinite(value)) return std::nullopt;
  return Error{ErrorCode::kBadSizeValue, field,
               "the size is " + text(value) + "; it must be positive and finite"};
}

}  // namespace

Result<std::optional<Expression>> read_options(const MeshRequest& request) {
  if (auto error = check_bounds(request)) return tl::unexpected(*error);
  if (request.size.constant) {
    if (auto error = check_size(*request.size.constant, "size.constant"))
      return tl::unexpected(*error);
  }
  if (!request.size.expression) return std::nullopt;
  auto expression = Expression::parse(*request.size.expression);
  if (!expression) return tl::unexpected(expression.error());
  if (expression->is_constant()) {
    if (auto error = check_size((*expression)(Point{0, 0}), "size.expression"))
      return tl::unexpected(*error);
  }
  return std::optional(std::move(*expression));
}

std::optional<Error> check_options(const MeshRequest& request) {
  const auto options = read_options(request);
  return options ? std::nullopt : std::optional(options.error());
}

}  // namespace weft
