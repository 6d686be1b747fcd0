// SPDX-License-Identifier: Apache-2.0
// The table of options of domains in files with layers and attributes, beside that of
// requests, call/request_rows.h.
#pragma once

#include "client/base/option_row.h"
#include "files/formats/layer_options.h"

namespace weft::client {

const OptionRows<LayerOptions>& layer_rows();

}  // namespace weft::client
