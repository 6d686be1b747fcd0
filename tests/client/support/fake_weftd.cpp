// SPDX-License-Identifier: Apache-2.0
// Stands in for weftd: takes the flags with which weft starts a private server, and misbehaves as
// the variable FAKE_WEFTD says:
//   (unset)      streams a good mesh of 32 triangles
//   large        streams a good mesh of a million triangles
//   die          ends at start, with a word on stderr
//   never-ready  listens but never says so
//   stubborn     ignores SIGTERM
//   vanish       is killed in the middle of the stream
//   hang         streams nothing and waits for the call to be cancelled
//   damage       streams a chunk whose digest is wrong
// The process id is written to the file that FAKE_WEFTD_PID names, the environment, a line feed
// before each variable, to that of FAKE_WEFTD_ENVIRONMENT.
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "client/base/files.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/sample_stream.h"
#include "tests/files/support/sample_mesh.h"

namespace {

using namespace weft::client;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::string flag(int argc, char** argv, const std::string& name) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i] == name) return argv[i + 1];
  return "";
}

grpc::Status wait_for_cancellation(grpc::ServerContext& context) {
  while (!context.IsCancelled()) ::poll(nullptr, 0, 5);
  return grpc::Status::CANCELLED;
}

Script script_for(const std::string& behaviour) {
  Script script{
      stream_of(square_mesh(behaviour == "large" ? 707 : 4), behaviour == "large" ? 30 : 3)};
  if (behaviour == "vanish") {
    script.messages.resize(3);
    script.end = [](grpc::ServerContext&) -> grpc::Status {
      ::raise(SIGKILL);
      return grpc::Status::OK;
    };
  }
  if (behaviour == "hang") {
    script.messages.resize(1);
    script.end = wait_for_cancellation;
  }
  if (behaviour == "damage") script.messages[3].mutable_chunk()->set_coordinates(0, 0.5);
  return script;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string behaviour = variable("FAKE_WEFTD");
  if (const std::string file = variable("FAKE_WEFTD_PID"); !file.empty())
    std::ofstream(file) << ::getpid();
  if (const std::string file = variable("FAKE_WEFTD_ENVIRONMENT"); !file.empty()) {
    std::ofstream out(file);
    for (char** each = environ; *each != nullptr; ++each) out << '\n' << *each;
  }
  if (behaviour == "die") {
    std::fputs("event=starting\nevent=cannot_listen message=\"no luck today\"\n", stderr);
    return 3;
  }
  if (behaviour == "stubborn") std::signal(SIGTERM, SIG_IGN);
  const FakeServer server(script_for(behaviour), flag(argc, argv, "--listen"));
  if (!server.listens()) return 3;
  if (behaviour != "never-ready") {
    std::puts(flag(argc, argv, "--listen").c_str());
    std::fflush(stdout);
  }
  // Until standard input ends; SIGTERM does what it does by default.
  char dropped;
  while (::read(STDIN_FILENO, &dropped, 1) > 0) continue;
  return 0;
}
