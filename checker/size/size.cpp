// SPDX-License-Identifier: Apache-2.0
#include "checker/size/size.h"

#include <cmath>
#include <memory>

#include "checker/size/field.h"
#include "checker/size/gradation.h"
#include "checker/size/size_expression.h"
#include "checker/text.h"

namespace weft::check {
namespace {

using Function = tl::expected<std::function<double(Vec2)>, std::string>;
using MadeField = tl::expected<Field, std::string>;

struct FieldMaker {
  const Domain& domain;

  MadeField operator()(const DistanceField& field) const {
    auto made = Distance::make(field, domain);
    if (!made) return tl::unexpected(made.error());
    const auto shared = std::make_shared<const Distance>(std::move(*made));
    return Field{"", [shared](Vec2 p) { return (*shared)(p); }, [](Vec2) { return 1.0; }};
  }

  MadeField operator()(const RasterField& field) const {
    if (auto fault = field.fault()) return tl::unexpected(std::move(*fault));
    return Field{"", [&field](Vec2 p) { return field.value(p); },
                 [&field](Vec2 p) { return field.slope(p); }};
  }

  MadeField operator()(const MeshField& field) const {
    auto made = MeshValues::make(field);
    if (!made) return tl::unexpected(made.error());
    const auto shared = std::make_shared<const MeshValues>(std::move(*made));
    return Field{"", [shared](Vec2 p) { return shared->value(p); },
                 [shared](Vec2 p) { return shared->slope(p); }};
  }

  MadeField operator()(const WidthField&) const { return Field{}; }
};

struct Maker {
  std::vector<Field> fields;

  Function operator()(std::monostate) const { return {}; }

  Function operator()(double constant) const {
    return [constant](Vec2) { return constant; };
  }

  Function operator()(const std::string& source) const {
    auto parsed = SizeExpression::parse(source, fields);
    if (!parsed) return tl::unexpected(parsed.error());
    const auto shared = std::make_shared<const SizeExpression>(std::move(*parsed));
    return [shared](Vec2 p) { return (*shared)(p); };
  }

  Function operator()(const Raster& raster) const {
    return [&raster](Vec2 p) { return raster(p); };
  }
};

}  // namespace

tl::expected<std::function<double(Vec2)>, std::string> size_function(const SizeSpec& spec,
                                                                     const Domain& domain) {
  if (!(spec.gradation >= 0) || std::isinf(spec.gradation))
    return tl::unexpected(say("the gradation is ", spec.gradation));
  std::vector<Field> fields;
  for (std::size_t i = 0; i < spec.fields.size(); ++i) {
    auto made = std::visit(FieldMaker{domain}, spec.fields[i].kind);
    if (!made) return tl::unexpected(say("field ", i, ": ", made.error()));
    made->name = spec.fields[i].name;
    fields.push_back(std::move(*made));
  }
  if (auto fault = fault_of_names(fields)) return tl::unexpected(std::move(*fault));
  auto size = std::visit(Maker{std::move(fields)}, spec.value);
  if (!size || !*size || spec.measure == Measure::kArea) return size;
  return [edge = std::move(*size)](Vec2 p) {
    const double h = edge(p);
    return h > 0 ? area_of_edge(h) : h;
  };
}

}  // namespace weft::check
