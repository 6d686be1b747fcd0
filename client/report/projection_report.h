// SPDX-License-Identifier: Apache-2.0
// The report on the projection of a domain, for people and for programs.
#pragma once

#include <string>

#include "client/base/files.h"
#include "client/report/json_line.h"
#include "files/geo/domain_projection.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// "projected by +proj=lcc ..., lengths in the plane are 0.991 to 1.009 of those on the ground\n"
std::string projection_text(const DomainProjection& projection);
// {"name": "+proj=lcc ...", "least_scale": 0.991, "greatest_scale": 1.009, "angle_deg": 0}
Json projection_json(const DomainProjection& projection);

// The places that the summary names, in longitude and latitude; boxes of leaves stay in the plane.
void bring_places_back(const DomainProjection& projection, v1::Summary& summary);

}  // namespace weft::client
