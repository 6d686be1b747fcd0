// SPDX-License-Identifier: Apache-2.0
#include "wire/request.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wire/fields.h"

namespace weft::wire {
namespace {

struct Refused {
  Error error;
};

[[noreturn]] void refuse(ErrorCode code, std::string field, std::string message) {
  throw Refused{{code, std::move(field), std::move(message)}};
}

template <std::integral Number>
std::string text(Number number) {
  return std::to_string(number);
}
// The shortest decimal that reads back as the same number, without an exponent from 1e-4 to 1e16.
std::string text(double number) {
  char buffer[32];
  char* const end = buffer + sizeof buffer;
  const double size = std::abs(number);
  return {buffer, size >= 1e-4 && size < 1e16
                      ? std::to_chars(buffer, end, number, std::chars_format::fixed).ptr
                      : std::to_chars(buffer, end, number).ptr};
}

[[noreturn]] void refuse_number(const std::string& field, double value, const char* rule) {
  refuse(ErrorCode::kBadOption, field, field + " is " + text(value) + "; it must be " + rule);
}

// Where numbers of an array come together: two or three to a row.
template <class Row, std::size_t N>
class Rows {
 public:
  void read(Fields& in) {
    // Only once: a message may hold an array in any number of parts.
    const auto reserve = [this](std::size_t numbers) {
      if (rows_.empty()) rows_.reserve(numbers / N);
    };
    in.array<Number>([this](Number number) { add(number); }, reserve);
  }
  std::size_t numbers() const { return numbers_; }
  // REQUIRES that they make whole rows.
  std::vector<Row> take(const std::string& field, const char* what) {
    if (numbers_ % N != 0)
      refuse(ErrorCode::kBadArray, field,
             field + " holds " + text(numbers_) + " numbers; " + what + " come in " +
                 (N == 2 ? "pairs" : "threes"));
    return std::move(rows_);
  }

 private:
  using Number = std::conditional_t<std::is_same_v<Row, Point>, double, std::uint32_t>;

  void add(Number number) {
    const std::size_t at = numbers_++ % N;
    if (at == 0) rows_.emplace_back();
    place(rows_.back(), at) = number;
  }
  static double& place(Point& point, std::size_t at) { return at == 0 ? point.x : point.y; }
  static std::uint32_t& place(Segment& segment, std::size_t at) {
    return at == 0 ? segment.a : segment.b;
  }
  static std::uint32_t& place(std::array<std::uint32_t, N>& row, std::size_t at) { return row[at]; }

  std::vector<Row> rows_;
  std::size_t numbers_ = 0;
};
using Points = Rows<Point, 2>;

// The protocol's enumerators follow a 0 that stands for the first of them.
template <class Enum>
Enum enumerator(std::int32_t number, Enum last, const std::string& field, const char* type) {
  if (number < 0 || number > static_cast<std::int32_t>(last) + 1)
    refuse(ErrorCode::kBadOption, field,
           field + " is " + text(number) + ", which is not a " + type);
  return static_cast<Enum>(std::max(0, number - 1));
}

// Of a region or an area, on the areas of triangles.
struct Bounds {
  std::optional<double> max_area;
  std::optional<double> max_edge;

  std::optional<double> area(const std::string& path) const {
    const auto check = [&](const char* name, double value, double area, const char* rule) {
      if (!(std::isfinite(area) && area > 0)) refuse_number(path + name, value, rule);
    };
    if (max_area) check(".max_area", *max_area, *max_area, "positive and finite");
    if (!max_edge) return max_area;
    const double by_edge = area_of_edge(*max_edge);
    check(".max_edge", *max_edge, by_edge, "positive and finite, and so must its square");
    return max_area ? std::min(*max_area, by_edge) : by_edge;
  }
};

RegionSeed read_region(Fields in, const std::string& path) {
  RegionSeed region;
  Bounds bounds;
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(region.at.x);
        break;
      case 2:
        in.read(region.at.y);
        break;
      case 3:
        in.read(region.id);
        break;
      case 4:
        in.read(bounds.max_area);
        break;
      case 5:
        in.read(bounds.max_edge);
        break;
      default:
        in.skip();
    }
  region.max_area = bounds.area(path);
  return region;
}

Area read_area(Fields in, const std::string& path) {
  Area area;
  Bounds bounds;
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(area.region);
        break;
      case 2:
        in.read(bounds.max_area);
        break;
      case 3:
        in.read(bounds.max_edge);
        break;
      case 4:
        in.read(area.priority);
        break;
      case 5:
        in.read(area.is_hole);
        break;
      default:
        in.skip();
    }
  area.max_area = bounds.area(path);
  return area;
}

// The path of the next element of an array.
template <class T>
std::string next_of(const char* field, const std::vector<T>& elements) {
  return std::string(field) + '[' + text(elements.size()) + ']';
}

class DomainReader {
 public:
  void read(Fields in) {
    while (in.next()) switch (in.number()) {
        case 1:
          points_.read(in);
          break;
        case 2:
          segments_.read(in);
          break;
        case 3:
          in.array(markers_);
          break;
        case 4:
          holes_.read(in);
          break;
        case 5:
          in.message([this](Fields region) {
            auto& regions = pslg_.regions;
            regions.push_back(read_region(region, next_of("domain.regions", regions)));
          });
          break;
        case 6:
          in.read_enumerator(fill_);
          break;
        case 7:
          in.read(pslg_.snap);
          break;
        case 10:
          in.message([this](Fields area) {
            pslg_.areas.push_back(read_area(area, next_of("domain.areas", pslg_.areas)));
          });
          break;
        case 11:
          in.array(areas_);
          break;
        case 12:
          in.array(arc_segments_);
          break;
        case 13:
          in.array(bulges_);
          break;
        default:
          in.skip();
      }
  }

  Pslg take() {
    pslg_.points = points_.take("domain.points", "coordinates");
    pslg_.segments = segments_.take("domain.segments", "point indices");
    pslg_.holes = holes_.take("domain.holes", "coordinates");
    check_one_each("segment_markers", "markers", markers_.size());
    check_one_each("segment_areas", "areas", areas_.size());
    for (std::size_t i = 0; i < markers_.size(); ++i) pslg_.segments[i].marker = markers_[i];
    // 0, for none, becomes kNone.
    for (std::size_t i = 0; i < areas_.size(); ++i) pslg_.segments[i].area = areas_[i] - 1;
    pslg_.arcs = take_arcs();
    pslg_.fill = enumerator(fill_, Fill::kUnion, "domain.fill", "Fill");
    return std::move(pslg_);
  }

 private:
  std::vector<Arc> take_arcs() const {
    if (bulges_.size() != arc_segments_.size())
      refuse(ErrorCode::kBadArray, "domain.arc_bulges",
             "domain.arc_bulges holds " + text(bulges_.size()) + " bulges for " +
                 text(arc_segments_.size()) + " arcs; give one per arc");
    std::vector<Arc> arcs;
    arcs.reserve(bulges_.size());
    for (std::size_t i = 0; i < bulges_.size(); ++i) arcs.push_back({arc_segments_[i], bulges_[i]});
    return arcs;
  }
  void check_one_each(const std::string& name, const char* what, std::size_t count) const {
    const std::size_t segments = pslg_.segments.size();
    if (count == 0 || count == segments) return;
    const std::string field = "domain." + name;
    refuse(ErrorCode::kBadArray, field,
           field + " holds " + text(count) + ' ' + what + " for " + text(segments) +
               " segments; give one per segment, or none");
  }

  Pslg pslg_;
  Points points_;
  Points holes_;
  Rows<Segment, 2> segments_;
  std::vector<std::int32_t> markers_;
  std::vector<std::uint32_t> areas_;
  std::vector<std::uint32_t> arc_segments_;
  std::vector<double> bulges_;
  std::int32_t fill_ = 0;
};

// A Raster or a FieldRaster, which errors call `path`.
template <class T>
GridOf<T> read_grid(Fields in, const std::string& path) {
  GridOf<T> grid;
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(grid.origin.x);
        break;
      case 2:
        in.read(grid.origin.y);
        break;
      case 3:
        in.read(grid.dx);
        break;
      case 4:
        in.read(grid.dy);
        break;
      case 5:
        in.read(grid.columns);
        break;
      case 6:
        in.read(grid.rows);
        break;
      case 7:
        in.array(grid.values);
        break;
      default:
        in.skip();
    }
  for (const auto& [name, value] : {std::pair{".x", grid.origin.x}, {".y", grid.origin.y}})
    if (!std::isfinite(value)) refuse_number(path + name, value, "finite");
  for (const auto& [name, value] : {std::pair{".dx", grid.dx}, {".dy", grid.dy}})
    if (!(std::isfinite(value) && value > 0))
      refuse_number(path + name, value, "positive and finite");
  const std::uint64_t nodes = std::uint64_t{grid.columns} * grid.rows;
  if (nodes == 0 || nodes != grid.values.size())
    refuse(ErrorCode::kBadArray, path + ".values",
           path + ".values holds " + text(grid.values.size()) + " values for " +
               text(grid.columns) + " columns and " + text(grid.rows) +
               " rows; it takes one per node, and at least one node");
  return grid;
}

DistanceSpec read_distance(Fields in, const std::string& path) {
  DistanceSpec distance;
  Points points;
  Rows<std::array<std::uint32_t, 2>, 2> segments;
  while (in.next()) switch (in.number()) {
      case 1:
        in.array(distance.markers);
        break;
      case 2:
        points.read(in);
        break;
      case 3:
        segments.read(in);
        break;
      default:
        in.skip();
    }
  distance.points = points.take(path + ".points", "coordinates");
  distance.segments = segments.take(path + ".segments", "point indices");
  return distance;
}

FieldMesh read_mesh(Fields in, const std::string& path) {
  FieldMesh mesh;
  Points vertices;
  Rows<std::array<std::uint32_t, 3>, 3> triangles;
  while (in.next()) switch (in.number()) {
      case 1:
        vertices.read(in);
        break;
      case 2:
        triangles.read(in);
        break;
      case 3:
        in.array(mesh.values);
        break;
      default:
        in.skip();
    }
  mesh.vertices = vertices.take(path + ".vertices", "coordinates");
  mesh.triangles = triangles.take(path + ".triangles", "vertex indices");
  if (mesh.triangles.empty())
    refuse(ErrorCode::kBadArray, path + ".triangles",
           path + ".triangles is empty; it takes at least one");
  if (mesh.values.size() != mesh.vertices.size())
    refuse(ErrorCode::kBadArray, path + ".values",
           path + ".values holds " + text(mesh.values.size()) + " values for " +
               text(mesh.vertices.size()) + " vertices; it takes one per vertex");
  return mesh;
}

FieldSpec read_field(Fields in, const std::string& path) {
  FieldSpec field;
  bool has_kind = false;
  const auto take = [&](auto kind) {
    field.kind = std::move(kind);
    has_kind = true;
  };
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(field.name);
        break;
      case 2:
        in.message([&](Fields kind) { take(read_distance(kind, path + ".distance")); });
        break;
      case 3:
        in.message([&](Fields kind) { take(read_grid<float>(kind, path + ".raster")); });
        break;
      case 4:
        in.message([&](Fields kind) { take(read_mesh(kind, path + ".mesh")); });
        break;
      case 5:
        in.message([&](Fields) { take(WidthSpec{}); });
        break;
      default:
        in.skip();
    }
  if (!has_kind)
    refuse(ErrorCode::kBadOption, path,
           path + " has no kind; it must be a distance, a raster, a mesh or a width");
  return field;
}

SizeAt read_size_at(Fields in) {
  SizeAt at;
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(at.marker);
        break;
      case 2:
        in.read(at.max_edge);
        break;
      default:
        in.skip();
    }
  return at;
}

void read_size(Fields in, SizeSpec& size) {
  std::int32_t measure = size.measure == Measure::kEdge ? 2 : 0;
  while (in.next()) switch (in.number()) {
      case 1: {
        std::optional<double> constant;
        in.read(constant);
        if (constant) size.value = *constant;
        break;
      }
      case 2: {
        std::optional<std::string> expression;
        in.read(expression);
        if (expression) size.value = *std::move(expression);
        break;
      }
      case 3:
        in.message([&](Fields raster) { size.value = read_grid<double>(raster, "size.raster"); });
        break;
      case 4:
        in.read_enumerator(measure);
        break;
      case 5:
        in.message([&](Fields field) {
          size.fields.push_back(read_field(field, next_of("size.fields", size.fields)));
        });
        break;
      case 6:
        in.read(size.cells_across);
        break;
      case 7:
        in.read(size.gradation);
        break;
      case 8:
        in.message([&](Fields at) { size.at.push_back(read_size_at(at)); });
        break;
      case 9:
        in.read(size.gradation_within);
        break;
      case 10:
        in.read(size.points_per_circle);
        break;
      default:
        in.skip();
    }
  size.measure = enumerator(measure, Measure::kEdge, "size.measure", "Measure");
}

void read_keep(Fields in, std::vector<std::int32_t>& markers) {
  while (in.next())
    if (in.number() == 1)
      in.array(markers);
    else
      in.skip();
}

PeriodicPair read_periodic_sides(Fields in) {
  PeriodicPair pair;
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(pair.from);
        break;
      case 2:
        in.read(pair.to);
        break;
      default:
        in.skip();
    }
  return pair;
}

Layers read_layers(Fields in) {
  Layers layers{.ratio = 0, .rows = 0};
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(layers.marker);
        break;
      case 2:
        in.read(layers.first);
        break;
      case 3:
        in.read(layers.ratio);
        break;
      case 4:
        in.read(layers.rows);
        break;
      case 5:
        in.read(layers.region);
        break;
      default:
        in.skip();
    }
  if (layers.ratio == 0) layers.ratio = 1;
  return layers;
}

void read_quality(Fields in, MeshRequest& request) {
  std::int32_t placement = static_cast<std::int32_t>(request.placement) + 1;
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(request.min_angle_deg);
        break;
      case 2:
        in.read(request.min_edge);
        break;
      case 3:
        in.read_enumerator(placement);
        break;
      case 4:
        in.read(request.sweeps);
        break;
      case 5:
        if (!request.keep) request.keep.emplace();
        in.message([&](Fields keep) { read_keep(keep, *request.keep); });
        break;
      case 6:
        in.message([&](Fields sides) { request.periodic.push_back(read_periodic_sides(sides)); });
        break;
      case 7:
        in.message([&](Fields layers) { request.layers.push_back(read_layers(layers)); });
        break;
      default:
        in.skip();
    }
  request.placement =
      enumerator(placement, Placement::kCircumcentre, "quality.placement", "Placement");
}

void read_budget(Fields in, Request& request) {
  while (in.next()) switch (in.number()) {
      case 1:
        in.read(request.max_triangles);
        break;
      case 2:
        in.read(request.max_bytes);
        break;
      case 3:
        in.read(request.max_seconds);
        break;
      default:
        in.skip();
    }
}

Request read(Fields in) {
  Request request;
  std::optional<DomainReader> domain;
  Points sample_points;
  while (in.next()) switch (in.number()) {
      case 1:
        in.message([&](Fields fields) {
          if (!domain) domain.emplace();
          domain->read(fields);
        });
        break;
      case 2:
        in.message([&](Fields size) { read_size(size, request.mesh.size); });
        break;
      case 3:
        in.message([&](Fields quality) { read_quality(quality, request.mesh); });
        break;
      case 4:
        in.message([&](Fields budget) { read_budget(budget, request); });
        break;
      case 5:
        in.read(request.threads);
        break;
      case 7:
        in.read(request.want_quadtree);
        break;
      case 9:
        in.read(request.mesh.allow_unrefined);
        break;
      case 10:
        in.read(request.mesh.simplify);
        break;
      case 11:
        sample_points.read(in);
        break;
      default:
        in.skip();
    }
  if (!domain) refuse(ErrorCode::kBadOption, "domain", "domain is missing; it is required");
  request.mesh.pslg = domain->take();
  request.mesh.sample_points = sample_points.take("sample_points", "coordinates");
  if (!(std::isfinite(request.max_seconds) && request.max_seconds >= 0))
    refuse_number("budget.max_seconds", request.max_seconds, "0 or more, and finite");
  return request;
}

}  // namespace

Result<Request> read_request(std::string_view bytes) try {
  return read(Fields({bytes.data(), bytes.size()}));
} catch (Refused& refused) {
  return tl::unexpected(std::move(refused.error));
} catch (const protozero::exception&) {
  return fail(ErrorCode::kMalformedRequest, "", "the bytes are not a weft.v1.GenerateMeshRequest");
}

}  // namespace weft::wire
