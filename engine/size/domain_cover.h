// SPDX-License-Identifier: Apache-2.0
// Where the meshed area lies, roughly: the square cells of a grid over a box that it touches, and
// perhaps some beside it.
//
//   Result<DomainCover> cover = DomainCover::make(domain, context);
//   cover->meets({0, 0, 1, 1});   // false only if no point of the box is meshed
//
// A cell that no border of the meshed area touches is inside or outside as a whole; the parity of
// the borders on its left, along the line through the middles of its row, tells which.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/domain/domain.h"
#include "weft/error.h"

namespace weft {

class DomainCover {
 public:
  static constexpr std::size_t kMaxCells = std::size_t{1} << 20;  // about; 4 bytes each

  // All of the box. REQUIRES: finite coordinates and a side of it, at least, is positive.
  // NOLINTNEXTLINE(google-explicit-constructor): a box is what it covers.
  DomainCover(const Box& box) : box_(box) {}
  // Nothing, of a domain in the box.
  static DomainCover nothing_of(const Box& box) {
    DomainCover cover(box);
    cover.is_empty_ = true;
    return cover;
  }
  // Errors: kCancelled, kDeadlineExceeded. REQUIRES: a domain that `triangulate` made.
  static Result<DomainCover> make(const Domain& domain, const ExecutionContext& context);

  const Box& box() const { return box_; }
  bool meets(const Box& box) const;

 private:
  // The cell that a coordinate is in, 0 and the last one beyond the grid.
  std::size_t column(double x) const { return cell((x - box_.min_x) / side_, columns_); }
  std::size_t row(double y) const { return cell((y - box_.min_y) / side_, rows_); }
  static std::size_t cell(double at, std::size_t cells) {
    const auto last = static_cast<double>(cells - 1);
    return static_cast<std::size_t>(at < 0 ? 0 : at < last ? at : last);
  }
  void divide(std::size_t cells);
  void add_border(Point a, Point b, std::vector<std::uint8_t>& cells) const;
  void sum_up(const std::vector<std::uint8_t>& cells);

  Box box_;
  bool is_empty_ = false;
  double side_ = 0;  // of a cell
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  // For each corner of a cell, how many cells below and to its left are touched; row by row. Empty:
  // all of the box.
  std::vector<std::uint32_t> touched_;
};

}  // namespace weft
