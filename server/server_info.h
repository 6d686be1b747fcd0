// SPDX-License-Identifier: Apache-2.0
// What GetServerInfo answers, for as long as the server runs.
#pragma once

#include "server/server_options.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

v1::GetServerInfoResponse server_info(const ServerOptions& options, bool has_store);

}  // namespace weft::server
