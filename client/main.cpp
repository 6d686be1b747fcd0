// SPDX-License-Identifier: Apache-2.0
// weft: the command line of the meshing service. cli/ knows the flags; commands/ does the work.
#include <grpc/support/log.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>

#include "client/base/signals.h"
#include "client/cli/command_groups.h"
#include "client/cli/flags.h"
#include "client/cli/suggest.h"
#include "files/formats/standard_streams.h"

namespace {

using namespace weft::client;

constexpr char kExitCodes[] = R"(Exit codes:
  0        all went well
  1        a fault of weft itself
  2        the command line is wrong
  3        `weft check` or `weft batch` ran, and a mesh fails; `weft lint` found faults
  4        the input is missing, unreadable or malformed
  5        the output cannot be written; nothing is left behind
  6        the private weftd could not be found or started
  64 + n   the call to the server, or the job that was waited for, ended with gRPC
           status n: 65 the job was cancelled, 67 the request is wrong, 68 a
           deadline passed, 69 there is no such job, 72 a limit was exceeded, 73 the
           mesh misses its bounds, or the job has not ended, 78 the server is absent
           or went away, 79 the stream was damaged, 80 the token is missing or wrong
  128 + n  stopped by signal n

Flags that name a variable in their help, such as (Env:WEFT_SERVER), are also read
from it. WEFT_WEFTD is the weftd that is started if no server is named.)";

// gRPC's own log lines are dropped: the status of a call says what they say.
void silence_grpc_log() {
  if (std::getenv("GRPC_VERBOSITY") == nullptr) gpr_set_log_function([](gpr_log_func_args*) {});
}

// CLI11 reads the variables of all commands. A value that one command takes and another refuses,
// such as a WEFT_MIN_ANGLE for `weft check`, must not end the others.
void forget_variables_of_others(CLI::App& app, const std::string& called) {
  for (CLI::App* command : app.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (command->get_name() != called) option->envname("");
}

Result<ExitCode> run(const Chosen& chosen, const std::stop_token& stop) {
  if (chosen.input != nullptr)
    if (auto taken = take_standard_input(*chosen.input, stop); !taken)
      return tl::unexpected(taken.error());
  return chosen.run(stop);
}

int run(int argc, char** argv) {
  CLI::App app("Graded, guaranteed-quality Delaunay meshes of planar domains.", "weft");
  app.set_version_flag("--version", "weft " WEFT_VERSION);
  app.require_subcommand(1);
  app.footer(kExitCodes);
  Chosen chosen;
  add_mesh_commands(app, chosen);
  add_batch_command(app, chosen);
  add_job_commands(app, chosen);
  add_server_commands(app, chosen);
  forget_variables_of_others(app, argc > 1 ? argv[1] : "");
  try {
    app.parse(argc, argv);
    for (const CLI::App* command : app.get_subcommands())
      refuse_idle_flags(*command, {argv, static_cast<std::size_t>(argc)});
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    const std::span<char* const> words(argv, static_cast<std::size_t>(argc));
    const std::string unknown = unknown_command(app, words);
    constexpr int kUsage = static_cast<int>(ExitCode::kUsage);
    app.exit(unknown.empty() ? error : CLI::ParseError(unknown, kUsage));
    const std::string meant = suggestion(app, words);
    if (!meant.empty()) std::fprintf(stderr, "weft: %s\n", meant.c_str());
    return kUsage;
  }

  Signals signals;
  const Result<ExitCode> result = run(chosen, signals.stop());
  // What was complete before the signal could end it is no failure.
  if (signals.received() != 0 && !result) {
    if (!chosen.when_interrupted.empty())
      std::fprintf(stderr, "weft: %s\n", chosen.when_interrupted.c_str());
    signals.die();
  }
  if (result) return static_cast<int>(*result);
  std::fprintf(stderr, "weft: %s\n", result.error().message.c_str());
  return static_cast<int>(result.error().exit);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    silence_grpc_log();
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
    return static_cast<int>(ExitCode::kInternal);
  }
}
