// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_service.h"

#include <fmt/format.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "server/jobs/job_wire.h"
#include "server/jobs/mesh_key.h"
#include "server/refusal.h"
#include "server/translate.h"
#include "server/unary_call.h"
#include "server/weight.h"
#include "server/wire_scan.h"
#include "server/work.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;

// That ask the store: enough for its latency, few enough for its connections.
constexpr std::size_t kThreads = 8;
constexpr std::size_t kWaitingCalls = 4096;
// Between two rounds of telling those who watch.
constexpr milliseconds kBetweenRounds{20};
constexpr std::uint32_t kDefaultPage = 100;
constexpr std::uint32_t kLargestPage = 1000;
constexpr std::size_t kLongestRequestId = 128;

template <class Message>
bool parse(const grpc::ByteBuffer& bytes, Message& message) {
  grpc::ByteBuffer shared = bytes;  // slices are shared
  return grpc::SerializationTraits<Message>::Deserialize(&shared, &message).ok();
}

Failure malformed(std::string_view type) {
  return {Reason::kMalformedRequest, "", fmt::format("the bytes are not a weft.v1.{}", type)};
}

std::optional<Failure> check_request_id(const std::string& id) {
  const bool printable =
      std::all_of(id.begin(), id.end(), [](char c) { return c > 31 && c < 127; });
  if (printable && id.size() <= kLongestRequestId) return std::nullopt;
  return Failure{
      Reason::kBadOption, "request_id",
      fmt::format("request_id must be at most {} bytes of printable ASCII", kLongestRequestId)};
}

}  // namespace

JobService::JobService(JobServiceOptions options, const Authenticator& authenticator,
                       Metrics& metrics, JobStore& store, Logger log)
    : options_(std::move(options)),
      authenticator_(authenticator),
      metrics_(metrics),
      store_(store),
      log_(std::move(log)),
      environment_{store_,   threads_, options_.stall_timeout,
                   metrics_, log_,     [this](MessageStream& stream) { forget(stream); }},
      threads_({.workers = kThreads, .capacity = kWaitingCalls}),
      ticker_([this] { tick_until_stopped(); }) {}

JobService::~JobService() {
  {
    std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  ticker_.join();
}

void JobService::wake() {
  {
    std::lock_guard lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void JobService::close() {
  gate_.close();
  for (const auto& stream : open_streams()) stream->drain();
}

void JobService::stop_all() {
  for (const auto& stream : open_streams()) stream->stop();
}

JobService::Unary* JobService::answer(Context* context, const char* method,
                                      std::function<Answer(const Caller&)> handler) {
  auto* const call = new UnaryCall;
  const auto finish = [this, call, method](const Caller& caller, const Answer& failure) {
    if (!failure) {
      metrics_.call_ended(method, grpc::OK, caller.seconds_since());
      return call->finish(grpc::Status::OK);
    }
    refused(caller, method, *failure);
    call->finish(to_status(*failure, ""));
  };
  const auto caller = authenticator_.identify(*context);
  if (!caller) {
    finish(Authenticator::unverified(*context), caller.error());
    return call;
  }
  auto pass = gate_.enter();
  if (!pass) {
    finish(*caller, Failure{Reason::kStopping, "", "the server is stopping"});
    return call;
  }
  const auto kept = std::make_shared<DrainGate::Pass>(std::move(*pass));
  const auto work = [finish, kept, handler = std::move(handler), caller = *caller] {
    try {
      finish(caller, handler(caller));
    } catch (const std::exception& error) {
      finish(caller, Failure{Reason::kInternal, "", error.what()});
    }
  };
  if (!push(threads_, work))
    finish(*caller, Failure{Reason::kQueueFull, "",
                            fmt::format("{} calls wait for the store already", kWaitingCalls)});
  return call;
}

JobService::Unary* JobService::SubmitJob(Context* context, const grpc::ByteBuffer* request,
                                         grpc::ByteBuffer* response) {
  return answer(context, "SubmitJob", [this, request, response](const Caller& caller) {
    return submit(caller, *request, *response);
  });
}

tl::expected<v1::SubmitJobRequest, Failure> JobService::read_submission(
    const grpc::ByteBuffer& bytes) const {
  if (auto failure = check_seed_count(count_submitted_regions(bytes), options_.limits))
    return tl::unexpected(*failure);
  v1::SubmitJobRequest request;
  if (!parse(bytes, request)) return tl::unexpected(malformed("SubmitJobRequest"));
  if (auto failure = check_request_id(request.request_id())) return tl::unexpected(*failure);
  if (auto failure = check_shape(request.mesh())) return tl::unexpected(*failure);
  if (auto failure = check_limits(request.mesh(), options_.limits)) return tl::unexpected(*failure);
  if (request.mesh().first_chunk() != 0)
    return tl::unexpected(Failure{Reason::kBadOption, "first_chunk",
                                  "first_chunk of a job must be 0; FetchMesh has its own"});
  return request;
}

JobService::Answer JobService::submit(const Caller& caller, const grpc::ByteBuffer& bytes,
                                      grpc::ByteBuffer& response) {
  auto request = read_submission(bytes);
  if (!request) return request.error();
  const int points = request->mesh().domain().points_size() / 2;
  Submission submission{.owner = caller.name,
                        .request_id = request->request_id(),
                        .request = request->mesh().SerializeAsString(),
                        .weight = expected_bytes(request->mesh(), options_.limits),
                        .trace = caller.trace,
                        .no_cache = request->no_cache() || request->mesh().no_cache(),
                        .max_queued = options_.max_queued,
                        .max_queued_of_owner = options_.max_queued_of_owner};
  submission.key = mesh_key(std::move(*request->mutable_mesh()));  // not a third copy of it
  auto submitted = store_.submit(submission);
  if (!submitted) return failure_of(submitted.error());
  switch (submitted->outcome) {
    case SubmitOutcome::kConflict:
      return Failure{Reason::kRequestIdReused, "request_id",
                     fmt::format("request_id '{}' names job {}, which is for another mesh",
                                 request->request_id(), submitted->job.id)};
    case SubmitOutcome::kQueueFull:
      return Failure{
          Reason::kQueueFull, "",
          fmt::format("{} meshes wait already, which is the limit", options_.max_queued)};
    case SubmitOutcome::kOwnQueueFull:
      return Failure{Reason::kQueueFull, "",
                     fmt::format("{} meshes of yours wait already, which is the limit",
                                 options_.max_queued_of_owner)};
    case SubmitOutcome::kAccepted:
      submitted->job.from_store ? metrics_.cache_hit() : metrics_.cache_missed();
      metrics_.job_became(state_name(submitted->job.state));
      log_->info(
          "event=job_submitted job={} {} state={} from_store={} task={} points={} "
          "bytes={}",
          submitted->job.id, log_fields(caller), state_name(submitted->job.state),
          submitted->job.from_store,
          submitted->job.task ? fmt::to_string(*submitted->job.task) : "-", points, bytes.Length());
      break;
    case SubmitOutcome::kFound:
      break;
  }
  v1::SubmitJobResponse message;
  *message.mutable_job() = to_wire(submitted->job);
  response = serialize(message);
  return std::nullopt;
}

JobService::Unary* JobService::GetJob(Context* context, const v1::GetJobRequest* request,
                                      v1::GetJobResponse* response) {
  return answer(context, "GetJob", [=, this](const Caller& caller) -> Answer {
    return tell(store_.get(caller.name, request->id()), request->id(), *response->mutable_job());
  });
}

JobService::Unary* JobService::CancelJob(Context* context, const v1::CancelJobRequest* request,
                                         v1::CancelJobResponse* response) {
  return answer(context, "CancelJob", [=, this](const Caller& caller) -> Answer {
    const auto before = store_.get(caller.name, request->id());
    const auto job = store_.cancel(caller.name, request->id());
    if (before && *before && !is_final((*before)->state) && job && *job &&
        (*job)->state == JobState::kCancelled) {
      metrics_.job_became("cancelled");
      log_->info("event=job_cancelled job={} {}", (*job)->id, log_fields(caller));
    }
    return tell(job, request->id(), *response->mutable_job());
  });
}

JobService::Unary* JobService::DeleteJob(Context* context, const v1::DeleteJobRequest* request,
                                         v1::DeleteJobResponse*) {
  return answer(context, "DeleteJob", [=, this](const Caller& caller) -> Answer {
    const auto job = store_.remove(caller.name, request->id());
    if (!job) return failure_of(job.error());
    if (!*job) return no_such_job(request->id());
    if (is_final((*job)->state)) return std::nullopt;
    return Failure{
        Reason::kJobNotDone, "id",
        fmt::format("the job {} is {}; cancel it first", request->id(), state_name((*job)->state))};
  });
}

JobService::Answer JobService::tell(const StoreResult<std::optional<JobRecord>>& record,
                                    const std::string& id, v1::Job& out) {
  if (!record) return failure_of(record.error());
  if (!*record) return no_such_job(id);
  out = to_wire(**record);
  return std::nullopt;
}

JobService::Unary* JobService::ListJobs(Context* context, const v1::ListJobsRequest* request,
                                        v1::ListJobsResponse* response) {
  return answer(context, "ListJobs", [=, this](const Caller& caller) -> Answer {
    if (request->page_size() > kLargestPage)
      return Failure{Reason::kBadOption, "page_size",
                     fmt::format("page_size is {}; it must be at most {}", request->page_size(),
                                 kLargestPage)};
    ListQuery query{.owner = caller.name, .before = request->page_token()};
    query.limit = request->page_size() != 0 ? request->page_size() : kDefaultPage;
    for (int i = 0; i < request->states_size(); ++i) {
      const auto state = from_wire(request->states(i));
      if (!state)
        return Failure{Reason::kBadOption, fmt::format("states[{}]", i),
                       fmt::format("states[{}] is {}, which is no state of a job", i,
                                   static_cast<int>(request->states(i)))};
      query.states.push_back(*state);
    }
    const auto jobs = store_.list(query);
    if (!jobs) return failure_of(jobs.error());
    for (const JobRecord& job : *jobs) *response->add_jobs() = to_wire(job);
    if (jobs->size() == query.limit) response->set_next_page_token(jobs->back().id);
    return std::nullopt;
  });
}

JobService::Stream* JobService::WatchJob(Context* context, const grpc::ByteBuffer* bytes) {
  return open<v1::WatchJobRequest>(
      context, *bytes, "WatchJob", "WatchJobRequest",
      [&](StreamedJob job, const v1::WatchJobRequest&, DrainGate::Pass pass) {
        return std::make_shared<WatchStream>(environment_, context, std::move(job),
                                             std::move(pass));
      });
}

JobService::Stream* JobService::FetchMesh(Context* context, const grpc::ByteBuffer* bytes) {
  return open<v1::FetchMeshRequest>(
      context, *bytes, "FetchMesh", "FetchMeshRequest",
      [&](StreamedJob job, const v1::FetchMeshRequest& request, DrainGate::Pass pass) {
        return std::make_shared<FetchStream>(environment_, context, std::move(job),
                                             request.first_chunk(), std::move(pass));
      });
}

template <class Request, class Make>
JobService::Stream* JobService::open(Context* context, const grpc::ByteBuffer& bytes,
                                     const char* method, const char* type, Make&& make) {
  const auto refuse = [&](const Caller& caller, const Failure& failure) {
    refused(caller, method, failure);
    return new Refusal(to_status(failure, ""));
  };
  auto caller = authenticator_.identify(*context);
  if (!caller) return refuse(Authenticator::unverified(*context), caller.error());
  auto pass = gate_.enter();
  if (!pass) return refuse(*caller, {Reason::kStopping, "", "the server is stopping"});
  Request request;
  if (!parse(bytes, request)) return refuse(*caller, malformed(type));
  const std::shared_ptr<JobStream> stream =
      make(StreamedJob{*caller, request.id()}, request, std::move(*pass));
  {
    std::lock_guard lock(mutex_);
    streams_.emplace(stream.get(), stream);
  }
  changed_.notify_all();
  stream->start();
  return stream->given_to_grpc();
}

void JobService::refused(const Caller& caller, const char* method, const Failure& failure) {
  const ErrorRow& row = row_of(failure.reason);
  metrics_.call_ended(method, row.code, caller.seconds_since());
  log_->info("event=call_refused {} method={} status={} reason={} field={}", log_fields(caller),
             method, code_name(row.code), row.name,
             log_value(failure.field.empty() ? "-" : failure.field));
}

void JobService::forget(MessageStream& stream) {
  std::shared_ptr<JobStream> last;  // destroyed without the lock
  std::lock_guard lock(mutex_);
  const auto found = streams_.find(&stream);
  last = std::move(found->second);
  streams_.erase(found);
}

std::vector<std::shared_ptr<JobStream>> JobService::open_streams() {
  std::vector<std::shared_ptr<JobStream>> streams;
  std::lock_guard lock(mutex_);
  streams.reserve(streams_.size());
  for (const auto& [key, stream] : streams_) streams.push_back(stream);
  return streams;
}

void JobService::tick_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (streams_.empty()) {
      changed_.wait(lock, [this] { return stopping_ || !streams_.empty(); });
      continue;
    }
    changed_.wait_for(lock, options_.tick, [this] { return stopping_ || woken_; });
    woken_ = false;
    lock.unlock();
    const auto now = MessageStream::Clock::now();
    for (const auto& stream : open_streams()) stream->tick(now);
    lock.lock();
    changed_.wait_for(lock, kBetweenRounds, [this] { return stopping_; });
  }
}

}  // namespace weft::server
