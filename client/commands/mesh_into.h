// SPDX-License-Identifier: Apache-2.0
// One mesh, from the call to the files.
#pragma once

#include <functional>
#include <stop_token>

#include "client/call/connection.h"
#include "client/call/mesh_call.h"
#include "client/call/mesh_report.h"
#include "client/commands/input_domain.h"
#include "client/report/mesh_output.h"
#include "client/report/progress_bar.h"
#include "files/base/error.h"

namespace weft::client {

// A call that shows its progress, and says on standard error that the server is away.
MeshCallOptions shown_call(const CallOptions& calls, ProgressBar& progress,
                           const DomainProjection* projection);

// Requests a mesh of the domain and writes `output`; null: nothing is written. `received` is called
// before anything is written. The report has all warnings: about the files of the request, its
// sizes and its budget, the projection, and the markers of what was written.
// REQUIRES: the options come from with_size. Errors: those of call_generate_mesh and of MeshOutput;
// kUnreadableInput if segments are outside of the mesh of a strict input;
// if a private server went away, with the last lines of its log.
Result<MeshReport> mesh_into(const Connection& connection, const InputDomain& input,
                             const RequestOptions& request_options, const MeshCallOptions& call,
                             MeshOutput* output, const std::function<void()>& received,
                             std::stop_token stop);

}  // namespace weft::client
