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
  const v1::GenerateMeshRequest request = make_request(domain, wishes);
  const auto stub = v1::MeshService::NewStub(connection.channel);
  grpc::ClientContext context;
  if (options.timeout_seconds)
    context.set_deadline(std::chrono::system_clock::now() +
                         std::chrono::duration_cast<std::chrono::system_clock::duration>(
                             std::chrono::duration<double>(*options.timeout_seconds)));
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });

  const auto start = Clock::now();
  const auto stream = stub->GenerateMesh(&context, request);
  MeshReceiver receiver(spool, {domain.points.size(), domain.segments.size()});
  MeshReport report;
  v1::GenerateMeshResponse message;
  Result<void> sound;
  while (sound && stream->Read(&message)) {
    sound = receiver.receive(message);
    if (receiver.chunks() == 1 && report.first_chunk_seconds == 0)
      report.first_chunk_seconds = seconds_since(start);
    if (message.has_progress() && options.on_progress) options.on_progress(message.progress());
  }
  if (!sound) {
    context.TryCancel();
    while (stream->Read(&message)) continue;
    stream->Finish();
    return tl::unexpected(sound.error());
  }
  const grpc::Status status = stream->Finish();
  report.stream_seconds = seconds_since(start);
  if (!status.ok()) return tl::unexpected(error_of(status, connection.address, &domain));
  if (auto complete = receiver.finish(); !complete) return tl::unexpected(complete.error());
  report.accepted = *receiver.accepted();
  report.summary = *receiver.summary();
  report.bytes_received = receiver.bytes();
  return report;
}

}  // namespace weft::client
