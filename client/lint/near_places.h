// SPDX-License-Identifier: Apache-2.0
// What probably made a mesh finer than was asked: points of the input that are apart by a fault.
#pragma once

#include <string>

#include "client/base/files.h"
#include "files/base/data_path.h"
#include "files/formats/domain.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// A line, with its end, that says how many points are near to others or to segments, how far off,
// and which --snap merges them, as weft lint does; empty if the summary has no triangles that small
// angles of the input force, already names a --snap, or no such points are found. `domain` is as it
// was sent, read from `file`.
std::string near_places_text(const Domain& domain, const DataPath& file,
                             const v1::Summary& summary);

}  // namespace weft::client
