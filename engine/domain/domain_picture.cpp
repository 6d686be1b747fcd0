// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/domain_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The part of a cell at the border that counts as domain: half of it, and some more to be safe.
constexpr double kPartOfBorder = 0.6;
constexpr std::uint16_t kUnknown = std::numeric_limits<std::uint16_t>::max();

Box box_of(const std::vector<Point>& points) {
  Box box;
  for (const Point p : points)
    if (std::isfinite(p.x) && std::isfinite(p.y)) box.add(p);
  return box.min_x <= box.max_x ? box : Box{0, 0, 0, 0};
}

int clamp_cell(double cell) {
  return cell > 0 ? static_cast<int>(std::min(cell, DomainPicture::kCells - 1.0)) : 0;
}

// Calls f(neighbor) for the cells beside one.
template <class F>
void for_neighbors(std::size_t cell, F&& f) {
  constexpr std::size_t kCells = DomainPicture::kCells;
  const std::size_t column = cell % kCells;
  const std::size_t row = cell / kCells;
  if (column > 0) f(cell - 1);
  if (column + 1 < kCells) f(cell + 1);
  if (row > 0) f(cell - kCells);
  if (row + 1 < kCells) f(cell + kCells);
}

}  // namespace

// Of each cell's middle.
struct DomainPicture::Covered {
  std::vector<std::uint32_t> areas = std::vector<std::uint32_t>(kAll, 0);  // holes not counted
  std::vector<char> is_hole = std::vector<char>(kAll, 0);
  std::vector<double> max_area = std::vector<double>(kAll, kInfinity);
};

DomainPicture DomainPicture::of(const Pslg& pslg) {
  DomainPicture picture;
  picture.box_ = box_of(pslg.points);
  picture.width_ = picture.box_.width() / kCells;
  picture.height_ = picture.box_.height() / kCells;
  picture.max_area_.assign(kAll, kInfinity);

  std::array<Face, kAll> faces;
  faces.fill(kUnknown);
  std::array<char, kAll> odd{};  // whether the way to the left crosses an odd number of segments
  for (const Segment& s : pslg.segments) {
    if (s.a >= pslg.points.size() || s.b >= pslg.points.size()) continue;
    picture.draw(pslg.points[s.a], pslg.points[s.b], faces);
    if (pslg.fill == Fill::kEvenOdd) picture.cross(pslg.points[s.a], pslg.points[s.b], odd);
  }
  for (std::size_t cell = 1; cell < kAll; ++cell)
    if (cell % kCells != 0) odd[cell] ^= odd[cell - 1];
  const Covered covered = picture.cover(pslg);
  const Face last = find_faces(faces);

  std::vector<char> outside(last + 1, 0);
  for (int i = 0; i < kCells; ++i)
    for (const std::size_t cell : {at(i, 0), at(i, kCells - 1), at(0, i), at(kCells - 1, i)})
      outside[faces[cell]] = 1;
  for (std::size_t cell = 0; cell < kAll; ++cell) {
    char& is_outside = outside[faces[cell]];
    if (pslg.fill == Fill::kUnion)
      is_outside = covered.areas[cell] == 0;
    else if (pslg.fill == Fill::kEvenOdd)
      is_outside = (pslg.areas.empty() ? odd[cell] : covered.areas[cell]) % 2 == 0;
    if (covered.is_hole[cell]) is_outside = 1;
  }
  const auto face_at = [&](double x, double y) { return faces[picture.cell_at(x, y)]; };
  for (const Point hole : pslg.holes) outside[face_at(hole.x, hole.y)] = 1;
  outside[kBorder] = 0;

  std::vector<double> bounds(last + 1, kInfinity);
  for (std::size_t cell = 0; cell < kAll; ++cell)
    if (faces[cell] != kBorder)
      bounds[faces[cell]] = std::min(bounds[faces[cell]], covered.max_area[cell]);
  for (const RegionSeed& region : pslg.regions)
    if (region.max_area) {
      double& bound = bounds[face_at(region.at.x, region.at.y)];
      bound = std::min(bound, *region.max_area);
    }

  for (std::size_t cell = 0; cell < kAll; ++cell) {
    const Face face = faces[cell];
    double part = outside[face] ? 0 : 1;
    double bound = face == kBorder ? kInfinity : bounds[face];
    if (face == kBorder) {
      for_neighbors(cell, [&](std::size_t other) {
        if (outside[faces[other]]) part = kPartOfBorder;
        if (faces[other] != kBorder) bound = std::min(bound, bounds[faces[other]]);
      });
    }
    picture.part_[cell] = part;
    picture.max_area_[cell] = bound;
  }
  return picture;
}

Point DomainPicture::middle(int column, int row) const {
  return {box_.min_x + (column + 0.5) * width_, box_.min_y + (row + 0.5) * height_};
}

double DomainPicture::area() const {
  double parts = 0;
  for (const double part : part_) parts += part;
  return parts * area_of_cell();
}

std::size_t DomainPicture::cell_at(double x, double y) const {
  return at(clamp_cell((x - box_.min_x) / width_), clamp_cell((y - box_.min_y) / height_));
}

// Marks the cells that a segment crosses, row by row.
void DomainPicture::draw(Point a, Point b, std::array<Face, kAll>& faces) const {
  if (!std::isfinite(a.x + a.y + b.x + b.y)) return;
  if (a.y > b.y) std::swap(a, b);
  const int first = clamp_cell((a.y - box_.min_y) / height_);
  const int last = clamp_cell((b.y - box_.min_y) / height_);
  const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
  for (int row = first; row <= last; ++row) {
    const double low = std::max(a.y, box_.min_y + row * height_);
    const double high = std::min(b.y, box_.min_y + (row + 1) * height_);
    const double x1 = row == first ? a.x : a.x + slope * (low - a.y);
    const double x2 = row == last ? b.x : a.x + slope * (high - a.y);
    const int from = clamp_cell((std::min(x1, x2) - box_.min_x) / width_);
    const int to = clamp_cell((std::max(x1, x2) - box_.min_x) / width_);
    for (int column = from; column <= to; ++column) faces[at(column, row)] = kBorder;
  }
}

// Marks, in each row, the first cell whose middle lies to the right of the segment.
void DomainPicture::cross(Point a, Point b, std::array<char, kAll>& odd) const {
  if (!std::isfinite(a.x + a.y + b.x + b.y)) return;
  if (a.y > b.y) std::swap(a, b);
  const int first = clamp_cell((a.y - box_.min_y) / height_);
  const int last = clamp_cell((b.y - box_.min_y) / height_);
  for (int row = first; row <= last; ++row) {
    const double y = middle(0, row).y;
    if (y < a.y || y >= b.y) continue;
    const double x = a.x + (b.x - a.x) / (b.y - a.y) * (y - a.y);
    const double column = std::ceil((x - box_.min_x) / width_ - 0.5);
    if (column < kCells) odd[at(clamp_cell(column), row)] ^= 1;
  }
}

// Takes time in proportion to the segments and to the cells of the areas' boxes.
DomainPicture::Covered DomainPicture::cover(const Pslg& pslg) const {
  Covered covered;
  const auto& points = pslg.points;
  std::vector<std::vector<std::pair<Point, Point>>> borders(pslg.areas.size());
  for (const Segment& s : pslg.segments) {
    if (s.area >= borders.size() || s.a >= points.size() || s.b >= points.size()) continue;
    const Point a = points[s.a], b = points[s.b];
    if (std::isfinite(a.x + a.y + b.x + b.y)) borders[s.area].emplace_back(a, b);
  }
  std::array<char, kAll> odd{};
  for (std::size_t area = 0; area < borders.size(); ++area) {
    if (borders[area].empty()) continue;
    std::size_t least = kAll, most = 0;  // the cells of the corners of the area's box, row by row
    int first_column = kCells - 1, last_column = 0;
    for (const auto& [a, b] : borders[area]) {
      cross(a, b, odd);
      for (const Point p : {a, b}) {
        const std::size_t cell = cell_at(p.x, p.y);
        least = std::min(least, cell / kCells * kCells);
        most = std::max(most, cell / kCells * kCells);
        const int column = static_cast<int>(cell % kCells);
        first_column = std::min(first_column, column);
        last_column = std::max(last_column, column);
      }
    }
    const Area& given = pslg.areas[area];
    const double bound = given.max_area.value_or(kInfinity);
    for (std::size_t row = least; row <= most; row += kCells) {
      char is_odd = 0;
      // A border that ends between two columns' middles counts from the next column on.
      for (int column = first_column; column <= std::min(last_column + 1, kCells - 1); ++column) {
        const std::size_t cell = row + static_cast<std::size_t>(column);
        is_odd ^= odd[cell];
        odd[cell] = 0;
        if (!is_odd) continue;
        if (given.is_hole) {
          covered.is_hole[cell] = 1;
        } else {
          ++covered.areas[cell];
          covered.max_area[cell] = std::min(covered.max_area[cell], bound);
        }
      }
    }
  }
  return covered;
}

// Numbers the faces from 1 on; returns the last number.
DomainPicture::Face DomainPicture::find_faces(std::array<Face, kAll>& faces) {
  Face last = kBorder;
  std::vector<std::size_t> open;
  for (std::size_t cell = 0; cell < kAll; ++cell) {
    if (faces[cell] != kUnknown) continue;
    faces[cell] = ++last;
    open.push_back(cell);
    while (!open.empty()) {
      const std::size_t here = open.back();
      open.pop_back();
      for_neighbors(here, [&](std::size_t other) {
        if (faces[other] != kUnknown) return;
        faces[other] = last;
        open.push_back(other);
      });
    }
  }
  return last;
}

}  // namespace weft
