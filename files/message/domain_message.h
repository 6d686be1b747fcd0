// SPDX-License-Identifier: Apache-2.0
// A domain as the protocol spells it, weft.v1.Domain, for the command line and libweft alike.
#pragma once

#include <string>

#include "files/formats/domain.h"

namespace weft::files {

// The bytes of the message. Places, warnings, markers of points and the coordinate system have no
// field there.
std::string domain_message(const Domain& domain);

// The place in the file of what `field` names, as in "domain.segments[17].b"; empty if unknown.
std::string locate_field(const std::string& field, const Domain& domain);

}  // namespace weft::files
