// SPDX-License-Identifier: Apache-2.0
// A stable sort that can stop: std::sort does not poll.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "weft/error.h"

namespace weft {

struct Keyed {
  std::uint64_t key;
  std::uint32_t item;
};

// By key; equal keys keep their order. O(n), with memory for as many again. Errors: those of
// context.poll.
inline std::optional<Error> radix_sort(std::vector<Keyed>& all, const ExecutionContext& context) {
  constexpr std::size_t kPollInterval = 1 << 18;
  constexpr unsigned kBits = 8;
  std::vector<Keyed> sorted(all.size());
  for (unsigned shift = 0; shift < 64; shift += kBits) {
    const auto digit = [shift](const Keyed& k) { return (k.key >> shift) & ((1u << kBits) - 1); };
    std::array<std::size_t, 1u << kBits> next{};
    for (const Keyed& k : all) ++next[digit(k)];
    std::size_t sum = 0;
    for (std::size_t& n : next) sum += std::exchange(n, sum);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % kPollInterval == 0) {
        if (auto error = context.poll()) return error;
      }
      sorted[next[digit(all[i])]++] = all[i];
    }
    all.swap(sorted);
  }
  return std::nullopt;
}

}  // namespace weft
