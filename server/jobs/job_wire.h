// SPDX-License-Identifier: GPL-3.0-or-later
// Between the store's records and the wire.
#pragma once

#include <optional>
#include <string_view>

#include "server/errors.h"
#include "server/store/job_store.h"
#include "weft/v1/job_service.pb.h"

namespace weft::server {

Failure failure_of(const StoreError& error);

Failure no_such_job(std::string_view id);
Failure mesh_gone(std::string_view id);

v1::Job to_wire(const JobRecord& record);

// "queued" and so on.
std::string_view state_name(JobState state);

v1::JobState to_wire(JobState state);
// Nothing for what is no state of a job.
std::optional<JobState> from_wire(v1::JobState state);

}  // namespace weft::server
