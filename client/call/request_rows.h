// SPDX-License-Identifier: Apache-2.0
// The table of what a client may ask of a mesh. The flags of `weft mesh` and `weft submit`, the
// keys of the manifest of `weft batch` and docs/flags.md are made of it: a new option is a field of
// RequestOptions, which make_request sends, and one row here.
#pragma once

#include "client/base/option_row.h"
#include "client/call/mesh_request.h"

namespace weft::client {

// How large triangles may be.
const OptionRows<RequestOptions>& size_rows();

// All, those of size_rows first.
const OptionRows<RequestOptions>& request_rows();

}  // namespace weft::client
