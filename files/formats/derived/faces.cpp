// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/faces.h"

#include <algorithm>
#include <utility>

#include "files/formats/derived/orientation.h"

namespace weft::files {
namespace {

class Polygon {
 public:
  Polygon(std::span<const std::uint32_t> corners, std::span<const double> coordinates)
      : coordinates_(coordinates) {
    for (const std::uint32_t corner : corners)
      if (left_.empty() || left_.back() != corner) left_.push_back(corner);
    while (left_.size() > 1 && left_.front() == left_.back()) left_.pop_back();
    for (std::size_t i = 2; i < left_.size(); ++i)
      area_ += twice_area(left_[0], left_[i - 1], left_[i]);
  }

  // Cuts off one corner after the other (G. H. Meisters, "Polygons have ears", 1975).
  std::vector<std::uint32_t> triangles() {
    std::vector<std::uint32_t> out;
    while (left_.size() >= 3) {
      std::size_t at = 0;
      while (at < left_.size() && !is_ear(at)) ++at;
      if (at == left_.size()) at = 0;  // the polygon crosses itself
      out.insert(out.end(), {before(at), left_[at], after(at)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    return out;
  }

 private:
  Point at(std::uint32_t corner) const {
    return {coordinates_[2 * std::size_t{corner}], coordinates_[2 * std::size_t{corner} + 1]};
  }
  double twice_area(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    const Point a = at(i), b = at(j), c = at(k);
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  std::uint32_t before(std::size_t i) const { return left_[i == 0 ? left_.size() - 1 : i - 1]; }
  std::uint32_t after(std::size_t i) const { return left_[i + 1 == left_.size() ? 0 : i + 1]; }
  // 1 on the polygon's inside of the line from a to b.
  int side(Point a, Point b, Point p) const { return orientation(a, b, p) * (area_ < 0 ? -1 : 1); }

  bool is_ear(std::size_t i) const {
    const Point a = at(before(i)), b = at(left_[i]), c = at(after(i));
    if (side(a, b, c) <= 0) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t corner) {
      const Point p = at(corner);
      return p != a && p != b && p != c && side(a, b, p) >= 0 && side(b, c, p) >= 0 &&
             side(c, a, p) >= 0;
    });
  }

  std::span<const double> coordinates_;
  std::vector<std::uint32_t> left_;  // corners that are not cut off
  double area_ = 0;                  // twice
};

}  // namespace

std::vector<std::uint32_t> cut_face(std::span<const std::uint32_t> corners,
                                    std::span<const double> coordinates) {
  return Polygon(corners, coordinates).triangles();
}

void cut_faces(Mesh& mesh) {
  const Faces faces = std::exchange(mesh.faces, {});
  mesh.regions.resize(mesh.triangles.size() / 3);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto triangles = cut_face(faces.of(i), mesh.coordinates);
    mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    mesh.regions.resize(mesh.triangles.size() / 3, faces.regions[i]);
    if (i < faces.parts.size()) mesh.parts.resize(mesh.triangles.size() / 3, faces.parts[i]);
    mesh.cut_faces += triangles.size() > 3;
  }
}

}  // namespace weft::files
