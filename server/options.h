// SPDX-License-Identifier: Apache-2.0
// The flags of weftd. Every flag is also read from the environment, as WEFT_ and its name in
// capitals: --max-points is WEFT_MAX_POINTS. A flag wins over the environment. --health, --help and
// --version, which do not serve, are flags alone.
#pragma once

#include <chrono>
#include <string>
#include <variant>

#include "server/observe/machine.h"
#include "server/server_options.h"

namespace weft::server {

struct Options {
  ServerOptions server;
  // Where jobs are kept: a folder, or a PostgreSQL server; both empty: nowhere.
  std::string data;
  std::string store;
  std::chrono::duration<double> drain{30};
  std::string log_level = "info";
  LogFormat log_format = LogFormat::kText;
  std::string port_file;  // empty: none
  bool exit_with_stdin = false;
  // Ask the server at this unix: address whether it serves, instead of being one; empty: serve.
  std::string ask_health_at;
};

// The command line needs no server: it asked for help, or it is wrong.
struct Exit {
  int code = 0;
};

inline constexpr int kExitUsage = 2;

// Defaults that depend on the machine come from `machine`. Prints help to stdout, and what is wrong
// to stderr.
std::variant<Options, Exit> parse_options(int argc, const char* const* argv,
                                          const Machine& machine);

}  // namespace weft::server
