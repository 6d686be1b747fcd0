// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_receiver.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "wire/chunk_view.h"

namespace weft::client {
namespace {

using wire::span_of;

static_assert(std::endian::native == std::endian::little,
              "arrays are hashed as they lie in memory");

tl::unexpected<Error> damaged(const std::string& what) {
  return fail(ExitCode::kDataLoss, "the stream is damaged: " + what);
}

tl::unexpected<Error> damaged(const v1::Chunk& chunk, const std::string& what) {
  return damaged("chunk " + std::to_string(chunk.index()) + " " + what);
}

// The first index that is not below the limit, if there is one. The common case reads each once and
// does not branch.
std::optional<std::uint32_t> out_of_range(std::span<const std::uint32_t> indices,
                                          std::uint64_t limit) {
  std::uint32_t largest = 0;
  for (const std::uint32_t i : indices) largest = std::max(largest, i);
  if (indices.empty() || largest < limit) return std::nullopt;
  return *std::find_if(indices.begin(), indices.end(),
                       [limit](std::uint32_t i) { return i >= limit; });
}

}  // namespace

template <class Message>
Result<void> MeshReceiver::receive_either(const Message& message) {
  bytes_ += message.ByteSizeLong();
  if (summary_) return damaged("a message follows the summary");
  if ((!accepted_ || resuming_) && !message.has_accepted())
    return damaged("its first message is not `accepted`");
  if (message.has_accepted()) return receive(message.accepted());
  if (message.has_chunk()) return receive(message.chunk());
  if (message.has_summary()) return receive(message.summary());
  if constexpr (requires { message.has_progress(); })
    if (message.has_progress()) return {};
  return damaged("a message is empty or of an unknown kind");
}

Result<void> MeshReceiver::receive(const v1::GenerateMeshResponse& message) {
  return receive_either(message);
}

Result<void> MeshReceiver::receive(const v1::FetchMeshResponse& message) {
  return receive_either(message);
}

Result<void> MeshReceiver::receive(const v1::Accepted& accepted) {
  if (accepted_ && !resuming_) return damaged("`accepted` came twice");
  // Another engine may go on differently, so a mesh is finished only by the engine that began it.
  if (accepted_ && accepted_->engine_version() != accepted.engine_version())
    return damaged("it was resumed by engine " + accepted.engine_version() + ", engine " +
                   accepted_->engine_version() + " had begun it");
  accepted_ = accepted;
  resuming_ = false;
  return {};
}

Result<void> MeshReceiver::check_shape(const v1::Chunk& chunk) const {
  if (chunk.index() != chunks_)
    return damaged(chunk, "came where chunk " + std::to_string(chunks_) + " should");
  if (chunk.first_vertex() != spool_.vertices())
    return damaged(chunk, "starts at vertex " + std::to_string(chunk.first_vertex()) +
                              ", it should start at " + std::to_string(spool_.vertices()));
  if (chunk.first_triangle() != spool_.triangles())
    return damaged(chunk, "starts at triangle " + std::to_string(chunk.first_triangle()) +
                              ", it should start at " + std::to_string(spool_.triangles()));
  const int triangles = chunk.triangles_size() / 3;
  const int edges = chunk.edges_size() / 2;
  const auto is = [](int size, int expected) { return size == expected; };
  const bool shapes = chunk.coordinates_size() % 2 == 0 && chunk.triangles_size() % 3 == 0 &&
                      (is(chunk.regions_size(), 0) || is(chunk.regions_size(), triangles)) &&
                      chunk.edges_size() % 2 == 0 &&
                      (is(chunk.edge_markers_size(), 0) || is(chunk.edge_markers_size(), edges)) &&
                      is(chunk.edge_segments_size(), edges) &&
                      (is(chunk.edge_bulges_size(), 0) || is(chunk.edge_bulges_size(), edges)) &&
                      chunk.input_points_size() % 2 == 0 &&
                      (is(chunk.box_size(), 0) || is(chunk.box_size(), 4));
  if (!shapes) return damaged(chunk, "has arrays whose lengths do not fit");
  return {};
}

Result<void> MeshReceiver::check_indices(const v1::Chunk& chunk) const {
  const auto refuse = [&chunk](const char* what, std::uint32_t index, std::uint64_t limit) {
    return damaged(chunk, std::string("names ") + what + " " + std::to_string(index) + " of " +
                              std::to_string(limit));
  };
  const std::uint64_t vertices =
      spool_.vertices() + static_cast<std::uint64_t>(chunk.coordinates_size() / 2);
  if (const auto bad = out_of_range(span_of(chunk.triangles()), vertices))
    return refuse("vertex", *bad, vertices);
  if (const auto bad = out_of_range(span_of(chunk.edges()), vertices))
    return refuse("vertex", *bad, vertices);
  if (domain_)
    if (const auto bad = out_of_range(span_of(chunk.edge_segments()), domain_->segments))
      return refuse("segment", *bad, domain_->segments);
  for (int i = 0; i < chunk.input_points_size(); i += 2) {
    if (chunk.input_points(i) >= vertices) return refuse("vertex", chunk.input_points(i), vertices);
    if (domain_ && chunk.input_points(i + 1) >= domain_->points)
      return refuse("input point", chunk.input_points(i + 1), domain_->points);
  }
  double finite = 0;  // NaN if any coordinate is not finite
  for (const double c : chunk.coordinates()) finite += c * 0;
  if (finite != 0) return damaged(chunk, "has a coordinate that is not finite");
  for (const double bulge : chunk.edge_bulges())
    if (!(std::fabs(bulge) <= 1)) return damaged(chunk, "has an edge that is no chord of an arc");
  return {};
}

// The layout of Chunk.sha256.
std::string MeshReceiver::digest_of(const v1::Chunk& chunk) {
  const auto add = [this]<class T>(std::span<const T> values) {
    hash_.add(values.data(), values.size_bytes());
  };
  add(span_of(chunk.coordinates()));
  add(span_of(chunk.triangles()));
  const auto triangles = static_cast<std::size_t>(chunk.triangles_size()) / 3;
  if (chunk.regions().empty()) {
    add(std::span<const std::int32_t>(zeros_).first(triangles));
  } else {
    add(span_of(chunk.regions()));
  }
  edges_.clear();
  for (int e = 0; e < chunk.edge_segments_size(); ++e) {
    const std::int32_t marker = chunk.edge_markers().empty() ? 0 : chunk.edge_markers(e);
    edges_.insert(edges_.end(), {chunk.edges(2 * e), chunk.edges(2 * e + 1), chunk.edge_segments(e),
                                 static_cast<std::uint32_t>(marker)});
  }
  add(std::span<const std::uint32_t>(edges_));
  add(span_of(chunk.input_points()));
  add(span_of(chunk.edge_bulges()));
  return hash_.finish();
}

Result<void> MeshReceiver::receive(const v1::Chunk& chunk) {
  if (auto ok = check_shape(chunk); !ok) return ok;
  if (auto ok = check_indices(chunk); !ok) return ok;
  const auto triangles = static_cast<std::size_t>(chunk.triangles_size()) / 3;
  zeros_.resize(std::max(zeros_.size(), triangles));
  const std::string digest = digest_of(chunk);
  if (digest != chunk.sha256()) return damaged(chunk, "does not match its SHA-256");
  mesh_hash_.add(digest.data(), digest.size());
  ++chunks_;

  return spool_.append(wire::view_of(chunk));
}

Result<void> MeshReceiver::receive(const v1::Summary& summary) {
  struct Count {
    const char* what;
    std::uint64_t received;
    std::uint64_t announced;
  };
  for (const auto& [what, received, announced] :
       {Count{"chunks", chunks_, summary.chunks()},
        Count{"vertices", spool_.vertices(), summary.vertices()},
        Count{"triangles", spool_.triangles(), summary.triangles()},
        Count{"edges", spool_.edges(), summary.edges()}})
    if (received != announced)
      return damaged(std::to_string(received) + " " + what + " came, the summary says " +
                     std::to_string(announced));
  const auto sides = static_cast<std::uint64_t>(summary.leaf_boxes_size());
  if (sides != 0 && sides != 4 * std::uint64_t{summary.leaves()})
    return damaged(std::to_string(sides) + " sides of boxes came for " +
                   std::to_string(summary.leaves()) + " leaves");
  if (!std::all_of(summary.leaf_boxes().begin(), summary.leaf_boxes().end(),
                   [](double side) { return std::isfinite(side); }))
    return damaged("a leaf's box is not finite");
  if (mesh_hash_.finish() != summary.sha256())
    return damaged("the mesh does not match the SHA-256 of the summary");
  summary_ = summary;
  return {};
}

Result<void> MeshReceiver::finish() const {
  if (!summary_) return damaged("it ended without a summary");
  return {};
}

}  // namespace weft::client
