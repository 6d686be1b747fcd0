// SPDX-License-Identifier: Apache-2.0
// The input file of Abaqus and CalculiX, .inp (Dhondt, CalculiX CrunchiX user's manual 2.20,
// chapter 7): the mesh alone, in the plane, for other decks to *INCLUDE. Triangles are CPS3, or
// CPS6 of second order; each region is their element set. A marker is a node set, and a surface of
// sides of elements; an edge inside the domain is a side of one of its two triangles. Sets without
// a name are region_7, marker_7. Nodes and elements have their numbers from 1. A number has at most
// 20 characters, which is all that both programs read, so that a coordinate whose shortest text is
// longer loses its last digits.
#pragma once

#include <filesystem>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/formats/mesh.h"

namespace weft::files {

void write_inp(const MeshView& mesh, OutputFile& file);

// Elements of 3, 4, 6 and 8 nodes of planes, of bodies of revolution and of shells, whose z is
// dropped, and lines of 2 and 3 nodes, which are edges. Other elements are left out with a warning.
//
// The region of an element is the first set that a *SOLID SECTION or another one names it by; else
// the first *ELSET that lists it and is not internal; else the ELSET of its *ELEMENT. The marker of
// a line is found like a region. The marker of a side is the first element surface that has it.
// Node sets, steps and what they say are passed over. Files in parts: one part, or one instance of
// it, in the part's own coordinates.
Result<Mesh> read_inp(const std::filesystem::path& path);

}  // namespace weft::files
