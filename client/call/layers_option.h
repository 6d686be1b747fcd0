// SPDX-License-Identifier: Apache-2.0
// Layers of triangles along a wall: one --layers, such as wall:first=1e-5,ratio=1.2,rows=20.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>

#include "client/base/files.h"
#include "files/base/error.h"
#include "files/formats/names.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

struct LayersOption {
  std::string marker;  // a number or a name
  v1::Layers rows{};   // without the marker

  // The error is a text that says what is wrong. A marker whose name has a colon is given by
  // number.
  static tl::expected<LayersOption, std::string> parse(const std::string& text);

  // Errors: kUsage for a name that is none of these.
  Result<v1::Layers> message(const NameTable& names_of_markers) const;
};

}  // namespace weft::client
