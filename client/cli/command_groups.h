// SPDX-License-Identifier: Apache-2.0
// The commands of `weft` with their flags, in groups. Each of these functions adds a group to the
// command line; when one of its commands is given, `chosen` becomes what it does.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stop_token>
#include <string>

#include "client/base/files.h"
#include "files/base/data_path.h"
#include "files/base/error.h"

namespace weft::client {

struct Chosen {
  std::function<Result<ExitCode>(std::stop_token)> run;
  // The message on SIGINT; empty: none.
  std::string when_interrupted = "interrupted, nothing was written";
  const DataPath* input = nullptr;  // that may be standard input, which is taken in before `run`
};

void add_mesh_commands(CLI::App& app, Chosen& chosen);  // mesh, draw, check, convert, info
void add_batch_command(CLI::App& app, Chosen& chosen);
void add_server_commands(CLI::App& app, Chosen& chosen);  // health, server-info
void add_job_commands(CLI::App& app, Chosen& chosen);     // submit, get, list, watch, cancel, ...

}  // namespace weft::client
