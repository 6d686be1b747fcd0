// SPDX-License-Identifier: Apache-2.0
// The table of what a client may ask of a mesh. The flags of `weft mesh` and `weft submit`, the
// keys of the manifest of `weft batch` and docs/flags.md are made of it: a new option is a field of
// RequestOptions, which make_request sends, and one row here.
#pragma once

#include <string>
#include <string_view>

#include "client/base/option_row.h"
#include "client/call/mesh_request.h"

namespace weft::client {

// How large triangles may be.
const OptionRows<RequestOptions>& size_rows();

// What markers and regions are called.
const OptionRows<RequestOptions>& name_rows();

// All, those of size_rows first. What they read is `given` then.
const OptionRows<RequestOptions>& request_rows();

// How polygons that overlap are filled.
template <class Options>
OptionValue<Options> fill_value(PolygonFill Options::*field) {
  return one_of(field, {{"union", PolygonFill::kUnion},
                        {"even-odd", PolygonFill::kEvenOdd},
                        {"difference", PolygonFill::kDifference}});
}

// That of an option of wire/marker_options.h.
OptionValue<RequestOptions> marker_value(std::string_view name);

// What was given for a field of the request, such as "size.fields[0].name", as errors call it:
// "--field d", or "field d" if a manifest gave it. Empty if no option was.
std::string option_of(std::string_view field, const RequestOptions& options);

}  // namespace weft::client
