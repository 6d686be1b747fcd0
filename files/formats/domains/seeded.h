// SPDX-License-Identifier: Apache-2.0
// Converts a domain to Triangle's rule (Fill::kSeeds), for formats that have no other: its points
// and segments become those of the arrangement, which the checker makes, and the faces that are not
// meshed, or that have a region or a bound, get a seed each.
//
// Errors (kUnreadableInput): what the checker refuses, such as over 2,000,000 contacts of segments
// or 4,000,000 chords of arcs; a domain with so many tall faces that the search for seeds would not
// end in reasonable time.
#pragma once

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

// A domain that has seeds already is returned as it is.
Result<Domain> seeded(Domain domain);

}  // namespace weft::files
