// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_spec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/domain/markers.h"
#include "engine/domain/validate.h"
#include "engine/size/constant_size.h"
#include "engine/size/edge_size.h"
#include "engine/size/expression/expression.h"
#include "engine/size/field_size.h"
#include "engine/size/fields/distance_field.h"
#include "engine/size/fields/mesh_field.h"
#include "engine/size/fields/raster_field.h"
#include "engine/size/fields/width_field.h"
#include "engine/size/gradation/border_graded_size.h"
#include "engine/size/gradation/graded_size.h"
#include "engine/size/gradation/region_borders.h"
#include "engine/size/least_size.h"
#include "engine/size/raster.h"
#include "weft/weft.h"

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

// The lines that a distance is measured from.
class Lines {
 public:
  Lines(const Pslg& pslg, const std::string& path) : pslg_(pslg), path_(path) {}

  Result<std::vector<Line>> of(const DistanceSpec& spec) const {
    if (!spec.points.empty()) return of_points(spec);
    if (!spec.segments.empty())
      return fail(ErrorCode::kIndexOutOfRange, path_ + ".segments[0].a",
                  path_ + ".segments[0].a is " + std::to_string(spec.segments[0][0]) +
                      ", but there are no points");
    if (const auto missing = first_without_segment(spec.markers, pslg_.segments))
      return fail(ErrorCode::kBadOption, path_ + ".markers",
                  path_ + ".markers holds " + std::to_string(spec.markers[*missing]) +
                      ", which is the marker of no segment of the domain");
    const MarkerSet wanted(spec.markers);
    std::vector<Line> lines;
    for (const Segment& segment : pslg_.segments)
      if (spec.markers.empty() || wanted.contains(segment.marker))
        lines.push_back({pslg_.points[segment.a], pslg_.points[segment.b]});
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

Result<DistanceField> distance_to(std::vector<Line> lines, const Domain& domain,
                                  const ExecutionContext& context) {
  const Result<DomainCover> cover = DomainCover::make(domain, context);
  if (!cover) return tl::unexpected(cover.error());
  return DistanceField::make(std::move(lines), *cover, context);
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
    return on_heap(distance_to(std::move(*lines), domain, context));
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
    return DistanceField::bytes_to_make(lines);
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

Result<Size> with_measure(const SizeSpec::Value& value, Measure measure,
                          const std::vector<NamedField>& fields) {
  auto function = std::visit(Maker{fields}, value);
  if (!function) return tl::unexpected(std::move(function).error());
  Size size(std::move(*function));
  if (measure == Measure::kEdge) size.add(std::make_unique<EdgeSize>(size.function()));
  return size;
}

// Whether all segments with one of the markers are in the domain, and none in a hole or outside.
// False, too, if some of them overlap in part, or with others of another marker.
bool are_in_domain(const std::vector<std::int32_t>& markers, const Pslg& pslg,
                   const Domain& domain) {
  const MarkerSet wanted(markers);
  std::vector<std::array<double, 4>> ends;  // of each once, though rings that touch have it twice
  for (const Segment& segment : pslg.segments) {
    if (!wanted.contains(segment.marker)) continue;
    const Point a = pslg.points[segment.a];
    const Point b = pslg.points[segment.b];
    ends.push_back(std::min(std::array{a.x, a.y, b.x, b.y}, std::array{b.x, b.y, a.x, a.y}));
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  double whole = 0;
  for (const auto& [ax, ay, bx, by] : ends)
    whole += std::sqrt(distance2(Point{ax, ay}, Point{bx, by}));
  double within = 0;
  for (const Subsegment& piece : domain.subsegments)
    if (wanted.contains(piece.marker))
      within += std::sqrt(distance2(domain.vertices[piece.a], domain.vertices[piece.b]));
  return within >= whole * (1 - 1e-9);
}

// What a field is the distance to, if it is one to segments of the domain.
std::optional<BorderGradedSize::Lines> lines_of(const FieldSpec& field, const Pslg& pslg,
                                                const Domain& domain) {
  const auto* const distance = std::get_if<DistanceSpec>(&field.kind);
  if (distance == nullptr || !distance->points.empty()) return std::nullopt;
  if (distance->markers.empty()) return BorderGradedSize::Lines::kWholeBorder;
  if (!are_in_domain(distance->markers, pslg, domain)) return std::nullopt;
  return BorderGradedSize::Lines::kInDomain;
}

// A limit to the growth of a size; null: none. And whether distances across land may matter to it:
// to the nearest point of the whole border, the straight way does not cross any.
struct Limit {
  std::unique_ptr<const SizeFunction> function = nullptr;
  bool across_land = false;
};

// What limits a size, or a part of one.
struct Limiter {
  const SizeSpec& spec;
  const std::vector<NamedField>& fields;
  const Pslg& pslg;
  const Domain& domain;
  const ExecutionContext& context;

  // Limits what depends on the distance to segments of the domain alone; null for anything else.
  Result<Limit> by_border(const SizeFunction& size) const {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto lines = lines_of(spec.fields[i], pslg, domain);
      if (!lines) continue;
      auto made = BorderGradedSize::make(size, *fields[i].field, *lines, spec.gradation,
                                         box_of(domain), context);
      if (!made) return tl::unexpected(std::move(made).error());
      if (*made) return Limit{std::move(*made), *lines != BorderGradedSize::Lines::kWholeBorder};
    }
    return Limit{};
  }

  // The limit of a least value is the least of the limits, so of min(a, b) what can be limited by
  // the border is; otherwise it may have as many sources as the border is long. Null if nothing
  // can.
  Result<Limit> by_border_in_parts() const {
    const auto* const source = std::get_if<std::string>(&spec.value);
    if (source == nullptr || spec.cells_across > 0) return Limit{};
    std::vector<Size> parts;
    bool any = false;
    bool across_land = false;
    for (const std::string& argument : Expression::arguments_of_min(*source)) {
      auto part = with_measure(argument, spec.measure, fields);
      if (!part) return tl::unexpected(std::move(part).error());
      auto limited = by_border(part->function());
      if (!limited) return limited;
      any = any || limited->function;
      across_land = across_land || limited->across_land;
      if (limited->function) part->add(std::move(limited->function));
      parts.push_back(std::move(*part));
    }
    if (!any) return Limit{};
    return Limit{std::make_unique<LeastSize>(std::move(parts)), across_land};
  }
};

// Gives `size` the gradation of the request.
std::optional<Error> limit(Size& size, const Limiter& limiter) {
  const SizeFunction& unlimited = size.function();
  const auto add = [&](Limit made) {
    if (made.across_land)
      size.limit(unlimited, std::move(made.function));
    else
      size.add(std::move(made.function));
  };
  auto by_border = limiter.by_border(unlimited);
  if (!by_border) return std::move(by_border).error();
  if (by_border->function) {
    add(std::move(*by_border));
    return std::nullopt;
  }
  auto in_parts = limiter.by_border_in_parts();
  if (!in_parts) return std::move(in_parts).error();
  if (in_parts->function) add(std::move(*in_parts));
  auto graded =
      GradedSize::make(size.function(), limiter.spec.gradation, limiter.domain, limiter.context);
  if (!graded) return std::move(graded).error();
  const bool limits = !graded->is_limited_already();
  add({std::make_unique<GradedSize>(std::move(*graded)), limits});
  return std::nullopt;
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
  if (!(spec.points_per_circle >= 0 && spec.points_per_circle <= kMaxPointsPerCircle))
    return Error{ErrorCode::kBadOption, "size.points_per_circle",
                 "size.points_per_circle is " + text(spec.points_per_circle) +
                     "; it must be from 0 to " + text(kMaxPointsPerCircle)};
  if (spec.fields.size() > kMaxSizeFields)
    return Error{ErrorCode::kLimitExceeded, "size.fields",
                 "size.fields: " + std::to_string(spec.fields.size()) + " fields; the limit is " +
                     std::to_string(kMaxSizeFields)};
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
    if (auto error = context.need_bytes(held, "the fields of the size"))
      return tl::unexpected(*error);
  }
  auto size = with_measure(spec.value, spec.measure, named);
  if (!size) return size;
  size->keep(std::move(fields));
  if (spec.cells_across > 0) {
    auto width = on_heap(WidthField::make(domain, context));
    if (!width) return tl::unexpected(std::move(width).error());
    size->add(std::make_unique<FieldSize>(size->function(), std::move(*width),
                                          EdgesByField{.parts = spec.cells_across}));
  }
  const SizeFunction& unlimited = size->function();
  if (spec.gradation > 0 && !unlimited.constant()) {
    if (auto error = limit(*size, {spec, named, pslg, domain, context}))
      return tl::unexpected(*std::move(error));
  }
  // After the gradation, because these sizes respect it by themselves.
  const auto grow = [&](std::vector<Line> lines, double max_edge,
                        const char* what) -> std::optional<Error> {
    if (auto error = context.need_bytes(
            domain.bytes() + size->bytes() + DistanceField::bytes_to_make(lines.size()), what))
      return error;
    auto distance = on_heap(distance_to(std::move(lines), domain, context));
    if (!distance) return std::move(distance).error();
    size->limit(unlimited, std::make_unique<FieldSize>(
                               size->function(), std::move(*distance),
                               EdgesByField{.base = max_edge, .growth = spec.gradation}));
    return std::nullopt;
  };
  for (std::size_t i = 0; i < spec.at.size(); ++i) {
    auto lines = lines_at(spec.at[i], i, pslg);
    if (!lines) return tl::unexpected(std::move(lines).error());
    if (spec.gradation == 0) continue;
    if (auto error = grow(std::move(*lines), spec.at[i].max_edge, "the size at markers"))
      return tl::unexpected(std::move(*error));
  }
  if (spec.gradation == 0) return size;
  for (RegionBorders& borders : region_borders(domain)) {
    if (size->function().bounds(box_of(domain)).hi <= borders.max_area) continue;
    if (auto error = grow(std::move(borders.lines), SizeFunction::edge_of_area(borders.max_area),
                          "the size of regions"))
      return tl::unexpected(std::move(*error));
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
    bytes += DistanceField::bytes_to_make(pslg.segments.size(), spec.at.size());
  return bytes;
}

}  // namespace weft
