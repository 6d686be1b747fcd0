// SPDX-License-Identifier: Apache-2.0
// A domain as the checker takes it.
#pragma once

#include "checker/domain.h"
#include "client/formats/domain.h"

namespace weft::client {

// `snap`: within which features are merged, 0 or more.
check::Domain checker_domain(const Domain& domain, double snap);

}  // namespace weft::client
