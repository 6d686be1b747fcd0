// SPDX-License-Identifier: Apache-2.0
// Why a call or a job failed, by the name that the server has for it.
#pragma once

#include "wire/failure.h"

namespace weft::server {

using wire::bad_option;
using wire::Failure;
using wire::Reason;

}  // namespace weft::server
