// SPDX-License-Identifier: Apache-2.0
// Receives one mesh over as many streams as needed: a broken stream is followed by another one that
// begins at the first missing chunk, as long as new chunks arrive, and a few times more (retry.h).
// GenerateMesh and FetchMesh have the same stream, so both use this.
//
//   MeshReceiver receiver(spool, domain);
//   auto report = download_mesh<v1::FetchMeshResponse>(
//       receiver, retry, deadline, stop,
//       [&](grpc::ClientContext* context, std::uint32_t first_chunk) { ... the stream ... },
//       [&](const v1::FetchMeshResponse& message) { ... });
//
// Errors: the status of the last stream as `Ended::status`; kDataLoss for an inconsistent stream,
// kUnwritableOutput if the spool fails. A requested stop cancels the stream.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "client/call/mesh_receiver.h"
#include "client/call/mesh_report.h"
#include "client/call/retry.h"
#include "files/base/error.h"
#include "files/base/text.h"

namespace weft::client {

struct Download {
  grpc::Status status;  // OK: the report is there
  MeshReport report{};
};

// `open(context, first_chunk)` begins a stream of Response; `on_message(message)` gets every valid
// message.
template <class Response, class Open, class OnMessage>
Result<Download> download_mesh(MeshReceiver& receiver, Retry retry,
                               std::optional<Deadline> deadline, const std::stop_token& stop,
                               Open&& open, OnMessage&& on_message) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto seconds = [start] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  Download download;
  MeshReport& report = download.report;
  for (;;) {
    if (receiver.accepted()) receiver.resume();
    grpc::ClientContext context;
    if (deadline) context.set_deadline(*deadline);
    const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
    const std::unique_ptr<grpc::ClientReader<Response>> stream = open(&context, receiver.chunks());
    Response message;
    Result<void> sound;
    while (sound && stream->Read(&message)) {
      sound = receiver.receive(message);
      if (!sound) break;
      if (message.has_chunk()) {
        retry.restart();
        if (report.first_chunk_seconds == 0) report.first_chunk_seconds = seconds();
      }
      on_message(message);
    }
    if (!sound) {
      context.TryCancel();
      while (stream->Read(&message)) continue;
      stream->Finish();
      return tl::unexpected(sound.error());
    }
    download.status = stream->Finish();
    // A failure after the summary does not matter: the mesh is complete.
    if (download.status.ok() || receiver.summary()) break;
    if (!retry.again(download.status)) return download;
  }
  if (auto complete = receiver.finish(); !complete) return tl::unexpected(complete.error());
  download.status = grpc::Status::OK;
  report.stream_seconds = seconds();
  report.accepted = *receiver.accepted();
  report.summary = *receiver.summary();
  report.bytes_received = receiver.bytes();
  for (const v1::SizeWarning& warning : report.summary.size_warnings())
    add_warnings({harmless(warning.message())}, report);
  return download;
}

}  // namespace weft::client
