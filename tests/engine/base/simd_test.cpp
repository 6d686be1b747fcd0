// SPDX-License-Identifier: Apache-2.0
#include "engine/base/simd.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace weft {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> lanes(__m128d of) {
  std::vector<double> values(2);
  _mm_storeu_pd(values.data(), of);
  return values;
}
std::uint64_t bits(double of) {
  return std::bit_cast<std::uint64_t>(of);
}

// Of -0 and 0, of a NaN and a number: the second.
TEST(Simd, TakesTheSecondUnlessTheFirstIsLessOrMore) {
  const std::vector<double> values{0.0, -0.0, 1.0, -1.0, kNan, kInfinity, -kInfinity, 5e-324};
  for (const double a : values)
    for (const double b : values) {
      const __m128d first = _mm_set_pd(b, a);
      const __m128d second = _mm_set_pd(a, b);
      const std::vector<double> least{a < b ? a : b, b < a ? b : a};
      const std::vector<double> most{a > b ? a : b, b > a ? b : a};
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(bits(lanes(_mm_min_pd(first, second))[k]), bits(least[k])) << a << ' ' << b;
        EXPECT_EQ(bits(lanes(_mm_max_pd(first, second))[k]), bits(most[k])) << a << ' ' << b;
      }
      EXPECT_EQ(bits(lanes(_mm_min_sd(first, second))[0]), bits(least[0])) << a << ' ' << b;
      EXPECT_EQ(bits(lanes(_mm_min_sd(first, second))[1]), bits(b)) << a << ' ' << b;
      EXPECT_EQ(bits(lanes(_mm_max_sd(first, second))[0]), bits(most[0])) << a << ' ' << b;
      EXPECT_EQ(bits(lanes(_mm_max_sd(first, second))[1]), bits(b)) << a << ' ' << b;
    }
}

TEST(Simd, ConvertsWhatNoIntHoldsToTheLeastInt) {
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  for (const double value : {kNan, kInfinity, -kInfinity, 2147483648.0, -1e300, 1e300}) {
    alignas(16) std::int32_t ints[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(ints), _mm_cvttpd_epi32(_mm_set_pd(value, -7.9)));
    EXPECT_EQ(ints[0], -7);
    EXPECT_EQ(ints[1], kLeast) << value;
  }
}

}  // namespace
}  // namespace weft
