// SPDX-License-Identifier: Apache-2.0
// The size as a request gives it, and the one place that knows its kinds and those of the fields
// that it may name. What reads a request, plans, refines or estimates sees a SizeFunction; a new
// kind is a type here, a file pair beside this one, and a case in size_spec.cpp.
//
//   Result<Size> size = make_size("0.01 + x^2", pslg, domain, context);
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/error.h"
#include "engine/domain/domain.h"
#include "engine/domain/pslg.h"
#include "engine/size/expression/expression.h"
#include "engine/size/fields/mesh_field.h"
#include "engine/size/fields/raster_field.h"
#include "engine/size/raster.h"
#include "engine/size/size_function.h"

namespace weft {

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
  std::string name;
  std::variant<DistanceSpec, FieldRaster, FieldMesh, WidthSpec> kind;
};

// How long edges may be on segments with a marker.
struct SizeAt {
  std::int32_t marker = 0;
  double max_edge = 0;  // > 0, in the unit of the points
};

// What the value of a size bounds: a triangle's area, or the length of edges h, which bounds the
// area by that of an equilateral triangle, sqrt(3)/4 h^2.
enum class Measure : std::uint8_t { kArea, kEdge };

// The grading function: how large a triangle may be, at its centroid.
struct SizeSpec {
  using Value = std::variant<std::monostate,  // no bound
                             double,          // the same everywhere, > 0 (constant_size.h)
                             std::string,     // of x, y and fields (expression/expression.h)
                             Raster>;         // values on a grid (raster.h)

  SizeSpec() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a value alone is a size.
  template <class T>
  requires std::is_constructible_v<Value, T> SizeSpec(T&& of) : value(std::forward<T>(of)) {}

  Value value;
  Measure measure = Measure::kArea;
  std::vector<FieldSpec> fields;  // at most Expression::kMaxFields
  // How much the wanted length of edges grows at most per unit of length (gradation/), from regions
  // with a bound of their own, too; finite. 0: no limit.
  double gradation = 0;
  // Whether distances for the gradation are measured within the domain, along the shortest paths
  // in it, instead of across land. `make_size` leaves that to engine.cpp, which meshes first.
  bool gradation_within = false;
  // How many edges fit across the domain at least (width_size.h); finite. 0: any number.
  double cells_across = 0;
  // On segments with these markers, edges are at most so long (refine/edge_limits.h). With a
  // gradation the wanted length grows from there by it, at most (line_size.h).
  std::vector<SizeAt> at;  // one per marker, at most kMaxSizesAt
};
inline constexpr std::size_t kMaxSizesAt = 32;

// A size that can be evaluated, with all that it is made of.
class Size {
 public:
  explicit Size(std::unique_ptr<const SizeFunction> function) { add(std::move(function)); }

  const SizeFunction& function() const { return *layers_.back(); }
  // What the gradation limits, if distances across land may have made the limit lower than those
  // within the domain would; otherwise null.
  const SizeFunction* limited_across_land() const { return limited_; }
  std::size_t bytes() const;

  // Keeps what the function refers to.
  void keep(std::vector<std::unique_ptr<const Field>> fields) { fields_ = std::move(fields); }
  // `function` refers to what was the function until now.
  void add(std::unique_ptr<const SizeFunction> function) { layers_.push_back(std::move(function)); }
  // The same, for a limit across land to `size`.
  void limit(const SizeFunction& size, std::unique_ptr<const SizeFunction> function) {
    limited_ = &size;
    add(std::move(function));
  }

 private:
  std::vector<std::unique_ptr<const Field>> fields_;
  std::vector<std::unique_ptr<const SizeFunction>> layers_;
  const SizeFunction* limited_ = nullptr;
};

// Judges what needs neither the domain nor the values of arrays: kBadSizeValue for a constant that
// is not positive and finite, kBadOption for names of fields, a second width, the gradation,
// cells_across and the sizes at markers, and the errors of Expression::check. The field is
// "size.constant", "size.expression", "size.gradation", "size.cells_across", "size.fields[i].name",
// "size.at[i].marker" or "size.at[i].max_edge".
std::optional<Error> check_size(const SizeSpec& spec);

// Computes in the context's arena. REQUIRES: a raster satisfies its own requirements (raster.h),
// and `spec` outlives the result. Errors: those of check_size, those of the kinds for what is wrong
// in their arrays ("size.raster.values[i]", "size.fields[i].mesh.values[j]"), kBadOption for a
// marker that no segment has ("size.at[i].marker", "size.fields[i].distance.markers"),
// kBudgetExceeded, and those of the context.
Result<Size> make_size(const SizeSpec& spec, const Pslg& pslg, const Domain& domain,
                       const ExecutionContext& context);

// The same for a size that names no field and has no limit to its gradation: without the domain.
Result<Size> make_size(const SizeSpec::Value& value, Measure measure);

// Bytes of memory that make_size takes at most for `spec`, which itself is held already: for all
// but the width and the gradation, which ask the context themselves.
std::uint64_t bytes_to_make(const SizeSpec& spec, const Pslg& pslg);

}  // namespace weft
