// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_spec.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/size/constant_size.h"

namespace weft {
namespace {

using Made = Result<std::unique_ptr<const SizeFunction>>;

// A value that is the same everywhere.
std::optional<Error> check_constant(double value, const char* field) {
  if (value > 0 && std::isfinite(value)) return std::nullopt;
  return Error{ErrorCode::kBadSizeValue, field,
               "the size is " + text(value) + "; it must be positive and finite"};
}

struct Maker {
  Made operator()(std::monostate) const {
    return std::make_unique<ConstantSize>(std::numeric_limits<double>::infinity());
  }

  Made operator()(double value) const {
    if (auto error = check_constant(value, "size.constant")) return tl::unexpected(*error);
    return std::make_unique<ConstantSize>(value);
  }

  Made operator()(const std::string& source) const {
    auto expression = Expression::parse(source);
    if (!expression) return tl::unexpected(expression.error());
    if (const auto value = expression->constant())
      if (auto error = check_constant(*value, "size.expression")) return tl::unexpected(*error);
    return std::make_unique<Expression>(std::move(*expression));
  }

  Made operator()(const Raster& raster) const {
    auto size = RasterSize::make(raster);
    if (!size) return tl::unexpected(size.error());
    return std::make_unique<RasterSize>(std::move(*size));
  }
};

}  // namespace

Result<std::unique_ptr<const SizeFunction>> make_size(const SizeSpec& spec) {
  return std::visit(Maker{}, spec);
}

std::uint64_t bytes_to_make(const SizeSpec& spec) {
  const auto* const raster = std::get_if<Raster>(&spec);
  return raster != nullptr ? RasterSize::kBytesPerValue * raster->values.size() : 0;
}

}  // namespace weft
