// SPDX-License-Identifier: Apache-2.0
#include "server/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "server/version.h"

namespace weft::server {
namespace {

// Flags that say nothing where no jobs are kept.
constexpr const char* kOfTheStore[] = {"--role",      "--max-queued",   "--max-queued-per-client",
                                       "--lease",     "--max-attempts", "--keep",
                                       "--keep-bytes"};

std::string environment_name(std::string flag) {
  std::string name = "WEFT_" + flag.substr(2);
  for (char& c : name)
    c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
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

// Adds flags that all have an environment variable.
class Flags {
 public:
  explicit Flags(CLI::App& app) : app_(app) {}

  template <class T>
  CLI::Option* value(const std::string& flag, T& target, const std::string& help) {
    return app_.add_option(flag, target, help)
        ->envname(environment_name(flag))
        ->capture_default_str();
  }
  void count(const std::string& flag, std::uint64_t& target, const std::string& help) {
    value(flag, target, help)->check(CLI::PositiveNumber);
  }
  CLI::Option* bytes(const std::string& flag, std::uint64_t& target, const std::string& help) {
    return value(flag, target, help + ", such as 256MiB")
        ->transform(CLI::AsSizeValue(false))
        ->check(CLI::PositiveNumber);
  }
  void seconds(const std::string& flag, double& target, const std::string& help) {
    value(flag, target, help + ", in seconds")->check(CLI::Range(0.0, 1e9))->check(is_a_number());
  }

 private:
  CLI::App& app_;
};

std::chrono::steady_clock::duration to_duration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

std::variant<Options, Exit> parse_options(int argc, const char* const* argv,
                                          const Machine& machine) {
  Options options;
  ServiceOptions& service = options.server.service;
  Limits& limits = service.limits;
  options.server.listen = {"127.0.0.1:7421"};
  service.cache_bytes = std::uint64_t{64} << 20;
  service.threads = machine.threads;
  if (machine.memory != 0) limits.max_bytes = machine.memory / 2;
  std::uint32_t jobs = 0;
  double drain = 30;
  double stall_timeout = 60;
  options.server.memory = machine.memory != 0 ? machine.memory / 4 * 3 : options.server.memory;
  std::vector<std::string> roles{"api", "worker"};
  JobOptions& kept = options.server.jobs;
  double lease = 30;
  double keep = 7 * 24 * 3600.0;
  kept.runner.keep.bytes = std::uint64_t{16} << 30;
  std::string log_format = "text";

  CLI::App app("weftd: graded, guaranteed-quality Delaunay meshes over gRPC", "weftd");
  app.set_version_flag("--version", "weftd " + std::string(kVersion));
  Flags flags(app);
  flags
      .value("--listen", options.server.listen,
             "HOST:PORT (0: any free port) or unix:PATH; may be repeated, or separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false);
  CLI::Option* tls_cert =
      flags.value("--tls-cert", options.server.tls.certificate,
                  "Encrypt TCP addresses; own certificate and those up to its CA, PEM");
  CLI::Option* tls_key =
      flags.value("--tls-key", options.server.tls.key, "Private key of --tls-cert, PEM");
  tls_cert->needs(tls_key);
  tls_key->needs(tls_cert);
  flags
      .value("--tls-client-ca", options.server.tls.client_ca,
             "Want of clients a certificate of one of these CAs, PEM")
      ->needs(tls_cert);
  flags.value("--tokens", options.server.tokens,
              "Want of callers a bearer token of this file, lines of NAME TOKEN");
  app.add_flag("--insecure", options.server.insecure,
               "Listen unencrypted where other machines can connect")
      ->envname(environment_name("--insecure"));
  flags.value("--port-file", options.port_file,
              "File for the bound addresses, one a line; that of --metrics as metrics=HOST:PORT");
  flags.value("--metrics", options.server.metrics,
              "HOST:PORT for /metrics of Prometheus and /healthz, over HTTP and to everyone");
  flags
      .value("--threads", service.threads, "Threads that compute; default: what the machine grants")
      ->check(CLI::Range(1u, 4096u));
  flags
      .value("--jobs", jobs,
             "Jobs that run at once and share the threads; default: as many as threads, at least 4")
      ->check(CLI::Range(1u, 4096u))
      ->default_str("");
  flags.value("--queue", service.queue, "Jobs that wait; more are refused")
      ->check(CLI::Range(0u, 1'000'000u));
  flags.bytes("--memory", options.server.memory,
              "Memory promised to jobs at the same time; default: three quarters of the memory");
  flags.value("--data", options.data, "Folder that keeps jobs and their meshes")->type_name("DIR");
  flags
      .value("--store", options.store,
             "PostgreSQL server that keeps jobs and their meshes, as postgres://...")
      ->check(is_postgres_uri())
      ->excludes("--data");
  flags
      .value("--role", roles,
             "With a store: api takes and shows jobs, worker does them; separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember({"api", "worker"}));
  flags.count("--max-queued", kept.service.max_queued, "Meshes that wait in the store");
  flags.count("--max-queued-per-client", kept.service.max_queued_of_owner,
              "Meshes of one client that wait in the store");
  flags
      .value("--max-attempts", kept.retry.max_attempts, "Attempts at a job whose workers are lost")
      ->check(CLI::Range(1u, 100u));
  flags.seconds("--lease", lease, "Silence after which a worker counts as lost");
  flags.seconds("--keep", keep, "How long ended jobs and meshes that nobody asks for are kept");
  flags.bytes("--keep-bytes", kept.runner.keep.bytes, "Meshes that are kept");
  flags
      .value("--cache-bytes", service.cache_bytes,
             "Meshes of calls kept in memory for the same request, such as 64MiB; 0: none")
      ->transform(CLI::AsSizeValue(false))
      ->check(CLI::NonNegativeNumber);
  flags.count("--max-points", limits.max_points, "Points a request");
  flags.count("--max-segments", limits.max_segments, "Segments a request");
  flags.count("--max-seeds", limits.max_seeds, "Hole and region seeds a request");
  flags.count("--max-raster-values", limits.max_raster_values, "Values of a size raster");
  flags.count("--max-triangles", limits.max_triangles, "Triangles a mesh");
  flags.bytes("--max-bytes", limits.max_bytes, "Engine memory a job; default: half of the memory");
  flags.bytes("--max-request-bytes", limits.max_request_bytes, "Request message")
      ->check(CLI::Range(1.0, double{std::numeric_limits<int>::max()}));  // gRPC's own range
  flags.seconds("--max-seconds", limits.max_seconds, "Work a job");
  flags.seconds("--stall-timeout", stall_timeout, "Patience with a client that reads nothing");
  flags.seconds("--drain", drain, "After SIGTERM, time for open calls to finish");
  flags.value("--log-level", options.log_level, "Least level of the log, on stderr")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"}));
  flags.value("--log-format", log_format, "Form of its lines")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_flag("--exit-with-stdin", options.exit_with_stdin,
               "Drain at the end of standard input, too")
      ->envname(environment_name("--exit-with-stdin"));
  app.footer("Every flag is also read from the environment: --max-points is WEFT_MAX_POINTS.");

  try {
    app.parse(argc, argv);
    if (options.data.empty() && options.store.empty())
      for (const char* name : kOfTheStore)
        if (app.count(name) != 0) throw CLI::RequiresError(name, "--data or --store");
  } catch (const CLI::ParseError& error) {
    return Exit{app.exit(error) == 0 ? 0 : kExitUsage};
  }
  // A small job must not wait for one huge job to end.
  constexpr std::uint32_t kFewestJobs = 4;
  service.jobs = jobs != 0 ? jobs : std::max(service.threads, kFewestJobs);
  service.light_jobs = 2;
  service.stall_timeout = to_duration(stall_timeout);
  kept.serves = std::find(roles.begin(), roles.end(), "api") != roles.end();
  kept.works = std::find(roles.begin(), roles.end(), "worker") != roles.end();
  kept.runner.lease =
      std::chrono::milliseconds(std::max<std::int64_t>(1, std::llround(lease * 1000)));
  kept.runner.renewal = std::min(kept.runner.renewal, kept.runner.lease / 3);
  kept.runner.keep.age = std::chrono::seconds(std::llround(keep));
  options.log_format = log_format == "json" ? LogFormat::kJson : LogFormat::kText;
  options.drain = std::chrono::duration<double>(drain);
  return options;
}

}  // namespace weft::server
