// SPDX-License-Identifier: Apache-2.0
// Small domains that nobody would draw, each from a seed.
//
//   Random random(seed);
//   for (const Kind& kind : kKinds) mesh(kind.generate(random));
#pragma once

#include <cstdint>
#include <iosfwd>
#include <random>
#include <span>

#include "weft/pslg.h"

namespace weft {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Point in_box(double size) { return {unit() * size, unit() * size}; }

 private:
  std::mt19937_64 engine_;
};

struct Kind {
  const char* name;
  Pslg (*generate)(Random&);
};
void PrintTo(const Kind& kind, std::ostream* out);

// All of them: dirty grids, stars, wedges, holes that touch, clusters, tangles, islands, areas.
std::span<const Kind> kinds();

}  // namespace weft
