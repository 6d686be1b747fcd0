// SPDX-License-Identifier: Apache-2.0
// The table of options of domains in files with layers and attributes, as call/request_rows.h is of
// what is asked of a mesh.
#pragma once

#include "client/base/option_row.h"
#include "client/formats/files/layer_options.h"

namespace weft::client {

const OptionRows<LayerOptions>& layer_rows();

}  // namespace weft::client
