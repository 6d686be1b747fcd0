// SPDX-License-Identifier: Apache-2.0
#include "server/wire/job_wire.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/common.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>

#include "google/rpc/error_details.pb.h"
#include "server/wire/translate.h"

namespace weft::server {
namespace {

google::protobuf::Timestamp to_wire(WallTime time) {
  return google::protobuf::util::TimeUtil::MicrosecondsToTimestamp(
      std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count());
}

// A damaged row must not keep a client from reading the whole message with all other jobs in it.
// Text that is not UTF-8, or a message that does not parse, would.
std::string text_of(const std::string& stored) {
  using google::protobuf::internal::IsStructurallyValidUTF8;
  if (IsStructurallyValidUTF8(stored.data(), static_cast<int>(stored.size()))) return stored;
  std::string text = stored;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c & 0x80) != 0; }, '?');
  return text;
}

v1::CallbackState to_wire(CallbackState state) {
  switch (state) {
    case CallbackState::kNone:
      return v1::CALLBACK_STATE_UNSPECIFIED;
    case CallbackState::kPending:
    case CallbackState::kClaimed:
      return v1::CALLBACK_STATE_PENDING;
    case CallbackState::kDelivered:
      return v1::CALLBACK_STATE_DELIVERED;
    case CallbackState::kFailed:
      return v1::CALLBACK_STATE_FAILED;
  }
  return v1::CALLBACK_STATE_UNSPECIFIED;
}

v1::Callback to_wire(const Callback& stored) {
  v1::Callback callback;
  callback.set_url(text_of(stored.url));
  callback.set_state(to_wire(stored.state));
  callback.set_attempts(stored.attempts);
  callback.set_error(text_of(stored.error));
  return callback;
}

template <class Message>
void parse_into(Message& message, const std::string& stored) {
  if (!message.ParseFromString(stored)) message.Clear();
}

// Jobs may share the error of their work, but each one's error names the job itself.
void name_job(google::rpc::Status& error, const std::string& id) {
  for (google::protobuf::Any& detail : *error.mutable_details()) {
    google::rpc::ErrorInfo info;
    if (!detail.Is<google::rpc::ErrorInfo>() || !detail.UnpackTo(&info)) continue;
    (*info.mutable_metadata())["job_id"] = id;
    detail.PackFrom(info);
  }
}

Reason reason_of(StoreErrorKind kind) {
  switch (kind) {
    case StoreErrorKind::kUnavailable:
      return Reason::kStoreUnavailable;
    case StoreErrorKind::kFull:
      return Reason::kStoreFull;
    case StoreErrorKind::kBroken:
      return Reason::kStoreBroken;
  }
  return Reason::kInternal;
}

}  // namespace

Failure failure_of(const StoreError& error) {
  return {reason_of(error.kind), "", error.message};
}

Failure no_such_job(std::string_view id) {
  return {Reason::kNoSuchJob, "id", fmt::format("there is no job '{}'", id)};
}

Failure mesh_gone(std::string_view id) {
  return {Reason::kMeshGone, "", fmt::format("the mesh of job {} is no longer kept", id)};
}

Failure mesh_damaged(std::string_view id) {
  return {Reason::kMeshGone, "",
          fmt::format("the mesh of job {} was damaged in the store, and is no longer kept: submit "
                      "it again, and it is made anew",
                      id)};
}

v1::Job to_wire(const JobRecord& record) {
  v1::Job job;
  job.set_id(text_of(record.id));
  job.set_request_id(text_of(record.request_id));
  job.set_state(to_wire(record.state));
  *job.mutable_create_time() = to_wire(record.created);
  if (record.started) *job.mutable_start_time() = to_wire(*record.started);
  if (record.ended) *job.mutable_end_time() = to_wire(*record.ended);
  job.set_attempts(record.attempts);
  job.set_worker(text_of(record.worker));
  if (!record.progress.empty()) parse_into(*job.mutable_progress(), record.progress);
  if (!record.error.empty()) {
    parse_into(*job.mutable_error(), record.error);
    name_job(*job.mutable_error(), job.id());
  }
  job.set_from_store(record.from_store);
  job.set_client(text_of(record.owner));
  if (!record.callback.url.empty()) *job.mutable_callback() = to_wire(record.callback);
  if (!record.brief.empty()) {
    parse_into(*job.mutable_summary(), record.brief);
    job.mutable_summary()->clear_leaf_boxes();  // of meshes that older servers made
  }
  return job;
}

tl::expected<ReadRequest, Failure> read_request(const Claim& claim) {
  auto message = std::make_unique<v1::GenerateMeshRequest>();
  if (!message->ParseFromString(claim.request))
    return tl::unexpected(Failure{Reason::kStoreBroken, "", "the stored request does not parse"});
  auto converted = to_engine(*message);
  if (!converted)
    return tl::unexpected(Failure{Reason::kStoreBroken, "",
                                  "the stored request is damaged: " + converted.error().message});
  return ReadRequest{std::move(message), *std::move(converted)};
}

tl::expected<v1::Summary, Failure> read_summary(const StoredMesh& mesh) {
  v1::Summary summary;
  if (!summary.ParseFromString(mesh.summary))
    return tl::unexpected(Failure{Reason::kStoreBroken, "", "the stored summary does not parse"});
  return summary;
}

std::string_view state_name(JobState state) {
  switch (state) {
    case JobState::kQueued:
      return "queued";
    case JobState::kRunning:
      return "running";
    case JobState::kSucceeded:
      return "succeeded";
    case JobState::kFailed:
      return "failed";
    case JobState::kCancelled:
      return "cancelled";
  }
  return "unknown";
}

v1::JobState to_wire(JobState state) {
  switch (state) {
    case JobState::kQueued:
      return v1::JOB_STATE_QUEUED;
    case JobState::kRunning:
      return v1::JOB_STATE_RUNNING;
    case JobState::kSucceeded:
      return v1::JOB_STATE_SUCCEEDED;
    case JobState::kFailed:
      return v1::JOB_STATE_FAILED;
    case JobState::kCancelled:
      return v1::JOB_STATE_CANCELLED;
  }
  return v1::JOB_STATE_UNSPECIFIED;
}

std::optional<JobState> from_wire(v1::JobState state) {
  for (const JobState known : {JobState::kQueued, JobState::kRunning, JobState::kSucceeded,
                               JobState::kFailed, JobState::kCancelled})
    if (to_wire(known) == state) return known;
  return std::nullopt;
}

}  // namespace weft::server
