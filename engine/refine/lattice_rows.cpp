// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/lattice_rows.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

// Twice the area of a, b, p: positive if p is on the left of a-b.
double side_of(Point a, Point b, Point p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

bool is_odd(double n) {
  return n - 2 * std::floor(0.5 * n) != 0;
}

}  // namespace

std::optional<LatticeRectangle> LatticeRectangle::in(const Box& box, double spacing,
                                                     double jitter) {
  constexpr double kFarthest = 1e13;  // spacings from the origin: coordinates are rounded to 0.002
  const double farthest = std::max(std::max(std::fabs(box.min_x), std::fabs(box.max_x)),
                                   std::max(std::fabs(box.min_y), std::fabs(box.max_y)));
  if (!(farthest < kFarthest * spacing) || jitter > kMaxJitter - 0.01) return std::nullopt;
  const double left = std::ceil(box.min_x / spacing + 1);
  const double right = std::floor(box.max_x / spacing - 1.5);
  const double bottom = std::ceil((box.min_y / spacing + 1) / kRowRise);
  const double top = std::floor((box.max_y / spacing - 1) / kRowRise);
  const double columns = right - left + 1;
  const double rows = top - bottom + 1;
  if (columns < kMin || rows < kMin || columns * rows > kMaxPoints) return std::nullopt;
  return LatticeRectangle{.first_column = left,
                          .first_row = bottom,
                          .columns = static_cast<std::uint32_t>(columns),
                          .rows = static_cast<std::uint32_t>(rows),
                          .spacing = spacing,
                          .jitter = jitter};
}

std::uint32_t LatticeRectangle::place_of(Point p) const {
  const double row = std::round(p.y / (kRowRise * spacing)) - first_row;
  if (!(row >= 0 && row < rows)) return kNone;
  const auto j = static_cast<std::uint32_t>(row);
  const double column = std::round(p.x / spacing - (is_shifted(j) ? 0.5 : 0)) - first_column;
  if (!(column >= 0 && column < columns)) return kNone;
  const auto i = static_cast<std::uint32_t>(column);
  return at(i, j) == p ? j * columns + i : kNone;
}

bool LatticeRectangle::is_shifted(std::uint32_t row) const {
  return is_odd(first_row + row);
}

void LatticeRectangle::append_ring(std::vector<std::uint32_t>& ring) const {
  const std::uint32_t right = columns - 1;
  const std::uint32_t top = rows - 1;
  for (std::uint32_t i = 0; i < right; ++i) ring.push_back(i);
  for (std::uint32_t j = 0; j < top; ++j) ring.push_back(j * columns + right);
  for (std::uint32_t i = right; i > 0; --i) ring.push_back(top * columns + i);
  for (std::uint32_t j = top; j > 0; --j) ring.push_back(j * columns);
}

std::uint32_t LatticeRows::locate(Point p, std::uint32_t from) const {
  constexpr std::uint32_t kMaxSteps = 8192;
  std::uint32_t t = from;
  for (std::uint32_t step = 0; step < kMaxSteps; ++step) {
    const Triangle& triangle = mesh_.triangles[t];
    if (triangle.dead() || !owns(t)) return kNone;
    std::uint32_t beyond = 3;
    for (std::uint32_t k = 0; k < 3 && beyond == 3; ++k) {
      const std::uint32_t edge = (k + step) % 3;  // a walk that always began alike could go round
      if (side_of(mesh_.vertices[triangle.vertex[kNext[edge]]],
                  mesh_.vertices[triangle.vertex[kPrevious[edge]]], p) < 0)
        beyond = edge;
    }
    if (beyond == 3) return t;
    if (triangle.on_segment(beyond)) return kNone;
    t = triangle_of(triangle.neighbor[beyond]);
  }
  return kNone;
}

std::uint32_t LatticeRows::vertex_at(Point p, std::uint32_t triangle) const {
  for (const std::uint32_t v : mesh_.triangles[triangle].vertex) {
    if (mesh_.vertices[v] == p) return v;
  }
  return kNone;
}

bool LatticeRows::owns(std::uint32_t triangle) const {
  const auto& v = mesh_.triangles[triangle].vertex;
  return ownership_.owns(mesh_.vertices[v[0]]) && ownership_.owns(mesh_.vertices[v[1]]) &&
         ownership_.owns(mesh_.vertices[v[2]]);
}

void LatticeRows::lay_out(const LatticeRectangle& rectangle) {
  rectangle_ = rectangle;
  vertex_.assign(rectangle.points(), kNone);
  ring_.clear();
  rectangle.append_ring(ring_);
}

std::optional<LatticeRows::Gain> LatticeRows::fill(std::uint32_t near) {
  if (!find_ring(near) || !collect_inside()) return std::nullopt;
  region_ = mesh_.triangles[inside_[0]].region;
  Gain gain;
  gain.vertices = add_vertices();
  gain.triangles = take_slots();
  write_rows();
  return gain;
}

// Finds the edges between neighbours on the ring: turns around each point until its edge to the
// next one is found; that triangle has the next point.
bool LatticeRows::find_ring(std::uint32_t near) {
  constexpr std::uint32_t kMaxAround = 64;
  inside_edges_.clear();
  outside_edges_.clear();
  std::uint32_t t = locate(mesh_.vertices[vertex_[ring_[0]]], near);
  if (t == kNone) return false;
  for (std::size_t k = 0; k < ring_.size(); ++k) {
    const std::uint32_t from = vertex_[ring_[k]];
    const std::uint32_t to = vertex_[ring_[(k + 1) % ring_.size()]];
    HalfEdge edge = kNone;
    for (std::uint32_t turn = 0; turn < kMaxAround; ++turn) {
      const Triangle& triangle = mesh_.triangles[t];
      const auto corner = static_cast<std::uint32_t>(
          std::find(triangle.vertex, triangle.vertex + 3, from) - triangle.vertex);
      if (corner == 3 || !owns(t)) return false;
      if (triangle.vertex[kNext[corner]] == to) {
        edge = half_edge(t, kPrevious[corner]);
        break;
      }
      if (triangle.on_segment(kNext[corner])) return false;
      t = triangle_of(triangle.neighbor[kNext[corner]]);
    }
    if (edge == kNone || mesh_.triangles[t].on_segment(edge_of(edge))) return false;
    const HalfEdge outside = mesh_.triangles[t].neighbor[edge_of(edge)];
    const Point apex =
        mesh_.vertices[mesh_.triangles[triangle_of(outside)].vertex[edge_of(outside)]];
    const Point a = mesh_.vertices[from];
    const Point b = mesh_.vertices[to];
    const bool sharp = (a.x - apex.x) * (b.x - apex.x) + (a.y - apex.y) * (b.y - apex.y) >= 0;
    if (!sharp) return false;
    inside_edges_.push_back(edge);
    outside_edges_.push_back(outside);
  }
  return true;
}

// Collects the triangles inside, from the edges of the ring inwards. Marks as deferred what it has
// met, and before that the triangles beyond the ring, where it ends. A triangle that another task
// has deferred is not met, and Euler's formula tells that one is missing.
bool LatticeRows::collect_inside() {
  const auto mark = [&](std::uint32_t t, std::vector<std::uint32_t>& marked) {
    if (mesh_.triangles[t].deferred()) return;
    mesh_.triangles[t].set_deferred(true);
    marked.push_back(t);
  };
  beyond_.clear();
  inside_.clear();
  for (const HalfEdge outside : outside_edges_) mark(triangle_of(outside), beyond_);
  for (const HalfEdge edge : inside_edges_) mark(triangle_of(edge), inside_);
  std::size_t inner = 0;  // vertices inside that are not on the ring
  bool possible = true;
  for (std::size_t n = 0; n < inside_.size() && possible; ++n) {
    const Triangle& triangle = mesh_.triangles[inside_[n]];
    possible = triangle.segment_bits() == 0;
    for (std::uint32_t i = 0; i < 3 && possible; ++i) {
      const std::uint32_t v = triangle.vertex[i];
      const std::uint32_t place = rectangle_.place_of(mesh_.vertices[v]);
      possible = place != kNone && (vertex_[place] == v || vertex_[place] == kNone);
      if (!possible) break;
      if (vertex_[place] == kNone) ++inner;
      vertex_[place] = v;
      mark(triangle_of(triangle.neighbor[i]), inside_);
    }
  }
  for (const std::vector<std::uint32_t>* marked : {&beyond_, &inside_}) {
    for (const std::uint32_t t : *marked) mesh_.triangles[t].set_deferred(false);
  }
  return possible && inside_.size() + 2 == 2 * inner + ring_.size();
}

std::uint32_t LatticeRows::add_vertices() {
  std::uint32_t added = 0;
  for (std::uint32_t j = 1; j + 1 < rectangle_.rows; ++j) {
    std::uint32_t* const row = &vertex_[std::size_t{j} * rectangle_.columns];
    for (std::uint32_t i = 1; i + 1 < rectangle_.columns; ++i) {
      if (row[i] != kNone) continue;
      row[i] = slots_->add_vertex(mesh_, rectangle_.at(i, j));
      ++added;
    }
  }
  return added;
}

// Gathers the slots for the rows: those inside that are this task's, then new ones. Returns how
// many triangles the mesh gains.
std::int64_t LatticeRows::take_slots() {
  const std::uint32_t count = rectangle_.triangles();
  slots_of_rows_.clear();
  slots_of_rows_.push_back(0);
  for (const std::uint32_t t : inside_) {
    if (mesh_.owner_of_triangle(t) == slots_->owner()) {
      slots_of_rows_.push_back(t);
    } else {
      mesh_.triangles[t].die();
    }
  }
  while (slots_of_rows_.size() < count + 1) slots_of_rows_.push_back(slots_->add_triangle(mesh_));
  slots_of_rows_.push_back(0);
  return static_cast<std::int64_t>(count) - static_cast<std::int64_t>(inside_.size());
}

// Writes strip by strip what lies between two rows of points. The triangles of a strip alternate
// from left to right: one on the lower row, one under the upper row, the latter first if the lower
// row is shifted. So a triangle's neighbours are those before and after it, and the one in the same
// place of the strip below or above.
void LatticeRows::write_rows() {
  Triangle* const triangles = mesh_.triangles.data();
  const std::uint32_t columns = rectangle_.columns - 1;  // pairs of triangles in a strip
  const std::uint32_t strips = rectangle_.rows - 1;
  const std::uint32_t length = 2 * columns;
  const std::uint32_t* const first = begin_made();
  // The edges of a triangle on the lower row lead to the one after it, the one before it and the
  // one below; those of a triangle under the upper row after it, above it and before it.
  constexpr std::uint32_t kAfter = 0;
  constexpr std::uint32_t kLowerBefore = 1;
  constexpr std::uint32_t kLowerBelow = 2;
  constexpr std::uint32_t kUpperAbove = 1;
  constexpr std::uint32_t kUpperBefore = 2;
  for (std::uint32_t j = 0; j < strips; ++j) {
    const std::uint32_t* const a = &vertex_[std::size_t{j} * rectangle_.columns];
    const std::uint32_t* const b = a + rectangle_.columns;
    const std::uint32_t* const s = first + std::size_t{j} * length;
    // At the ring these and the ends of `s` lead anywhere; it is linked below.
    const std::uint32_t* const below = j > 0 ? s - length : s;
    const std::uint32_t* const above = j + 1 < strips ? s + length : s;
    const std::uint32_t shifted = rectangle_.is_shifted(j) ? 1 : 0;
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t* const lower = s + 2 * i + shifted;
      const std::uint32_t* const upper = s + 2 * i + 1 - shifted;
      triangles[*lower] = {{a[i], a[i + 1], b[i + shifted]},
                           0,
                           {half_edge(lower[1], kUpperBefore), half_edge(lower[-1], kAfter),
                            half_edge(below[lower - s], kUpperAbove)},
                           region_};
      triangles[*upper] = {{b[i], a[i + 1 - shifted], b[i + 1]},
                           0,
                           {half_edge(upper[1], kLowerBefore),
                            half_edge(above[upper - s], kLowerBelow), half_edge(upper[-1], kAfter)},
                           region_};
    }
  }
  const HalfEdge* outside = outside_edges_.data();  // counter-clockwise, as the ring
  const std::uint32_t shifted = rectangle_.is_shifted(0) ? 1 : 0;
  for (std::uint32_t i = 0; i < columns; ++i) link(first[2 * i + shifted], kLowerBelow, *outside++);
  for (std::uint32_t j = 0; j < strips; ++j) link(first[(j + 1) * length - 1], kAfter, *outside++);
  const std::uint32_t top_shifted = rectangle_.is_shifted(strips - 1) ? 1 : 0;
  const std::uint32_t* const top = first + std::size_t{strips - 1} * length;
  for (std::uint32_t i = columns; i-- > 0;)
    link(top[2 * i + 1 - top_shifted], kUpperAbove, *outside++);
  for (std::uint32_t j = strips; j-- > 0;)
    link(first[j * length], rectangle_.is_shifted(j) ? kUpperBefore : kLowerBefore, *outside++);
}

void LatticeRows::link(std::uint32_t triangle, std::uint32_t edge, HalfEdge outside) {
  mesh_.triangles[triangle].neighbor[edge] = outside;
  mesh_.triangles[triangle_of(outside)].neighbor[edge_of(outside)] = half_edge(triangle, edge);
}

std::uint64_t LatticeRows::bytes() const {
  std::uint64_t bytes = 0;
  for (const auto* v :
       {&vertex_, &ring_, &inside_edges_, &outside_edges_, &inside_, &beyond_, &slots_of_rows_})
    bytes += v->capacity() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace weft
