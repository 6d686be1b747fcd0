// SPDX-License-Identifier: Apache-2.0
// The tables of how meshes are written and drawn, as call/request_rows.h is of what is asked of a
// mesh. The files themselves are no rows: a manifest judges their names where it reads them.
#pragma once

#include "client/base/option_row.h"
#include "client/report/mesh_output.h"

namespace weft::client {

const OptionRows<MeshWriteOptions>& writing_rows();
// What drawings show, of any mesh.
const OptionRows<DrawOptions>& drawing_rows();
// What they show of a mesh that was just made.
const OptionRows<MeshOutputOptions>& quadtree_rows();

}  // namespace weft::client
