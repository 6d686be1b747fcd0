// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_spec.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/domain/validate.h"
#include "engine/size/constant_size.h"
#include "engine/size/edge_size.h"
#include "engine/size/fields/distance_field.h"
#include "engine/size/fields/width_field.h"
#include "engine/size/gradation/graded_size.h"
#include "engine/size/marker_size.h"
#include "engine/size/width_size.h"

namespace weft {
namespace {

using Function = Result<std::unique_ptr<const SizeFunction>>;
using AnyField = Result<std::unique_ptr<const Field>>;

template <class T>
AnyField on_heap(Result<T> made) {
  if (!made) return tl::unexpected(std::move(made).error());
  return std::make_unique<const T>(std::move(*made));
}

// A value that is the same everywhere.
std::optional<Error> check_constant(double value, const char* field) {
  if (value > 0 && std::isfinite(value)) return std::nullopt;
  return Error{ErrorCode::kBadSizeValue, field,
               "the size is " + text(value) + "; it must be positive and finite"};
}

std::vector<std::string> names_of(const std::vector<FieldSpec>& fields) {
  std::vector<std::string> names;
  for (const FieldSpec& field : fields) names.push_back(field.name);
  return names;
}

// The width takes long to make, and a second one would be the same.
std::optional<Error> check_widths(const std::vector<FieldSpec>& fields) {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!std::holds_alternative<WidthSpec>(fields[i].kind)) continue;
    const std::string field = "size.fields[" + std::to_string(i) + "]";
    if (first)
      return Error{ErrorCode::kBadOption, field,
                   field + " is the width, as size.fields[" + std::to_string(*first) + "] is"};
    first = i;
  }
  return std::nullopt;
}

std::optional<Error> check_sizes_at(const std::vector<SizeAt>& at) {
  if (at.size() > kMaxSizesAt)
    return Error{ErrorCode::kLimitExceeded, "size.at",
                 "size.at: " + std::to_string(at.size()) + " markers; the limit is " +
                     std::to_string(kMaxSizesAt)};
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::string path = "size.at[" + std::to_string(i) + "]";
    if (!(at[i].max_edge > 0 && std::isfinite(at[i].max_edge)))
      return Error{
          ErrorCode::kBadOption, path + ".max_edge",
          path + ".max_edge is " + text(at[i].max_edge) + "; it must be positive and finite"};
    for (std::size_t j = 0; j < i; ++j)
      if (at[j].marker == at[i].marker)
        return Error{ErrorCode::kBadOption, path + ".marker",
                     path + ".marker is " + std::to_string(at[i].marker) + ", as that of size.at[" +
                         std::to_string(j) + "]"};
  }
  return std::nullopt;
}

// What a distance is to.
class Lines {
 public:
  Lines(const Pslg& pslg, const std::string& path) : pslg_(pslg), path_(path) {}

  Result<std::vector<Line>> of(const DistanceSpec& spec) const {
    if (!spec.points.empty()) return of_points(spec);
    if (!spec.segments.empty())
      return fail(ErrorCode::kIndexOutOfRange, path_ + ".segments[0].a",
                  path_ + ".segments[0].a is " + std::to_string(spec.segments[0][0]) +
                      ", but there are no points");
    for (const std::int32_t marker : spec.markers)
      if (!has(marker))
        return fail(ErrorCode::kBadOption, path_ + ".markers",
                    path_ + ".markers holds " + std::to_string(marker) +
                        ", which is the marker of no segment of the domain");
    std::vector<Line> lines;
    for (const Segment& segment : pslg_.segments) {
      const bool wanted =
          spec.markers.empty() ||
          std::find(spec.markers.begin(), spec.markers.end(), segment.marker) != spec.markers.end();
      if (wanted) lines.push_back({pslg_.points[segment.a], pslg_.points[segment.b]});
    }
    if (lines.empty())
      return fail(ErrorCode::kBadOption, path_,
                  path_ + " is the distance to the segments of the domain, which has none");
    return lines;
  }

 private:
  Result<std::vector<Line>> of_points(const DistanceSpec& spec) const {
    if (!spec.markers.empty())
      return fail(ErrorCode::kBadOption, path_ + ".markers",
                  path_ + ".markers and " + path_ + ".points exclude each other");
    for (std::size_t i = 0; i < spec.points.size(); ++i)
      for (const auto& [name, value] :
           {std::pair{".x", spec.points[i].x}, std::pair{".y", spec.points[i].y}})
        if (!(std::fabs(value) <= kMaxMagnitude)) {
          const std::string field = path_ + ".points[" + std::to_string(i) + "]" + name;
          return fail(ErrorCode::kBadCoordinate, field,
                      field + " is " + text(value) + "; a magnitude must be at most " +
                          text(kMaxMagnitude));
        }
    std::vector<Line> lines;
    for (std::size_t i = 0; i < spec.segments.size(); ++i) {
      for (const int end : {0, 1})
        if (spec.segments[i][end] >= spec.points.size()) {
          const std::string field =
              path_ + ".segments[" + std::to_string(i) + (end == 0 ? "].a" : "].b");
          return fail(ErrorCode::kIndexOutOfRange, field,
                      field + " is " + std::to_string(spec.segments[i][end]) + ", but there are " +
                          std::to_string(spec.points.size()) + " points");
        }
      lines.push_back({spec.points[spec.segments[i][0]], spec.points[spec.segments[i][1]]});
    }
    if (lines.empty())
      for (const Point point : spec.points) lines.push_back({point, point});
    return lines;
  }

  bool has(std::int32_t marker) const {
    return std::any_of(pslg_.segments.begin(), pslg_.segments.end(),
                       [&](const Segment& segment) { return segment.marker == marker; });
  }

  const Pslg& pslg_;
  const std::string& path_;
};

Box box_of(const Domain& domain) {
  Box box;
  for (const Point vertex : domain.vertices) box.add(vertex);
  return box;
}

// The segments with the marker of size.at[i].
Result<std::vector<Line>> lines_at(const SizeAt& at, std::size_t i, const Pslg& pslg) {
  std::vector<Line> lines;
  for (const Segment& segment : pslg.segments)
    if (segment.marker == at.marker)
      lines.push_back({pslg.points[segment.a], pslg.points[segment.b]});
  if (!lines.empty()) return lines;
  const std::string field = "size.at[" + std::to_string(i) + "].marker";
  return fail(ErrorCode::kBadOption, field,
              field + " is " + std::to_string(at.marker) +
                  ", which is the marker of no segment of the domain");
}

// Makes a field, which errors call `path`.
struct FieldMaker {
  const Pslg& pslg;
  const Domain& domain;
  const ExecutionContext& context;
  std::string path;

  AnyField operator()(const DistanceSpec& spec) const {
    const std::string field = path + ".distance";
    auto lines = Lines(pslg, field).of(spec);
    if (!lines) return tl::unexpected(std::move(lines).error());
    return on_heap(DistanceField::make(std::move(*lines), box_of(domain), context));
  }
  AnyField operator()(const FieldRaster& raster) const {
    return on_heap(RasterField::make(raster, path + ".raster", context));
  }
  AnyField operator()(const FieldMesh& mesh) const {
    return on_heap(MeshField::make(mesh, path + ".mesh", context));
  }
  AnyField operator()(const WidthSpec&) const { return on_heap(WidthField::make(domain, context)); }
};

// Bytes of memory that a field takes at most while it is made, copies of arrays included.
struct BytesOfField {
  const Pslg& pslg;

  std::uint64_t operator()(const DistanceSpec& spec) const {
    const std::size_t lines = spec.points.empty()     ? pslg.segments.size()
                              : spec.segments.empty() ? spec.points.size()
                                                      : spec.segments.size();
    return DistanceField::kBytesPerLine * lines + DistanceField::kBytesBesides;
  }
  std::uint64_t operator()(const FieldRaster& raster) const {
    return sizeof(float) * raster.values.size() +
           RasterField::bytes_to_make(raster.columns, raster.rows);
  }
  std::uint64_t operator()(const FieldMesh& mesh) const {
    return sizeof(Point) * mesh.vertices.size() + sizeof(double) * mesh.values.size() +
           sizeof(mesh.triangles[0]) * mesh.triangles.size() +
           MeshField::bytes_to_make(mesh.triangles.size());
  }
  std::uint64_t operator()(const WidthSpec&) const { return 0; }
};

// Makes the function of the value that a request gives.
struct Maker {
  const std::vector<NamedField>& fields;

  Function operator()(std::monostate) const {
    return std::make_unique<ConstantSize>(std::numeric_limits<double>::infinity());
  }
  Function operator()(double value) const { return std::make_unique<ConstantSize>(value); }
  Function operator()(const std::string& source) const {
    auto expression = Expression::parse(source, fields);
    if (!expression) return tl::unexpected(expression.error());
    return std::make_unique<Expression>(std::move(*expression));
  }
  Function operator()(const Raster& raster) const {
    auto size = RasterSize::make(raster);
    if (!size) return tl::unexpected(size.error());
    return std::make_unique<RasterSize>(std::move(*size));
  }
};

// What a job holds, its fields included, must be within its budget, and granted.
std::optional<Error> check_held(std::uint64_t bytes, const ExecutionContext& context) {
  const std::uint64_t limit = context.budget().max_bytes;
  if (bytes > limit)
    return Error{ErrorCode::kBudgetExceeded, "budget.max_bytes",
                 "the fields of the size take " + std::to_string(bytes) +
                     " bytes with the domain, the limit is " + std::to_string(limit)};
  return context.need_bytes(bytes);
}

Result<Size> with_measure(const SizeSpec::Value& value, Measure measure,
                          const std::vector<NamedField>& fields) {
  auto function = std::visit(Maker{fields}, value);
  if (!function) return tl::unexpected(std::move(function).error());
  Size size(std::move(*function));
  if (measure == Measure::kEdge) size.add(std::make_unique<EdgeSize>(size.function()));
  return size;
}

}  // namespace

std::size_t Size::bytes() const {
  std::size_t sum = 0;
  for (const auto& field : fields_) sum += field->bytes();
  for (const auto& layer : layers_) sum += layer->bytes();
  return sum;
}

std::optional<Error> check_size(const SizeSpec& spec) {
  for (const auto& [field, value] : {std::pair{"size.gradation", spec.gradation},
                                     std::pair{"size.cells_across", spec.cells_across}})
    if (!(value >= 0 && std::isfinite(value)))
      return Error{ErrorCode::kBadOption, field,
                   std::string(field) + " is " + text(value) + "; it must be finite and 0 or more"};
  if (spec.fields.size() > Expression::kMaxFields)
    return Error{ErrorCode::kLimitExceeded, "size.fields",
                 "size.fields: " + std::to_string(spec.fields.size()) + " fields; the limit is " +
                     std::to_string(Expression::kMaxFields)};
  const std::vector<std::string> names = names_of(spec.fields);
  if (auto error = Expression::check_names(names)) return error;
  if (auto error = check_widths(spec.fields)) return error;
  if (auto error = check_sizes_at(spec.at)) return error;
  if (const auto* const value = std::get_if<double>(&spec.value))
    return check_constant(*value, "size.constant");
  const auto* const source = std::get_if<std::string>(&spec.value);
  if (source == nullptr) return std::nullopt;
  const auto judged = Expression::check(*source, names);
  if (!judged) return judged.error();
  if (const auto& value = judged->constant) return check_constant(*value, "size.expression");
  return std::nullopt;
}

Result<Size> make_size(const SizeSpec& spec, const Pslg& pslg, const Domain& domain,
                       const ExecutionContext& context) {
  if (auto error = check_size(spec)) return tl::unexpected(*error);
  std::vector<std::unique_ptr<const Field>> fields;
  std::vector<NamedField> named;
  std::uint64_t held = domain.bytes();
  for (std::size_t i = 0; i < spec.fields.size(); ++i) {
    const std::string path = "size.fields[" + std::to_string(i) + "]";
    auto field = std::visit(FieldMaker{pslg, domain, context, path}, spec.fields[i].kind);
    if (!field) return tl::unexpected(std::move(field).error());
    fields.push_back(std::move(*field));
    named.push_back({spec.fields[i].name, fields.back().get()});
    held += fields.back()->bytes();
    if (auto error = check_held(held, context)) return tl::unexpected(*error);
  }
  auto size = with_measure(spec.value, spec.measure, named);
  if (!size) return size;
  size->keep(std::move(fields));
  if (spec.cells_across > 0) {
    auto width = WidthField::make(domain, context);
    if (!width) return tl::unexpected(std::move(width).error());
    size->add(std::make_unique<WidthSize>(size->function(), std::move(*width), spec.cells_across));
  }
  if (spec.gradation > 0 && !size->function().constant()) {
    auto graded = GradedSize::make(size->function(), spec.gradation, domain, context);
    if (!graded) return tl::unexpected(std::move(graded).error());
    size->add(std::make_unique<GradedSize>(std::move(*graded)));
  }
  // After the gradation, which these keep to by themselves.
  for (std::size_t i = 0; i < spec.at.size(); ++i) {
    auto lines = lines_at(spec.at[i], i, pslg);
    if (!lines) return tl::unexpected(std::move(lines).error());
    if (spec.gradation == 0) continue;
    auto distance = DistanceField::make(std::move(*lines), box_of(domain), context);
    if (!distance) return tl::unexpected(std::move(distance).error());
    held += distance->bytes();
    if (auto error = check_held(held, context)) return tl::unexpected(*error);
    size->add(std::make_unique<MarkerSize>(size->function(), std::move(*distance),
                                           spec.at[i].max_edge, spec.gradation));
  }
  return size;
}

Result<Size> make_size(const SizeSpec::Value& value, Measure measure) {
  return with_measure(value, measure, {});
}

std::uint64_t bytes_to_make(const SizeSpec& spec, const Pslg& pslg) {
  const auto* const raster = std::get_if<Raster>(&spec.value);
  std::uint64_t bytes = raster != nullptr ? RasterSize::kBytesPerValue * raster->values.size() : 0;
  for (const FieldSpec& field : spec.fields) bytes += std::visit(BytesOfField{pslg}, field.kind);
  if (!spec.at.empty() && spec.gradation > 0)
    bytes += DistanceField::kBytesPerLine * pslg.segments.size() +
             DistanceField::kBytesBesides * spec.at.size();
  return bytes;
}

}  // namespace weft
