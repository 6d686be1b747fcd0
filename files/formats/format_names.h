// SPDX-License-Identifier: Apache-2.0
// How each format writes the names of markers and regions (MeshFormat::marker_names), and what
// becomes of names that it cannot write as they are.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/formats/names.h"

namespace weft::files {

struct MeshFormat;

// As it is.
std::string any_name(std::string_view name);
// In double quotes, of which it has none itself: .2dm, .mfem.
std::string quotable_name(std::string_view name);
// The same, and nothing that reads as "marker 7" or "region 7", which Gmsh's files have for numbers
// without a name.
std::string gmsh_name(std::string_view name);
// One word without SU2's separators, and no integer, which is a marker without a name.
std::string su2_tag(std::string_view name);
// A word of the letters, digits and _-.+@ that CF's flag_meanings may have.
std::string flag_meaning(std::string_view name);
// One word, and nothing that reads as "region_7", "marker_7" or "default": .obj, .vol.
std::string group_word(std::string_view name);
// Nothing that reads as "marker 7" or "region 7".
std::string exodus_name(std::string_view name);
// A word of letters, digits and _-. that does not begin with a digit, - or ., and nothing that
// reads as "region_7", "marker_7" or kFrontAndBack.
std::string foam_word(std::string_view name);
// A word of letters, digits and _- that begins with a letter, of at most 72 characters so that with
// a number behind it has no more than 80, and nothing that reads as "region_7" or "marker_7".
std::string inp_label(std::string_view name);
// OpenFOAM's patch of the triangles themselves.
inline constexpr char kFrontAndBack[] = "frontAndBack";

// The names as the format writes them; without those that it does not carry.
Names names_in(const MeshFormat& format, const Names& names);

// Adds sentences on the names that a file lacks, or spells in another way. `written`: what it has.
void add_name_losses(const std::string& file, const Names& names, const Names& written,
                     std::vector<std::string>& sentences);

}  // namespace weft::files
