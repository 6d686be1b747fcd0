// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_warnings.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include "engine/base/text.h"
#include "engine/size/expression/expression.h"
#include "engine/size/size_function.h"

namespace weft {
namespace {

using Kind = SizeWarning::Kind;

// Of the fields, by their order, whether the size names each.
std::vector<bool> named_by(const SizeSpec& size) {
  std::vector<std::string> names;
  for (const FieldSpec& field : size.fields) names.push_back(field.name);
  if (const auto* expression = std::get_if<std::string>(&size.value))
    if (auto judged = Expression::check(*expression, names)) return std::move(judged->used);
  return std::vector<bool>(names.size(), false);
}

}  // namespace

std::vector<SizeWarning> size_warnings(const SizeSpec& size, const Box& box, double least_bound) {
  std::vector<SizeWarning> warnings;
  const double edge = least_bound > 0 ? SizeFunction::edge_of_area(least_bound) : 0;
  if (edge > std::max(box.width(), box.height()))
    warnings.push_back({Kind::kBoundsNothing, "",
                        "the size bounds nothing: it asks for edges of " + rough_text(edge) +
                            " or more in a domain that is " + rough_text(box.width()) + " by " +
                            rough_text(box.height()) + "; is it in another unit than the domain?"});
  if (const auto* raster = std::get_if<Raster>(&size.value)) {
    const double least = *std::min_element(raster->values.begin(), raster->values.end());
    const double asked = size.measure == Measure::kEdge ? least : SizeFunction::edge_of_area(least);
    const double step = std::max(raster->dx, raster->dy);
    if (asked < step)
      warnings.push_back({Kind::kCoarseRaster, "",
                          "the raster of sizes is coarser than what it asks for: its nodes are " +
                              rough_text(step) + " apart, and the least edge is " +
                              rough_text(asked) + "; details between the nodes are missed"});
  }
  const std::vector<bool> named = named_by(size);
  for (std::size_t i = 0; i < size.fields.size(); ++i)
    if (!named[i])
      warnings.push_back({Kind::kFieldNotNamed, size.fields[i].name,
                          "the size does not name the field '" + size.fields[i].name + "'"});
  if (size.gradation_within && size.gradation == 0)
    warnings.push_back(
        {Kind::kGradationWithinAlone, "", "gradation_within has no effect without gradation"});
  return warnings;
}

}  // namespace weft
