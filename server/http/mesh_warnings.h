// SPDX-License-Identifier: Apache-2.0
// What an answer over HTTP warns of, in headers `Weft-Warning`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/console/problem.h"
#include "server/http/domain_file.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// What the mesh is not, though it was asked for; places are those of the file that was sent.
void add_warnings(const v1::Summary& summary, const SentDomain& sent, std::uint64_t max_triangles,
                  std::vector<std::string>& warnings);

// The first of them, each on a line of its own in ASCII, and how many more there are.
void warn(std::vector<std::string> warnings, boost::beast::http::fields& head);

}  // namespace weft::server
