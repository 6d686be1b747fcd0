// SPDX-License-Identifier: Apache-2.0
// A domain as the checker takes it.
#pragma once

#include "checker/domain.h"
#include "files/formats/domain.h"

namespace weft::files {

// `snap`: within which features are merged, 0 or more; 0: that of the domain.
check::Domain checker_domain(const Domain& domain, double snap);

}  // namespace weft::files
