// SPDX-License-Identifier: Apache-2.0
// The flags of every command that speaks to a server.
#pragma once

#include <CLI/App.hpp>

#include "client/call/connect_options.h"

namespace weft::client {

enum class WithoutServer {
  kPrivate,  // a weftd is started
  kRefused,  // the command needs one that stays
};

// `options` outlives the parsing.
void add_server_flags(CLI::App& command, ConnectOptions& options, WithoutServer without);

}  // namespace weft::client
