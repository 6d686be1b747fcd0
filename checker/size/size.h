// SPDX-License-Identifier: Apache-2.0
// The grading function as a caller gives it: the one place of the checker that knows its kinds, and
// those of the fields that it may name.
//
//   auto size = size_function("0.01 + x^2", domain);
//   if (!size) return size.error();
//   double bound = (*size)({1, 2});
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "checker/domain.h"
#include "checker/size/distance_field.h"
#include "checker/size/mesh_field.h"
#include "checker/size/raster.h"
#include "checker/size/raster_field.h"

namespace weft::check {

// The local width of the domain, which the checker cannot judge: an expression that uses it is an
// error.
struct WidthField {};

struct NamedField {
  std::string name;
  std::variant<DistanceField, RasterField, MeshField, WidthField> kind;
};

// What the value of a size bounds: a triangle's area, or the length of edges h, which bounds the
// area by that of an equilateral triangle, sqrt(3)/4 h^2.
enum class Measure : std::uint8_t { kArea, kEdge };

// Edges that carry the marker are at most so long. With a gradation, the length of edges is at most
// `max_edge` + gradation * (distance to the segments with the marker).
struct SizeAt {
  std::int32_t marker = 0;
  double max_edge = 0;
};

struct SizeSpec {
  using Value = std::variant<std::monostate,  // no bound
                             double,          // the same everywhere
                             std::string,     // of x, y and the fields (size_expression.h)
                             Raster>;         // values on a grid

  SizeSpec() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a value alone is a size.
  template <class T>
  requires std::is_constructible_v<Value, T> SizeSpec(T&& of) : value(std::forward<T>(of)) {}

  Value value;
  Measure measure = Measure::kArea;
  std::vector<NamedField> fields;
  // How much the wanted length of edges grows at most per unit of length (gradation.h): positive
  // and finite, or 0: no limit. The function of `size_function` is without it, but for `at` if
  // distances are straight.
  double gradation = 0;
  bool gradation_within = false;  // the domain, along the shortest paths in it
  std::vector<SizeAt> at;
};

// The upper bound on a triangle's area at its centroid, squared units; empty if there is none. If
// it cannot be computed, NaN. Errors: a sentence that says what was not understood, and where, or
// which field is wrong. REQUIRES: `spec` outlives the function. Not thread-safe: one function per
// thread.
tl::expected<std::function<double(Vec2)>, std::string> size_function(const SizeSpec& spec,
                                                                     const Domain& domain);

}  // namespace weft::check
