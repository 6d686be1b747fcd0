// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/quality_statistics.h"

#include <sleef.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft {
namespace {

// An angle is kept as t = c / (1 + |c|) of its cotangent c: t falls from 1 at 0 degrees to -1 at
// 180, and costs one division and no root.
constexpr double squeeze(double c) {
  return c / (1 + (c < 0 ? -c : c));
}

// t at 10 k degrees for k = 1 to 17: an angle's bin is the number of these that its t is at most.
// No t is at most the last one.
constexpr std::array<double, 18> kBorders = {
    squeeze(5.671281819617709),    squeeze(2.7474774194546216),   squeeze(1.7320508075688774),
    squeeze(1.19175359259421),     squeeze(0.8390996311772800),   squeeze(0.5773502691896257),
    squeeze(0.36397023426620234),  squeeze(0.17632698070846498),  0,
    squeeze(-0.17632698070846498), squeeze(-0.36397023426620234), squeeze(-0.5773502691896257),
    squeeze(-0.8390996311772800),  squeeze(-1.19175359259421),    squeeze(-1.7320508075688774),
    squeeze(-2.7474774194546216),  squeeze(-5.671281819617709),   -2};

// The borders are at least 0.08 apart: so a cell of a table of 64 holds one at most, and one
// comparison decides.
constexpr std::size_t kCells = 64;
constexpr auto kFirstBinOfCell = [] {
  std::array<std::uint8_t, kCells + 1> bins{};
  for (std::size_t cell = 0; cell <= kCells; ++cell) {
    const double upper = -1 + 2.0 * static_cast<double>(cell + 1) / kCells;
    while (bins[cell] < 17 && kBorders[bins[cell]] >= upper) ++bins[cell];
  }
  return bins;
}();

std::size_t angle_bin(double t) {
  const auto cell = static_cast<std::size_t>((t + 1) * (kCells / 2.0));
  const std::size_t bin = kFirstBinOfCell[cell];
  return bin + (t <= kBorders[bin] ? 1 : 0);
}

constexpr std::array<double, 8> kAspects = {1.1, 1.25, 1.5, 2, 3, 5, 10, 100};

double degrees(double t) {
  const double cotangent = t / (1 - std::fabs(t));
  return Sleef_cinz_atan2d1_u10purec(1, cotangent) * (180 / 3.14159265358979323846);
}

}  // namespace

void TriangleBlock::find_centroids() {
  for (std::size_t i = 0; i < size; ++i) {
    centroid_x[i] = x[0][i] + ((x[1][i] - x[0][i]) + (x[2][i] - x[0][i])) * (1.0 / 3);
    centroid_y[i] = y[0][i] + ((y[1][i] - y[0][i]) + (y[2][i] - y[0][i])) * (1.0 / 3);
  }
  for (std::size_t i = size; i % 8 != 0; ++i) {
    centroid_x[i] = centroid_x[0];
    centroid_y[i] = centroid_y[0];
  }
}

void QualityStatistics::add(const TriangleBlock& block) {
  constexpr std::size_t kSize = TriangleBlock::kSize;
  double angle[3][kSize];
  std::int64_t aspect[kSize];  // its bin
  double ratio[kSize];
  double area[kSize];
  const std::size_t n = block.size;
  for (std::size_t i = 0; i < n; ++i) {
    // Edge k is opposite corner k.
    const double ex0 = block.x[2][i] - block.x[1][i];
    const double ey0 = block.y[2][i] - block.y[1][i];
    const double ex1 = block.x[0][i] - block.x[2][i];
    const double ey1 = block.y[0][i] - block.y[2][i];
    const double ex2 = block.x[1][i] - block.x[0][i];
    const double ey2 = block.y[1][i] - block.y[0][i];
    const double doubled = ex2 * ey0 - ey2 * ex0;
    const double dot0 = -(ex1 * ex2 + ey1 * ey2);
    const double dot1 = -(ex2 * ex0 + ey2 * ey0);
    const double dot2 = -(ex0 * ex1 + ey0 * ey1);
    angle[0][i] = dot0 / (doubled + std::fabs(dot0));
    angle[1][i] = dot1 / (doubled + std::fabs(dot1));
    angle[2][i] = dot2 / (doubled + std::fabs(dot2));
    const double l0 = std::sqrt(ex0 * ex0 + ey0 * ey0);
    const double l1 = std::sqrt(ex1 * ex1 + ey1 * ey1);
    const double l2 = std::sqrt(ex2 * ex2 + ey2 * ey2);
    const double longest = std::max(l0, std::max(l1, l2));
    const double scaled = longest * (l0 + l1 + l2) * (0.5 / 1.7320508075688772);
    aspect[i] = 0;
    for (const double end : kAspects) aspect[i] += scaled > end * doubled ? 1 : 0;
    area[i] = 0.5 * doubled;
    ratio[i] = area[i] / block.bound[i] * 10;
  }
  for (std::size_t i = 0; i < n; ++i) {
    area_ += area[i];
    for (const auto& t : angle) {
      ++angles_[angle_bin(t[i])];
      smallest_angle_ = std::max(smallest_angle_, t[i]);
      largest_angle_ = std::min(largest_angle_, t[i]);
    }
    ++aspects_[static_cast<std::size_t>(aspect[i])];
    if (block.bound[i] < std::numeric_limits<double>::infinity()) {
      // Not a number, where the size field is bad, counts as exceeding.
      ++sizes_[ratio[i] < 9 ? static_cast<std::size_t>(ratio[i]) : 9];
    }
  }
}

void QualityStatistics::add(const QualityStatistics& other) {
  const auto add_each = [](auto& to, const auto& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  };
  area_ += other.area_;
  smallest_angle_ = std::max(smallest_angle_, other.smallest_angle_);
  largest_angle_ = std::min(largest_angle_, other.largest_angle_);
  add_each(angles_, other.angles_);
  add_each(aspects_, other.aspects_);
  add_each(sizes_, other.sizes_);
}

void QualityStatistics::write(Summary& summary) const {
  summary.area = area_;
  summary.min_angle_deg = degrees(smallest_angle_);
  summary.max_angle_deg = degrees(largest_angle_);
  summary.angle_histogram = angles_;
  summary.aspect_histogram = aspects_;
  summary.size_histogram = sizes_;
}

}  // namespace weft
