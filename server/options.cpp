// SPDX-License-Identifier: Apache-2.0
#include "server/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>

#include "server/callbacks/address_rules.h"
#include "server/console/request_rules.h"
#include "server/net/listen.h"
#include "server/version.h"

namespace weft::server {
namespace {

constexpr char kFooter[] = R"(SIZE is a number of bytes, or one with a unit: 256MiB, 2GiB.
Every flag is also read from the environment: --max-points is WEFT_MAX_POINTS.

Exit codes:
  0        drained after SIGTERM or SIGINT; with --health, the server serves
  1        failed; with --health, the server does not serve
  2        the command line is wrong
  3        cannot listen
  4        cannot open the store
  5        an address no longer answers
  128 + n  a second signal n cut the draining short)";

// Flags that have no effect if no jobs are kept.
constexpr const char* kOfTheStore[] = {"--role",        "--max-queued",   "--max-queued-per-client",
                                       "--lease",       "--max-attempts", "--keep",
                                       "--keep-bytes",  "--keep-jobs",    "--notify-secrets",
                                       "--notify-allow"};

std::string environment_name(std::string flag) {
  std::string name = "WEFT_" + flag.substr(2);
  for (char& c : name)
    c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

// --max-points of max_points.
std::string flag_name(std::string_view field) {
  std::string name = "--" + std::string(field);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

// A size as --help shows it: 256MiB.
std::string size_text(std::uint64_t bytes) {
  constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  while (bytes != 0 && bytes % 1024 == 0 && unit + 1 < std::size(kUnits)) {
    bytes /= 1024;
    ++unit;
  }
  return std::to_string(bytes) + (unit == 0 ? "" : kUnits[unit]);
}

// A check that adds nothing to the help, because the type's name and the text say it there.
CLI::Validator silent(CLI::Validator validator) {
  return validator.description("");
}

// CLI::Range lets NaN pass.
CLI::Validator is_a_number() {
  return CLI::Validator(
      [](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && !std::isnan(value);
        return good ? std::string() : text + " is not a number";
      },
      "");
}

CLI::Validator is_postgres_uri() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool good = text.starts_with("postgres://") || text.starts_with("postgresql://");
        return good ? std::string() : text + " does not begin with postgres://";
      },
      "");
}

CLI::Validator is_a_network() {
  return CLI::Validator(
      [](const std::string& text) {
        return Network::parse(text) ? std::string() : text + " is no network such as 10.0.0.0/8";
      },
      "");
}

CLI::Validator is_an_origin() {
  return CLI::Validator(
      [](const std::string& text) {
        return is_origin(text) ? std::string()
                               : text + " is not an origin, such as https://example.org";
      },
      "");
}

// Adds flags that all have an environment variable, in groups of the help.
class Flags {
 public:
  explicit Flags(CLI::App& app) : app_(app) {}

  void begin_group(const std::string& name) { group_ = name; }

  template <class T>
  CLI::Option* value(const std::string& flag, T& target, const std::string& type,
                     const std::string& help) {
    return app_.add_option(flag, target, help)
        ->envname(environment_name(flag))
        ->capture_default_str()
        ->type_name(type)
        ->group(group_);
  }
  CLI::Option* flag(const std::string& flags, bool& target, const std::string& help) {
    return app_.add_flag(flags, target, help)
        ->envname(environment_name(flags.substr(0, flags.find(','))))
        ->group(group_);
  }
  void count(const std::string& flag, std::uint64_t& target, const std::string& help) {
    value(flag, target, "N", help)->check(silent(CLI::PositiveNumber));
  }
  // `unless` says what the default is if it depends on the machine.
  CLI::Option* bytes(const std::string& flag, std::uint64_t& target, const std::string& help,
                     const std::string& unless = "") {
    CLI::Option* option =
        value(flag, target, "SIZE", help + (unless.empty() ? "" : ". Default: " + unless));
    return option->default_str(unless.empty() ? size_text(target) : "")
        ->transform(silent(CLI::AsSizeValue(false)))
        ->check(silent(CLI::PositiveNumber));
  }
  void seconds(const std::string& flag, double& target, const std::string& help) {
    value(flag, target, "SECONDS", help + ". Range: 0 to 1e9")
        ->check(silent(CLI::Range(0.0, 1e9)))
        ->check(is_a_number());
  }

 private:
  CLI::App& app_;
  std::string group_;
};

std::chrono::steady_clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

// One client may fill three places of four.
constexpr double kDefaultClientShare = 0.75;

// What the flags have in another form than Options.
struct Given {
  std::uint32_t jobs = 0;  // 0: chosen from the number of threads
  double stall_timeout = 60;
  double request_timeout = 120;
  double lease = 30;
  double keep = 7 * 24 * 3600.0;
  double drain = 30;
  std::vector<std::string> roles{"api", "worker"};
  std::vector<std::string> notify_allow{};
  std::string log_format = "text";
  CLI::Option* share_across_clients = nullptr;
  CLI::Option* client_share = nullptr;
  CLI::Option* max_bytes = nullptr;
  CLI::Option* cache_bytes = nullptr;
};

// A connection has three descriptors: the client's, and both ends of the pair to gRPC. The store,
// the console and files keep some in reserve.
std::uint64_t connections_for(std::uint64_t descriptors) {
  constexpr std::uint64_t kReserve = 768;
  constexpr std::uint64_t kMaxByDefault = 4096;
  return std::clamp<std::uint64_t>((descriptors - std::min(descriptors / 2, kReserve)) / 3, 1,
                                   kMaxByDefault);
}

// Defaults, some of which depend on the machine.
Options defaults(const Machine& machine) {
  Options options;
  ServiceOptions& service = options.server.service;
  options.server.listen = {"127.0.0.1:7421"};
  service.threads = machine.threads;
  options.server.jobs.runner.keep.bytes = std::uint64_t{16} << 30;
  options.server.jobs.runner.keep.jobs_of_owner = 10'000;
  if (machine.memory != 0) options.server.memory = machine.memory / 4 * 3;
  options.server.max_connections = connections_for(machine.descriptors);
  return options;
}

void add_listening(Flags& flags, Options& options) {
  ServerOptions& server = options.server;
  flags.begin_group("Listening");
  flags
      .value("--listen", server.listen, "ADDRESS",
             "Address to listen on: HOST:PORT, with port 0 for any free one, or unix:PATH. May be "
             "repeated, or separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false);
  CLI::Option* tls_cert =
      flags.value("--tls-cert", server.tls.certificate, "FILE",
                  "Encrypt TCP addresses with this certificate, followed by those up to its CA "
                  "(PEM)");
  CLI::Option* tls_key = flags.value("--tls-key", server.tls.key, "FILE",
                                     "Private key of the certificate in --tls-cert (PEM)");
  tls_cert->needs(tls_key);
  tls_key->needs(tls_cert);
  flags
      .value("--tls-client-ca", server.tls.client_ca, "FILE",
             "Require client certificates signed by one of these CAs (PEM)")
      ->needs(tls_cert);
  flags.value("--tokens", server.tokens, "FILE",
              "Require a bearer token listed in this file, one NAME TOKEN per line");
  flags.flag("--insecure", server.insecure,
             "Allow unencrypted addresses that other machines can reach");
  flags.value("--metrics", server.metrics, "HOST:PORT",
              "Serve /metrics for Prometheus and /healthz at this address, over HTTP, without "
              "identification. Requires --insecure if other machines can reach it");
  flags.value("--console", server.console.address, "HOST:PORT",
              "Serve the console for browsers at this address, over HTTP, and gRPC-Web. Encrypted "
              "with --tls-cert; otherwise requires --insecure if other machines can reach it");
  flags.value("--http", server.console.http, "HOST:PORT",
              "Serve meshes over HTTP at this address: the file of a domain in, that of its mesh "
              "out. May be the address of --console. Encrypted with --tls-cert; otherwise requires "
              "--insecure if other machines can reach it");
  flags
      .value("--console-origin", server.console.origins, "ORIGIN",
             "Origin of pages that may call by gRPC-Web, such as https://example.org; its host is "
             "also "
             "accepted as a name of the console. May be repeated, or separated by commas")
      ->default_str("")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(is_an_origin());
  flags.value("--port-file", options.port_file, "FILE",
              "Write the bound addresses to this file, - for the standard output, once the server "
              "listens: one per line, that of --metrics as "
              "metrics=HOST:PORT, that of --console as console=HOST:PORT, and that of --http as "
              "http=HOST:PORT");
}

void add_work(Flags& flags, Options& options, Given& given) {
  ServiceOptions& service = options.server.service;
  flags.begin_group("Work");
  flags
      .value("--threads", service.threads, "N",
             "Compute threads. Range: 1 to 4096. Default: the processors that the process may use")
      ->check(silent(CLI::Range(1u, 4096u)));
  flags
      .value("--jobs", given.jobs, "N",
             "Runs of the engine at the same time, which share the threads. Range: 1 to 4096. "
             "Default: the number of threads, at least 4")
      ->check(silent(CLI::Range(1u, 4096u)))
      ->default_str("");
  flags
      .value("--queue", service.queue, "N",
             "Calls and jobs that may wait for a run; more are refused. Range: 0 to 1000000")
      ->check(silent(CLI::Range(0u, 1'000'000u)));
  flags.bytes("--memory", options.server.memory,
              "Memory of the whole process: messages, finished meshes, and all runs",
              "three quarters of the machine's");
  given.client_share =
      flags
          .value(
              "--client-share", service.client_share, "PART",
              "Share of the queue, the runs, the memory and --keep-bytes that one client may "
              "take. Range: above 0 to 1. Default: 0.75 if clients are identified, by --tokens or "
              "--tls-client-ca, or an address can be reached from other machines; otherwise 1")
          ->check(silent(CLI::Range(1e-6, 1.0)))
          ->check(is_a_number())
          ->default_str("");
  given.cache_bytes =
      flags
          .value("--cache-bytes", service.cache_bytes, "SIZE",
                 "Memory for a cache of finished meshes; 0: no cache. Default: 64MiB, or 1/32 of "
                 "--memory if that is less")
          ->default_str("")
          ->transform(silent(CLI::AsSizeValue(false)))
          ->check(silent(CLI::NonNegativeNumber));
  given.share_across_clients = flags.flag(
      "--share-across-clients,!--no-share-across-clients", service.share_across_clients,
      "Answer a client with meshes that another client asked for. Default: only if clients are not "
      "identified, by --tokens or --tls-client-ca");
}

void add_store(Flags& flags, Options& options, Given& given) {
  JobOptions& jobs = options.server.jobs;
  flags.begin_group("Jobs that are kept");
  flags.value("--data", options.data, "DIR", "Keep jobs and their meshes in this folder");
  flags
      .value("--store", options.store, "URI",
             "Keep jobs and their meshes in this PostgreSQL database, postgres://...")
      ->check(is_postgres_uri())
      ->excludes("--data");
  flags
      .value("--role", given.roles, "api|worker",
             "What this server does with jobs: api accepts and shows them, worker runs them. May "
             "be separated by commas")
      ->delimiter(',')
      ->check(silent(CLI::IsMember({"api", "worker"})));
  flags.count("--max-queued", jobs.service.max_queued, "Maximum jobs that wait in the store");
  flags.count("--max-queued-per-client", jobs.service.max_open_of_client,
              "Maximum jobs per client that have not ended");
  flags
      .value("--max-attempts", jobs.retry.max_attempts, "N",
             "Maximum attempts at a job whose workers are lost. Range: 1 to 100")
      ->check(silent(CLI::Range(1u, 100u)));
  flags.seconds("--lease", given.lease,
                "Time without a renewal after which a worker is considered lost");
  flags.seconds("--keep", given.keep,
                "Time to keep jobs that ended, and meshes that nobody asks for");
  flags.bytes("--keep-bytes", jobs.runner.keep.bytes,
              "Maximum size of all stored meshes; the least recently used are deleted first");
  flags.count("--keep-jobs", jobs.runner.keep.jobs_of_owner,
              "Maximum ended jobs that are kept per client; the oldest are deleted first");
  CLI::Option* secrets = flags.value(
      "--notify-secrets", options.server.callbacks.clients, "FILE",
      "Send callbacks, which tell a URL of the end of a job. This file has a line NAME SECRET, or "
      "NAME SECRET URL, for each client whose jobs may have one; * is all others");
  flags
      .value("--notify-allow", given.notify_allow, "CIDR",
             "Network, such as 10.0.0.0/8, that callbacks may go to although it is not of the "
             "public internet. May be repeated, or separated by commas")
      ->default_str("")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(is_a_network())
      ->needs(secrets);
}

void add_limits(Flags& flags, Options& options, Given& given) {
  Limits& limits = options.server.service.limits;
  flags.begin_group("Limits of a request");
  for (const CountLimit& row : kCountLimits)
    flags.count(flag_name(row.name), limits.*row.limit, std::string(row.about));
  flags.value("--max-triangles", limits.max_triangles, "N", "Maximum triangles per mesh")
      ->check(CLI::Range(std::uint64_t{1}, kMaxTriangles).description(""));
  given.max_bytes = flags.bytes(
      "--max-bytes", limits.max_bytes,
      "Maximum memory of the engine per run; --jobs runs of that size must fit into what --memory "
      "leaves for runs",
      "what --memory leaves for runs, divided by --jobs");
  flags.seconds("--max-seconds", limits.max_seconds, "Maximum time of work per run");
  flags.bytes("--max-request-bytes", limits.max_request_bytes, "Maximum size of a request message")
      ->check(silent(CLI::Range(1.0, double{std::numeric_limits<int>::max()})));  // gRPC's range
  flags.seconds("--request-timeout", given.request_timeout,
                "Maximum time for a request message to arrive");
  flags
      .value(
          "--max-connections", options.server.max_connections, "N",
          "Connections over TCP that may be open at the same time; one client has at most "
          "--client-share of them. Each takes three descriptors. Default: what ulimit -n allows, "
          "at most 4096")
      ->check(silent(CLI::PositiveNumber))
      ->default_str("");
  flags.value("--max-resets", options.server.max_resets, "N",
              "Maximum calls that a connection may reset in a second before it is closed; 0: no "
              "limit");
}

void add_readers(Flags& flags, Options& options, Given& given) {
  flags.begin_group("Readers of meshes");
  flags.bytes("--stream-buffer", options.server.service.limits.stream_buffer,
              "Maximum bytes of a mesh that wait for its reader; at this limit refinement pauses, "
              "and another run takes its place");
  flags.seconds("--stall-timeout", given.stall_timeout,
                "Time after which a client that reads nothing is cut off");
  flags.value("--min-rate", options.server.service.patience.least_rate, "BYTES",
              "Minimum rate in bytes per second at which a client must read what waits for it, on "
              "average over --stall-timeout; 0: none");
}

void add_process(Flags& flags, Options& options, Given& given) {
  flags.begin_group("Process");
  flags.seconds("--drain", given.drain, "Time for open calls to finish after SIGTERM");
  flags
      .value("--log-level", options.log_level, "LEVEL",
             "Lowest level of messages that are logged to standard error: trace, debug, info, "
             "warning, error, critical or off")
      ->check(
          silent(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"})));
  flags.value("--log-format", given.log_format, "text|json", "Format of the log")
      ->check(silent(CLI::IsMember({"text", "json"})));
  flags.flag("--exit-with-stdin", options.exit_with_stdin,
             "Drain at the end of standard input, as SIGTERM does");
}

// The socket of the server that --health asks. Throws CLI::ValidationError.
std::string first_socket(const std::vector<std::string>& listen) {
  const auto socket = std::find_if(listen.begin(), listen.end(), is_unix);
  if (socket == listen.end())
    throw CLI::ValidationError("--health", "there is no unix: address in --listen");
  return *socket;
}

// All runs that are at work at the same time can take what one may. Defaults are lowered for that;
// values that were given are not. Throws CLI::ValidationError.
void settle_memory(const Given& given, Options& options) {
  ServiceOptions& service = options.server.service;
  std::uint64_t& max_bytes = service.limits.max_bytes;
  const std::uint64_t memory = options.server.memory;
  if (given.cache_bytes->count() == 0)
    service.cache_bytes = std::min(std::uint64_t{64} << 20, memory / 32);
  const MemoryPlan plan = plan_memory(options.server);
  if (plan.runs < kMinBytesOfRuns)
    throw CLI::ValidationError(
        "--memory", fmt::format("{} bytes leave {} for runs, beside {} for messages, {} for "
                                "--cache-bytes and {} for the process; runs need at least {}",
                                memory, plan.runs, plan.received, service.cache_bytes,
                                kBytesOfProcess + plan.kept, kMinBytesOfRuns));
  // At least so many, so that a small request need not wait for the end of one huge run.
  constexpr std::uint32_t kMinRuns = 4;
  service.jobs = given.jobs != 0 ? given.jobs : std::max(service.threads, kMinRuns);
  if (given.max_bytes->count() == 0) {
    max_bytes = plan.runs / service.jobs;
  } else if (given.jobs == 0) {
    service.jobs = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(plan.runs / max_bytes, 1, service.jobs));
  }
  if (max_bytes <= plan.runs / service.jobs) return;
  throw CLI::ValidationError(
      "--max-bytes",
      fmt::format("{} bytes for each of {} runs (--jobs) are more than the {} that --memory, which "
                  "is {} bytes, leaves for runs",
                  max_bytes, service.jobs, plan.runs, memory));
}

void settle(const Given& given, Options& options) {
  ServiceOptions& service = options.server.service;
  JobOptions& jobs = options.server.jobs;
  const auto has_role = [&](const char* role) {
    return std::find(given.roles.begin(), given.roles.end(), role) != given.roles.end();
  };
  service.light_jobs = 2;
  service.patience.stall_timeout = to_duration(given.stall_timeout);
  options.server.admission.request_timeout = to_duration(given.request_timeout);
  const bool identified = !options.server.tokens.empty() || !options.server.tls.client_ca.empty();
  const ConsoleOptions& console = options.server.console;
  const bool local =
      std::all_of(options.server.listen.begin(), options.server.listen.end(), is_local) &&
      (console.address.empty() || is_local(console.address)) &&
      (console.http.empty() || is_local(console.http));
  if (given.share_across_clients->count() == 0) service.share_across_clients = !identified;
  if (given.client_share->count() == 0)
    service.client_share = identified || !local ? kDefaultClientShare : 1;
  jobs.runner.keep.share_of_owner = service.client_share;
  for (const std::string& cidr : given.notify_allow)
    options.server.callbacks.allowed.push_back(Network::parse(cidr).value());
  jobs.serves = has_role("api");
  jobs.works = has_role("worker");
  jobs.runner.lease =
      std::chrono::milliseconds(std::max<std::int64_t>(1, std::llround(given.lease * 1000)));
  jobs.runner.renewal = std::min(jobs.runner.renewal, jobs.runner.lease / 3);
  jobs.runner.keep.age = std::chrono::seconds(std::llround(given.keep));
  options.log_format = given.log_format == "json" ? LogFormat::kJson : LogFormat::kText;
  options.drain = std::chrono::duration<double>(given.drain);
}

}  // namespace

std::variant<Options, Exit> parse_options(int argc, const char* const* argv,
                                          const Machine& machine) {
  Options options = defaults(machine);
  Given given;
  CLI::App app("weftd: graded, guaranteed-quality Delaunay meshes over gRPC", "weftd");
  app.set_version_flag("--version", "weftd " + std::string(kVersion));
  // No environment variable: with it set, no server would start.
  bool health = false;
  app.add_flag("--health", health,
               "Ask the server at the first unix: address in --listen whether it serves, and exit");
  Flags flags(app);
  add_listening(flags, options);
  add_work(flags, options, given);
  add_store(flags, options, given);
  add_limits(flags, options, given);
  add_readers(flags, options, given);
  add_process(flags, options, given);
  app.footer(kFooter);
  try {
    app.parse(argc, argv);
    if (options.data.empty() && options.store.empty())
      for (const char* name : kOfTheStore)
        if (app.count(name) != 0) throw CLI::RequiresError(name, "--data or --store");
    settle_memory(given, options);
    if (health) options.ask_health_at = first_socket(options.server.listen);
  } catch (const CLI::ParseError& error) {
    return Exit{app.exit(error) == 0 ? 0 : kExitUsage};
  }
  settle(given, options);
  return options;
}

}  // namespace weft::server
