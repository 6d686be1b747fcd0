// SPDX-License-Identifier: Apache-2.0
#include "client/mesh_call.h"

#include <grpcpp/client_context.h>

#include <charconv>
#include <cmath>
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

// The value of a text that is nothing but a finite number.
std::optional<double> as_number(const std::string& text) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

void fill(const Domain& domain, v1::Domain& out) {
  auto* points = out.mutable_points();
  points->Reserve(static_cast<int>(2 * domain.points.size()));
  for (const Point& point : domain.points) {
    points->AddAlreadyReserved(point.x);
    points->AddAlreadyReserved(point.y);
  }
  bool marked = false;
  auto* segments = out.mutable_segments();
  segments->Reserve(static_cast<int>(2 * domain.segments.size()));
  for (const Domain::Segment& segment : domain.segments) {
    segments->AddAlreadyReserved(segment.a);
    segments->AddAlreadyReserved(segment.b);
    marked |= segment.marker != 0;
  }
  if (marked)
    for (const Domain::Segment& segment : domain.segments) out.add_segment_markers(segment.marker);
  for (const Point& hole : domain.holes) {
    out.add_holes(hole.x);
    out.add_holes(hole.y);
  }
  for (const Domain::Region& region : domain.regions) {
    v1::Region& seed = *out.add_regions();
    seed.set_x(region.at.x);
    seed.set_y(region.at.y);
    seed.set_id(region.id);
    if (region.max_area) seed.set_max_area(*region.max_area);
  }
  out.set_fill(domain.fill == Domain::Fill::kEvenOdd ? v1::FILL_EVEN_ODD : v1::FILL_SEEDS);
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
        receiver_(spool, {domain.points.size(), domain.segments.size()}) {}

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

v1::GenerateMeshRequest make_request(const Domain& domain, const MeshWishes& wishes) {
  v1::GenerateMeshRequest request;
  fill(domain, *request.mutable_domain());
  if (const auto constant = as_number(wishes.size)) {
    request.mutable_size()->set_constant(*constant);
  } else if (!wishes.size.empty()) {
    request.mutable_size()->set_expression(wishes.size);
  }
  if (wishes.min_angle_deg) request.mutable_quality()->set_min_angle_deg(*wishes.min_angle_deg);
  if (wishes.min_edge) request.mutable_quality()->set_min_edge(*wishes.min_edge);
  if (wishes.max_triangles) request.mutable_budget()->set_max_triangles(*wishes.max_triangles);
  if (wishes.max_seconds) request.mutable_budget()->set_max_seconds(*wishes.max_seconds);
  if (wishes.threads) request.set_threads(*wishes.threads);
  request.set_want_quadtree(wishes.quadtree);
  return request;
}

Result<MeshReport> call_generate_mesh(const Connection& connection, const Domain& domain,
                                      const MeshWishes& wishes, const MeshCallOptions& options,
                                      MeshSpool& spool, std::stop_token stop) {
  // A message of gRPC ends at 2 GiB.
  constexpr std::size_t kMostPoints = std::size_t{1} << 26;
  if (domain.points.size() > kMostPoints || domain.segments.size() > kMostPoints)
    return fail(ExitCode::kUnreadableInput,
                "the domain has " + std::to_string(domain.points.size()) + " points and " +
                    std::to_string(domain.segments.size()) + " segments, a request takes " +
                    std::to_string(kMostPoints) + " of each");
  MeshCall call(connection, domain, wishes, options, spool, stop);
  Result<grpc::Status> status = call.attempt();
  if (status && call.can_resume(*status) && wait_until_connected(*connection.channel, stop))
    status = call.attempt();
  if (!status) return tl::unexpected(status.error());
  if (!status->ok()) return tl::unexpected(error_of(*status, connection.address, &domain));
  return call.report();
}

}  // namespace weft::client
