// SPDX-License-Identifier: Apache-2.0
// The tables of options for writing and drawing meshes; call/request_rows.h has those of requests.
// The output files are not among the rows: a manifest checks their names where it reads them.
#pragma once

#include "client/base/option_row.h"
#include "client/report/mesh_output.h"

namespace weft::client {

const OptionRows<MeshWriteOptions>& writing_rows();
// The value of the row "open-boundary".
OptionValue<MeshWriteOptions> open_boundaries();
// What drawings show, of any mesh, by `weft draw`.
const OptionRows<DrawOptions>& drawing_rows();
// The same for drawings of a mesh that is being made: they have no bound to colour by, so help does
// not offer that colour; MeshOutput::open tells a user who asks for it what to do instead.
const OptionRows<DrawOptions>& drawing_rows_of_new_mesh();
// What they show of a domain, without a mesh.
const OptionRows<DrawOptions>& drawing_rows_of_domain();
// What they show of a mesh that was just made.
const OptionRows<MeshOutputOptions>& quadtree_rows();

}  // namespace weft::client
