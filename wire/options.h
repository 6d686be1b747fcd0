// SPDX-License-Identifier: Apache-2.0
// The one table of the options of a request: the fields of weft.v1.GenerateMeshRequest that are one
// value each. Data alone, for whoever reads options from text.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace weft::wire {

struct Option {
  enum class Kind : std::uint8_t { kNumber, kCount, kLargeCount, kSwitch, kText, kChoice };

  std::string_view field;  // its path, such as "quality.min_angle_deg"
  // The numbers of the fields on the path; the second is 0 if the path is one field.
  std::array<std::uint32_t, 2> numbers;
  Kind kind = Kind::kNumber;
  // Of a choice: the names of the enumerators from 1 on.
  std::span<const std::string_view> names{};
};

inline constexpr std::string_view kFills[] = {"seeds", "even_odd", "union"};
inline constexpr std::string_view kMeasures[] = {"area", "edge"};
inline constexpr std::string_view kPlacements[] = {"lattice", "circumcentre"};

inline constexpr std::array kOptions = {
    Option{"domain.fill", {1, 6}, Option::Kind::kChoice, kFills},
    Option{"domain.snap", {1, 7}},
    Option{"size.constant", {2, 1}},
    Option{"size.expression", {2, 2}, Option::Kind::kText},
    Option{"size.measure", {2, 4}, Option::Kind::kChoice, kMeasures},
    Option{"size.cells_across", {2, 6}},
    Option{"size.points_per_circle", {2, 10}},
    Option{"size.gradation", {2, 7}},
    Option{"size.gradation_within", {2, 9}, Option::Kind::kSwitch},
    Option{"quality.min_angle_deg", {3, 1}},
    Option{"quality.min_edge", {3, 2}},
    Option{"quality.placement", {3, 3}, Option::Kind::kChoice, kPlacements},
    Option{"quality.optimise", {3, 4}, Option::Kind::kCount},
    Option{"budget.max_triangles", {4, 1}, Option::Kind::kLargeCount},
    Option{"budget.max_bytes", {4, 2}, Option::Kind::kLargeCount},
    Option{"budget.max_seconds", {4, 3}},
    Option{"threads", {5, 0}, Option::Kind::kCount},
    Option{"want_quadtree", {7, 0}, Option::Kind::kSwitch},
    Option{"allow_unrefined", {9, 0}, Option::Kind::kSwitch},
    Option{"simplify", {10, 0}},
};

}  // namespace weft::wire
