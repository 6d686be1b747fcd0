// SPDX-License-Identifier: Apache-2.0
#include "client/report/size_warnings.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>

#include "client/base/text.h"

namespace weft::client {
namespace {

struct Extent {
  double width = 0;
  double height = 0;
};

Extent extent_of(const Domain& domain) {
  if (domain.points.empty()) return {};
  const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
  const auto by_y = [](const Point& a, const Point& b) { return a.y < b.y; };
  const auto [left, right] = std::minmax_element(domain.points.begin(), domain.points.end(), by_x);
  const auto [low, high] = std::minmax_element(domain.points.begin(), domain.points.end(), by_y);
  return {right->x - left->x, high->y - low->y};
}

// The edge of the equilateral triangle that a value of the size allows.
double edge_of(const v1::SizeField& size, double value) {
  return size.measure() == v1::MEASURE_EDGE ? value : std::sqrt(4 / std::sqrt(3.0) * value);
}

std::optional<double> least_value(const v1::SizeField& size) {
  if (size.has_constant()) return size.constant();
  const auto& values = size.raster().values();
  if (values.empty()) return std::nullopt;
  return *std::min_element(values.begin(), values.end());
}

// Whether the expression has `name` as a word.
bool names(std::string_view expression, std::string_view name) {
  const auto in_word = [&](std::size_t i) {
    return i < expression.size() &&
           (std::isalnum(static_cast<unsigned char>(expression[i])) || expression[i] == '_');
  };
  for (std::size_t at = expression.find(name); at != std::string_view::npos;
       at = expression.find(name, at + 1))
    if ((at == 0 || !in_word(at - 1)) && !in_word(at + name.size())) return true;
  return false;
}

}  // namespace

std::vector<std::string> size_warnings(const v1::SizeField& size, const Domain& domain) {
  std::vector<std::string> warnings;
  const Extent extent = extent_of(domain);
  if (const auto least = least_value(size); least && *least > 0) {
    const double edge = edge_of(size, *least);
    if (edge > std::max(extent.width, extent.height))
      warnings.push_back("the size bounds nothing: it asks for edges of " + shortest(edge) +
                         " or more in a domain that is " + shortest(extent.width) + " by " +
                         shortest(extent.height) + "; is it in another unit than the domain?");
    const v1::Raster& raster = size.raster();
    const double step = std::max(raster.dx(), raster.dy());
    if (size.has_raster() && edge < step)
      warnings.push_back("the raster of sizes is coarser than what it asks for: its nodes are " +
                         shortest(step) + " apart, and the least edge is " + shortest(edge) +
                         "; what is finer than the nodes is missed");
  }
  for (const v1::NamedField& field : size.fields())
    if (!names(size.expression(), field.name()))
      warnings.push_back("the size does not name the field " + in_quotes(field.name()));
  return warnings;
}

}  // namespace weft::client
