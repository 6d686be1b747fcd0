// SPDX-License-Identifier: Apache-2.0
// Converts a domain to Triangle's rule (Fill::kSeeds), for formats that have no other: points that
// coincide become one, segments that repeat become one, and every hole gets a seed.
//
// Errors (kUnreadableInput): a domain of so many tall rings that the search for seeds would not end
// in reasonable time. If rings cross each other between their points, the faces between them may
// lack a seed; valid GeoJSON has no such rings.
#pragma once

#include "client/base/error.h"
#include "client/formats/domain.h"

namespace weft::client {

// A domain that has seeds already is returned as it is.
Result<Domain> seeded(Domain domain);

}  // namespace weft::client
