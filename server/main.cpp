// SPDX-License-Identifier: Apache-2.0
// weftd: the process around the server. Exit codes: 0 drained, 1 failed, 2 wrong flags, 3 cannot
// listen, 4 cannot open the store, 5 an address no longer answers, 128 + signal where a second
// signal cut the draining short.
#include <fmt/format.h>
#include <grpc/grpc.h>
#include <malloc.h>
#include <openssl/crypto.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <thread>

#include "server/console/assets.h"
#include "server/net/health_check.h"
#include "server/observe/log.h"
#include "server/observe/machine.h"
#include "server/options.h"
#include "server/server.h"
#include "server/server_options.h"
#include "server/stop_events.h"
#include "server/store/postgres/postgres_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "server/version.h"
#include "weft/weft.h"

namespace weft::server {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitCannotListen = 3;
constexpr int kExitNoStore = 4;
constexpr int kExitLost = 5;

void write_addresses(std::ostream& out, const Server& server) {
  for (const std::string& address : server.addresses()) out << address << '\n';
  if (!server.metrics_address().empty()) out << "metrics=" << server.metrics_address() << '\n';
  if (!server.console_address().empty()) out << "console=" << server.console_address() << '\n';
  if (!server.http_address().empty()) out << "http=" << server.http_address() << '\n';
  out.flush();
}

// Writes another file and renames it, so that nobody reads half of it; "-" is the standard output.
bool write_port_file(const std::filesystem::path& path, const Server& server) {
  if (path == "-") {
    write_addresses(std::cout, server);
    return std::cout.good();
  }
  const std::filesystem::path draft = path.string() + ".tmp";
  {
    std::ofstream out(draft);
    write_addresses(out, server);
    if (!out) return false;
  }
  std::error_code error;
  std::filesystem::rename(draft, path, error);
  return !error;
}

// Null if no jobs are kept.
StoreResult<std::unique_ptr<JobStore>> open_store(const Options& options) {
  if (!options.data.empty()) return SqliteStore::open({.folder = options.data});
  if (!options.store.empty()) return PostgresStore::open({.uri = options.store});
  return nullptr;
}

const char* name_of(const StopEvents::Event& event) {
  if (event.kind == StopEvents::Kind::kInputEnded) return "end-of-input";
  return event.signal == SIGINT ? "SIGINT" : "SIGTERM";
}

// Waits for what ends the process.
StopEvents::Event wait_for_end(Server& server, StopEvents& events, const Logger& log) {
  while (true) {
    const StopEvents::Event event = events.wait();
    if (event.kind != StopEvents::Kind::kSignal || event.signal != SIGHUP) return event;
    server.reload();
    log->info("event=reloaded cause=SIGHUP");
  }
}

// Drains on a thread of its own, so that a second signal is noticed in the meantime.
void drain(Server& server, StopEvents& events, const Options& options, const Logger& log) {
  std::thread drainer([&] {
    server.drain(std::chrono::duration_cast<std::chrono::steady_clock::duration>(options.drain));
    events.notify();
  });
  while (true) {
    const StopEvents::Event event = events.wait();
    if (event.kind == StopEvents::Kind::kNotified) break;
    if (event.kind != StopEvents::Kind::kSignal || event.signal == SIGHUP) continue;
    log->warn("event=exit_now cause={}", name_of(event));
    server.remove_socket_files();
    std::_Exit(128 + event.signal);
  }
  drainer.join();
}

// By default glibc has eight heaps per processor, each of which keeps its holes, up to the size of
// the largest block that was freed before: beside hostile clients, up to 600 MiB of a server with
// --memory 1GiB were such holes. keep_memory_at_most bounds the blocks. REQUIRES: no other thread
// runs.
void bound_heaps(std::uint32_t threads) {
  mallopt(M_ARENA_MAX, static_cast<int>(std::max(threads, 4u)));
}

int serve(Options options) {
  bound_heaps(options.server.service.threads);
  std::signal(SIGPIPE, SIG_IGN);               // a log that nobody reads must not end the server
  StopEvents events(options.exit_with_stdin);  // before any thread: gRPC's inherit its mask
  // Never undone: after the last user of gRPC 1.51, its clean-up may wait 10 s for a poller. The
  // end of the process does the same at once.
  grpc_init();
  // OpenSSL keeps a state for the thread that uses it first, and frees only that of the main thread
  // at exit.
  OPENSSL_init_crypto(OPENSSL_INIT_LOAD_CONFIG, nullptr);
  keep_memory_at_most(plan_memory(options.server).kept);
  adopt_grpc_logs(options.log_format);
  const Logger log = make_logger(options.log_level, options.log_format);
  ServiceOptions& service = options.server.service;
  options.server.console.assets = console_assets();
  service.instance = fmt::format("{:08x}", std::random_device{}());
  log->info("event=starting version={} engine={} threads={} jobs={} queue={} instance={}",
            log_value(kVersion), log_value(kEngineVersion), service.threads, service.jobs,
            service.queue, log_value(service.instance));

  auto store = open_store(options);
  if (!store) {
    log->error("event=cannot_open_store message={}", log_value(store.error().message));
    return kExitNoStore;
  }
  // Whoever supervises the process starts another one. Jobs go on from the store.
  options.server.address_lost = [&log](const std::string&) {
    log->flush();
    std::_Exit(kExitLost);
  };
  auto started = Server::start(options.server, stream, log, std::move(*store));
  if (!started) {
    log->error("event=cannot_listen message={}", log_value(started.error()));
    return kExitCannotListen;
  }
  Server& server = **started;
  if (!options.port_file.empty() && !write_port_file(options.port_file, server)) {
    log->error("event=cannot_write_port_file path={}", log_value(options.port_file));
    return kExitFailed;
  }
  log->info("event=draining cause={} seconds={}", name_of(wait_for_end(server, events, log)),
            options.drain.count());
  drain(server, events, options, log);
  log->info("event=stopped");
  return 0;
}

int ask_health(const std::string& address) {
  grpc_init();  // never undone, as in `serve`
  const auto healthy = check_health(address);
  if (healthy) return 0;
  fmt::print(stderr, "weftd: {}\n", healthy.error());
  return kExitFailed;
}

}  // namespace
}  // namespace weft::server

int main(int argc, char** argv) {
  using namespace weft::server;
  try {
    auto parsed = parse_options(argc, argv, this_machine());
    if (const Exit* exit = std::get_if<Exit>(&parsed)) return exit->code;
    Options& options = std::get<Options>(parsed);
    if (!options.ask_health_at.empty()) return ask_health(options.ask_health_at);
    return serve(std::move(options));
  } catch (const std::exception& error) {
    fmt::print(stderr, "weftd: {}\n", error.what());
    return kExitFailed;
  }
}
