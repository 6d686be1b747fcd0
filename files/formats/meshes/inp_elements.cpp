// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/inp_elements.h"

#include <string>

#include "files/base/words.h"

namespace weft::files {
namespace {

struct Family {
  std::string_view name;  // what stands before the number of nodes
  bool is_shell;
};
constexpr Family kFamilies[] = {{"cps", false},  {"cpe", false},  {"cpeg", false}, {"cax", false},
                                {"cgax", false}, {"dc2d", false}, {"dcax", false}, {"ac2d", false},
                                {"acax", false}, {"s", true},     {"ds", true},    {"stri", true},
                                {"m3d", true},   {"r3d", true},   {"sfm3d", true}};

// By their first letters: the names of lines do not always have their number of nodes.
constexpr std::string_view kLinesOfTwo[] = {"t2d2", "t3d2", "b21",  "b23",  "b31",
                                            "b33",  "r2d2", "rax2", "sax1", "dc1d2"};
constexpr std::string_view kLinesOfThree[] = {"t2d3", "t3d3", "b22", "b32", "sax2", "dc1d3"};

}  // namespace

InpElementType inp_element_type(std::string_view name) {
  const std::string type = lower_case(name);
  for (const std::string_view line : kLinesOfTwo)
    if (type.starts_with(line)) return {.corners = 2};
  for (const std::string_view line : kLinesOfThree)
    if (type.starts_with(line)) return {.corners = 2, .second_order = true};
  for (const auto& [family, is_shell] : kFamilies) {
    if (!type.starts_with(family) || type.size() == family.size()) continue;
    const char nodes = type[family.size()];
    if (nodes == '3' || nodes == '6') return {3, nodes == '6', is_shell};
    if (nodes == '4' || nodes == '8') return {4, nodes == '8', is_shell};
  }
  return {};
}

}  // namespace weft::files
