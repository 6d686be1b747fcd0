// SPDX-License-Identifier: Apache-2.0
#include "server/wire/translate.h"

#include <fmt/format.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "server/wire/names.h"
#include "server/wire/points.h"
#include "server/wire/size_field.h"
#include "wire/summary.h"

namespace weft::server {
namespace {

std::optional<Failure> check_pairs(std::string_view field, int size, std::string_view what) {
  if (size % 2 == 0) return std::nullopt;
  return Failure{Reason::kBadArray, std::string(field),
                 fmt::format("{} holds {} numbers; {} come in pairs", field, size, what)};
}

bool not_negative(double value) {
  return std::isfinite(value) && value >= 0;
}

// Of a region or an area.
template <class Bounded>
std::optional<Failure> check_bounds(const std::string& field, const Bounded& bounded) {
  if (bounded.has_max_area() && !(std::isfinite(bounded.max_area()) && bounded.max_area() > 0))
    return bad_option(field + ".max_area",
                      fmt::format("{}.max_area is {}; it must be positive and finite", field,
                                  bounded.max_area()));
  const double area = area_of_edge(bounded.max_edge());
  if (bounded.has_max_edge() && !(std::isfinite(area) && area > 0))
    return bad_option(field + ".max_edge",
                      fmt::format("{}.max_edge is {}; it must be positive and finite, and so must "
                                  "its square",
                                  field, bounded.max_edge()));
  return std::nullopt;
}

// The bound on the areas of triangles that max_area and max_edge of a region or an area make
// together.
template <class Bounded>
std::optional<double> max_area_of(const Bounded& bounded) {
  std::optional<double> area;
  if (bounded.has_max_area()) area = bounded.max_area();
  if (!bounded.has_max_edge()) return area;
  const double by_edge = area_of_edge(bounded.max_edge());
  return area ? std::min(*area, by_edge) : by_edge;
}

Fill to_engine(v1::Fill fill) {
  switch (fill) {
    case v1::FILL_EVEN_ODD:
      return Fill::kEvenOdd;
    case v1::FILL_UNION:
      return Fill::kUnion;
    default:
      return Fill::kSeeds;
  }
}

std::optional<Failure> check_domain(const v1::Domain& domain) {
  if (auto f = check_pairs("domain.points", domain.points_size(), "coordinates")) return f;
  if (auto f = check_pairs("domain.segments", domain.segments_size(), "point indices")) return f;
  if (auto f = check_pairs("domain.holes", domain.holes_size(), "coordinates")) return f;
  const int segments = domain.segments_size() / 2;
  const int markers = domain.segment_markers_size();
  if (markers != 0 && markers != segments)
    return Failure{Reason::kBadArray, "domain.segment_markers",
                   fmt::format("domain.segment_markers holds {} markers for {} segments; give one "
                               "per segment, or none",
                               markers, segments)};
  const int areas = domain.segment_areas_size();
  if (areas != 0 && areas != segments)
    return Failure{Reason::kBadArray, "domain.segment_areas",
                   fmt::format("domain.segment_areas holds {} areas for {} segments; give one per "
                               "segment, or none",
                               areas, segments)};
  for (int i = 0; i < domain.regions_size(); ++i)
    if (auto f = check_bounds(fmt::format("domain.regions[{}]", i), domain.regions(i))) return f;
  for (int i = 0; i < domain.areas_size(); ++i)
    if (auto f = check_bounds(fmt::format("domain.areas[{}]", i), domain.areas(i))) return f;
  if (!v1::Fill_IsValid(domain.fill()))
    return bad_option("domain.fill", fmt::format("domain.fill is {}, which is not a Fill",
                                                 static_cast<int>(domain.fill())));
  return check_names(domain);
}

Pslg to_engine(const v1::Domain& domain) {
  Pslg out;
  out.points = to_points(domain.points());
  out.holes = to_points(domain.holes());
  out.segments.resize(static_cast<std::size_t>(domain.segments_size() / 2));
  const bool marked = domain.segment_markers_size() != 0;
  const bool bordering = domain.segment_areas_size() != 0;
  for (std::size_t i = 0; i < out.segments.size(); ++i) {
    const std::uint32_t* ends = domain.segments().data() + 2 * i;
    // 0, for none, becomes kNone.
    const std::uint32_t area = bordering ? domain.segment_areas().data()[i] - 1 : kNone;
    out.segments[i] = {ends[0], ends[1], marked ? domain.segment_markers().data()[i] : 0, area};
  }
  out.regions.reserve(static_cast<std::size_t>(domain.regions_size()));
  for (const v1::Region& region : domain.regions())
    out.regions.push_back({{region.x(), region.y()}, region.id(), max_area_of(region)});
  out.areas.reserve(static_cast<std::size_t>(domain.areas_size()));
  for (const v1::Area& area : domain.areas())
    out.areas.push_back({.region = area.has_region() ? std::optional(area.region()) : std::nullopt,
                         .priority = area.priority(),
                         .max_area = max_area_of(area),
                         .is_hole = area.hole()});
  out.fill = to_engine(domain.fill());
  out.snap = domain.snap();
  return out;
}

// All of a request but its domain and its size.
MeshRequest options_of(const v1::GenerateMeshRequest& request) {
  MeshRequest out;
  if (request.quality().has_min_angle_deg()) out.min_angle_deg = request.quality().min_angle_deg();
  out.min_edge = request.quality().min_edge();
  if (request.quality().placement() == v1::PLACEMENT_CIRCUMCENTRE)
    out.placement = Placement::kCircumcentre;
  if (request.quality().has_optimise()) out.sweeps = request.quality().optimise();
  out.simplify = request.simplify();
  out.allow_unrefined = request.allow_unrefined();
  return out;
}

template <class Array, class Values>
void assign(Array& array, const Values& values) {
  array.Clear();
  array.Add(values.data(), values.data() + values.size());
}

template <class Bytes>
std::string to_string(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::optional<Failure> check_shape(const v1::GenerateMeshRequest& request) {
  if (!request.has_domain()) return bad_option("domain", "domain is missing; it is required");
  if (auto f = check_domain(request.domain())) return f;

  if (auto f = check_shape(request.size())) return f;
  const v1::Quality& quality = request.quality();
  if (!v1::Placement_IsValid(quality.placement()))
    return bad_option("quality.placement",
                      fmt::format("quality.placement is {}, which is not a Placement",
                                  static_cast<int>(quality.placement())));
  if (!not_negative(request.budget().max_seconds()))
    return bad_option("budget.max_seconds",
                      fmt::format("budget.max_seconds is {}; it must be 0 or more, and finite",
                                  request.budget().max_seconds()));
  return std::nullopt;
}

std::optional<Failure> check_values(const v1::GenerateMeshRequest& request) {
  if (const auto error = check_options(options_of(request))) return failure_of(*error);
  return check_values(request.size());
}

MeshRequest to_engine(const v1::GenerateMeshRequest& request) {
  MeshRequest out = options_of(request);
  out.pslg = to_engine(request.domain());
  out.size = to_engine(request.size());
  return out;
}

Budget to_budget(const v1::Budget& budget, const Limits& limits) {
  Budget out;
  if (budget.max_triangles() != 0) out.max_triangles = budget.max_triangles();
  out.triangle_limit = limits.max_triangles;
  out.max_bytes = budget.max_bytes() != 0 ? budget.max_bytes() : limits.max_bytes;
  return out;
}

double to_seconds(const v1::Budget& budget, const Limits& limits) {
  return budget.max_seconds() != 0 ? budget.max_seconds() : limits.max_seconds;
}

std::uint32_t to_threads(std::uint32_t wanted, int available) {
  const auto all = static_cast<std::uint32_t>(available);
  return wanted == 0 ? all : std::min(wanted, all);
}

void to_wire(const Chunk& chunk, v1::Chunk& message) {
  message.set_index(chunk.index);
  message.set_first_vertex(chunk.first_vertex);
  message.set_first_triangle(chunk.first_triangle);
  assign(*message.mutable_coordinates(), chunk.coordinates);
  assign(*message.mutable_triangles(), chunk.triangles);
  assign(*message.mutable_regions(), chunk.regions);

  auto& ends = *message.mutable_edges();
  auto& markers = *message.mutable_edge_markers();
  auto& segments = *message.mutable_edge_segments();
  ends.Clear();
  markers.Clear();
  segments.Clear();
  const int edges = static_cast<int>(chunk.edges.size());
  ends.Reserve(2 * edges);
  segments.Reserve(edges);
  const bool marked = std::any_of(chunk.edges.begin(), chunk.edges.end(),
                                  [](const Chunk::Edge& edge) { return edge.marker != 0; });
  if (marked) markers.Reserve(edges);
  for (const Chunk::Edge& edge : chunk.edges) {
    ends.AddAlreadyReserved(edge.a);
    ends.AddAlreadyReserved(edge.b);
    segments.AddAlreadyReserved(edge.segment);
    if (marked) markers.AddAlreadyReserved(edge.marker);
  }

  auto& input_points = *message.mutable_input_points();
  input_points.Clear();
  input_points.Reserve(2 * static_cast<int>(chunk.input_points.size()));
  for (const auto& [vertex, point] : chunk.input_points) {
    input_points.AddAlreadyReserved(vertex);
    input_points.AddAlreadyReserved(point);
  }
  assign(*message.mutable_box(),
         std::array{chunk.box.min_x, chunk.box.min_y, chunk.box.max_x, chunk.box.max_y});
  message.set_sha256(to_string(chunk.digest));
}

v1::Summary to_wire(const Summary& summary, std::uint32_t threads) {
  v1::Summary message;
  message.ParseFromString(wire::write_summary(summary, threads));
  return message;
}

void add_quadtree(const Summary& summary, v1::Summary& message) {
  message.MergeFromString(wire::write_leaf_boxes(summary));
}

v1::Stage to_wire(Stage stage) {
  switch (stage) {
    case Stage::kQueued:
      return v1::STAGE_QUEUED;
    case Stage::kTriangulate:
      return v1::STAGE_TRIANGULATE;
    case Stage::kSize:
      return v1::STAGE_SIZE;
    case Stage::kRefine:
      return v1::STAGE_REFINE;
    case Stage::kDone:
      return v1::STAGE_EMIT;
  }
  return v1::STAGE_UNSPECIFIED;
}

void write_progress(const Progress& now, double elapsed_seconds, v1::Progress& progress) {
  progress.set_stage(std::max(progress.stage(), to_wire(now.stage)));
  progress.set_triangles(std::max<std::uint64_t>(progress.triangles(), now.triangles));
  progress.set_expected_triangles(now.expected_triangles);
  progress.set_fraction(std::max(progress.fraction(), now.fraction));
  progress.set_elapsed_seconds(elapsed_seconds);
}

grpc::ByteBuffer serialize(const google::protobuf::MessageLite& message) {
  grpc::ByteBuffer bytes;
  bool own_buffer = false;
  const grpc::Status status =
      grpc::GenericSerialize<grpc::ProtoBufferWriter, google::protobuf::MessageLite>(
          message, &bytes, &own_buffer);
  // Serializing fails only above 2 GiB, and no message here comes near that.
  if (!status.ok()) throw std::length_error(status.error_message());
  return bytes;
}

}  // namespace weft::server
