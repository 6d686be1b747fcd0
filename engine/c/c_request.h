// SPDX-License-Identifier: Apache-2.0
// A request of the C interface (weft/c.h): the message that it is, and what could not be taken.
#pragma once

#include <optional>
#include <string>

#include "weft/c.h"
#include "weft/error.h"

struct weft_request {
  std::string bytes{};                              // of a weft.v1.GenerateMeshRequest
  std::optional<weft::Error> fault = std::nullopt;  // the first
};
