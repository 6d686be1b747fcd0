// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/wire_scan.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include "weft/v1/mesh_service.pb.h"

namespace weft::server {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::uint32_t message_tag(int field) {
  return WireFormatLite::MakeTag(field, WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
}
constexpr std::uint32_t kDomainTag = message_tag(v1::GenerateMeshRequest::kDomainFieldNumber);
constexpr std::uint32_t kRegionTag = message_tag(v1::Domain::kRegionsFieldNumber);

// False where the bytes are malformed.
bool count_in_domain(CodedInputStream& in, std::uint64_t& regions) {
  while (const std::uint32_t tag = in.ReadTag()) {
    if (tag == kRegionTag) ++regions;
    if (!WireFormatLite::SkipField(&in, tag)) return false;
  }
  return in.ConsumedEntireMessage();
}

}  // namespace

std::uint64_t count_regions(const grpc::ByteBuffer& bytes) {
  grpc::ByteBuffer shared = bytes;  // the reader wants a mutable one; slices are shared
  grpc::ProtoBufferReader reader(&shared);
  CodedInputStream in(&reader);
  std::uint64_t regions = 0;
  while (const std::uint32_t tag = in.ReadTag()) {
    if (tag != kDomainTag) {
      if (!WireFormatLite::SkipField(&in, tag)) break;
      continue;
    }
    int length = 0;
    if (!in.ReadVarintSizeAsInt(&length)) break;
    const auto outer = in.PushLimit(length);
    if (!count_in_domain(in, regions)) break;
    in.PopLimit(outer);
  }
  return regions;
}

}  // namespace weft::server
