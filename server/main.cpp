// SPDX-License-Identifier: Apache-2.0
// weftd: the process around the server. Exit codes: 0 drained, 1 failed, 2 wrong flags, 3 cannot
// listen, 4 cannot open the store, 128 + signal where a second signal cut the draining short.
#include <fmt/format.h>
#include <grpc/grpc.h>
#include <openssl/crypto.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "engine/engine.h"
#include "server/console/assets.h"
#include "server/machine.h"
#include "server/observe/log.h"
#include "server/options.h"
#include "server/server.h"
#include "server/stop_events.h"
#include "server/store/postgres/postgres_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "server/version.h"

namespace weft::server {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitCannotListen = 3;
constexpr int kExitNoStore = 4;

// Whoever waits for the file never sees half of it.
bool write_port_file(const std::filesystem::path& path, const Server& server) {
  const std::filesystem::path draft = path.string() + ".tmp";
  {
    std::ofstream out(draft);
    for (const std::string& address : server.addresses()) out << address << '\n';
    if (!server.metrics_address().empty()) out << "metrics=" << server.metrics_address() << '\n';
    if (!server.console_address().empty()) out << "console=" << server.console_address() << '\n';
    if (!out.flush()) return false;
  }
  std::error_code error;
  std::filesystem::rename(draft, path, error);
  return !error;
}

// Null if jobs are kept nowhere.
StoreResult<std::unique_ptr<JobStore>> open_store(const Options& options) {
  if (!options.data.empty()) return SqliteStore::open({.folder = options.data});
  if (!options.store.empty()) return PostgresStore::open({.uri = options.store});
  return nullptr;
}

const char* name_of(const StopEvents::Event& event) {
  if (event.kind == StopEvents::Kind::kInputEnded) return "end-of-input";
  return event.signal == SIGINT ? "SIGINT" : "SIGTERM";
}

// Drains on a thread of its own, so that a second signal is heard meanwhile.
void drain(Server& server, StopEvents& events, const Options& options, const Logger& log) {
  std::thread drainer([&] {
    server.drain(std::chrono::duration_cast<std::chrono::steady_clock::duration>(options.drain));
    events.notify();
  });
  while (true) {
    const StopEvents::Event event = events.wait();
    if (event.kind == StopEvents::Kind::kNotified) break;
    if (event.kind != StopEvents::Kind::kSignal) continue;
    log->warn("event=exit_now cause={}", name_of(event));
    server.remove_socket_files();
    std::_Exit(128 + event.signal);
  }
  drainer.join();
}

int serve(Options options) {
  std::signal(SIGPIPE, SIG_IGN);               // a log that nobody reads must not end the server
  StopEvents events(options.exit_with_stdin);  // before any thread: gRPC's inherit its mask
  // Never undone: the clean-up that follows the last user of gRPC 1.51 may wait 10 s for its backup
  // poller. The end of the process does it at once.
  grpc_init();
  // OpenSSL keeps a state for the thread that uses it first. At the end it is freed for this one,
  // and would not be for one of the arena.
  OPENSSL_init_crypto(OPENSSL_INIT_LOAD_CONFIG, nullptr);
  keep_memory_at_most(options.server.memory / 16);  // what is kept is beside what runs are granted
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
  auto started = Server::start(options.server, generate_mesh, log, std::move(*store));
  if (!started) {
    log->error("event=cannot_listen message={}", log_value(started.error()));
    return kExitCannotListen;
  }
  Server& server = **started;
  if (!options.port_file.empty() && !write_port_file(options.port_file, server)) {
    log->error("event=cannot_write_port_file path={}", log_value(options.port_file));
    return kExitFailed;
  }
  log->info("event=draining cause={} seconds={}", name_of(events.wait()), options.drain.count());
  drain(server, events, options, log);
  log->info("event=stopped");
  return 0;
}

}  // namespace
}  // namespace weft::server

int main(int argc, char** argv) {
  using namespace weft::server;
  try {
    auto parsed = parse_options(argc, argv, this_machine());
    if (const Exit* exit = std::get_if<Exit>(&parsed)) return exit->code;
    return serve(std::move(std::get<Options>(parsed)));
  } catch (const std::exception& error) {
    fmt::print(stderr, "weftd: {}\n", error.what());
    return kExitFailed;
  }
}
