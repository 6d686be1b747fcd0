// SPDX-License-Identifier: Apache-2.0
// What a server is started with, and how its memory is divided, so that the whole process stays
// within it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "server/admission/admission.h"
#include "server/callbacks/callbacks.h"
#include "server/console/console.h"
#include "server/jobs/job_system.h"
#include "server/mesh/mesh_service.h"
#include "server/net/tls.h"

namespace weft::server {

struct ServerOptions {
  std::vector<std::string> listen;  // see listen.h
  ServiceOptions service{};
  AdmissionOptions admission{};  // its request_bytes are filled in
  // Bytes of the whole process.
  std::uint64_t memory = std::uint64_t{8} << 30;
  // Where there is a store. Their limits are those of `service`.
  JobOptions jobs{};
  TlsOptions tls{};             // of TCP addresses; a unix socket is guarded by its folder
  CallbackOptions callbacks{};  // of these jobs
  // Connections over TCP that may be open at the same time; one client has the share of
  // `service.client_share`.
  std::uint64_t max_connections = 1024;
  // Calls that one connection may reset in a second; more close it. 0: no bound, nor on those that
  // do not end.
  std::uint64_t max_resets = 600;
  std::string tokens{};  // the file, see tokens.h; empty: whoever can connect may call
  // Listen unencrypted even if other machines can connect, and show the metrics to them.
  bool insecure = false;
  std::string metrics{};  // HOST:PORT to show them on, see metrics_endpoint.h; empty: nowhere
  ConsoleOptions console{};
  // Called once if an address has not answered the server itself for a minute, see probe.h.
  std::function<void(const std::string& address)> address_lost = [](const std::string&) {};
};

struct MemoryPlan {
  // Messages that are being received; those of the console and of HTTP once more. Those that wait
  // to be parsed, and requests that wait for their run, have as much of `runs`.
  std::uint64_t received = 0;
  std::uint64_t kept = 0;  // pages that runs which have ended leave for later ones
  std::uint64_t runs = 0;  // and for requests that wait for theirs; the rest
};

// The process itself, and what the allocator has of pages that are used in part: an idle server has
// 29 MiB.
inline constexpr std::uint64_t kBytesOfProcess = std::uint64_t{32} << 20;
// The least for runs: one that is light.
inline constexpr std::uint64_t kMinBytesOfRuns = std::uint64_t{32} << 20;

// Its `runs` are 0 if there is not enough for all else.
MemoryPlan plan_memory(const ServerOptions& options);

}  // namespace weft::server
