// SPDX-License-Identifier: Apache-2.0
// The whole server but the process around it: MeshService, grpc.health.v1 and reflection on their
// addresses.
//
//   auto server = Server::start({.listen = {"127.0.0.1:0"}}, stream, make_logger("info"));
//   if (!server) return complain(server.error());
//   ... (*server)->addresses() ...
//   (*server)->drain(std::chrono::seconds(30));
#pragma once

#include <grpcpp/server.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/admission/admission.h"
#include "server/callbacks/callbacks.h"
#include "server/console/console.h"
#include "server/front/front.h"
#include "server/front/probe.h"
#include "server/jobs/job_system.h"
#include "server/mesh/mesh_service.h"
#include "server/net/caller.h"
#include "server/net/connection_table.h"
#include "server/net/tokens.h"
#include "server/observe/metrics.h"
#include "server/run/memory_budget.h"
#include "server/run/run_queue.h"
#include "server/server_options.h"
#include "server/services/health_service.h"
#include "server/services/metrics_endpoint.h"
#include "server/services/reflection_service.h"

namespace weft::server {

class Server {
 public:
  // Binds every address or none. The error names the address or file and what is wrong with it.
  // Without a store there is no JobService.
  static tl::expected<std::unique_ptr<Server>, std::string> start(
      const ServerOptions& options, EngineFn engine, Logger log,
      std::unique_ptr<JobStore> store = nullptr);
  // Ends what is open at once.
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // As bound: port 0 is replaced.
  const std::vector<std::string>& addresses() const { return addresses_; }
  // Where metrics are shown, as bound; empty: nowhere.
  std::string metrics_address() const { return endpoint_ ? endpoint_->address() : ""; }

  // Where the console and HTTP are served, as bound; empty: nowhere.
  std::string console_address() const { return console_ ? console_->address() : ""; }
  std::string http_address() const { return console_ ? console_->http_address() : ""; }

  // Health says NOT_SERVING, new calls get UNAVAILABLE, open ones may finish; those that do not
  // within `at_most` are ended with UNAVAILABLE. Then closes all connections and removes the socket
  // files. Call at most once.
  void drain(std::chrono::steady_clock::duration at_most);

  // Reads the tokens, the secrets of callbacks and the certificates again, which happens by itself
  // within two seconds of a change; what is open stays open, but for the streams of tokens that are
  // gone.
  void reload();

  // For a process that exits without draining.
  void remove_socket_files();

 private:
  Server(const ServerOptions& options, std::unique_ptr<TokenFile> tokens,
         std::unique_ptr<Callbacks> callbacks, EngineFn engine, Logger log,
         std::unique_ptr<JobStore> store);
  JobService* job_service();  // null if there is none
  // Ends the streams of callers whose token is no longer known.
  void revoke_unknown();
  // These return what is wrong.
  std::optional<std::string> listen(const ServerOptions& options);
  std::optional<std::string> start_console(const ServerOptions& options);

  const Logger log_;
  const std::unique_ptr<TokenFile> tokens_;     // may be null
  const std::unique_ptr<Callbacks> callbacks_;  // may be null
  const std::string console_secret_;            // see caller.h
  ConnectionTable connections_;
  const Authenticator authenticator_;
  Metrics metrics_;
  MemoryBudget memory_;
  Admission admission_;
  HealthService health_;
  ReflectionService reflection_;
  ThreadPool pool_;
  RunQueue queue_;
  MeshService service_;
  std::optional<JobSystem> jobs_;
  std::unique_ptr<Front> front_;  // null if no address is of TCP
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<Console> console_;  // may be null
  std::vector<std::string> addresses_;
  std::atomic<bool> serving_{false};
  std::unique_ptr<Probe> probe_;
  std::unique_ptr<MetricsEndpoint> endpoint_;  // destroyed first: it asks all of the above
};

}  // namespace weft::server
