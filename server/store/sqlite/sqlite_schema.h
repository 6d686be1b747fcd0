// SPDX-License-Identifier: Apache-2.0
// The tables of the SQLite store, by version.
#pragma once

#include <string>

#include "server/store/sqlite/sqlite.h"

namespace weft::server {

// Brings a database, new or old, to the version of this program. kBroken if the database has a
// newer version. `path` is for messages.
StoreResult<void> migrate(sqlite::Connection& connection, const std::string& path);

}  // namespace weft::server
