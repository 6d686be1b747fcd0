// SPDX-License-Identifier: Apache-2.0
#include "engine/emit/quality_statistics.h"

#include <sleef.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/base/simd.h"
#include "engine/size/size_function.h"

namespace weft {
namespace {

using Lanes = __m128d;

// An angle with the cotangent c is kept as t = c / (1 + |c|). t falls from 1 at 0 degrees to -1 at
// 180, and costs one division and no root.
constexpr double squeeze(double c) {
  return c / (1 + (c < 0 ? -c : c));
}

// The t of 10 k degrees for k = 1 to 17. The bin of an angle is the number of borders that its t
// does not exceed; every t exceeds the last one.
constexpr std::array<double, 18> kBorders = {
    squeeze(5.671281819617709),    squeeze(2.7474774194546216),   squeeze(1.7320508075688774),
    squeeze(1.19175359259421),     squeeze(0.8390996311772800),   squeeze(0.5773502691896257),
    squeeze(0.36397023426620234),  squeeze(0.17632698070846498),  0,
    squeeze(-0.17632698070846498), squeeze(-0.36397023426620234), squeeze(-0.5773502691896257),
    squeeze(-0.8390996311772800),  squeeze(-1.19175359259421),    squeeze(-1.7320508075688774),
    squeeze(-2.7474774194546216),  squeeze(-5.671281819617709),   -2};

// The borders are at least 0.08 apart, so a cell of a table of 64 holds at most one, and one
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

// Smallest angles are counted by their t, from 1 down to 0.366 at 60 degrees, in steps of 0.07
// degrees.
constexpr double kFinePerT = 1600;

constexpr std::array<double, 8> kAspects = {1.1, 1.25, 1.5, 2, 3, 5, 10, 100};

double degrees(double t) {
  const double cotangent = t / (1 - std::fabs(t));
  return Sleef_cinz_atan2d1_u10purec(1, cotangent) * (180 / 3.14159265358979323846);
}

}  // namespace

void QualityStatistics::add(const TriangleBlock& block) {
  constexpr std::size_t kSize = TriangleBlock::kSize;
  static_assert(kSize % 2 == 0);
  alignas(16) double angle[3][kSize];      // as t
  alignas(16) std::int64_t aspect[kSize];  // its bin
  alignas(16) double ratio[kSize];
  alignas(16) double area[kSize];
  alignas(16) double quality[kSize];
  if (fine_.empty()) fine_.resize(2 * kFineBins);
  const std::size_t n = block.size;
  for (std::size_t i = 0; i < n; i += 2) {
    const auto edge = [i](const double(&coordinate)[3][kSize], std::size_t from, std::size_t to) {
      return _mm_load_pd(&coordinate[to][i]) - _mm_load_pd(&coordinate[from][i]);
    };
    // Edge k is opposite corner k.
    const Lanes ex[3] = {edge(block.x, 1, 2), edge(block.x, 2, 0), edge(block.x, 0, 1)};
    const Lanes ey[3] = {edge(block.y, 1, 2), edge(block.y, 2, 0), edge(block.y, 0, 1)};
    // Of a triangle that turns left by less than rounding it may come out negative, and then its
    // angles of 0 and 180 degrees would be taken for each other.
    const Lanes doubled = _mm_max_pd(ex[2] * ey[0] - ey[2] * ex[0], _mm_setzero_pd());
    Lanes length[3];
    Lanes sum2 = _mm_setzero_pd();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = k == 2 ? 0 : k + 1;
      const std::size_t previous = k == 0 ? 2 : k - 1;
      const Lanes dot = -(ex[next] * ex[previous] + ey[next] * ey[previous]);
      const Lanes magnitude = _mm_andnot_pd(_mm_set1_pd(-0.0), dot);
      _mm_store_pd(&angle[k][i], dot / (doubled + magnitude));
      const Lanes length2 = ex[k] * ex[k] + ey[k] * ey[k];
      sum2 += length2;
      length[k] = _mm_sqrt_pd(length2);
    }
    const Lanes longest = _mm_max_pd(length[0], _mm_max_pd(length[1], length[2]));
    const Lanes scaled = longest * (length[0] + length[1] + length[2]) * (0.5 / 1.7320508075688772);
    __m128i bin = _mm_setzero_si128();
    for (const double end : kAspects)
      bin = _mm_sub_epi64(bin, _mm_castpd_si128(_mm_cmpgt_pd(scaled, end * doubled)));
    _mm_store_si128(reinterpret_cast<__m128i*>(&aspect[i]), bin);
    const Lanes half = 0.5 * doubled;
    _mm_store_pd(&area[i], half);
    _mm_store_pd(&quality[i], (2 * 1.7320508075688772) * doubled / sum2);
    _mm_store_pd(&ratio[i], half / _mm_load_pd(&block.bound[i]) * 10);
  }
  // Neighbours fall into the same bins. With a counter each, none waits for the one before.
  std::array<std::array<std::uint32_t, 18>, 3> angles{};
  double total = area_;
  double on_lattice = 0;
  double off_lattice = 0;
  double mean = 0;
  double least = 0;
  double least_bound = least_bound_;
  double smallest = smallest_angle_;
  double largest = largest_angle_;
  for (std::size_t i = 0; i < n; ++i) {
    total += area[i];
    (block.on_lattice[i] ? on_lattice : off_lattice) += area[i];
    mean += quality[i];
    for (std::size_t k = 0; k < 3; ++k) ++angles[k][angle_bin(angle[k][i])];
    const double least_angle = std::max(std::max(angle[0][i], angle[1][i]), angle[2][i]);
    smallest = std::max(smallest, least_angle);
    // Neighbours are in the same bin here, too.
    ++fine_[2 * static_cast<std::size_t>((1 - least_angle) * kFinePerT) + i % 2];
    largest = std::min(largest, std::min(std::min(angle[0][i], angle[1][i]), angle[2][i]));
    ++aspects_[static_cast<std::size_t>(aspect[i])];
    if (SizeFunction::bounds_area(block.bound[i])) {
      // NaN, if the size is undefined, counts as exceeding.
      ++sizes_[ratio[i] < 9 ? static_cast<std::size_t>(ratio[i]) : 9];
      least += ratio[i];
      least_bound = std::min(least_bound, block.bound[i]);
      ++bounded_;
    }
  }
  area_ = total;
  on_lattice_ += on_lattice;
  off_lattice_ += off_lattice;
  quality_ += mean;
  least_ += least;
  least_bound_ = least_bound;
  smallest_angle_ = smallest;
  largest_angle_ = largest;
  for (std::size_t bin = 0; bin < angles_.size(); ++bin)
    angles_[bin] += std::uint64_t{angles[0][bin]} + angles[1][bin] + angles[2][bin];
}

void QualityStatistics::add(const QualityStatistics& other) {
  const auto add_each = [](auto& to, const auto& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  };
  area_ += other.area_;
  on_lattice_ += other.on_lattice_;
  off_lattice_ += other.off_lattice_;
  quality_ += other.quality_;
  least_ += other.least_;
  bounded_ += other.bounded_;
  least_bound_ = std::min(least_bound_, other.least_bound_);
  if (!other.fine_.empty()) {
    fine_.resize(2 * kFineBins);
    add_each(fine_, other.fine_);
  }
  smallest_angle_ = std::max(smallest_angle_, other.smallest_angle_);
  largest_angle_ = std::min(largest_angle_, other.largest_angle_);
  add_each(angles_, other.angles_);
  add_each(aspects_, other.aspects_);
  add_each(sizes_, other.sizes_);
}

// The smallest angle, in degrees, that `rank` triangles are below; interpolated within a bin.
double QualityStatistics::percentile(double rank) const {
  double below = 0;
  for (std::size_t bin = 0; bin < kFineBins; ++bin) {
    const auto here = static_cast<double>(fine_[2 * bin] + fine_[2 * bin + 1]);
    if (here > 0 && below + here >= rank)
      return degrees(1 - (static_cast<double>(bin) + (rank - below) / here) / kFinePerT);
    below += here;
  }
  return 60;
}

void QualityStatistics::write(Summary& summary) const {
  const auto triangles =
      static_cast<double>(std::accumulate(aspects_.begin(), aspects_.end(), std::uint64_t{0}));
  summary.area = area_;
  summary.lattice_share = on_lattice_ / (on_lattice_ + off_lattice_);
  summary.mean_quality = quality_ / triangles;
  summary.ideal_ratio = least_ > 0 ? static_cast<double>(bounded_) / (0.1 * least_) : 0;
  summary.least_bound = bounded_ > 0 ? least_bound_ : 0;
  summary.min_angle_deg = degrees(smallest_angle_);
  summary.min_angle_p1_deg = std::max(summary.min_angle_deg, percentile(0.01 * triangles));
  summary.max_angle_deg = degrees(largest_angle_);
  summary.angle_histogram = angles_;
  summary.aspect_histogram = aspects_;
  summary.size_histogram = sizes_;
}

}  // namespace weft
