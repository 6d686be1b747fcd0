// SPDX-License-Identifier: Apache-2.0
#include "tests/client/support/sample_stream.h"

#include <openssl/sha.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include "client/report/mesh_angles.h"

namespace weft::client {
namespace {

// The bytes of a number, lowest first.
template <class T>
void put(std::string& out, T value) {
  std::uint64_t bits = 0;
  if constexpr (std::is_same_v<T, double>) {
    bits = std::bit_cast<std::uint64_t>(value);
  } else {
    bits = static_cast<std::uint32_t>(value);
  }
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out += static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
}

std::string sha256(const std::string& bytes) {
  std::string digest(32, '\0');
  ::SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
           reinterpret_cast<unsigned char*>(digest.data()));
  return digest;
}

std::string digest_of(const v1::Chunk& chunk) {
  std::string bytes;
  for (const double c : chunk.coordinates()) put(bytes, c);
  for (const std::uint32_t v : chunk.triangles()) put(bytes, v);
  for (int t = 0; t < chunk.triangles_size() / 3; ++t)
    put(bytes, chunk.regions().empty() ? 0 : chunk.regions(t));
  for (int e = 0; e < chunk.edges_size() / 2; ++e) {
    put(bytes, chunk.edges(2 * e));
    put(bytes, chunk.edges(2 * e + 1));
    put(bytes, chunk.edge_segments(e));
    put(bytes, chunk.edge_markers().empty() ? 0 : chunk.edge_markers(e));
  }
  for (const std::uint32_t v : chunk.input_points()) put(bytes, v);
  for (const double bulge : chunk.edge_bulges()) put(bytes, bulge);
  return sha256(bytes);
}

}  // namespace

std::vector<v1::GenerateMeshResponse> stream_of(const Mesh& mesh, std::size_t chunks) {
  std::vector<v1::GenerateMeshResponse> stream(2);
  stream[0].mutable_accepted()->set_job_id("job-1");
  stream[0].mutable_accepted()->set_engine_version("1");
  stream[0].mutable_accepted()->set_threads(2);
  stream[1].mutable_progress()->set_stage(v1::STAGE_REFINE);
  stream[1].mutable_progress()->set_triangles(10);
  stream[1].mutable_progress()->set_expected_triangles(100);

  const std::size_t vertices = mesh.coordinates.size() / 2;
  const std::size_t triangles = mesh.triangles.size() / 3;
  std::size_t sent = 0;  // vertices
  for (std::size_t k = 0; k < chunks; ++k) {
    v1::Chunk& chunk = *stream.emplace_back().mutable_chunk();
    const std::size_t first = triangles * k / chunks;
    const std::size_t end = triangles * (k + 1) / chunks;
    std::size_t needed = k + 1 == chunks ? vertices : sent;
    for (std::size_t i = 3 * first; i < 3 * end; ++i)
      needed = std::max<std::size_t>(needed, mesh.triangles[i] + 1);
    chunk.set_index(static_cast<std::uint32_t>(k));
    chunk.set_first_vertex(static_cast<std::uint32_t>(sent));
    chunk.set_first_triangle(static_cast<std::uint32_t>(first));
    for (std::size_t i = 2 * sent; i < 2 * needed; ++i) chunk.add_coordinates(mesh.coordinates[i]);
    sent = needed;
    for (std::size_t i = 3 * first; i < 3 * end; ++i) chunk.add_triangles(mesh.triangles[i]);
    const auto region = [&mesh](std::size_t t) { return mesh.regions[t]; };
    bool any = false;
    for (std::size_t t = first; t < end; ++t) any |= region(t) != 0;
    for (std::size_t t = first; t < end && any; ++t) chunk.add_regions(region(t));
    if (k + 1 == chunks) {
      for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e) {
        chunk.add_edges(mesh.edges[2 * e]);
        chunk.add_edges(mesh.edges[2 * e + 1]);
        chunk.add_edge_markers(mesh.edge_markers[e]);
        chunk.add_edge_segments(static_cast<std::uint32_t>(mesh.edge_markers[e] - 1));
      }
      chunk.add_input_points(0);
      chunk.add_input_points(0);
    }
  }
  v1::Summary& summary = *stream.emplace_back().mutable_summary();
  const AngleRange angles = mesh_angles(mesh.view());
  summary.set_vertices(vertices);
  summary.set_triangles(triangles);
  summary.set_edges(mesh.edge_markers.size());
  summary.set_chunks(static_cast<std::uint32_t>(chunks));
  summary.set_min_angle_deg(angles.min_deg);
  summary.set_max_angle_deg(angles.max_deg);
  summary.set_threads(2);
  v1::Timings& timings = *summary.mutable_timings();
  timings.set_triangulate_seconds(0.0625);
  timings.set_size_seconds(0.125);
  timings.set_prelude_seconds(0.25);
  timings.set_refine_seconds(0.75);
  timings.set_emit_seconds(0.375);
  timings.set_engine_seconds(0.5);
  summary.set_deferred(3);
  summary.set_rounds(2);
  summary.set_leaves(1);
  summary.set_engine_version("1");
  for (const double side : {0, 0, 1, 1}) summary.add_leaf_boxes(side);
  seal(stream);
  return stream;
}

void seal(std::vector<v1::GenerateMeshResponse>& stream) {
  std::string digests;
  for (auto& message : stream) {
    if (message.has_chunk()) {
      message.mutable_chunk()->set_sha256(digest_of(message.chunk()));
      digests += message.chunk().sha256();
    }
    if (message.has_summary()) message.mutable_summary()->set_sha256(sha256(digests));
  }
}

}  // namespace weft::client
