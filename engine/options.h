// SPDX-License-Identifier: Apache-2.0
// The options of a request, judged without its domain: check_options (engine.h) for those who only
// want to know, read_options for the run. A library of its own, so that who admits requests needs
// nothing else of the engine.
#pragma once

#include <optional>

#include "engine/base/error.h"
#include "engine/engine.h"
#include "engine/size/expression/expression.h"

namespace weft {

// The expression of the size, if there is one. Errors: those of check_options.
Result<std::optional<Expression>> read_options(const MeshRequest& request);

}  // namespace weft
