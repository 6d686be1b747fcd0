// SPDX-License-Identifier: Apache-2.0
// `weft health`: asks grpc.health.v1 whether the server takes work.
//
// Debian has no generated code for that service. Its request is empty for the server as a whole;
// its answer has one field, number 1, whose value 1 means SERVING.
#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/client_context.h>
#include <grpcpp/completion_queue.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include <chrono>

#include "client/call/connection.h"
#include "client/call/server_error.h"
#include "client/commands/commands.h"

namespace weft::client {
namespace {

bool says_serving(const grpc::ByteBuffer& answer) {
  std::vector<grpc::Slice> slices;
  if (!answer.Dump(&slices).ok()) return false;
  std::string bytes;
  for (const grpc::Slice& slice : slices)
    bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  google::protobuf::UnknownFieldSet fields;
  if (!fields.ParseFromString(bytes)) return false;
  constexpr int kStatus = 1;
  constexpr std::uint64_t kServing = 1;
  for (int i = 0; i < fields.field_count(); ++i) {
    const auto& field = fields.field(i);
    if (field.number() == kStatus && field.type() == google::protobuf::UnknownField::TYPE_VARINT)
      return field.varint() == kServing;
  }
  return false;
}

}  // namespace

Result<ExitCode> run_health(const ServerOptions& options, std::stop_token stop) {
  const auto connection = connect(options.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  grpc::GenericStub stub(connection->channel);
  grpc::ClientContext context;
  context.set_deadline(
      std::chrono::system_clock::now() +
      std::chrono::milliseconds(static_cast<std::int64_t>(options.timeout_seconds * 1000)));
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });

  grpc::CompletionQueue queue;
  const grpc::Slice nothing;
  const grpc::ByteBuffer request(&nothing, 1);
  const auto call =
      stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  call->StartCall();
  grpc::ByteBuffer answer;
  grpc::Status status;
  call->Finish(&answer, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  if (!status.ok()) return tl::unexpected(error_of(status, connection->address));
  constexpr int kUnavailable = 14;
  if (!says_serving(answer))
    return fail(exit_code_of_status(kUnavailable),
                "the server " + connection->address + " is not serving");
  return print("serving\n");
}

}  // namespace weft::client
