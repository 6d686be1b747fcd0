// SPDX-License-Identifier: Apache-2.0
#include "client/mesh_call.h"

#include <grpcpp/client_context.h>

#include <chrono>
#include <memory>
#include <utility>

#include "client/mesh_receiver.h"
#include "client/server_error.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::client {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// False where the server stays away, or the user wants to stop.
bool wait_until_connected(grpc::Channel& channel, const std::stop_token& stop) {
  constexpr auto kPatience = std::chrono::seconds(5);
  constexpr auto kBetweenLooks = std::chrono::milliseconds(100);
  const auto end = std::chrono::system_clock::now() + kPatience;
  while (!stop.stop_requested() && std::chrono::system_clock::now() < end)
    if (channel.WaitForConnected(std::chrono::system_clock::now() + kBetweenLooks)) return true;
  return false;
}

// One mesh, in one call or, where the server went away in the middle of it, two.
class MeshCall {
 public:
  MeshCall(const Connection& connection, const Domain& domain, const MeshWishes& wishes,
           const MeshCallOptions& options, MeshSpool& spool, std::stop_token stop)
      : connection_(connection),
        options_(options),
        stop_(std::move(stop)),
        stub_(v1::MeshService::NewStub(connection.channel)),
        request_(make_request(domain, wishes)),
        receiver_(spool, DomainCounts{domain.points.size(), domain.segments.size()}) {}

  // The status with which the call ended; an error where its stream was not sound.
  Result<grpc::Status> attempt() {
    if (receiver_.accepted()) receiver_.resume();
    request_.set_first_chunk(receiver_.chunks());
    grpc::ClientContext context;
    if (options_.timeout_seconds)
      context.set_deadline(started_at_ +
                           std::chrono::duration_cast<Deadline::duration>(
                               std::chrono::duration<double>(*options_.timeout_seconds)));
    const std::stop_callback cancel(stop_, [&context] { context.TryCancel(); });
    const auto stream = stub_->GenerateMesh(&context, request_);
    v1::GenerateMeshResponse message;
    Result<void> sound;
    while (sound && stream->Read(&message)) {
      sound = receiver_.receive(message);
      if (receiver_.chunks() == 1 && report_.first_chunk_seconds == 0)
        report_.first_chunk_seconds = seconds_since(start_);
      if (message.has_progress() && options_.on_progress) options_.on_progress(message.progress());
    }
    if (!sound) {
      context.TryCancel();
      while (stream->Read(&message)) continue;
      stream->Finish();
      return tl::unexpected(sound.error());
    }
    return stream->Finish();
  }

  // A private server does not come back.
  bool can_resume(const grpc::Status& status) const {
    return status.error_code() == grpc::StatusCode::UNAVAILABLE && receiver_.chunks() > 0 &&
           !connection_.server;
  }

  // REQUIRES: the last attempt ended with OK.
  Result<MeshReport> report() {
    report_.stream_seconds = seconds_since(start_);
    if (auto complete = receiver_.finish(); !complete) return tl::unexpected(complete.error());
    report_.accepted = *receiver_.accepted();
    report_.summary = *receiver_.summary();
    report_.bytes_received = receiver_.bytes();
    return std::move(report_);
  }

 private:
  using Deadline = std::chrono::system_clock::time_point;

  const Connection& connection_;
  const MeshCallOptions& options_;
  const std::stop_token stop_;
  const std::unique_ptr<v1::MeshService::Stub> stub_;
  v1::GenerateMeshRequest request_;
  MeshReceiver receiver_;
  MeshReport report_;
  const Clock::time_point start_ = Clock::now();
  const Deadline started_at_ = std::chrono::system_clock::now();
};

}  // namespace

Result<MeshReport> call_generate_mesh(const Connection& connection, const Domain& domain,
                                      const MeshWishes& wishes, const MeshCallOptions& options,
                                      MeshSpool& spool, std::stop_token stop) {
  if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
  MeshCall call(connection, domain, wishes, options, spool, stop);
  Result<grpc::Status> status = call.attempt();
  if (status && call.can_resume(*status) && wait_until_connected(*connection.channel, stop))
    status = call.attempt();
  if (!status) return tl::unexpected(status.error());
  if (!status->ok()) return tl::unexpected(error_of(*status, connection.address, &domain));
  return call.report();
}

}  // namespace weft::client
