// SPDX-License-Identifier: Apache-2.0
// Many jobs for one or more servers that may be killed meanwhile: submitted, counted, and each mesh
// held against that of a server that was left in peace.
//
//   Reference reference;
//   Jobs jobs(mixed_request);
//   while (!jobs.submit(server.address())) continue;
//   ... servers are killed, frozen, started again ...
//   expect_all_well(jobs.settle(server.address(), reference), 1);
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/status.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "tests/e2e/programs.h"
#include "weft/v1/job_service.grpc.pb.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::e2e {

// How many of something: few where all tests run, as many as stand in bench/README.md where the
// environment variable WEFT_SOAK is set.
int few_or_many(int few, int many);

// Sanitizers keep what was freed for a while: then the memory of a server tells nothing of it.
#ifdef WEFT_SANITIZED
inline constexpr bool kMemoryTells = false;
#else
inline constexpr bool kMemoryTells = true;
#endif

// A connection of its own.
std::shared_ptr<grpc::Channel> connect(const std::string& address);

// By their number.
using Requests = v1::GenerateMeshRequest (*)(int);
// Meshes of 30,000 to 600,000 triangles; those whose numbers are equal modulo 20 are the same.
v1::GenerateMeshRequest repeated_request(int number);
// All models, 4,000 to 250,000 triangles, and no two the same.
v1::GenerateMeshRequest mixed_request(int number);

// What an undisturbed server answers; each request is made once. Thread-safe.
class Reference {
 public:
  v1::Summary summary(const v1::GenerateMeshRequest& request);
  std::string digest(const v1::GenerateMeshRequest& request) { return summary(request).sha256(); }

 private:
  const Server server_;
  std::mutex mutex_;
  std::map<std::string, v1::Summary> summaries_;  // by the request's bytes
};

// A refusal by a server that is full, which says when to come again.
bool is_full(const grpc::Status& status);

// The job once it has ended, through deaths of the server; nothing if there is no such job.
std::optional<v1::Job> wait_for_job(v1::JobService::Stub& stub, const std::string& id);

// The digest of the mesh that a stream carried, from its chunks: so what arrived is judged, and not
// what is said of it. Empty if the two disagree.
template <class Reader, class Message>
std::string digest_of_stream(Reader& reader, Message& message);
std::string sha256(const std::string& bytes);

// What became of all jobs.
struct Tally {
  int accepted = 0;
  int lost = 0;
  int duplicated = 0;
  int wrong = 0;
  int attempts = 0;
};

class Jobs {
 public:
  explicit Jobs(Requests requests) : requests_(requests) {}

  // Submits one more job, and the same one again where the answer was lost. False if no server
  // answers.
  bool submit(const std::string& address);
  // How many have ended; nothing if no server answers.
  static std::optional<int> ended(const std::string& address);
  // Waits for all jobs and fetches their meshes.
  Tally settle(const std::string& address, Reference& reference);

 private:
  const Requests requests_;
  int next_ = 0;
  std::map<int, std::string> ids_;  // by number
};

void expect_all_well(const Tally& tally, int accepted);

// --- implementation ---

template <class Reader, class Message>
std::string digest_of_stream(Reader& reader, Message& message) {
  std::string digests;
  while (reader.Read(&message))
    if (message.has_chunk()) digests += message.chunk().sha256();
  return sha256(digests) == message.summary().sha256() ? message.summary().sha256() : "";
}

}  // namespace weft::e2e
