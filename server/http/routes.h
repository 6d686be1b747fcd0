// SPDX-License-Identifier: Apache-2.0
// What --http serves, for whoever has curl rather than gRPC, and the console's pages:
//
//   PUT, POST  /v1/mesh, /v1/mesh/NAME   the file of a domain in, that of its mesh out
//   POST       /v1/domain/NAME           the file of a domain in, the domain and its faults out
//   GET        /v1/info                  versions and limits
//   GET        /, /v1/openapi.json       a description of all this, made of the tables
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "server/console/exchange.h"
#include "server/console/session.h"
#include "server/observe/log.h"
#include "server/run/memory_budget.h"

namespace weft::server {

struct RouteOptions {
  MemoryBudget& memory;          // outlives the routes
  std::filesystem::path folder;  // of nameless files, while meshes are at work
  std::uint64_t file_bytes = 0;  // of all files there
  std::size_t meshes = 128;      // on their way at the same time, until they are sent
  std::size_t threads = 2;       // that read and write large files; at least 2
  double client_share = 1;       // of all these, for one client
  Logger log;
};

// What is wrong with the folder; empty if nothing is.
std::string folder_fault(const std::filesystem::path& folder);

std::unique_ptr<Routes> make_routes(SessionContext& context, const RouteOptions& options);

}  // namespace weft::server
