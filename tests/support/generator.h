// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same with every standard library, unlike those of its distributions.
#pragma once

#include <cstdint>
#include <random>

namespace weft {

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : engine_(seed) {}
  int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }
  double unit() { return engine_() / 4294967296.0; }  // in [0, 1)
  double between(double low, double high) { return low + (high - low) * unit(); }

 private:
  std::mt19937 engine_;
};

}  // namespace weft
