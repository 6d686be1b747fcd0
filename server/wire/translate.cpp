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

namespace weft::server {
namespace {

v1::SizeWarningKind to_wire(SizeWarning::Kind kind) {
  switch (kind) {
    case SizeWarning::Kind::kBoundsNothing:
      return v1::SIZE_WARNING_KIND_BOUNDS_NOTHING;
    case SizeWarning::Kind::kCoarseRaster:
      return v1::SIZE_WARNING_KIND_COARSE_RASTER;
    case SizeWarning::Kind::kFieldNotNamed:
      return v1::SIZE_WARNING_KIND_FIELD_NOT_NAMED;
    case SizeWarning::Kind::kGradationWithinAlone:
      return v1::SIZE_WARNING_KIND_GRADATION_WITHIN_ALONE;
  }
  return v1::SIZE_WARNING_KIND_UNSPECIFIED;
}

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

void write_unrefined(const Summary& summary, v1::Unrefined& message) {
  const Unrefined& unrefined = summary.unrefined;
  message.set_small_input_angle(unrefined.small_input_angle);
  message.set_edge_floor(unrefined.edge_floor);
  message.set_budget(unrefined.budget);
  message.set_precision(unrefined.precision);
  message.set_streaming(unrefined.streaming);
  message.set_too_large(unrefined.too_large);
  if (unrefined.without_exemption() == 0) return;
  message.set_x(summary.unrefined_at.x);
  message.set_y(summary.unrefined_at.y);
}

void write_merging(const Merging& merging, v1::Merging& message) {
  message.set_tolerance(merging.tolerance);
  message.set_points(merging.points);
  message.set_segments(merging.segments);
  message.set_farthest(merging.farthest);
  if (merging.farthest > 0) {
    message.set_farthest_x(merging.farthest_at.x);
    message.set_farthest_y(merging.farthest_at.y);
  }
  message.set_vanished_faces(merging.vanished_faces);
  if (merging.vanished_faces > 0) {
    message.set_vanished_x(merging.vanished_at.x);
    message.set_vanished_y(merging.vanished_at.y);
  }
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
  message.set_vertices(summary.vertices);
  message.set_triangles(summary.triangles);
  message.set_edges(summary.edges);
  message.set_chunks(summary.chunks);
  message.set_area(summary.area);
  message.set_engine_version(std::string(kEngineVersion));
  message.set_min_angle_deg(summary.min_angle_deg);
  message.set_max_angle_deg(summary.max_angle_deg);
  message.set_min_angle_p1_deg(summary.min_angle_p1_deg);
  message.set_mean_quality(summary.mean_quality);
  message.set_ideal_ratio(summary.ideal_ratio);
  message.set_lattice_share(summary.lattice_share);
  message.set_streamed(summary.streamed);
  assign(*message.mutable_angle_histogram(), summary.angle_histogram);
  assign(*message.mutable_aspect_histogram(), summary.aspect_histogram);
  assign(*message.mutable_size_histogram(), summary.size_histogram);
  write_unrefined(summary, *message.mutable_unrefined());
  write_merging(summary.merging, *message.mutable_merging());
  if (summary.overlap.areas > 0) {
    v1::Overlap& overlap = *message.mutable_overlap();
    overlap.set_areas(summary.overlap.areas);
    overlap.set_area(summary.overlap.area);
    overlap.set_united(summary.overlap.united);
  }
  if (summary.simplified) {
    v1::Simplification& simplification = *message.mutable_simplification();
    simplification.set_points(summary.simplified->points);
    simplification.set_islands(summary.simplified->islands);
    simplification.set_waters(summary.simplified->waters);
    simplification.set_channels(summary.simplified->channels);
    simplification.set_cut_off(summary.simplified->cut_off);
    simplification.set_straits(summary.simplified->straits);
    simplification.set_area(summary.simplified->area);
    simplification.set_farthest(summary.simplified->farthest);
  }
  if (summary.outside.segments > 0) {
    v1::OutsideSegments& outside = *message.mutable_outside();
    outside.set_segments(summary.outside.segments);
    outside.set_first(summary.outside.first);
    outside.set_x(summary.outside.at.x);
    outside.set_y(summary.outside.at.y);
  }
  if (summary.narrow) {
    v1::NarrowPlace& narrow = *message.mutable_narrow();
    narrow.set_segment(summary.narrow->segment);
    narrow.set_other(summary.narrow->other);
    narrow.set_x(summary.narrow->at.x);
    narrow.set_y(summary.narrow->at.y);
    narrow.set_width(summary.narrow->width);
    narrow.set_triangles(static_cast<std::uint64_t>(summary.narrow->triangles));
    narrow.set_in_all(static_cast<std::uint64_t>(summary.narrow->in_all));
    narrow.set_widest(summary.narrow->widest);
  }
  for (const SizeWarning& warning : summary.size_warnings) {
    v1::SizeWarning& warned = *message.add_size_warnings();
    warned.set_kind(to_wire(warning.kind));
    warned.set_field(warning.field);
    warned.set_message(warning.message);
  }
  v1::Timings& timings = *message.mutable_timings();
  timings.set_triangulate_seconds(summary.triangulate_seconds);
  timings.set_size_seconds(summary.size_seconds);
  timings.set_prelude_seconds(summary.coarse_seconds);
  timings.set_refine_seconds(summary.refine_seconds);
  timings.set_emit_seconds(summary.emit_seconds);
  timings.set_engine_seconds(summary.engine_seconds);
  message.set_peak_engine_bytes(summary.peak_bytes);
  message.set_insertions(summary.insertions);
  message.set_exact_predicates(summary.exact_predicates);
  message.set_sha256(to_string(summary.digest));
  message.set_threads(threads);
  message.set_deferred(summary.deferred);
  message.set_rounds(summary.rounds);
  message.set_leaves(static_cast<std::uint32_t>(summary.leaves.size()));
  return message;
}

void add_quadtree(const Summary& summary, v1::Summary& message) {
  if (summary.leaves.size() > kMaxLeafBoxes) return;
  auto& boxes = *message.mutable_leaf_boxes();
  boxes.Reserve(4 * static_cast<int>(summary.leaves.size()));
  for (const Box& box : summary.leaves)
    for (const double side : {box.min_x, box.min_y, box.max_x, box.max_y})
      boxes.AddAlreadyReserved(side);
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
