// SPDX-License-Identifier: Apache-2.0
#include "server/wire/request_reader.h"

#include <fmt/format.h>
#include <grpcpp/impl/codegen/proto_utils.h>

#include <algorithm>
#include <utility>

#include "server/wire/translate.h"
#include "server/wire/wire_scan.h"

namespace weft::server {
namespace {

constexpr std::size_t kLongestRequestId = 128;

Failure malformed(const google::protobuf::Message& message) {
  return {Reason::kMalformedRequest, "",
          fmt::format("the bytes are not a {}", message.GetDescriptor()->full_name())};
}

std::optional<Failure> parse(grpc::ByteBuffer bytes, google::protobuf::Message& message,
                             const Limits* limits) {
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  const WireScan scan = scan_wire(bytes, type);
  if (scan.malformed) return malformed(message);
  if (limits != nullptr)
    if (auto failure = check_limits(scan, *limits)) return failure;
  if (scan.unknown_fields != 0) bytes = without_unknown_fields(std::move(bytes), type);
  using Traits = grpc::SerializationTraits<google::protobuf::Message>;
  if (!Traits::Deserialize(&bytes, &message).ok()) return malformed(message);
  return std::nullopt;
}

std::optional<Failure> check_request_id(const std::string& id) {
  const bool printable =
      std::all_of(id.begin(), id.end(), [](char c) { return c > 31 && c < 127; });
  if (printable && id.size() <= kLongestRequestId) return std::nullopt;
  return Failure{
      Reason::kBadOption, "request_id",
      fmt::format("request_id must be at most {} bytes of printable ASCII", kLongestRequestId)};
}

}  // namespace

tl::expected<std::unique_ptr<v1::GenerateMeshRequest>, Failure> read_mesh_request(
    grpc::ByteBuffer bytes, const Limits& limits) {
  auto request = std::make_unique<v1::GenerateMeshRequest>();
  if (auto failure = parse(std::move(bytes), *request, &limits)) return tl::unexpected(*failure);
  return request;
}

tl::expected<v1::SubmitJobRequest, Failure> read_submission(grpc::ByteBuffer bytes,
                                                            const Limits& limits) {
  v1::SubmitJobRequest request;
  if (auto failure = parse(std::move(bytes), request, &limits)) return tl::unexpected(*failure);
  if (auto failure = check_request_id(request.request_id())) return tl::unexpected(*failure);
  if (request.mesh().first_chunk() != 0)
    return tl::unexpected(Failure{Reason::kBadOption, "first_chunk",
                                  "first_chunk of a job must be 0; FetchMesh has its own"});
  return request;
}

tl::expected<MeshRequest, Failure> admissible(const v1::GenerateMeshRequest& request,
                                              const Limits& limits) {
  auto converted = to_engine(request);
  if (!converted) return converted;
  if (auto failure = check_limits(request, limits)) return tl::unexpected(*failure);
  if (auto failure = check_values(*converted)) return tl::unexpected(*failure);
  return converted;
}

std::optional<Failure> read_small(grpc::ByteBuffer bytes, google::protobuf::Message& message) {
  return parse(std::move(bytes), message, nullptr);
}

}  // namespace weft::server
