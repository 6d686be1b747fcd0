// SPDX-License-Identifier: Apache-2.0
// The size of triangles as a request gives it: the grading function, as plain data.
//
//   SizeSpec size = "0.01 + x^2";      // the bound on a triangle's area, at its centroid
//   size.measure = Measure::kEdge;     // ... or on the length of its edges
//
// Expressions are of x, y and named fields: + - * / ^, comparisons, && || !, ?:, and the functions
// sqrt abs exp log sin cos tan floor ceil pow atan2 hypot min max clamp slope defined coalesce. A
// size that is not positive at a point of the domain ends a run with kBadSizeValue. The least of
// all bounds holds: of the size, of regions, of areas, and at markers.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "weft/geometry.h"

namespace weft {

inline constexpr std::size_t kMaxExpressionBytes = 65536;
inline constexpr std::size_t kMaxSizeFields = 32;
inline constexpr std::size_t kMaxFieldNameBytes = 64;
inline constexpr std::size_t kMaxSizesAt = 32;

// Values at the nodes of a grid, bilinear between them. REQUIRES: origin, dx and dy are finite, dx
// and dy positive; columns * rows values, one at least.
template <class T>
struct GridOf {
  Point origin{};  // of the first node
  double dx = 0;
  double dy = 0;
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::vector<T> values{};  // by rows from the lowest: that of node (i, j) is [j * columns + i]
};
// Sizes, each positive and finite; outside the grid those of its nearest point.
using Raster = GridOf<double>;
// A field, of any values; NaN for no data. It is undefined (NaN) in every cell with a node that is
// NaN, and more than half a cell outside the grid.
using FieldRaster = GridOf<float>;

// A field on an earlier mesh: linear in its triangles, from values at its vertices; outside them
// the value at the nearest point. The triangles may be oriented as they like.
struct FieldMesh {
  std::vector<Point> vertices{};
  std::vector<std::array<std::uint32_t, 3>> triangles{};
  std::vector<double> values{};  // one for each vertex, may be NaN
};

// The distance to the nearest of: the points, or the segments between them; if there are none, the
// segments of the PSLG that have one of the markers; without markers, all of its segments.
struct DistanceSpec {
  std::vector<std::int32_t> markers{};
  std::vector<Point> points{};
  std::vector<std::array<std::uint32_t, 2>> segments{};  // indices of `points`
};

// The local width of the domain.
struct WidthSpec {};

// A field that an expression may name.
struct FieldSpec {
  std::string name;  // letters, digits and _, a letter or _ first; at most kMaxFieldNameBytes
  std::variant<DistanceSpec, FieldRaster, FieldMesh, WidthSpec> kind{};
};

// How long edges may be on segments with a marker.
struct SizeAt {
  std::int32_t marker = 0;
  double max_edge = 0;  // > 0, in the unit of the points
};

// What the value of a size bounds: a triangle's area, or the length of edges h, which bounds the
// area by that of an equilateral triangle, sqrt(3)/4 h^2.
enum class Measure : std::uint8_t { kArea, kEdge };

// The area of an equilateral triangle with an edge of this length; negative for a negative one, so
// that it is found to be no size. Never falls as the edge grows, because products of numbers that
// are not negative do not.
inline double area_of_edge(double edge) {
  return 0.4330127018922193 * edge * std::fabs(edge);
}

inline constexpr double kMaxPointsPerCircle = 1e5;

struct SizeSpec {
  using Value = std::variant<std::monostate,  // no bound
                             double,          // the same everywhere, > 0
                             std::string,     // an expression, at most kMaxExpressionBytes
                             Raster>;

  SizeSpec() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a value alone is a size.
  template <class T>
  requires std::is_constructible_v<Value, T> SizeSpec(T&& of) : value(std::forward<T>(of)) {}

  Value value;
  Measure measure = Measure::kArea;
  std::vector<FieldSpec> fields;  // at most kMaxSizeFields
  // How much the wanted length of edges grows at most per unit of length, from regions with a bound
  // of their own, too; finite. 0: no limit.
  double gradation = 0;
  // Whether distances for the gradation are measured within the domain, along the shortest paths
  // in it, instead of across land.
  bool gradation_within = false;
  // How many edges fit across the domain at least; finite. 0: any number.
  double cells_across = 0;
  // Edges on arcs turn by at most 360 degrees divided by this; at most kMaxPointsPerCircle. 0: by
  // 60 degrees at most.
  double points_per_circle = 0;
  // On segments with these markers, edges are at most so long. With a gradation the wanted length
  // grows from there by it, at most.
  std::vector<SizeAt> at;  // one per marker, at most kMaxSizesAt
};

}  // namespace weft
