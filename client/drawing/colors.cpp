// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/colors.h"

#include <algorithm>
#include <array>

namespace weft::client {
namespace {

constexpr Color from_hex(std::uint32_t rgb) {
  return {static_cast<double>(rgb >> 16 & 255) / 255, static_cast<double>(rgb >> 8 & 255) / 255,
          static_cast<double>(rgb & 255) / 255};
}

constexpr Color mix(Color a, Color b, double t) {
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green),
          a.blue + t * (b.blue - a.blue)};
}

}  // namespace

Color viridis(double t) {
  static constexpr std::array kAnchors = {
      from_hex(0x440154), from_hex(0x482878), from_hex(0x3e4989), from_hex(0x31688e),
      from_hex(0x26828e), from_hex(0x1f9e89), from_hex(0x35b779), from_hex(0x6ece58),
      from_hex(0xb5de2b), from_hex(0xfde725)};
  const double at = std::clamp(t, 0.0, 1.0) * (kAnchors.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kAnchors.size() - 2);
  return mix(kAnchors[i], kAnchors[i + 1], at - static_cast<double>(i));
}

Color region_color(std::int32_t id) {
  static constexpr std::array kPalette = {
      from_hex(0x0072b2), from_hex(0xe69f00), from_hex(0x009e73), from_hex(0xcc79a7),
      from_hex(0x56b4e9), from_hex(0xd55e00), from_hex(0xf0e442), from_hex(0x8c6bb1)};
  if (id == 0) return from_hex(0xe4e6ea);
  constexpr auto kCount = static_cast<std::int64_t>(kPalette.size());
  const std::int64_t i = ((std::int64_t{id} - 1) % kCount + kCount) % kCount;
  return mix(kPalette[static_cast<std::size_t>(i)], kPaper, 0.35);
}

Color mark_color(std::size_t kind) {
  constexpr Color kColors[] = {kMarkInk,         {0, 0.45, 0.70},    {0, 0.62, 0.45},
                               {0.84, 0.37, 0},  {0.58, 0.25, 0.60}, {0.20, 0.60, 0.85},
                               {0.75, 0.55, 0.0}};
  return kColors[kind % std::size(kColors)];
}

}  // namespace weft::client
