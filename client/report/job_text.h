// SPDX-License-Identifier: Apache-2.0
// Formats jobs for people and programs. Times are RFC 3339 in UTC.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "client/call/server_error.h"
#include "client/report/json_line.h"
#include "files/base/error.h"
#include "weft/v1/job_service.pb.h"

namespace weft::client {

constexpr bool is_final(v1::JobState state) {
  return state == v1::JOB_STATE_SUCCEEDED || state == v1::JOB_STATE_FAILED ||
         state == v1::JOB_STATE_CANCELLED;
}

// "queued", "running", "succeeded", "failed", "cancelled"; "unknown" for states of newer servers.
const char* state_name(v1::JobState state);

// "2026-11-20T16:16:09Z", to the second.
std::string time_text(const google::protobuf::Timestamp& time);

// The fields of Job by name, without unset ones; states and stages in lower case.
Json job_json(const v1::Job& job);

// One field per line.
std::string job_text(const v1::Job& job);

// One job per line, under a heading; with clients if a job names one.
std::string job_table(std::span<const v1::Job> jobs);

// The job's progress for a progress bar, also while it waits.
v1::Progress progress_of(const v1::Job& job);

// Returns nullopt if the job succeeded. If it failed, the exit code is that of its error; if it was
// cancelled, that of CANCELLED; if it has not ended, that of FAILED_PRECONDITION.
std::optional<Error> job_error(const v1::Job& job, const RequestOrigin& origin = {});

}  // namespace weft::client
