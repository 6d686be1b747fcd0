// SPDX-License-Identifier: Apache-2.0
// Looks at the bytes of a message without parsing it, by the descriptor of its type.
//
// Memory: numbers take at most eight times their wire bytes once they are parsed, messages and
// unknown fields far more. Two bytes of an empty `domain.regions` become 80; two bytes of a field
// that the type does not have become 16 to 66, because protobuf keeps such fields. So the elements
// are counted first, and unknown fields are taken out of the bytes before anything is parsed.
//
// Unknown fields are ignored, as proto3 has it: a newer client may talk to an older server. A known
// field with another wire type is unknown, too, as it is to protobuf's own parser.
//
//   WireScan scan = scan_wire(bytes, *v1::GenerateMeshRequest::descriptor());
//   if (scan.malformed) ...                    // parsing would fail
//   if (scan.count(kRegions) > limit) ...      // refuse; nothing was allocated
//   if (scan.unknown_fields != 0) bytes = without_unknown_fields(bytes, type);
//
// Laws: bytes that protobuf parses are not malformed. After `without_unknown_fields` they parse to
// the same message, without unknown fields, and are no longer than before.
// Cost: one pass; an array is counted without looking at its numbers, or at a byte a cycle.
// Source: https://protobuf.dev/programming-guides/encoding/
#pragma once

#include <google/protobuf/descriptor.h>
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <string>
#include <unordered_map>

namespace weft::server {

struct WireScan {
  // For a repeated field its number of elements, for a string the bytes of the longest, for any
  // other field its number of occurrences; in all messages of the field's type together. An upper
  // bound on what parsing keeps: members of a oneof that a later one replaces are counted, too.
  std::uint64_t count(const google::protobuf::FieldDescriptor& field) const;
  std::uint64_t count(const google::protobuf::Descriptor& type, int field_number) const;

  bool malformed = false;
  std::uint64_t unknown_fields = 0;  // at every depth, a group as one
  std::unordered_map<const google::protobuf::FieldDescriptor*, std::uint64_t> counts{};
};

// Of malformed bytes, what comes before the fault is counted.
WireScan scan_wire(const grpc::ByteBuffer& bytes, const google::protobuf::Descriptor& type);

// REQUIRES: scan_wire(bytes, type) is not malformed.
grpc::ByteBuffer without_unknown_fields(grpc::ByteBuffer bytes,
                                        const google::protobuf::Descriptor& type);

}  // namespace weft::server
