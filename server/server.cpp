// SPDX-License-Identifier: Apache-2.0
#include "server/server.h"

#include <fmt/format.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server_builder.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "server/http/routes.h"
#include "server/net/connections.h"
#include "server/net/listen.h"
#include "server/run/memory_estimate.h"
#include "server/server_info.h"
#include "server/server_options.h"
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

AdmissionOptions admission_options(const ServerOptions& options, MemoryBudget& budget,
                                   ConnectionTable& connections) {
  AdmissionOptions admission = options.admission;
  admission.request_bytes = plan_memory(options).received;
  admission.memory = &budget;
  admission.connections = &connections;
  return admission;
}

// What reflection lists.
std::vector<std::string> services(bool keeps_jobs) {
  std::vector<std::string> names{"grpc.health.v1.Health", "grpc.reflection.v1.ServerReflection",
                                 kMeshServiceName};
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

// gRPC keeps up to 70 KB for each stream that is open or was just reset: a part of --memory.
constexpr std::uint64_t kMemoryPerStream = std::uint64_t{512} << 10;
constexpr std::uint64_t kMinLoad = 512;
constexpr std::uint64_t kMaxLoad = 16'384;

ConnectionTable::Bounds connection_bounds(const ServerOptions& options) {
  return {.connections = options.max_connections,
          .per_host = connections_of_host(options.max_connections, options.service.client_share),
          .load = std::clamp(options.memory / kMemoryPerStream, kMinLoad, kMaxLoad)};
}

ServiceOptions with_info(const ServerOptions& options, bool has_store) {
  ServiceOptions service = options.service;
  service.info = server_info(options, has_store);
  return service;
}

}  // namespace

Server::Server(const ServerOptions& options, std::unique_ptr<TokenFile> tokens,
               std::unique_ptr<Callbacks> callbacks, EngineFn engine, Logger log,
               std::unique_ptr<JobStore> store)
    : log_(std::move(log)),
      tokens_(std::move(tokens)),
      callbacks_(std::move(callbacks)),
      console_secret_(random_secret()),
      connections_(connection_bounds(options), console_secret_),
      authenticator_(tokens_.get(), console_secret_, &connections_),
      metrics_(kVersion, kEngineVersion),
      memory_(budget_options(options), [this] { queue_.memory_released(); }),
      admission_(admission_options(options, memory_, connections_), authenticator_, metrics_, log_),
      health_(admission_),
      reflection_(admission_, services(store != nullptr)),
      pool_(static_cast<int>(options.service.threads)),
      queue_({.slots = options.service.jobs,
              .light_slots = options.service.light_jobs,
              .capacity = options.service.queue,
              .max_light_estimate = max_light_bytes(options.service.limits),
              .memory = &memory_,
              .client_share = options.service.client_share}),
      service_(with_info(options, store != nullptr), admission_, metrics_, engine, pool_, queue_,
               log_) {
  metrics_.set_connections([this] { return static_cast<double>(connections_.size()); });
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
  jobs.service.callbacks = callbacks_.get();
  if (options.service.client_share == 1) jobs.callbacks.of_client = jobs.callbacks.at_once;
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

  if (const auto good = check_encryption(options.listen, options.tls, options.insecure); !good)
    return tl::unexpected(good.error());
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
  std::unique_ptr<Callbacks> callbacks;
  if (!options.callbacks.clients.empty()) {
    auto opened = Callbacks::open(options.callbacks, log);
    if (!opened) return tl::unexpected(opened.error());
    callbacks = std::move(*opened);
  }

  std::unique_ptr<Server> server(new Server(options, std::move(tokens), std::move(callbacks),
                                            std::move(engine), std::move(log), std::move(store)));
  if (auto failed = server->listen(options)) return tl::unexpected(std::move(*failed));
  server->health_.set("", true);
  server->health_.set(kMeshServiceName, true);
  if (server->job_service() != nullptr) server->health_.set(kJobServiceName, true);
  server->serving_ = true;
  server->probe_ =
      std::make_unique<Probe>(ProbeOptions{.addresses = server->addresses_,
                                           .encrypted = !options.tls.certificate.empty(),
                                           .lost = options.address_lost},
                              server->log_);
  if (server->tokens_)
    server->tokens_->on_change([self = server.get()] { self->revoke_unknown(); });
  if (!options.metrics.empty()) {
    auto endpoint = MetricsEndpoint::start(
        options.metrics,
        {.metrics = [self = server.get()] { return self->metrics_.text(); },
         .healthy = [self =
                         server.get()] { return self->serving_ && self->probe_->all_answer(); }});
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

std::optional<std::string> Server::listen(const ServerOptions& options) {
  FrontOptions front{.tls = options.tls,
                     .max_resets = options.max_resets,
                     .lanes = std::clamp(options.service.threads / 4, 1u, 4u)};
  for (const std::string& address : options.listen)
    if (!is_unix(address)) front.listen.push_back(address);
  if (!front.listen.empty()) {
    auto opened = Front::open(front, connections_, log_,
                              [this](const char* cause) { metrics_.connection_closed(cause); });
    if (!opened) return std::move(opened.error());
    front_ = std::move(*opened);
  }
  grpc::ServerBuilder builder;
  configure(builder, options);
  limit_connections(builder);
  std::vector<int> bound(options.listen.size());
  for (std::size_t i = 0; i < bound.size(); ++i)
    if (is_unix(options.listen[i]))
      builder.AddListeningPort(options.listen[i], grpc::InsecureServerCredentials(), &bound[i]);
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor;
  if (front_ != nullptr)
    acceptor = builder.experimental().AddExternalConnectionAcceptor(
        grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD,
        grpc::InsecureServerCredentials());
  builder.RegisterService(&health_);
  builder.RegisterService(&reflection_);
  builder.RegisterService(&service_);
  if (job_service() != nullptr) builder.RegisterService(job_service());
  server_ = builder.BuildAndStart();
  for (std::size_t i = 0, of_tcp = 0; i < bound.size(); ++i) {
    if (!is_unix(options.listen[i])) bound[i] = front_->ports()[of_tcp++];
    if (bound[i] == 0) return fmt::format("cannot listen on {}", options.listen[i]);
    addresses_.push_back(bound_address(options.listen[i], bound[i]));
  }
  if (server_ == nullptr) return "gRPC does not start";
  if (front_ != nullptr) front_->start(std::move(acceptor));
  return std::nullopt;
}

std::optional<std::string> Server::start_console(const ServerOptions& options) {
  if (!options.console.wanted()) return std::nullopt;
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  if (const std::string fault = folder_fault(folder); !fault.empty())
    return "--console and --http need a folder for files that vanish, TMPDIR: " + fault;
  std::error_code unknown;
  const std::uint64_t room = std::filesystem::space(folder, unknown).available;
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(-1);  // messages come from this server itself
  auto console = Console::start(
      options.console,
      {.channel = server_->InProcessChannel(arguments),
       .authenticator = authenticator_,
       .secret = console_secret_,
       .metrics = [this] { return metrics_.text(); },
       .tls = options.tls,
       .insecure = options.insecure,
       .most_request_bytes = options.service.limits.max_request_bytes,
       .request_bytes = plan_memory(options).received,
       .client_share = options.service.client_share,
       .patience = options.service.patience,
       .body_timeout = std::chrono::duration_cast<milliseconds>(options.admission.request_timeout),
       .routes =
           [&](SessionContext& context) {
             return make_routes(context,
                                {.memory = memory_,
                                 .folder = folder,
                                 .file_bytes = options.console.file_bytes.value_or(room / 10 * 9),
                                 .meshes = options.console.meshes,
                                 .client_share = options.service.client_share,
                                 .log = log_});
           },
       .log = log_});
  if (!console) return console.error();
  console_ = std::move(*console);
  if (!http_address().empty())
    log_->info("event=serving_http security={} tokens={} address={}",
               security_of(http_address(), options.tls), tokens_ ? "yes" : "no",
               log_value(http_address()));
  if (console_address().empty()) return std::nullopt;
  log_->info("event=serving_console security={} tokens={} application={} address={}",
             security_of(console_->address(), options.tls), tokens_ ? "yes" : "no",
             options.console.assets.empty() ? "no" : "yes", log_value(console_->address()));
  return std::nullopt;
}

void Server::reload() {
  if (tokens_) tokens_->reload();
  if (callbacks_) callbacks_->reload();
  if (front_ != nullptr) front_->reload();
  if (console_ != nullptr) console_->reload();
}

void Server::revoke_unknown() {
  health_.revoke_unknown(authenticator_);
  service_.revoke_unknown(authenticator_);
  if (job_service() != nullptr) job_service()->revoke_unknown(authenticator_);
}

void Server::drain(std::chrono::steady_clock::duration at_most) {
  const auto end = std::chrono::steady_clock::now() + at_most;
  if (probe_ != nullptr) probe_->stop();
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
  if (console_ != nullptr) {
    const auto grace = std::chrono::steady_clock::now() + kOthersGrace;
    console_->stop(grace, std::max(end, grace));
  }
  if (front_ != nullptr) front_->stop_accepting();
  server_->Shutdown(std::chrono::system_clock::now() + kOthersGrace);
  server_->Wait();
  if (front_ != nullptr) front_->finish(std::chrono::steady_clock::now() + kLastWords);
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
  if (tokens_) tokens_->on_change({});
  if (server_ != nullptr) drain(seconds(0));
  if (jobs_) jobs_->close();
  queue_.stop();  // its runs use all that is destroyed now
}

}  // namespace weft::server
