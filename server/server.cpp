// SPDX-License-Identifier: Apache-2.0
#include "server/server.h"

#include <fmt/format.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "server/memory_plan.h"
#include "server/mesh/server_info.h"
#include "server/net/connections.h"
#include "server/net/listen.h"
#include "server/run/memory_estimate.h"
#include "server/version.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr const char* kMeshServiceName = "weft.v1.MeshService";
constexpr const char* kJobServiceName = "weft.v1.JobService";

// Calls that were ended still have to send their status.
constexpr seconds kLastWords{1};
// Streams of other services, such as Health.Watch, do not end by themselves.
constexpr milliseconds kOthersGrace{100};

AdmissionOptions admission_options(const ServerOptions& options, MemoryBudget& budget) {
  AdmissionOptions admission = options.admission;
  admission.request_bytes = plan_memory(options).received;
  admission.memory = &budget;
  return admission;
}

// What reflection lists.
std::vector<std::string> services(bool keeps_jobs) {
  std::vector<std::string> names{"grpc.health.v1.Health", "grpc.reflection.v1.ServerReflection",
                                 "grpc.reflection.v1alpha.ServerReflection", kMeshServiceName};
  if (keeps_jobs) names.push_back(kJobServiceName);
  return names;
}

// A sixteenth is reserved for light runs, but at most what all of their slots take.
MemoryBudget::Options budget_options(const ServerOptions& options) {
  const ServiceOptions& service = options.service;
  const std::uint64_t light = max_light_bytes(service.limits);
  const std::uint64_t runs = plan_memory(options).runs;
  MemoryBudget::Options budget{.capacity = runs,
                               .light_reserve = std::min(runs / 16, service.light_jobs * light)};
  if (service.client_share < 1)
    budget.max_per_client =
        static_cast<std::uint64_t>(service.client_share * static_cast<double>(runs));
  return budget;
}

void configure(grpc::ServerBuilder& builder, const ServerOptions& options) {
  const Limits& limits = options.service.limits;
  builder.SetMaxReceiveMessageSize(static_cast<int>(limits.max_request_bytes));
  // Two servers must not share a port unnoticed.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  // The limit on message bytes holds before decompression: 256 MiB of gzip could be 256 GiB.
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_GZIP, false);
  builder.SetCompressionAlgorithmSupportStatus(GRPC_COMPRESS_DEFLATE, false);
  grpc::ResourceQuota quota("weftd");
  quota.SetMaxThreads(16);
  quota.Resize(plan_memory(options).received);
  builder.SetResourceQuota(quota);
}

// A secret that ends with the process.
std::string random_secret() {
  std::array<unsigned char, 16> bytes;
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("OpenSSL has no random bytes");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

ServiceOptions with_info(const ServerOptions& options, bool has_store) {
  ServiceOptions service = options.service;
  service.info = server_info(options, has_store);
  return service;
}

}  // namespace

Server::Server(const ServerOptions& options, std::unique_ptr<TokenFile> tokens, EngineFn engine,
               Logger log, std::unique_ptr<JobStore> store)
    : log_(std::move(log)),
      tokens_(std::move(tokens)),
      console_secret_(random_secret()),
      authenticator_(tokens_.get(), console_secret_),
      metrics_(kVersion, kEngineVersion),
      memory_(budget_options(options), [this] { queue_.memory_released(); }),
      admission_(admission_options(options, memory_), authenticator_, metrics_, log_),
      health_(admission_),
      reflection_(ReflectionService::Version::kV1, admission_, services(store != nullptr)),
      reflection_alpha_(ReflectionService::Version::kV1Alpha, admission_,
                        services(store != nullptr)),
      pool_(static_cast<int>(options.service.threads)),
      queue_({.slots = options.service.jobs,
              .light_slots = options.service.light_jobs,
              .capacity = options.service.queue,
              .max_light_estimate = max_light_bytes(options.service.limits),
              .memory = &memory_,
              .client_share = options.service.client_share}),
      service_(with_info(options, store != nullptr), admission_, metrics_, engine, pool_, queue_,
               log_) {
  metrics_.add_queue("calls", [this] {
    QueueStats stats = service_.stats();
    const double of_jobs = jobs_ ? jobs_->stats().admitted_bytes : 0;
    stats.admitted_bytes = std::max(0.0, static_cast<double>(memory_.reserved()) - of_jobs);
    return stats;
  });
  if (!store) return;
  JobOptions jobs = options.jobs;
  jobs.service.limits = options.service.limits;
  jobs.service.share_across_clients = options.service.share_across_clients;
  jobs.service.patience = options.service.patience;
  jobs.service.client_share = options.service.client_share;
  jobs.runner.worker = options.service.instance;
  jobs_.emplace(std::move(store), std::move(jobs), admission_, metrics_, engine, pool_, memory_,
                queue_, log_);
  metrics_.add_queue("jobs", [this] { return jobs_->stats(); });
}

tl::expected<std::unique_ptr<Server>, std::string> Server::start(const ServerOptions& options,
                                                                 EngineFn engine, Logger log,
                                                                 std::unique_ptr<JobStore> store) {
  for (const std::string& address : options.listen)
    if (const auto claimed = claim(address); !claimed)
      return tl::unexpected(fmt::format("cannot listen on {}: {}", address, claimed.error()));

  auto credentials = credentials_for(options.listen, options.tls, options.insecure);
  if (!credentials) return tl::unexpected(credentials.error());
  if (!options.metrics.empty() && !options.insecure && !is_local(options.metrics))
    return tl::unexpected(fmt::format(
        "{} would show the metrics to other machines, unencrypted and to everyone: "
        "give --metrics an address of this machine alone, or --insecure to do it anyway",
        options.metrics));
  std::unique_ptr<TokenFile> tokens;
  if (!options.tokens.empty()) {
    auto opened = TokenFile::open(options.tokens, log);
    if (!opened) return tl::unexpected(opened.error());
    tokens = std::move(*opened);
  }

  std::unique_ptr<Server> server(
      new Server(options, std::move(tokens), std::move(engine), std::move(log), std::move(store)));
  grpc::ServerBuilder builder;
  configure(builder, options);
  limit_connections(builder);
  std::vector<int> ports(options.listen.size());
  for (std::size_t i = 0; i < ports.size(); ++i)
    builder.AddListeningPort(options.listen[i], (*credentials)[i], &ports[i]);
  builder.RegisterService(&server->health_);
  builder.RegisterService(&server->reflection_);
  builder.RegisterService(&server->reflection_alpha_);
  builder.RegisterService(&server->service_);
  JobService* const job_service = server->job_service();
  if (job_service != nullptr) builder.RegisterService(job_service);
  server->server_ = builder.BuildAndStart();
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (ports[i] == 0) return tl::unexpected(fmt::format("cannot listen on {}", options.listen[i]));
    server->addresses_.push_back(bound_address(options.listen[i], ports[i]));
  }
  server->health_.set("", true);
  server->health_.set(kMeshServiceName, true);
  if (job_service != nullptr) server->health_.set(kJobServiceName, true);
  server->serving_ = true;
  if (!options.metrics.empty()) {
    auto endpoint = MetricsEndpoint::start(
        options.metrics, {.metrics = [self = server.get()] { return self->metrics_.text(); },
                          .healthy = [self = server.get()] { return self->serving_.load(); }});
    if (!endpoint) return tl::unexpected(endpoint.error());
    server->endpoint_ = std::move(*endpoint);
    server->log_->info("event=showing_metrics address={}", log_value(server->metrics_address()));
  }
  if (auto failed = server->start_console(options)) return tl::unexpected(std::move(*failed));
  for (const std::string& address : server->addresses_)
    server->log_->info("event=listening security={} tokens={} address={}",
                       security_of(address, options.tls), server->tokens_ ? "yes" : "no",
                       log_value(address));
  return server;
}

std::optional<std::string> Server::start_console(const ServerOptions& options) {
  if (options.console.address.empty()) return std::nullopt;
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);  // messages come from this server itself
  auto console = Console::start(options.console,
                                {.channel = server_->InProcessChannel(arguments),
                                 .authenticator = authenticator_,
                                 .secret = console_secret_,
                                 .metrics = [this] { return metrics_.text(); },
                                 .tls = options.tls,
                                 .insecure = options.insecure,
                                 .most_request_bytes = options.service.limits.max_request_bytes,
                                 .request_bytes = plan_memory(options).received,
                                 .stall_timeout = std::chrono::duration_cast<milliseconds>(
                                     options.service.patience.stall_timeout),
                                 .log = log_});
  if (!console) return console.error();
  console_ = std::move(*console);
  log_->info("event=serving_console security={} tokens={} application={} address={}",
             security_of(console_->address(), options.tls), tokens_ ? "yes" : "no",
             options.console.assets.empty() ? "no" : "yes", log_value(console_->address()));
  return std::nullopt;
}

void Server::drain(std::chrono::steady_clock::duration at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  health_.set_all(false);
  serving_ = false;
  service_.gate().close();
  if (jobs_) jobs_->close();
  const auto empty_by = [&](std::chrono::steady_clock::time_point when) {
    const auto left = [&] { return when - std::chrono::steady_clock::now(); };
    return service_.gate().wait_empty(left()) &&
           (job_service() == nullptr || job_service()->gate().wait_empty(left()));
  };
  if (!empty_by(end)) {
    service_.stop_all();
    if (job_service() != nullptr) job_service()->stop_all();
    empty_by(std::chrono::steady_clock::now() + kLastWords);
  }
  if (console_ != nullptr) console_->stop(std::chrono::steady_clock::now() + kOthersGrace);
  server_->Shutdown(std::chrono::system_clock::now() + kOthersGrace);
  server_->Wait();
  console_.reset();
  server_.reset();
  remove_socket_files();
}

JobService* Server::job_service() {
  return jobs_ ? jobs_->service() : nullptr;
}

void Server::remove_socket_files() {
  for (const std::string& address : addresses_) release(address);
}

Server::~Server() {
  if (server_ != nullptr) drain(seconds(0));
  if (jobs_) jobs_->close();
  queue_.stop();  // its runs use all that is destroyed now
}

}  // namespace weft::server
