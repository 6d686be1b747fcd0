// SPDX-License-Identifier: Apache-2.0
#include "server/admission/domain_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "server/wire/translate.h"

namespace weft::server {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// The part of a cell at the border that counts as domain: half of it, and some more to be safe.
constexpr double kPartOfBorder = 0.6;
constexpr std::uint16_t kUnknown = std::numeric_limits<std::uint16_t>::max();

Box box_of(const google::protobuf::RepeatedField<double>& points) {
  Box box{kInfinity, kInfinity, -kInfinity, -kInfinity};
  for (int i = 0; i + 1 < points.size(); i += 2) {
    if (!std::isfinite(points[i]) || !std::isfinite(points[i + 1])) continue;
    box.min_x = std::min(box.min_x, points[i]);
    box.max_x = std::max(box.max_x, points[i]);
    box.min_y = std::min(box.min_y, points[i + 1]);
    box.max_y = std::max(box.max_y, points[i + 1]);
  }
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

DomainPicture DomainPicture::of(const v1::Domain& domain) {
  DomainPicture picture;
  const auto& points = domain.points();
  picture.box_ = box_of(points);
  picture.width_ = picture.box_.width() / kCells;
  picture.height_ = picture.box_.height() / kCells;
  picture.max_area_.assign(kAll, kInfinity);

  std::array<Face, kAll> faces;
  faces.fill(kUnknown);
  std::array<char, kAll> odd{};  // whether the way to the left crosses an odd number of segments
  const auto point = [&](std::uint32_t i) { return Point{points[2 * i], points[2 * i + 1]}; };
  const auto count = static_cast<std::uint32_t>(points.size() / 2);
  for (int i = 0; i + 1 < domain.segments_size(); i += 2) {
    const std::uint32_t a = domain.segments(i);
    const std::uint32_t b = domain.segments(i + 1);
    if (a >= count || b >= count) continue;
    picture.draw(point(a), point(b), faces);
    if (domain.fill() == v1::FILL_EVEN_ODD) picture.cross(point(a), point(b), odd);
  }
  for (std::size_t cell = 1; cell < kAll; ++cell)
    if (cell % kCells != 0) odd[cell] ^= odd[cell - 1];
  const Face last = find_faces(faces);

  std::vector<char> outside(last + 1, 0);
  for (int i = 0; i < kCells; ++i)
    for (const std::size_t cell : {at(i, 0), at(i, kCells - 1), at(0, i), at(kCells - 1, i)})
      outside[faces[cell]] = 1;
  if (domain.fill() == v1::FILL_EVEN_ODD)
    for (std::size_t cell = 0; cell < kAll; ++cell) outside[faces[cell]] = !odd[cell];
  const auto face_at = [&](double x, double y) { return faces[picture.cell_at(x, y)]; };
  for (int i = 0; i + 1 < domain.holes_size(); i += 2)
    outside[face_at(domain.holes(i), domain.holes(i + 1))] = 1;
  outside[kBorder] = 0;

  std::vector<double> bounds(last + 1, kInfinity);
  for (const v1::Region& region : domain.regions())
    if (const auto area = max_area_of(region)) bounds[face_at(region.x(), region.y())] = *area;

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

}  // namespace weft::server
