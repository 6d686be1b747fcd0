// SPDX-License-Identifier: Apache-2.0
// Between the store's records and the wire.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <tl/expected.hpp>

#include "server/store/job_store.h"
#include "server/wire/errors.h"
#include "weft/v1/job_service.pb.h"
#include "weft/v1/mesh_service.pb.h"
#include "weft/weft.h"

namespace weft::server {

Failure failure_of(const StoreError& error);

Failure no_such_job(std::string_view id);
Failure mesh_gone(std::string_view id);
Failure mesh_damaged(std::string_view id);  // and therefore gone

// A client can read it whatever the record holds: bytes of texts that are no UTF-8 become '?', and
// messages that do not parse are left empty.
v1::Job to_wire(const JobRecord& record);

struct ReadRequest {
  std::unique_ptr<v1::GenerateMeshRequest> message;
  MeshRequest converted;  // the same for the engine
};

// What a store keeps as bytes, for whoever works with it: kStoreBroken if no server has written
// them.
tl::expected<ReadRequest, Failure> read_request(const Claim& claim);
tl::expected<v1::Summary, Failure> read_summary(const StoredMesh& mesh);

// "queued" and so on.
std::string_view state_name(JobState state);

v1::JobState to_wire(JobState state);
// Nothing for what is no state of a job.
std::optional<JobState> from_wire(v1::JobState state);

}  // namespace weft::server
