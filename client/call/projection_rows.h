// SPDX-License-Identifier: Apache-2.0
// The table of options of domains in longitude and latitude, beside that of requests,
// call/request_rows.h.
#pragma once

#include "client/base/option_row.h"
#include "files/geo/projection_options.h"

namespace weft::client {

const OptionRows<ProjectionOptions>& projection_rows();

}  // namespace weft::client
