// SPDX-License-Identifier: Apache-2.0
// The tables of the PostgreSQL store, by version.
#pragma once

#include "server/store/postgres/postgres.h"

namespace weft::server {

// Brings a database, new or old, to the version of this program; several servers may do so at once.
// kBroken if the database has a newer version.
StoreResult<void> migrate(postgres::Connection& connection);

}  // namespace weft::server
