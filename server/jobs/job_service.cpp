// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_service.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <utility>

#include "server/run/memory_estimate.h"
#include "server/store/job_id.h"
#include "server/wire/job_wire.h"
#include "server/wire/request_key.h"
#include "server/wire/request_reader.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;

// Threads that use the store: enough to hide its latency, few enough for its connections.
constexpr std::size_t kThreads = 8;
constexpr std::size_t kWaitingCalls = 4096;
// How long to wait between two rounds of notifying watchers.
constexpr milliseconds kBetweenRounds{20};
constexpr std::uint32_t kDefaultPage = 100;
constexpr std::uint32_t kLargestPage = 1000;

// Refuses what cannot be a job's id before it is looked up, logged or sent back.
std::optional<Failure> check_job_id(const std::string& id, const char* field) {
  if (is_job_id(id)) return std::nullopt;
  return Failure{
      Reason::kBadOption, field,
      fmt::format(
          "{} has {} bytes and is not the id of a job; ids have 26 digits and capital letters",
          field, id.size())};
}

// Of requests that name one.
template <class Request>
std::optional<Failure> check_id(const Request& request) {
  if constexpr (requires { request.id(); }) return check_job_id(request.id(), "id");
  return std::nullopt;
}

// Refuses what the engine would refuse before it triangulates, and what does not fit into `runs`,
// unless that is null; returns the memory that the run is expected to take. Linear time, and
// meanwhile memory for the engine's form of the request.
tl::expected<std::uint64_t, Failure> check_and_estimate(const v1::GenerateMeshRequest& request,
                                                        const Limits& limits,
                                                        const MemoryBudget* runs) {
  if (request.sample_points_size() > 0)
    return tl::unexpected(Failure{Reason::kBadOption, "sample_points",
                                  "a job makes a mesh, sample_points make none"});
  const auto converted = admissible(request, limits);
  if (!converted) return tl::unexpected(converted.error());
  if (const auto error = check_pslg(converted->pslg)) return tl::unexpected(failure_of(*error));
  const Estimate expected = estimate(*converted, to_budget(request.budget(), limits));
  const std::uint64_t besides = bytes_besides(limits) + bytes_of_request(request);
  if (runs == nullptr) return expected.bytes + besides;
  if (auto error = runs->check_fits(expected.least_bytes + besides, 0))
    return tl::unexpected(
        Failure{Reason::kLimitExceeded, largest_field(request), std::move(error->message)});
  return expected.bytes + besides;
}

WorkBudget budget_of(const v1::GenerateMeshRequest& request, const Limits& limits) {
  return {to_budget(request.budget(), limits).max_bytes,
          std::chrono::round<std::chrono::microseconds>(
              std::chrono::duration<double>(to_seconds(request.budget(), limits)))};
}

// A job as the store has it, or why there is none.
template <class Response>
tl::expected<Response, Failure> answer_with(const StoreResult<std::optional<JobRecord>>& record,
                                            const std::string& id) {
  if (!record) return tl::unexpected(failure_of(record.error()));
  if (!*record) return tl::unexpected(no_such_job(id));
  Response response;
  *response.mutable_job() = to_wire(**record);
  return response;
}

}  // namespace

JobService::JobService(JobServiceOptions options, Admission& admission, Metrics& metrics,
                       MemoryBudget& memory, JobStore& store, Logger log)
    : RawService("/weft.v1.JobService/", admission),
      options_(std::move(options)),
      metrics_(metrics),
      store_(store),
      log_(std::move(log)),
      environment_{store_,
                   threads_,
                   memory,
                   options_.patience,
                   metrics_,
                   log_,
                   [this](MessageStream& stream) { streams_.forget(stream); },
                   [&admission] { return admission.may_log_failure(); }},
      threads_(
          {.slots = kThreads, .capacity = kWaitingCalls, .client_share = options_.client_share}),
      ticker_([this] { tick_until_stopped(); }) {
  add({"SubmitJob", options_.limits.max_request_bytes,
       [this](const auto& call) { submit_job(call); }});
  add_unary("GetJob", &JobService::get);
  add_unary("ListJobs", &JobService::list);
  add_unary("CancelJob", &JobService::cancel);
  add_unary("DeleteJob", &JobService::remove);
  add_stream<v1::WatchJobRequest, WatchStream>("WatchJob");
  add_stream<v1::FetchMeshRequest, FetchStream>("FetchMesh");
}

JobService::~JobService() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  ticker_.join();
}

void JobService::wake() {
  {
    MutexLock lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void JobService::close() {
  gate().close();
  for (const auto& stream : streams_.all()) stream->drain();
}

void JobService::stop_all() {
  for (const auto& stream : streams_.all()) stream->stop();
}

template <class Request, class Response>
void JobService::add_unary(const char* method,
                           Answer<Response> (JobService::*handler)(const Caller&, const Request&)) {
  add({method, kSmallRequest, [this, handler](const std::shared_ptr<AdmittedCall>& call) {
         Request request;
         auto failure = read_small(std::exchange(call->bytes, {}), request);
         if (!failure) failure = check_id(request);
         if (failure) return admission().refuse(*call, *failure);
         answer_soon<Response>(call, [this, handler, call, request = std::move(request)] {
           return (this->*handler)(call->caller, request);
         });
       }});
}

template <class Request, class Stream>
void JobService::add_stream(const char* method) {
  add({method, kSmallRequest, [this](const std::shared_ptr<AdmittedCall>& call) {
         Request request;
         auto failure = read_small(std::exchange(call->bytes, {}), request);
         if (!failure) failure = check_id(request);
         if (failure) return admission().refuse(*call, *failure);
         std::shared_ptr<JobStream> stream;
         if constexpr (requires { request.first_chunk(); })
           stream =
               std::make_shared<Stream>(environment_, *call, request.id(), request.first_chunk());
         else
           stream = std::make_shared<Stream>(environment_, *call, request.id());
         {
           MutexLock lock(mutex_);
           streams_.add(stream);
         }
         changed_.notify_all();
         stream->take_call();
         stream->start();
       }});
}

template <class Response>
void JobService::answer_soon(std::shared_ptr<AdmittedCall> call,
                             std::function<Answer<Response>()> handler) {
  const auto work = [this, call, handler = std::move(handler)](RunQueue::Slot&) {
    try {
      const Answer<Response> answer = handler();
      if (answer)
        admission().answer(*call, serialize(*answer));
      else
        admission().refuse(*call, answer.error());
    } catch (const std::bad_alloc&) {
      admission().refuse(*call, {Reason::kOutOfMemory, "", "no memory is left for the call"});
    } catch (const std::exception& error) {
      admission().refuse(*call, {Reason::kInternal, "", error.what()});
    }
  };
  if (auto refusal = threads_.push({.client = call->caller.client()}, work))
    admission().refuse(*call, *refusal);
}

// A thread of the service parses the domain, too.
void JobService::submit_job(const std::shared_ptr<AdmittedCall>& call) {
  answer_soon<v1::SubmitJobResponse>(call, [this, call]() -> Answer<v1::SubmitJobResponse> {
    const std::size_t bytes = call->bytes.Length();
    auto request = read_submission(std::exchange(call->bytes, {}), options_.limits);
    if (!request) return tl::unexpected(request.error());
    if (auto failure =
            admission().reserve(*call, request->SpaceUsedLong(), largest_field(request->mesh())))
      return tl::unexpected(*failure);
    return submit(call->caller, std::move(*request), bytes);
  });
}

JobService::Answer<Callback> JobService::callback_of(const Caller& caller,
                                                     const std::string& url) const {
  const auto bad = [](std::string message) {
    return tl::unexpected(Failure{Reason::kBadOption, "notify", std::move(message)});
  };
  if (options_.callbacks == nullptr && url.empty()) return Callback{};
  if (options_.callbacks == nullptr) return bad("the server sends no callbacks");
  auto callback = options_.callbacks->accept(caller.name, url);
  if (!callback) return bad(std::move(callback.error()));
  return std::move(*callback);
}

JobService::Answer<v1::SubmitJobResponse> JobService::submit(const Caller& caller,
                                                             v1::SubmitJobRequest request,
                                                             std::size_t bytes) {
  const int points = request.mesh().domain().points_size() / 2;
  const auto estimate = check_and_estimate(request.mesh(), options_.limits,
                                           options_.works ? &environment_.memory : nullptr);
  if (!estimate) return tl::unexpected(estimate.error());
  auto callback = callback_of(caller, request.notify());
  if (!callback) return tl::unexpected(callback.error());
  Submission submission{.owner = caller.name,
                        .request_id = request.request_id(),
                        .request = request.mesh().SerializeAsString(),
                        .estimate = *estimate,
                        .budget = budget_of(request.mesh(), options_.limits),
                        .trace = caller.trace,
                        .no_cache = request.no_cache() || request.mesh().no_cache(),
                        .max_queued = options_.max_queued,
                        .max_open_of_owner = options_.max_open_of_client,
                        .callback = std::move(*callback),
                        .max_callbacks_of_owner = options_.max_open_of_client};
  submission.key = mesh_key(std::move(*request.mutable_mesh()));  // not a third copy of it
  if (!options_.share_across_clients) submission.key = key_of_client(submission.key, caller.name);
  auto submitted = store_.submit(submission);
  if (!submitted) return tl::unexpected(failure_of(submitted.error()));
  switch (submitted->outcome) {
    case SubmitOutcome::kConflict:
      return tl::unexpected(
          Failure{Reason::kRequestIdReused, "request_id",
                  fmt::format("request_id '{}' names job {}, which is for another mesh",
                              request.request_id(), submitted->job.id)});
    case SubmitOutcome::kQueueFull:
      return tl::unexpected(
          Failure{Reason::kQueueFull, "",
                  fmt::format("{} meshes wait already, which is the limit", options_.max_queued)});
    case SubmitOutcome::kOwnerFull:
      return tl::unexpected(
          Failure{Reason::kQueueFull, "",
                  fmt::format("{} jobs of yours have not ended yet, which is the limit",
                              options_.max_open_of_client)});
    case SubmitOutcome::kCallbacksFull:
      return tl::unexpected(
          Failure{Reason::kQueueFull, "notify",
                  fmt::format("{} callbacks of yours are pending, which is the limit",
                              options_.max_open_of_client)});
    case SubmitOutcome::kAccepted:
      submitted->job.from_store ? metrics_.cache_hit() : metrics_.cache_missed();
      metrics_.job_became(state_name(submitted->job.state));
      log_->info(
          "event=job_submitted job={} {} state={} from_store={} task={} points={} "
          "bytes={}",
          submitted->job.id, log_fields(caller), state_name(submitted->job.state),
          submitted->job.from_store,
          submitted->job.task ? fmt::to_string(*submitted->job.task) : "-", points, bytes);
      break;
    case SubmitOutcome::kFound:
      break;
  }
  v1::SubmitJobResponse response;
  *response.mutable_job() = to_wire(submitted->job);
  return response;
}

JobService::Answer<v1::GetJobResponse> JobService::get(const Caller& caller,
                                                       const v1::GetJobRequest& request) {
  return answer_with<v1::GetJobResponse>(store_.get(caller.name, request.id()), request.id());
}

JobService::Answer<v1::CancelJobResponse> JobService::cancel(const Caller& caller,
                                                             const v1::CancelJobRequest& request) {
  const auto before = store_.get(caller.name, request.id());
  const auto job = store_.cancel(caller.name, request.id());
  if (before && *before && !is_final((*before)->state) && job && *job &&
      (*job)->state == JobState::kCancelled) {
    metrics_.job_became("cancelled");
    log_->info("event=job_cancelled job={} {}", (*job)->id, log_fields(caller));
  }
  return answer_with<v1::CancelJobResponse>(job, request.id());
}

JobService::Answer<v1::DeleteJobResponse> JobService::remove(const Caller& caller,
                                                             const v1::DeleteJobRequest& request) {
  const auto job = store_.remove(caller.name, request.id());
  if (!job) return tl::unexpected(failure_of(job.error()));
  if (!*job) return tl::unexpected(no_such_job(request.id()));
  if (is_final((*job)->state)) return v1::DeleteJobResponse();
  return tl::unexpected(Failure{
      Reason::kJobNotDone, "id",
      fmt::format("the job {} is {}; cancel it first", request.id(), state_name((*job)->state))});
}

JobService::Answer<v1::ListJobsResponse> JobService::list(const Caller& caller,
                                                          const v1::ListJobsRequest& request) {
  if (request.page_size() > kLargestPage)
    return tl::unexpected(Failure{
        Reason::kBadOption, "page_size",
        fmt::format("page_size is {}; it must be at most {}", request.page_size(), kLargestPage)});
  if (!request.page_token().empty())
    if (auto failure = check_job_id(request.page_token(), "page_token"))
      return tl::unexpected(*failure);
  ListQuery query{.owner = caller.name, .before = request.page_token()};
  query.limit = request.page_size() != 0 ? request.page_size() : kDefaultPage;
  for (int i = 0; i < request.states_size(); ++i) {
    const auto state = from_wire(request.states(i));
    if (!state)
      return tl::unexpected(Failure{Reason::kBadOption, fmt::format("states[{}]", i),
                                    fmt::format("states[{}] is {}, which is no state of a job", i,
                                                static_cast<int>(request.states(i)))});
    query.states.push_back(*state);
  }
  const auto jobs = store_.list(query);
  if (!jobs) return tl::unexpected(failure_of(jobs.error()));
  v1::ListJobsResponse response;
  for (const JobRecord& job : *jobs) *response.add_jobs() = to_wire(job);
  if (jobs->size() == query.limit) response.set_next_page_token(jobs->back().id);
  return response;
}

void JobService::tick_until_stopped() {
  constexpr auto kNotified = std::cv_status::no_timeout;
  MutexLock lock(mutex_);
  while (!stopping_) {
    if (streams_.empty()) {
      changed_.wait(lock.native());
      continue;
    }
    const auto next = MessageStream::Clock::now() + options_.tick;
    while (!stopping_ && !woken_ && changed_.wait_until(lock.native(), next) == kNotified) continue;
    woken_ = false;
    lock.unlock();
    const auto now = MessageStream::Clock::now();
    try {
      for (const auto& stream : streams_.all()) stream->tick(now);
    } catch (const std::bad_alloc&) {
      // The next tick does it.
    }
    lock.lock();
    const auto rest = MessageStream::Clock::now() + kBetweenRounds;
    while (!stopping_ && changed_.wait_until(lock.native(), rest) == kNotified) continue;
  }
}

}  // namespace weft::server
