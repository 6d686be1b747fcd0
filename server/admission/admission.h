// SPDX-License-Identifier: Apache-2.0
// The entry of every call of every service: identify the caller by the call's headers, pass the
// drain gate, then read the message, within a time and a size. Refusals on this way are counted and
// logged here alone.
//
//   class EchoService : public RawService {
//    public:
//     explicit EchoService(Admission& admission) : RawService("/weft.v1.Echo/", admission) {
//       add({"Echo", kSmallRequest, [this](auto call) { call->answer(call->take_bytes()); }});
//     }
//   };
//
// Why raw, and why not as gRPC generates it: gRPC takes the first message of a unary or
// server-streaming call in, and parses it, before it asks anybody who calls. A bidirectional call
// is handed over with its headers alone; on the wire the two are the same.
//
// Memory: a message of more than 64 KiB reserves five times its bytes until it is parsed, then the
// bytes of the parsed request until its run has ended, in `request_bytes` and in the budget of
// runs. If that much is not free, the call is refused with OUT_OF_MEMORY and a RetryInfo. Messages
// on their way are gRPC's, within its ResourceQuota (server.cpp).
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <grpcpp/impl/service_type.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/net/caller.h"
#include "server/net/drain_gate.h"
#include "server/net/raw_call.h"
#include "server/observe/bounded_log.h"
#include "server/observe/log.h"
#include "server/observe/metrics.h"
#include "server/run/memory_budget.h"
#include "server/wire/errors.h"

namespace weft::server {

// Enough for every request but those that carry a domain.
inline constexpr std::size_t kSmallRequest = std::size_t{64} << 10;

struct AdmissionOptions {
  // From the headers of a call to the end of its message.
  std::chrono::steady_clock::duration request_timeout = std::chrono::seconds(120);
  // Refusals that are logged in a second; more are counted.
  std::uint64_t refusal_lines = 20;
  // The maximum memory of large messages that are parsed, or wait to be, and of requests that wait
  // for their run. It is also reserved in `memory`, which outlives the admission; null: in no other
  // budget.
  std::uint64_t request_bytes = std::uint64_t{1} << 30;
  MemoryBudget* memory = nullptr;
  // Is told of each call, and outlives the admission; null: nobody is.
  ConnectionTable* connections = nullptr;
};

// The memory of a large message, and then of the request that is parsed from it, in both budgets.
struct RequestMemory {
  MemoryBudget::Reservation of_requests{};
  MemoryBudget::Reservation of_all{};

  void shrink_to(std::uint64_t bytes) {
    of_requests.shrink_to(bytes);
    of_all.shrink_to(bytes);
  }
};

// A call that was admitted. Whoever holds it may take its parts.
struct AdmittedCall {
  std::shared_ptr<RawCall> call;
  const char* method;
  Caller caller;
  std::optional<DrainGate::Pass> pass;  // none: the service has no gate
  grpc::ByteBuffer bytes{};             // its message
  RequestMemory memory{};               // of that, if it is large
};

class Admission : private RawCall::Observer {
 public:
  struct Method {
    const char* name;        // as in the .proto
    std::size_t most_bytes;  // of its message
    std::function<void(std::shared_ptr<AdmittedCall>)> handler;
    // Unidentified callers get an answer, too, as if their message were empty: it is not taken in,
    // because gRPC 1.51 cannot be told to take less of it than of any other.
    bool allow_unauthenticated = false;
  };

  // The authenticator and the metrics outlive it.
  Admission(const AdmissionOptions& options, const Authenticator& authenticator, Metrics& metrics,
            Logger log);
  // REQUIRES: no call is open.
  ~Admission();
  Admission(const Admission&) = delete;
  Admission& operator=(const Admission&) = delete;

  // What gRPC's handler of the method returns. `gate` may be null; both outlive the call.
  RawCall* open(grpc::CallbackServerContext* context, const Method& method, DrainGate* gate);

  // Reserves memory for the request that was parsed from the call's message, instead of what was
  // reserved for the message; 64 KiB need none. `field` takes most of them. Errors: LIMIT_EXCEEDED
  // if there is never so much, OUT_OF_MEMORY if it is not free now.
  std::optional<Failure> reserve(AdmittedCall& call, std::uint64_t bytes, const char* field);

  // Whether a line on a call that failed may be logged now; if not, it is counted.
  bool may_log_failure() { return refusals_.allow(); }

  // Ends a call that was admitted with what is wrong with it.
  void refuse(const AdmittedCall& call, const Failure& failure);
  // Ends it with one message.
  void answer(const AdmittedCall& call, grpc::ByteBuffer message);

 private:
  struct Reading {
    std::shared_ptr<AdmittedCall> call;
    std::chrono::steady_clock::time_point until;
  };

  void admit(const std::shared_ptr<RawCall>& raw, const Method& method, DrainGate* gate);
  void received(const std::shared_ptr<AdmittedCall>& call, const Method& method,
                std::optional<grpc::ByteBuffer> bytes);
  void handle(const std::shared_ptr<AdmittedCall>& call, const Method& method,
              grpc::ByteBuffer bytes);
  std::optional<Failure> take(AdmittedCall& call, std::uint64_t bytes);
  void note(const AdmittedCall& call, const Failure& failure);
  void ended(RawCall& call) override;
  void expire_pending(std::chrono::steady_clock::time_point now);
  void tick_until_stopped();

  const AdmissionOptions options_;
  const Authenticator& authenticator_;
  Metrics& metrics_;
  const Logger log_;
  BoundedLog refusals_;
  MemoryBudget requests_memory_;

  std::mutex mutex_;            // guards the two below
  std::list<Reading> reading_;  // the oldest first
  bool stopping_ = false;
  std::condition_variable stopped_;
  std::thread ticker_;
};

// A service whose methods all come in through an Admission.
class RawService : public grpc::Service {
 public:
  // Refuses new calls once it is closed; `gate().wait_empty` tells when the old ones have ended.
  DrainGate& gate() { return gate_; }

 protected:
  // `name` is "/package.Service/"; the admission outlives the service.
  RawService(std::string name, Admission& admission)
      : name_(std::move(name)), admission_(admission) {}

  // Call in the constructor alone.
  void add(Admission::Method method, bool gated = true);

  Admission& admission() { return admission_; }

 private:
  const std::string name_;
  Admission& admission_;
  DrainGate gate_;
  struct Entry {
    std::string path;
    Admission::Method method;
  };
  std::deque<Entry> methods_;  // gRPC keeps pointers into it
};

}  // namespace weft::server
