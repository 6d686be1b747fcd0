// SPDX-License-Identifier: Apache-2.0
// Shared by `weft submit --wait` and `weft fetch`: waits for a job, and downloads its mesh into
// files.
#pragma once

#include <string>

#include "client/call/job_server.h"
#include "client/call/mesh_report.h"
#include "client/commands/input_domain.h"
#include "client/report/mesh_output.h"
#include "client/report/mesh_text.h"
#include "client/report/progress_bar.h"
#include "files/base/error.h"

namespace weft::client {

// Waits for a job to end, and returns it.
Result<v1::Job> wait_for_job(JobServer& server, const std::string& id, ProgressBar& progress);

// `input` may be null. Sets `times.received` and `times.written`. REQUIRES: the job succeeded.
Result<MeshReport> download(JobServer& server, const v1::Job& job, const InputDomain* input,
                            MeshOutput& output, ProgressBar& progress, MeshTimes& times);

// mesh_json, after the job's id.
Json download_json(const v1::Job& job, const MeshReport& report, const MeshTimes& times);

}  // namespace weft::client
