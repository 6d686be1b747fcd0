// SPDX-License-Identifier: Apache-2.0
// A coarse picture of a domain, for estimates: which cells of a grid over its points lie in it, and
// in which region. Takes time in proportion to the points, the segments, and the cells that these
// cross.
//
//   const DomainPicture picture = DomainPicture::of(pslg);
//   picture.area()                                   // at most a cell's width too large, or small
//   picture.max_area(column, row)                    // of the regions; infinity for none
//
// A cell that a segment crosses belongs to the border; the others make up faces. A face is left out
// if a hole's seed is in it, if it reaches the picture's rim, or if the fill or an area that is a
// hole leaves it out. Faces that are smaller than a cell are not seen: so the picture rather shows
// too much than too little.
//
// Coordinates that are no numbers, and indices that are out of range, are left out: the picture is
// made before the engine judges them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "weft/geometry.h"
#include "weft/pslg.h"

namespace weft {

class DomainPicture {
 public:
  static constexpr int kCells = 64;  // each way

  static DomainPicture of(const Pslg& pslg);

  // How much of a cell is in the domain: 0, 1, or a bit over half where the domain ends.
  double part_inside(int column, int row) const { return part_[at(column, row)]; }
  // The region's bound.
  double max_area(int column, int row) const { return max_area_[at(column, row)]; }
  Point middle(int column, int row) const;
  double area_of_cell() const { return width_ * height_; }
  double area() const;

 private:
  using Face = std::uint16_t;
  static constexpr Face kBorder = 0;
  static constexpr std::size_t kAll = std::size_t{kCells} * kCells;

  static std::size_t at(int column, int row) {
    return static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column);
  }
  std::size_t cell_at(double x, double y) const;
  void draw(Point a, Point b, std::array<Face, kAll>& faces) const;
  void cross(Point a, Point b, std::array<char, kAll>& odd) const;
  struct Covered;
  Covered cover(const Pslg& pslg) const;
  static Face find_faces(std::array<Face, kAll>& faces);

  Box box_;
  double width_ = 0;  // of a cell
  double height_ = 0;
  std::vector<double> part_ = std::vector<double>(kAll, 0.0);
  std::vector<double> max_area_;
};

}  // namespace weft
