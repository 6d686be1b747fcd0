// SPDX-License-Identifier: Apache-2.0
#include "checker/size/size.h"

#include <memory>
#include <utility>

#include "checker/size/size_expression.h"

namespace weft::check {
namespace {

using Function = tl::expected<std::function<double(Vec2)>, std::string>;

struct Maker {
  Function operator()(std::monostate) const { return {}; }

  Function operator()(const std::string& source) const {
    auto parsed = SizeExpression::parse(source);
    if (!parsed) return tl::unexpected(parsed.error());
    const auto shared = std::make_shared<const SizeExpression>(std::move(*parsed));
    return [shared](Vec2 p) { return (*shared)(p); };
  }

  Function operator()(const Raster& raster) const {
    return [&raster](Vec2 p) { return raster(p); };
  }
};

}  // namespace

tl::expected<std::function<double(Vec2)>, std::string> size_function(const SizeSpec& spec) {
  return std::visit(Maker{}, spec);
}

}  // namespace weft::check
