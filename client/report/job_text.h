// SPDX-License-Identifier: Apache-2.0
// Jobs as people and programs read them. Times are RFC 3339 in UTC.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "client/base/error.h"
#include "client/formats/domain.h"
#include "client/report/json_line.h"
#include "weft/v1/job_service.pb.h"

namespace weft::client {

constexpr bool is_final(v1::JobState state) {
  return state == v1::JOB_STATE_SUCCEEDED || state == v1::JOB_STATE_FAILED ||
         state == v1::JOB_STATE_CANCELLED;
}

// "queued", "running", "succeeded", "failed", "cancelled"; "unknown" for one of a newer server.
const char* state_name(v1::JobState state);

// "2026-11-20T16:16:09Z", to the second.
std::string time_text(const google::protobuf::Timestamp& time);

// The fields of Job by their names, those that are unset left out; states and stages in lower case.
Json job_json(const v1::Job& job);

// One field a line.
std::string job_text(const v1::Job& job);

// One job a line, under a heading.
std::string job_table(std::span<const v1::Job> jobs);

// How far the job is, as a progress bar shows it; of one that waits, too.
v1::Progress progress_of(const v1::Job& job);

// Nothing if the job succeeded. For one that failed the exit code of its error, for one that was
// cancelled that of CANCELLED, and for one that has not ended that of FAILED_PRECONDITION.
// `domain`, where it is known, tells the places of fields at fault.
std::optional<Error> job_error(const v1::Job& job, const Domain* domain);

}  // namespace weft::client
