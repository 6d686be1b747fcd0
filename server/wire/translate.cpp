// SPDX-License-Identifier: Apache-2.0
#include "server/wire/translate.h"

#include <grpcpp/impl/codegen/proto_utils.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "server/wire/names.h"
#include "wire/request.h"
#include "wire/summary.h"

namespace weft::server {
namespace {

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

tl::expected<MeshRequest, Failure> to_engine(const v1::GenerateMeshRequest& request) {
  auto read = wire::read_request(request.SerializeAsString());
  if (!read) return tl::unexpected(failure_of(read.error()));
  if (auto failure = check_names(request.domain())) return tl::unexpected(*failure);
  return std::move(read->mesh);
}

std::optional<Failure> check_values(const MeshRequest& request) {
  std::optional<Error> error = check_options(request);
  if (!error) error = check_size(request.size);
  if (const auto* raster = std::get_if<Raster>(&request.size.value); raster != nullptr && !error)
    error = check_raster_values(raster->values, raster->columns);
  return error ? std::optional(failure_of(*error)) : std::nullopt;
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

  assign(*message.mutable_edge_bulges(), chunk.bulges);

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
