// SPDX-License-Identifier: Apache-2.0
// The same domain by Triangle's rule (Fill::kSeeds), for formats that know no other: points that
// coincide become one, segments that repeat become one, and every hole gets a seed.
//
// Errors (kUnreadableInput): a domain of so many tall rings that the search for seeds would not end
// in reasonable time. Where rings cross each other between their points, the faces between them may
// miss their seed; GeoJSON that is valid has no such rings.
#pragma once

#include "client/base/error.h"
#include "client/formats/domain.h"

namespace weft::client {

// A domain that has seeds already is returned as it is.
Result<Domain> seeded(Domain domain);

}  // namespace weft::client
