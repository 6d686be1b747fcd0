// SPDX-License-Identifier: Apache-2.0
#include "server/wire_scan.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <array>
#include <span>

#include "weft/v1/job_service.pb.h"

namespace weft::server {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::uint32_t message_tag(int field) {
  return WireFormatLite::MakeTag(field, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
}
// Counts the messages at the end of a path of fields. False where the bytes are malformed.
bool count(CodedInputStream& in, std::span<const std::uint32_t> path, std::uint64_t& found) {
  while (const std::uint32_t tag = in.ReadTag()) {
    if (tag != path.front() || path.size() == 1) {
      if (tag == path.front()) ++found;
      if (!WireFormatLite::SkipField(&in, tag)) return false;
      continue;
    }
    int length = 0;
    if (!in.ReadVarintSizeAsInt(&length)) return false;
    const auto outer = in.PushLimit(length);
    if (!count(in, path.subspan(1), found)) return false;
    in.PopLimit(outer);
  }
  return in.ConsumedEntireMessage();
}

constexpr std::array kToRegions = {message_tag(v1::SubmitJobRequest::kMeshFieldNumber),
                                   message_tag(v1::GenerateMeshRequest::kDomainFieldNumber),
                                   message_tag(v1::Domain::kRegionsFieldNumber)};

std::uint64_t count(const grpc::ByteBuffer& bytes, std::span<const std::uint32_t> path) {
  grpc::ByteBuffer shared = bytes;  // the reader wants a mutable one; slices are shared
  grpc::ProtoBufferReader reader(&shared);
  CodedInputStream in(&reader);
  std::uint64_t found = 0;
  count(in, path, found);
  return found;
}

}  // namespace

std::uint64_t count_regions(const grpc::ByteBuffer& bytes) {
  return count(bytes, std::span(kToRegions).subspan(1));
}

std::uint64_t count_submitted_regions(const grpc::ByteBuffer& bytes) {
  return count(bytes, kToRegions);
}

}  // namespace weft::server
