// SPDX-License-Identifier: Apache-2.0
#include "engine/size/domain_cover.h"

#include <algorithm>
#include <cmath>

#include "engine/domain/stop_poller.h"

namespace weft {
namespace {

constexpr std::uint8_t kTouched = 1;  // by a border
constexpr std::uint8_t kTurned = 2;   // this cell and those to its right change sides

}  // namespace

// Square cells, so many about.
void DomainCover::divide(std::size_t cells) {
  const double wide = box_.width(), high = box_.height();
  const double longer = std::max(wide, high), shorter = std::min(wide, high);
  const auto wanted = static_cast<double>(cells);
  // As many along the longer side as a square would have, or as the area asks for.
  side_ = std::max(longer / wanted, std::sqrt(longer / wanted) * std::sqrt(shorter));
  const auto count = [&](double length) {
    return static_cast<std::size_t>(std::floor(length / side_)) + 1;
  };
  columns_ = count(wide);
  rows_ = count(high);
}

void DomainCover::add_border(Point a, Point b, std::vector<std::uint8_t>& cells) const {
  if (b.y < a.y) std::swap(a, b);
  const std::size_t first = row(a.y), last = row(b.y);
  const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
  const double low_x = std::min(a.x, b.x), high_x = std::max(a.x, b.x);
  const double rounding = 1e-6 * side_;
  for (std::size_t r = first; r <= last; ++r) {
    // The part of the border in this row, and a bit more.
    const double bottom = box_.min_y + static_cast<double>(r) * side_;
    double left = low_x, right = high_x;
    if (first != last) {
      const double at_bottom = a.x + (std::max(bottom, a.y) - a.y) * slope;
      const double at_top = a.x + (std::min(bottom + side_, b.y) - a.y) * slope;
      left = std::max(low_x, std::min(at_bottom, at_top));
      right = std::min(high_x, std::max(at_bottom, at_top));
    }
    std::uint8_t* const in_row = cells.data() + r * columns_;
    for (std::size_t c = column(left - rounding); c <= column(right + rounding); ++c)
      in_row[c] |= kTouched;
    const double middle = bottom + 0.5 * side_;
    if (!(a.y <= middle) || !(middle < b.y)) continue;
    const std::size_t c = column(std::clamp(a.x + (middle - a.y) * slope, left, right));
    if (c + 1 < columns_) in_row[c + 1] ^= kTurned;
  }
}

void DomainCover::sum_up(const std::vector<std::uint8_t>& cells) {
  const std::size_t width = columns_ + 1;
  touched_.assign(width * (rows_ + 1), 0);
  for (std::size_t r = 0; r < rows_; ++r) {
    std::uint32_t in_row = 0;
    bool inside = false;
    for (std::size_t c = 0; c < columns_; ++c) {
      const std::uint8_t cell = cells[r * columns_ + c];
      inside ^= (cell & kTurned) != 0;
      in_row += inside || (cell & kTouched) != 0;
      touched_[(r + 1) * width + c + 1] = touched_[r * width + c + 1] + in_row;
    }
  }
}

Result<DomainCover> DomainCover::make(const Domain& domain, const ExecutionContext& context) {
  try {
    StopPoller poller(context);
    Box box;
    for (const Point p : domain.vertices) {
      poller.step();
      box.add(p);
    }
    DomainCover cover(box);
    cover.divide(std::min(kMaxCells, 64 + 8 * domain.vertices.size()));
    std::vector<std::uint8_t> cells(cover.columns_ * cover.rows_, 0);
    for (const Domain::Triangle& t : domain.triangles) {
      for (int i = 0; i < 3; ++i) {
        poller.step();
        if (t.neighbor[i] == kNone)
          cover.add_border(domain.vertices[t.vertex[(i + 1) % 3]],
                           domain.vertices[t.vertex[(i + 2) % 3]], cells);
      }
    }
    cover.sum_up(cells);
    return cover;
  } catch (Stopped& stopped) {
    return tl::unexpected(std::move(stopped.error));
  }
}

bool DomainCover::meets(const Box& box) const {
  if (is_empty_ || !(box.min_x <= box_.max_x && box.max_x >= box_.min_x &&
                     box.min_y <= box_.max_y && box.max_y >= box_.min_y))
    return false;
  if (touched_.empty()) return true;
  const std::size_t width = columns_ + 1;
  const std::size_t left = column(box.min_x), right = column(box.max_x) + 1;
  const std::size_t bottom = row(box.min_y) * width, top = (row(box.max_y) + 1) * width;
  return touched_[top + right] - touched_[top + left] !=
         touched_[bottom + right] - touched_[bottom + left];
}

}  // namespace weft
