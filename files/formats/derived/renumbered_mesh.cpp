// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/renumbered_mesh.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

using Vertex = std::uint32_t;

// The vertices next to each vertex, sorted by degree, then by number.
class Neighbours {
 public:
  explicit Neighbours(const MeshView& mesh, const MeshEdges& edges)
      : starts_(mesh.vertex_count() + 1), vertices_(2 * edges.size()) {
    for (const std::size_t e : mesh.up_to(edges.size())) {
      ++starts_[edges.low(e)];
      ++starts_[edges.high(e)];
    }
    std::size_t end = 0;
    for (std::size_t& start : starts_) start = end += start;
    for (const std::size_t e : mesh.up_to(edges.size())) {
      vertices_[--starts_[edges.low(e)]] = edges.high(e);
      vertices_[--starts_[edges.high(e)]] = edges.low(e);
    }
    for (Vertex v = 0; v < mesh.vertex_count(); ++v)
      std::sort(
          vertices_.begin() + static_cast<std::ptrdiff_t>(starts_[v]),
          vertices_.begin() + static_cast<std::ptrdiff_t>(starts_[v + 1]),
          [this](Vertex a, Vertex b) { return std::pair(degree(a), a) < std::pair(degree(b), b); });
  }
  std::size_t degree(Vertex v) const { return starts_[v + 1] - starts_[v]; }
  std::span<const Vertex> of(Vertex v) const {
    return std::span(vertices_).subspan(starts_[v], degree(v));
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<Vertex> vertices_;
};

class Ordering {
 public:
  explicit Ordering(const Neighbours& neighbours, std::size_t vertices)
      : neighbours_(neighbours), search_(vertices) {
    order_.reserve(vertices);
    for (Vertex v = 0; v < vertices; ++v)
      if (search_[v] != kDone) add_component(v);
    std::reverse(order_.begin(), order_.end());
  }
  const std::vector<Vertex>& order() const { return order_; }

 private:
  static constexpr std::uint32_t kDone = ~std::uint32_t{0};

  // Appends the component of `start`, breadth first. Returns where its last level begins, and how
  // many levels there are.
  std::pair<std::size_t, std::size_t> append(Vertex start, std::uint32_t mark) {
    std::size_t level = order_.size();
    std::size_t levels = 0;
    order_.push_back(start);
    search_[start] = mark;
    for (;; ++levels) {
      const std::size_t end = order_.size();
      for (std::size_t i = level; i < end; ++i)
        for (const Vertex v : neighbours_.of(order_[i])) {
          if (search_[v] == mark) continue;
          search_[v] = mark;
          order_.push_back(v);
        }
      if (order_.size() == end) return {level, levels};
      level = end;
    }
  }

  // The vertex with the least degree from order_[first] on.
  Vertex least_degree(std::size_t first) const {
    return *std::min_element(order_.begin() + static_cast<std::ptrdiff_t>(first), order_.end(),
                             [this](Vertex a, Vertex b) {
                               return std::pair(neighbours_.degree(a), a) <
                                      std::pair(neighbours_.degree(b), b);
                             });
  }

  // Adds a component, from a vertex that is far from another one: begins with the one of least
  // degree, and goes on to the farthest from there as long as that adds levels.
  void add_component(Vertex any) {
    const std::size_t first = order_.size();
    append(any, ++searches_);
    Vertex start = least_degree(first);
    order_.resize(first);
    for (std::size_t most = 0;;) {
      const auto [last, levels] = append(start, ++searches_);
      const Vertex far = least_degree(last);
      order_.resize(first);
      if (levels <= most) break;
      most = levels;
      start = far;
    }
    append(start, kDone);
  }

  const Neighbours& neighbours_;
  std::vector<std::uint32_t> search_;  // the number of the last search that met the vertex
  std::uint32_t searches_ = 0;
  std::vector<Vertex> order_;
};

std::vector<Vertex> renumbered(std::span<const Vertex> vertices, std::span<const Vertex> numbers) {
  std::vector<Vertex> out(vertices.size());
  std::transform(vertices.begin(), vertices.end(), out.begin(),
                 [numbers](Vertex v) { return numbers[v]; });
  return out;
}

}  // namespace

RenumberedMesh::RenumberedMesh(const MeshView& mesh) : mesh_(mesh) {
  const MeshEdges edges(mesh);
  const Neighbours neighbours(mesh, edges);
  const std::vector<Vertex> order = Ordering(neighbours, mesh.vertex_count()).order();
  std::vector<Vertex> numbers(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) numbers[order[i]] = static_cast<Vertex>(i);
  for (const std::size_t e : mesh.up_to(edges.size())) {
    const auto [low, high] = std::minmax(numbers[edges.low(e)], numbers[edges.high(e)]);
    before_ = std::max(before_, edges.high(e) - edges.low(e));
    after_ = std::max(after_, high - low);
  }
  coordinates_.reserve(mesh.coordinates.size());
  for (const Vertex v : order)
    for (const std::size_t axis : {0, 1})
      coordinates_.push_back(mesh.coordinates[2 * std::size_t{v} + axis]);
  triangles_ = renumbered(mesh.triangles, numbers);
  edges_ = renumbered(mesh.edges, numbers);
  input_points_.assign(mesh.input_points.begin(), mesh.input_points.end());
  for (std::size_t i = 0; i < input_points_.size(); i += 2)
    input_points_[i] = numbers[input_points_[i]];
  arrays_.reserve(mesh.vertex_values.size());
  for (const VertexValues& values : mesh.vertex_values) {
    std::vector<double>& array = arrays_.emplace_back(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) array[i] = values.values[order[i]];
    vertex_values_.push_back({values.name, array});
  }
}

MeshView RenumberedMesh::view() const {
  MeshView view = mesh_;
  view.coordinates = coordinates_;
  view.triangles = triangles_;
  view.edges = edges_;
  view.input_points = input_points_;
  view.vertex_values = vertex_values_;
  return view;
}

}  // namespace weft::files
