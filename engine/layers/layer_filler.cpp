// SPDX-License-Identifier: Apache-2.0
#include "engine/layers/layer_filler.h"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "engine/base/vector.h"

namespace weft {

LayerFiller::LayerFiller(const std::vector<Layers>& layers, const Pslg& pslg, const Domain& domain,
                         const LayerPlan& plan, ChunkSink& sink)
    : layers_(layers), pslg_(pslg), domain_(domain), plan_(plan), sink_(sink) {
  std::int32_t highest = 0;
  for (const RegionSeed& seed : pslg.regions) highest = std::max(highest, seed.id);
  for (const Area& area : pslg.areas) highest = std::max(highest, area.region.value_or(0));
  for (const Layers& each : layers) {
    heights_.push_back(heights_of(each));
    regions_.push_back(each.region.value_or(highest < INT32_MAX ? highest + 1 : highest));
  }
}

bool LayerFiller::accept(Chunk&& chunk) {
  coordinates_.insert(coordinates_.end(), chunk.coordinates.begin(), chunk.coordinates.end());
  for (const auto [vertex, point] : chunk.input_points) vertex_of_point_.emplace(point, vertex);
  const auto is_line = [this](const Chunk::Edge& edge) {
    return edge.segment >= pslg_.segments.size();
  };
  std::copy_if(chunk.edges.begin(), chunk.edges.end(), std::back_inserter(line_), is_line);
  std::erase_if(chunk.edges, is_line);
  std::erase_if(chunk.input_points,
                [this](const auto& input) { return input[1] >= pslg_.points.size(); });
  chunk.digest = chunk_digest(chunk);
  digest_.add(chunk.digest.data(), chunk.digest.size());
  sent_ = chunk.first_vertex + chunk.coordinates.size() / 2;
  return sink_.accept(std::move(chunk));
}

std::vector<LayerFiller::LineEdge> LayerFiller::edges_in_order() const {
  std::vector<LineEdge> edges;
  for (const Chunk::Edge& edge : line_) {
    const auto index = static_cast<std::uint32_t>(edge.segment - pslg_.segments.size());
    const LinePiece& piece = plan_.pieces()[index];
    const Point origin = plan_.spokes()[piece.first].tip;
    const Vector along = plan_.spokes()[piece.last].tip - origin;
    const auto place = [&](std::uint32_t vertex) {
      return dot(at(vertex) - origin, along) / dot(along, along);
    };
    LineEdge one{index, edge.a, edge.b, place(edge.a), place(edge.b)};
    if (one.from > one.to) {
      std::swap(one.first, one.last);
      std::swap(one.from, one.to);
    }
    edges.push_back(one);
  }
  std::sort(edges.begin(), edges.end(), [](const LineEdge& e, const LineEdge& f) {
    return std::pair(e.piece, e.from) < std::pair(f.piece, f.from);
  });
  return edges;
}

std::uint32_t LayerFiller::add_vertex(Point p) {
  chunk_.coordinates.insert(chunk_.coordinates.end(), {p.x, p.y});
  return static_cast<std::uint32_t>(sent_ + chunk_.coordinates.size() / 2 - 1);
}

// A corner of the wall, which the mesh has already where layers end in a point or walls touch.
std::uint32_t LayerFiller::wall_vertex(std::uint32_t spoke) {
  const Spoke& s = plan_.spokes()[spoke];
  const auto [found, is_new] = wall_vertices_.try_emplace(s.vertex, kNone);
  if (!is_new) return found->second;
  const std::uint32_t input = domain_.input_point[s.vertex];
  const auto in_mesh =
      vertex_of_point_.find(input != kNone ? input : plan_.point_of_base(spoke, pslg_));
  if (in_mesh != vertex_of_point_.end()) return found->second = in_mesh->second;
  const std::uint32_t vertex = add_vertex(s.base);
  if (input != kNone) chunk_.input_points.push_back({vertex, input});
  return found->second = vertex;
}

LayerFiller::Column LayerFiller::column(std::uint32_t layers, std::uint32_t wall, Point base,
                                        std::uint32_t end) {
  const Point tip = at(end);
  Column column{{wall}, {base}};
  for (const double height : std::span(heights_[layers]).first(heights_[layers].size() - 1)) {
    const Point place{base.x + height * (tip.x - base.x), base.y + height * (tip.y - base.y)};
    column.vertices.push_back(wall == end ? wall : add_vertex(place));
    column.places.push_back(place);
  }
  column.vertices.push_back(end);
  column.places.push_back(tip);
  return column;
}

LayerFiller::Column LayerFiller::column_of_spoke(std::uint32_t layers, std::uint32_t spoke,
                                                 std::uint32_t end) {
  const Spoke& s = plan_.spokes()[spoke];
  const std::uint32_t wall = s.tip == s.base ? end : wall_vertex(spoke);
  if (s.tip == s.base) wall_vertices_.emplace(s.vertex, end);
  Column made = column(layers, wall, s.base, end);
  if (s.side != kNone)
    for (std::size_t i = 0; i + 1 < made.vertices.size(); ++i)
      add_edge(made.vertices[i], made.vertices[i + 1], s.side);
  return made;
}

void LayerFiller::add_edge(std::uint32_t a, std::uint32_t b, std::uint32_t subsegment) {
  const Subsegment& s = domain_.subsegments[subsegment];
  chunk_.edges.push_back({a, b, s.segment, s.marker});
}

void LayerFiller::add_triangle(const std::array<std::uint32_t, 3>& corners, std::int32_t region) {
  chunk_.triangles.insert(chunk_.triangles.end(), corners.begin(), corners.end());
  chunk_.regions.push_back(region);
}

// The triangles between two columns; of each quadrilateral's diagonals the shorter one is an edge.
void LayerFiller::fill(const Column& from, const Column& to, std::int32_t region) {
  for (const Column* column : {&from, &to})
    for (const Point p : column->places) chunk_.box.add(p);
  for (std::size_t i = 0; i + 1 < from.vertices.size(); ++i) {
    const std::uint32_t a = from.vertices[i], d = from.vertices[i + 1];
    const std::uint32_t b = to.vertices[i], c = to.vertices[i + 1];
    if (a == b) {
      add_triangle({a, c, d}, region);
    } else if (a == d) {
      add_triangle({a, b, c}, region);
    } else if (b == c) {
      add_triangle({a, b, d}, region);
    } else if (distance2(from.places[i], to.places[i + 1]) <=
               distance2(to.places[i], from.places[i + 1])) {
      add_triangle({a, b, c}, region);
      add_triangle({a, c, d}, region);
    } else {
      add_triangle({a, b, d}, region);
      add_triangle({b, c, d}, region);
    }
  }
}

std::optional<Error> LayerFiller::send(const ExecutionContext& context, Summary& summary) {
  chunk_.index = summary.chunks++;
  chunk_.first_vertex = static_cast<std::uint32_t>(sent_);
  chunk_.first_triangle = static_cast<std::uint32_t>(summary.triangles);
  chunk_.digest = chunk_digest(chunk_);
  sent_ += chunk_.coordinates.size() / 2;
  summary.vertices += chunk_.coordinates.size() / 2;
  summary.triangles += chunk_.triangles.size() / 3;
  summary.layers->triangles += chunk_.triangles.size() / 3;
  summary.edges += chunk_.edges.size();
  summary.box.merge(chunk_.box);
  digest_.add(chunk_.digest.data(), chunk_.digest.size());
  if (!sink_.accept(std::exchange(chunk_, Chunk{}))) {
    if (auto error = context.poll()) return error;
    return Error{ErrorCode::kCancelled, "", "the receiver of the mesh has gone"};
  }
  return context.poll();
}

std::optional<Error> LayerFiller::finish(const ExecutionContext& context, Summary& summary) {
  summary.edges -= line_.size();
  summary.layers = LayerSummary{.triangles = 0,
                                .least_thickness = plan_.least_thickness(),
                                .at = plan_.thinnest_at(),
                                .cut = plan_.cut()};
  const std::vector<LineEdge> edges = edges_in_order();
  std::uint64_t most = summary.triangles;
  for (const LineEdge& edge : edges)
    most += 2 * std::uint64_t{layers_[plan_.pieces()[edge.piece].layers].rows};
  if (most > std::min<std::uint64_t>(context.budget().triangle_limit, UINT32_MAX))
    return Error{ErrorCode::kLimitExceeded, "quality.layers",
                 "the mesh has up to " + std::to_string(most) +
                     " triangles with its layers, more than the limit of " +
                     std::to_string(context.budget().triangle_limit)};
  Column first, last;  // of the wall; `first` is at spoke `from`, where the wall may close
  std::uint32_t from = kNone;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const LineEdge& edge = edges[i];
    const LinePiece& piece = plan_.pieces()[edge.piece];
    const bool begins = i == 0 || edges[i - 1].piece != edge.piece;
    const bool ends = i + 1 == edges.size() || edges[i + 1].piece != edge.piece;
    if (begins && (i == 0 || plan_.pieces()[edges[i - 1].piece].last != piece.first)) {
      from = piece.first;
      first = last = column_of_spoke(piece.layers, from, edge.first);
    }
    Column next;
    if (ends && piece.last == from) {
      next = std::move(first);
    } else if (ends) {
      next = column_of_spoke(piece.layers, piece.last, edge.last);
    } else if (piece.wall == kNone) {
      next = column(piece.layers, last.vertices.front(), last.places.front(), edge.last);
    } else {
      const Point a = plan_.spokes()[piece.first].base, b = plan_.spokes()[piece.last].base;
      const Point base{a.x + edge.to * (b.x - a.x), a.y + edge.to * (b.y - a.y)};
      next = column(piece.layers, add_vertex(base), base, edge.last);
    }
    if (piece.wall != kNone) add_edge(last.vertices.front(), next.vertices.front(), piece.wall);
    fill(last, next, regions_[piece.layers]);
    last = std::move(next);
    constexpr std::size_t kEnough = kMaxChunkBytes / 2;  // an edge adds far less than that
    const std::size_t bytes = 8 * chunk_.coordinates.size() + 4 * chunk_.triangles.size() +
                              4 * chunk_.regions.size() + 16 * chunk_.edges.size();
    if (bytes < kEnough) continue;
    if (auto error = send(context, summary)) return error;
  }
  if (!chunk_.triangles.empty())
    if (auto error = send(context, summary)) return error;
  summary.area += plan_.area();
  summary.digest = digest_.finish();
  return std::nullopt;
}

}  // namespace weft
