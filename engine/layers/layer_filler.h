// SPDX-License-Identifier: Apache-2.0
// Fills the holes that a LayerPlan left: passes a mesh on, and adds rows of triangles between the
// line on which layers end and the walls. Each edge of the mesh on the line becomes a column: its
// ends lead to the wall, to places that divide the wall's edge as they divide the piece of the
// line.
//
//   LayerFiller filler(request.layers, pslg, domain, plan, sink);
//   auto summary = ... run with `filler` as the sink ...
//   if (auto error = filler.finish(context, *summary)) return error;
//
// Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/emit/digest.h"
#include "engine/layers/layer_plan.h"
#include "weft/error.h"
#include "weft/mesh.h"
#include "weft/weft.h"

namespace weft {

class LayerFiller final : public ChunkSink {
 public:
  // All outlive it. The domain is that of the PSLG, without layers, of which the plan was made.
  LayerFiller(const std::vector<Layers>& layers, const Pslg& pslg, const Domain& domain,
              const LayerPlan& plan, ChunkSink& sink);

  // A chunk of the mesh of `plan.with_holes(pslg)`.
  bool accept(Chunk&& chunk) override;

  // Sends the layers, and makes the summary of the rest of the mesh one of all of it. Errors:
  // kLimitExceeded for triangles over the limit; what stopped the context; kCancelled if the sink
  // accepts no more.
  std::optional<Error> finish(const ExecutionContext& context, Summary& summary);

 private:
  // From the wall to the line, both included; all the same in a point.
  struct Column {
    std::vector<std::uint32_t> vertices;
    std::vector<Point> places;
  };
  // An edge of the mesh on the line, from the first to the last spoke of its piece.
  struct LineEdge {
    std::uint32_t piece = 0;
    std::uint32_t first = 0, last = 0;  // mesh vertices
    double from = 0, to = 0;            // where on the piece: 0 to 1
  };

  Point at(std::uint32_t vertex) const {
    return {coordinates_[2 * std::size_t{vertex}], coordinates_[2 * std::size_t{vertex} + 1]};
  }
  std::vector<LineEdge> edges_in_order() const;
  std::uint32_t add_vertex(Point p);
  std::uint32_t wall_vertex(std::uint32_t spoke);
  Column column(std::uint32_t layers, std::uint32_t wall, Point base, std::uint32_t end);
  Column column_of_spoke(std::uint32_t layers, std::uint32_t spoke, std::uint32_t end);
  void add_edge(std::uint32_t a, std::uint32_t b, std::uint32_t subsegment);
  void add_triangle(const std::array<std::uint32_t, 3>& corners, std::int32_t region);
  void fill(const Column& from, const Column& to, std::int32_t region);
  std::optional<Error> send(const ExecutionContext& context, Summary& summary);

  const std::vector<Layers>& layers_;
  const Pslg& pslg_;
  const Domain& domain_;
  const LayerPlan& plan_;
  ChunkSink& sink_;
  std::vector<std::vector<double>> heights_;  // per layers
  std::vector<std::int32_t> regions_;         // per layers

  std::vector<double> coordinates_;  // of the vertices of the mesh, without layers
  std::vector<Chunk::Edge> line_;
  // Vertices of the mesh by the points of the PSLG with holes.
  std::unordered_map<std::uint32_t, std::uint32_t> vertex_of_point_;
  std::unordered_map<std::uint32_t, std::uint32_t> wall_vertices_;  // by vertices of the domain
  std::size_t sent_ = 0;                                            // vertices
  Chunk chunk_;                                                     // not sent yet
  Sha256 digest_;
};

}  // namespace weft
