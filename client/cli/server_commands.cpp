// SPDX-License-Identifier: Apache-2.0
// The flags of `weft health` and `weft server-info`.
#include <memory>

#include "client/cli/command_groups.h"
#include "client/cli/connect_flags.h"
#include "client/cli/flags.h"
#include "client/commands/commands.h"

namespace weft::client {
namespace {

using Run = Result<ExitCode> (*)(const ServerOptions&, std::stop_token);

void add(CLI::App& app, const char* name, const char* help, Run run, Chosen& chosen) {
  const auto options = std::make_shared<ServerOptions>();
  CLI::App& command = *app.add_subcommand(name, help);
  add_server_flags(command, options->server, WithoutServer::kPrivate);
  add_timeout(command, options->timeout_seconds, "Maximum time of the command, in seconds", "10");
  command.callback([options, run, &chosen] {
    chosen.run = [options, run](std::stop_token stop) { return run(*options, std::move(stop)); };
  });
}

}  // namespace

void add_server_commands(CLI::App& app, Chosen& chosen) {
  add(app, "health", "Check whether the server accepts work", run_health, chosen);
  add(app, "server-info", "Show the version and the limits of the server", run_server_info, chosen);
}

}  // namespace weft::client
