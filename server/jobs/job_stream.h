// SPDX-License-Identifier: Apache-2.0
// What the two streams of JobService have in common: a job that its owner may see, a store that is
// asked on the service's own threads, an end for clients that read nothing.
//
// WatchStream tells what a job has become until that is final. FetchStream sends the mesh: as much
// of it as the client takes is read from the store, no more, and no thread waits for a client.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/admission/admission.h"
#include "server/admission/work_queue.h"
#include "server/net/caller.h"
#include "server/net/message_stream.h"
#include "server/observe/log.h"
#include "server/observe/metrics.h"
#include "server/store/job_store.h"
#include "server/wire/errors.h"

namespace weft::server {

// What all streams share; outlives them.
struct StreamEnvironment {
  JobStore& store;
  WorkQueue& threads;  // that may wait for the store
  ReaderPatience patience;
  Metrics& metrics;
  Logger log;
  std::function<void(MessageStream&)> forget;  // drops the owner's pointer to the stream
};

struct StreamedJob {
  Caller caller;
  std::string id;
};

class JobStream : public MessageStream, public std::enable_shared_from_this<JobStream> {
 public:
  // Begins on one of the service's threads.
  void start();

  // Called a few times a second, on one thread: ends the call of a client that reads nothing.
  virtual void tick(Clock::time_point now);

  // The server stops. A watch ends at once, a mesh is sent to its end.
  virtual void drain() {}

  // The server stops now.
  void stop() { fail({Reason::kStopping, "", "the server is stopping"}); }

 protected:
  JobStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id);

  virtual void begin() = 0;
  void fail(const Failure& failure);
  void log_end(grpc::StatusCode status, std::string_view reason) const;
  // The job, or what is to be told instead of it.
  tl::expected<JobRecord, Failure> look_up();
  // Runs on one of the service's threads, and keeps the stream alive meanwhile.
  void soon(std::function<void()> function);
  // Ends the call with what is thrown.
  template <class F>
  void guarded(F&& function);

  const StreamEnvironment& environment_;
  const StreamedJob job_;
  std::atomic<std::uint64_t> bytes_{0};  // handed to gRPC

 private:
  void client_gone() override { fail({Reason::kCancelled, "", "the client cancelled the call"}); }
  void ended_for_good() override { environment_.forget(*this); }

  const char* const method_;
  const std::optional<DrainGate::Pass> pass_;
  const Clock::time_point began_ = Clock::now();
};

class WatchStream final : public JobStream {
 public:
  // Each takes the parts of the call but its bytes.
  WatchStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id)
      : JobStream(environment, call, std::move(id)) {}

  void tick(Clock::time_point now) override;
  void drain() override { stop(); }

 private:
  void begin() override;
  void look();

  std::atomic<bool> begun_{false};
  std::string told_;  // bytes of the message that was sent last
};

class FetchStream final : public JobStream {
 public:
  FetchStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id,
              std::uint32_t first_chunk)
      : JobStream(environment, call, std::move(id)), next_(first_chunk) {}

 private:
  void begin() override;
  void wrote() override;
  void send_what_fits();
  // False if the call has ended by that.
  bool send_chunk(const std::string& sha256);

  // Of whoever has set busy_.
  StoredMesh mesh_;
  std::size_t next_;
  std::atomic<bool> busy_{true};  // `begin` is the first
};

}  // namespace weft::server
