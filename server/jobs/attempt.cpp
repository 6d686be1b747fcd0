// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/attempt.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/net/caller.h"
#include "server/run/memory_estimate.h"
#include "server/wire/job_wire.h"
#include "server/wire/request_key.h"
#include "server/wire/request_options.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;
using Seconds = std::chrono::duration<double>;

// The store did not take the task back: another attempt begins once the lease has run out.
constexpr std::string_view kStillLeased = "leased";
// If the store is away for longer, the run is lost, because its lease has run out.
constexpr std::chrono::seconds kMaxUnavailable{60};
constexpr milliseconds kFirstPause{50};
constexpr milliseconds kLongestPause{2000};

// The request, or an empty one if there is none: the run then ends before it begins.
const v1::GenerateMeshRequest& request_or_empty(const tl::expected<ReadRequest, Failure>& request) {
  return request ? *request->message : v1::GenerateMeshRequest::default_instance();
}

std::string label_of(const Claim& claim) {
  const std::string who = log_fields({.name = claim.owner, .trace = claim.trace});
  return fmt::format("task={} job={} attempt={}{}{}", claim.ref.task, claim.job_id,
                     claim.ref.attempt, who.empty() ? "" : " ", who);
}

// Whether another attempt, or another server, may succeed at the same task: the fault lies with the
// machine, not with the request.
bool is_of_the_machine(Reason reason) {
  return reason == Reason::kInternal || row_of(reason).retryable;
}

}  // namespace

Attempt::Attempt(const RunEnvironment& environment, Claim claim, RunQueue::Slot& slot)
    : environment_(environment),
      claim_(std::move(claim)),
      label_(label_of(claim_)),
      request_(read_request(claim_)),
      slot_(slot),
      besides_(bytes_of_request(request_or_empty(request_)) + bytes_besides(environment.limits)),
      max_seconds_(to_seconds(request_or_empty(request_).budget(), environment.limits)),
      threads_(to_threads(request_or_empty(request_).threads(), environment.pool.threads())),
      run_(to_budget(request_or_empty(request_).budget(), environment.limits)) {
  claim_.request = {};
}

void Attempt::run() {
  environment_.log->info("event=attempt_started {}", label_);
  environment_.metrics.job_became("running");
  if (const auto made = make_mesh(); !made) return settle(made.error());
  const auto held =
      retry_while_unavailable([&] { return environment_.store.finish(claim_.ref, mesh_); });
  if (!held) return settle(failure_of(held.error()));
  if (*held == Held::kHeld) environment_.metrics.job_became("succeeded");
  log_end(*held == Held::kHeld ? "succeeded" : "lost", "-");
}

tl::expected<void, Failure> Attempt::make_mesh() {
  if (!request_) return tl::unexpected(request_.error());
  v1::GenerateMeshRequest options = options_of(*request_->message);
  request_->message.reset();
  auto summary = call_engine(environment_.engine, std::move(request_->converted), *this,
                             {.run = run_,
                              .slot = slot_,
                              .besides = besides_,
                              .deadline = seconds_from_now(max_seconds_),
                              .pool = environment_.pool,
                              .threads = threads_});
  if (store_error_) return tl::unexpected(failure_of(*store_error_));
  if (!summary && summary.error().reason == Reason::kDeadlineExceeded)
    summary.error().message =
        fmt::format("the job worked for {} s, which is its limit", max_seconds_);
  if (!summary) return tl::unexpected(summary.error());
  environment_.metrics.refined(summary->engine_seconds);
  v1::Summary message = to_wire(*summary, threads_);
  mesh_.brief = message.SerializeAsString();
  add_quadtree(*summary, message);
  *message.mutable_request() = std::move(options);
  mesh_.summary = message.SerializeAsString();
  return {};
}

// What is stored is what FetchMesh sends.
bool Attempt::accept(Chunk&& chunk) {
  environment_.metrics.triangles_made(chunk.triangles.size() / 3);
  to_wire(chunk, *chunk_message_.mutable_chunk());
  const std::string bytes = chunk_message_.SerializeAsString();
  StoredChunk stored{sha256(bytes), bytes.size()};
  const auto put =
      retry_while_unavailable([&] { return environment_.store.put_chunk(stored.sha256, bytes); });
  if (!put) {
    store_error_ = put.error();
    return false;
  }
  if (*put) {
    environment_.metrics.chunk_damaged();
    environment_.log->error("event=chunk_damaged {} bytes={} mended=yes", label_, bytes.size());
  }
  bytes_ += bytes.size();
  mesh_.chunks.push_back(std::move(stored));
  ++chunks_stored_;
  return true;
}

void Attempt::settle(const Failure& failure) {
  bool stopping = false;
  {
    MutexLock lock(mutex_);
    if (lost_) return log_end("lost", "-");
    stopping = stopping_;
  }
  const std::string_view reason = row_of(failure.reason).name;
  if (stopping) {
    const auto released = environment_.store.release(claim_.ref, milliseconds(0), false);
    return log_end(released ? "requeued" : kStillLeased, "-");
  }
  if (is_of_the_machine(failure.reason) && claim_.tries < environment_.retry.max_attempts) {
    const auto released = retry_while_unavailable([&] {
      return environment_.store.release(claim_.ref, delay_after(environment_.retry, claim_.tries),
                                        true);
    });
    return log_end(released ? "requeued" : kStillLeased, reason);
  }
  (void)retry_while_unavailable(
      [&] { return environment_.store.fail(claim_.ref, to_status(failure, "").error_details()); });
  environment_.metrics.job_became("failed");
  log_end("failed", reason);
}

void Attempt::stop() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  ended_.notify_all();
  run_.cancel();
}

void Attempt::lose() {
  {
    MutexLock lock(mutex_);
    if (std::exchange(lost_, true)) return;
  }
  ended_.notify_all();
  run_.cancel();
}

void Attempt::renew(milliseconds lease) {
  const Clock::time_point now = Clock::now();
  const std::uint64_t pulse = run_.pulse() + chunks_stored_;
  // A job that waits for a thread of the pool is not stuck.
  if (pulse != last_pulse_ || run_.progress().stage == Stage::kQueued) {
    last_pulse_ = pulse;
    last_moved_ = now;
  }
  if (now - last_moved_ > lease) return;
  write_progress(run_.progress(), Seconds(now - began_).count(), progress_);
  const auto held = environment_.store.renew(claim_.ref, lease, progress_.SerializeAsString());
  if (held && *held == Held::kLost) lose();
}

template <class F>
std::invoke_result_t<F> Attempt::retry_while_unavailable(F&& call) {
  const Clock::time_point end = Clock::now() + kMaxUnavailable;
  milliseconds wait = kFirstPause;
  while (true) {
    auto answer = call();
    if (answer || answer.error().kind != StoreErrorKind::kUnavailable) return answer;
    if (Clock::now() >= end || !pause(wait)) return answer;
    wait = std::min(2 * wait, kLongestPause);
  }
}

// Returns false if the run is to end.
bool Attempt::pause(milliseconds at_most) {
  const Clock::time_point end = Clock::now() + at_most;
  MutexLock lock(mutex_);
  while (!lost_ && !stopping_)
    if (ended_.wait_until(lock.native(), end) == std::cv_status::timeout) return true;
  return false;
}

void Attempt::log_end(std::string_view outcome, std::string_view reason) const {
  environment_.log->info(
      "event=attempt_ended {} outcome={} reason={} triangles={} chunks={} bytes={} seconds={:.3f}",
      label_, outcome, reason, run_.progress().triangles, chunks_stored_.load(), bytes_,
      Seconds(Clock::now() - began_).count());
}

}  // namespace weft::server
