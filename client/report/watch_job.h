// SPDX-License-Identifier: Apache-2.0
// Follows a job to its end. Another watch continues a broken one, as retry.h says.
//
// Errors: as JobServer's; a failed job is not an error.
#pragma once

#include <functional>
#include <string>

#include "client/call/job_server.h"
#include "files/base/error.h"

namespace weft::client {

// Returns the job as it ended. `on_job` is called on this thread whenever the job has changed, last
// with the returned job; it may be empty.
Result<v1::Job> watch_job(JobServer& server, const std::string& id,
                          const std::function<void(const v1::Job&)>& on_job);

}  // namespace weft::client
