// SPDX-License-Identifier: Apache-2.0
// Reads the models of the tests: Triangle's .poly with its points in the same file.
//
//   Pslg coast = read_poly(model("us-east-coast.poly"));
#pragma once

#include <string>

#include "weft/pslg.h"

namespace weft {

// Takes comments, 0- or 1-based numbering, attributes, markers, holes and regions; a region's
// attribute becomes its id, a maximum area that is not positive means none. Throws
// std::runtime_error naming the line: a test ends there.
Pslg read_poly(const std::string& path);

// The path of a file in tests/models.
std::string model(const std::string& name);

}  // namespace weft
