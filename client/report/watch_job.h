// SPDX-License-Identifier: Apache-2.0
// Follows a job to its end. A watch that breaks is taken up by another one, as retry.h says.
//
// Errors: as JobServer's; a job that fails is none.
#pragma once

#include <functional>
#include <string>

#include "client/base/error.h"
#include "client/call/job_server.h"

namespace weft::client {

// The job as it ended. `on_job` is called on this thread, whenever the job is not as it was, the
// last time with what is returned; it may be empty.
Result<v1::Job> watch_job(JobServer& server, const std::string& id,
                          const std::function<void(const v1::Job&)>& on_job);

}  // namespace weft::client
