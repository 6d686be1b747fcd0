// SPDX-License-Identifier: Apache-2.0
// Sizes of the client, as the checker takes them.
#pragma once

#include "checker/size/size.h"
#include "client/call/mesh_request.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/geo/domain_projection.h"

namespace weft::client {

// The size that the options ask for; a projection is that of the domain. Errors: those of
// with_size; kUsage for a constant that no triangle can fail.
Result<check::SizeSpec> checker_size(const RequestOptions& options, const Domain& domain,
                                     const DomainProjection* projection);

}  // namespace weft::client
