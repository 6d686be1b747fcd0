// SPDX-License-Identifier: Apache-2.0
// The two streams of JobService, and their common base: it checks that the caller owns the job,
// calls the store on the service's own threads, and ends calls of clients that read nothing.
//
// WatchStream sends the job whenever it changes, until its state is final. FetchStream sends the
// mesh: it reads from the store only as much as the client takes, and no thread waits for a client.
// It reserves the memory of what it reads ahead; without any, one chunk waits while another is
// sent.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/admission/admission.h"
#include "server/net/caller.h"
#include "server/net/message_stream.h"
#include "server/observe/log.h"
#include "server/observe/metrics.h"
#include "server/run/memory_budget.h"
#include "server/run/mutex.h"
#include "server/run/run_queue.h"
#include "server/store/job_store.h"
#include "server/wire/errors.h"

namespace weft::server {

// Shared by all streams; must outlive them.
struct StreamEnvironment {
  JobStore& store;
  RunQueue& threads;     // may wait for the store
  MemoryBudget& memory;  // of what is read ahead
  ReaderPatience patience;
  Metrics& metrics;
  Logger log;
  std::function<void(MessageStream&)> forget;  // drops the owner's pointer to the stream
  std::function<bool()> may_log_failure;       // see Admission
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

  // Called when the server drains. A watch ends at once, a mesh is sent to its end.
  virtual void drain() {}

  // Ends the call because the server stops now.
  void stop() { fail({Reason::kStopping, "", "the server is stopping"}); }

  const Caller& caller() const { return job_.caller; }
  void revoke() { fail(token_revoked()); }

 protected:
  JobStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id);

  void ended_for_good() override { environment_.forget(*this); }
  virtual void begin() = 0;
  void fail(const Failure& failure);
  void log_end(grpc::StatusCode status, std::string_view reason) const;
  // Returns the job, or the failure to reply with.
  tl::expected<JobRecord, Failure> look_up();
  // Runs the function on one of the service's threads, and keeps the stream alive meanwhile.
  void soon(std::function<void()> function);
  // Calls the function; ends the call with what it throws.
  template <class F>
  void guarded(F&& function);

  const StreamEnvironment& environment_;
  const StreamedJob job_;
  std::atomic<std::uint64_t> bytes_{0};  // handed to gRPC

 private:
  void client_gone() override { fail({Reason::kCancelled, "", "the client cancelled the call"}); }

  const char* const method_;
  const std::optional<DrainGate::Pass> pass_;
  const Clock::time_point began_ = Clock::now();
};

class WatchStream final : public JobStream {
 public:
  // Takes all parts of the call except its bytes.
  WatchStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id)
      : JobStream(environment, call, std::move(id)) {}

  void tick(Clock::time_point now) override;
  void drain() override { stop(); }

 private:
  void begin() override;
  void look();

  std::atomic<bool> begun_{false};
  std::string sent_;  // bytes of the last message
};

class FetchStream final : public JobStream {
 public:
  FetchStream(const StreamEnvironment& environment, AdmittedCall& call, std::string id,
              std::uint32_t first_chunk)
      : JobStream(environment, call, std::move(id)), next_(first_chunk) {}

 private:
  void begin() override;
  void wrote() override;
  void ended_for_good() override;
  void reserve_memory();
  bool may_read_ahead();
  void send_what_fits();
  // Returns false if that has ended the call.
  bool send_chunk(const std::string& sha256);
  void drop_damaged(const std::string& sha256, const std::string& bytes);

  // Used only by the thread that has set busy_.
  StoredMesh mesh_;
  std::size_t next_;
  std::atomic<bool> busy_{true};  // `begin` is the first

  Mutex mutex_;
  MemoryBudget::Reservation read_ahead_ ABSL_GUARDED_BY(mutex_);  // empty if no memory was free
  bool over_ ABSL_GUARDED_BY(mutex_) = false;                     // the call has ended for good
};

}  // namespace weft::server
