// SPDX-License-Identifier: Apache-2.0
// The flags of the commands on jobs that a server keeps.
#include "client/commands/job_commands.h"

#include <algorithm>
#include <map>
#include <memory>

#include "client/cli/command_groups.h"
#include "client/cli/connect_flags.h"
#include "client/cli/flags.h"

namespace weft::client {
namespace {

constexpr char kSubmitExamples[] = R"(Examples:
  weft submit coast.geojson --size 1e-6 --server mesh.example.org:7421
  id=$(weft submit key.poly --request-id nightly-2026-11-20)
  weft submit key.poly --min-angle 30 --wait -o key.vtu
  weft submit key.poly --notify https://hooks.example.org/weft)";

constexpr char kGetExamples[] = R"(Example:
  weft get 01JCZ3V5K2M7Q8R9S0T1V2W3X4 --json | jq -r .state)";

constexpr char kListExamples[] = R"(Examples:
  weft list --state queued --state running
  weft list --limit 20 --json | jq -r '.jobs[].id')";

constexpr char kWatchExamples[] =
    R"(Exits as the job does: 0 if it succeeded, 64 + the gRPC code of its error if it
failed, 65 if it was cancelled.

Examples:
  weft watch 01JCZ3V5K2M7Q8R9S0T1V2W3X4 && weft fetch 01JCZ3V5K2M7Q8R9S0T1V2W3X4 -o coast.vtu
  weft watch 01JCZ3V5K2M7Q8R9S0T1V2W3X4 --json | jq .progress.fraction)";

constexpr char kCancelExamples[] = R"(Example:
  weft list --state queued --json | jq -r '.jobs[].id' | xargs weft cancel)";

constexpr char kDeleteExamples[] = R"(Example:
  weft list --state failed --json | jq -r '.jobs[].id' | xargs weft delete)";

constexpr char kFetchExamples[] = R"(A download that breaks is resumed where it broke.

Examples:
  weft fetch 01JCZ3V5K2M7Q8R9S0T1V2W3X4 -o coast.vtu --draw coast.png --color angle
  weft fetch 01JCZ3V5K2M7Q8R9S0T1V2W3X4 -o key.node --domain key.poly --wait)";

constexpr char kTopExamples[] =
    R"(On a terminal, q ends it. If the output is not a terminal, it prints one update.

Examples:
  weft top --server mesh.example.org:7421
  weft top --once)";

CLI::App& add_command(CLI::App& app, const char* name, const char* help, const char* examples) {
  CLI::App& command = *app.add_subcommand(name, help);
  command.group("Jobs that a server keeps");
  command.footer(examples);
  return command;
}

constexpr double kShortTimeout = 30;

void add_job_calls(CLI::App& command, CallOptions& calls,
                   const std::string& timeout_about = "Maximum time of the command, in seconds") {
  add_calls(command, calls, WithoutServer::kRefused, timeout_about);
}

void look_at_variables(const CLI::App& command, SubmitOptions& options) {
  warn_of_variables(command, options.request_options);
}
// Other commands make no mesh.
void look_at_variables(const CLI::App&, const auto&) {}

// Makes `run` the action of the command, called with its options.
template <class Options>
void bind(CLI::App& command, Result<ExitCode> (*run)(const Options&, std::stop_token),
          const std::shared_ptr<Options>& options, const char* when_interrupted, Chosen& chosen) {
  command.callback([=, &command, &chosen] {
    look_at_variables(command, *options);
    chosen.run = [=](std::stop_token stop) { return run(*options, std::move(stop)); };
    chosen.when_interrupted = when_interrupted;
  });
}

// What a server takes as a request id.
std::string check_request_id(const std::string& id) {
  constexpr std::size_t kLongest = 128;
  const bool printable = std::ranges::all_of(id, [](char c) { return c >= 0x20 && c < 0x7f; });
  if (!id.empty() && id.size() <= kLongest && printable) return "";
  return "is not 1 to 128 bytes of printable ASCII";
}

void add_submit(CLI::App& app, Chosen& chosen) {
  const auto options = std::make_shared<SubmitOptions>();
  CLI::App& command =
      add_command(app, "submit", "Submit a domain to a server as a job, and print the job's id",
                  kSubmitExamples);
  add_domain_and_request_options(command, options->input, options->layers, options->request_options,
                                 chosen);
  add_job_calls(command, options->calls);
  command
      .add_option("--request-id", options->request_id,
                  "Name of the submission: the same name finds the same job. Default: a random one")
      ->envname("WEFT_REQUEST_ID")
      ->check(CLI::Validator(check_request_id, "", ""))
      ->type_name("ID");
  command
      .add_option("--notify", options->notify,
                  "URL that the server tells of the job's end, by a signed POST. Default: the one "
                  "that the server has for you, if any")
      ->envname("WEFT_NOTIFY")
      ->type_name("URL");
  command
      .add_flag("--wait", options->wait,
                "Wait for the job to end; with -o and --draw, write its mesh")
      ->envname("WEFT_WAIT");
  add_output(command, options->output);
  add_json(command, options->json,
           "Print the job as one JSON object, or, if the mesh is written, the mesh");
  add_quiet(command, options->quiet);
  bind(command, run_submit, options,
       "interrupted; a job that was accepted goes on, see `weft list`", chosen);
}

void add_get(CLI::App& app, Chosen& chosen) {
  const auto options = std::make_shared<JobOptions>();
  options->calls.timeout_seconds = kShortTimeout;
  CLI::App& command = add_command(app, "get", "Show the state of a job", kGetExamples);
  command.add_option("ID", options->id, "Job")->required();
  add_job_calls(command, options->calls);
  add_json(command, options->json, "Print the job as one JSON object");
  bind(command, run_get, options, "interrupted", chosen);
}

void add_list(CLI::App& app, Chosen& chosen) {
  static const std::map<std::string, v1::JobState> kStates = {
      {"queued", v1::JOB_STATE_QUEUED},
      {"running", v1::JOB_STATE_RUNNING},
      {"succeeded", v1::JOB_STATE_SUCCEEDED},
      {"failed", v1::JOB_STATE_FAILED},
      {"cancelled", v1::JOB_STATE_CANCELLED}};
  const auto options = std::make_shared<ListOptions>();
  options->calls.timeout_seconds = kShortTimeout;
  CLI::App& command = add_command(app, "list", "List your jobs, the youngest first", kListExamples);
  command
      .add_option(
          "--state", options->states,
          "Only jobs in this state: queued, running, succeeded, failed or cancelled; may be "
          "repeated")
      ->allow_extra_args(false)
      ->transform(CLI::CheckedTransformer(kStates).description(""))
      ->type_name("STATE");
  add_row(
      command,
      {"limit", "WEFT_LIMIT", "Maximum jobs to list", "all", number("N", &ListOptions::limit, 1)},
      *options);
  add_job_calls(command, options->calls);
  add_json(command, options->json, "Print one JSON object, with the jobs in `jobs`");
  bind(command, run_list, options, "interrupted", chosen);
}

void add_watch(CLI::App& app, Chosen& chosen) {
  const auto options = std::make_shared<JobOptions>();
  CLI::App& command = add_command(app, "watch", "Follow a job to its end", kWatchExamples);
  command.add_option("ID", options->id, "Job")->required();
  add_job_calls(command, options->calls);
  add_json(command, options->json, "Print the job as a JSON object, on a line for every change");
  bind(command, run_watch, options, "interrupted; the job goes on", chosen);
}

void add_of_several(CLI::App& app, const char* name, const char* help, const char* examples,
                    Result<ExitCode> (*run)(const JobsOptions&, std::stop_token), Chosen& chosen) {
  const auto options = std::make_shared<JobsOptions>();
  options->calls.timeout_seconds = kShortTimeout;
  CLI::App& command = add_command(app, name, help, examples);
  command.add_option("ID", options->ids, "Jobs")->required();
  add_job_calls(command, options->calls);
  add_json(command, options->json, "Print one JSON object");
  bind(command, run, options, "interrupted", chosen);
}

void add_fetch(CLI::App& app, Chosen& chosen) {
  const auto options = std::make_shared<FetchOptions>();
  CLI::App& command = add_command(app, "fetch", "Write the mesh of a job to files", kFetchExamples);
  command.add_option("ID", options->id, "Job that succeeded")->required();
  add_output(command, options->output);
  command
      .add_option("--domain", options->domain,
                  "Domain that was submitted: the markers of its points are written to .node, and "
                  "the mesh is checked against it")
      ->type_name("INPUT");
  add_layers(command, options->layers);
  command.add_flag("--wait", options->wait, "Wait for the job to end")->envname("WEFT_WAIT");
  add_job_calls(command, options->calls);
  add_json(command, options->json, "Print one JSON object on standard output");
  add_quiet(command, options->quiet);
  bind(command, run_fetch, options, "interrupted, nothing was written", chosen);
}

void add_top(CLI::App& app, Chosen& chosen) {
  const auto options = std::make_shared<TopOptions>();
  options->calls.timeout_seconds = 10;
  CLI::App& command =
      add_command(app, "top", "Show your jobs and the throughput, live", kTopExamples);
  add_job_calls(command, options->calls, "Maximum time of an answer of the server, in seconds");
  add_row(command,
          {"interval", "WEFT_INTERVAL", "Seconds between two updates", "1",
           number("S", &TopOptions::interval_seconds, 0.1, 3600)},
          *options);
  command.add_flag("--once", options->once, "Print one update, and end");
  bind(command, run_top, options, "", chosen);
}

}  // namespace

void add_job_commands(CLI::App& app, Chosen& chosen) {
  add_submit(app, chosen);
  add_get(app, chosen);
  add_list(app, chosen);
  add_watch(app, chosen);
  add_fetch(app, chosen);
  add_of_several(app, "cancel", "Cancel jobs that have not ended", kCancelExamples, run_cancel,
                 chosen);
  add_of_several(app, "delete", "Delete jobs that have ended", kDeleteExamples, run_delete, chosen);
  add_top(app, chosen);
}

}  // namespace weft::client
