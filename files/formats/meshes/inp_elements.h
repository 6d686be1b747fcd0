// SPDX-License-Identifier: Apache-2.0
// What the types of elements of Abaqus are in the plane.
#pragma once

#include <cstddef>
#include <string_view>

namespace weft::files {

struct InpElementType {
  std::size_t corners =
      0;  // 2 of a line; 0: not an element of planes, bodies of revolution or shells
  bool second_order = false;
  bool is_shell = false;  // its sides are E1, E2, ...; those of others S1, S2, ...

  std::size_t nodes() const {
    return corners == 2 ? (second_order ? 3 : 2) : (second_order ? 2 : 1) * corners;
  }
};

// "CPS3", in letters of either case.
InpElementType inp_element_type(std::string_view name);

}  // namespace weft::files
