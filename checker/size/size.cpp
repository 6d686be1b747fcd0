// SPDX-License-Identifier: Apache-2.0
#include "checker/size/size.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

// The size, lowered by what the gradation makes of the sizes at markers.
Function with_sizes_at(std::function<double(Vec2)> size, const SizeSpec& spec,
                       const Domain& domain) {
  for (const SizeAt& at : spec.at) {
    if (!(at.max_edge > 0) || std::isinf(at.max_edge))
      return tl::unexpected(say("the size at marker ", at.marker, " is ", at.max_edge));
    auto distance = Distance::make({{at.marker}, {}, {}}, domain);
    if (!distance) return tl::unexpected(say("sizes at markers: ", distance.error()));
    if (spec.gradation == 0 || spec.gradation_within) continue;
    const auto lines = std::make_shared<const Distance>(std::move(*distance));
    size = [size = std::move(size), lines, at, growth = spec.gradation](Vec2 p) {
      const double near = area_of_edge(at.max_edge + growth * (*lines)(p));
      const double area = size ? size(p) : std::numeric_limits<double>::infinity();
      return near < area ? near : area;
    };
  }
  return size;
}

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
  if (!size) return size;
  if (*size && spec.measure == Measure::kEdge)
    size = [edge = std::move(*size)](Vec2 p) {
      const double h = edge(p);
      return h > 0 ? area_of_edge(h) : h;
    };
  return with_sizes_at(std::move(*size), spec, domain);
}

}  // namespace weft::check
