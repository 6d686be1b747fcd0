// SPDX-License-Identifier: Apache-2.0
#include "server/wire/wire_scan.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

namespace weft::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormat;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

// How a field is spelled, if the type has the field.
enum class Spelling { kUnknown, kMessage, kPacked, kText, kPlain };

struct Field {
  const FieldDescriptor* descriptor = nullptr;
  Spelling spelling = Spelling::kUnknown;
};

Field field_of(const Descriptor& type, std::uint32_t tag) {
  const FieldDescriptor* const field =
      type.FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag));
  if (field == nullptr) return {};
  const WireFormatLite::WireType wire = WireFormatLite::GetTagWireType(tag);
  if (wire == WireFormat::WireTypeForFieldType(field->type())) {
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) return {field, Spelling::kMessage};
    const bool text = wire == WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
    return {field, text ? Spelling::kText : Spelling::kPlain};
  }
  if (field->is_packable() && wire == WireFormatLite::WIRETYPE_LENGTH_DELIMITED)
    return {field, Spelling::kPacked};
  return {};
}

// The bytes of a number in an array; 0 if that depends on the number.
int width_of(const FieldDescriptor& field) {
  switch (WireFormat::WireTypeForFieldType(field.type())) {
    case WireFormatLite::WIRETYPE_FIXED64:
      return 8;
    case WireFormatLite::WIRETYPE_FIXED32:
      return 4;
    default:
      return 0;
  }
}

class Walk {
 public:
  Walk(CodedInputStream& in, WireScan& scan) : in_(in), scan_(scan) {}

  // Returns false if the bytes are malformed. REQUIRES: the stream has a limit. The types of
  // requests do not contain themselves, so the recursion is as deep as they are.
  bool message(const Descriptor& type) {
    while (const std::uint32_t tag = in_.ReadTag()) {
      if (WireFormatLite::GetTagFieldNumber(tag) == 0) return false;
      const Field field = field_of(type, tag);
      if (!(field.spelling == Spelling::kUnknown ? skip_unknown(tag) : known(field, tag)))
        return false;
    }
    return in_.ConsumedEntireMessage();
  }

 private:
  bool skip_unknown(std::uint32_t tag) {
    ++scan_.unknown_fields;
    return WireFormatLite::SkipField(&in_, tag);
  }

  bool known(const Field& field, std::uint32_t tag) {
    std::uint64_t& count = count_of(field.descriptor);
    if (field.spelling == Spelling::kPlain) {
      ++count;
      return WireFormatLite::SkipField(&in_, tag);
    }
    int length = 0;
    if (!in_.ReadVarintSizeAsInt(&length)) return false;
    switch (field.spelling) {
      case Spelling::kText:
        count = std::max(count, static_cast<std::uint64_t>(length));
        return in_.Skip(length);
      case Spelling::kPacked:
        return numbers(width_of(*field.descriptor), length, count);
      default:
        ++count;
        return inner(*field.descriptor->message_type(), length);
    }
  }

  bool inner(const Descriptor& type, int length) {
    if (length > in_.BytesUntilLimit()) return false;  // PushLimit would keep the outer limit
    const auto outer = in_.PushLimit(length);
    if (!message(type)) return false;
    in_.PopLimit(outer);
    return true;
  }

  bool numbers(int width, int length, std::uint64_t& count) {
    if (width != 0) {
      count += static_cast<std::uint64_t>(length / width);
      return length % width == 0 && in_.Skip(length);
    }
    while (length > 0) {
      const void* data = nullptr;
      int size = 0;
      if (!in_.GetDirectBufferPointer(&data, &size)) return false;
      size = std::min(size, length);
      const auto* const bytes = static_cast<const signed char*>(data);
      // The last byte of a number is the one whose highest bit is 0.
      count += static_cast<std::uint64_t>(
          std::count_if(bytes, bytes + size, [](signed char byte) { return byte >= 0; }));
      if (!in_.Skip(size)) return false;
      length -= size;
    }
    return true;
  }

  std::uint64_t& count_of(const FieldDescriptor* field) {
    if (field != last_) {
      last_ = field;
      last_count_ = &scan_.counts[field];
    }
    return *last_count_;
  }

  CodedInputStream& in_;
  WireScan& scan_;
  const FieldDescriptor* last_ = nullptr;
  std::uint64_t* last_count_ = nullptr;
};

// Writes the number in as many bytes as there are, which is more than a small number needs.
void write_length(std::uint8_t* bytes, std::size_t width, std::size_t length) {
  for (std::size_t i = 0; i < width; ++i, length >>= 7)
    bytes[i] = static_cast<std::uint8_t>((length & 0x7f) | (i + 1 < width ? 0x80 : 0));
}

// Moves the fields that the type has to the front. Returns how many bytes they take.
std::size_t compact(std::uint8_t* bytes, std::size_t size, const Descriptor& type) {
  CodedInputStream in(bytes, static_cast<int>(size));
  std::size_t kept = 0;
  const auto position = [&in] { return static_cast<std::size_t>(in.CurrentPosition()); };
  while (true) {
    const std::size_t begin = position();
    const std::uint32_t tag = in.ReadTag();
    if (tag == 0) return kept;
    const Field field = field_of(type, tag);
    std::size_t end = 0;
    if (field.spelling == Spelling::kMessage) {
      const std::size_t prefix = position();
      int length = 0;
      in.ReadVarintSizeAsInt(&length);
      const std::size_t inside = position();
      in.Skip(length);
      const std::size_t inner = compact(bytes + inside, static_cast<std::size_t>(length),
                                        *field.descriptor->message_type());
      write_length(bytes + prefix, inside - prefix, inner);
      end = inside + inner;
    } else {
      WireFormatLite::SkipField(&in, tag);
      if (field.spelling == Spelling::kUnknown) continue;
      end = position();
    }
    std::memmove(bytes + kept, bytes + begin, end - begin);
    kept += end - begin;
  }
}

}  // namespace

std::uint64_t WireScan::count(const FieldDescriptor& field) const {
  const auto found = counts.find(&field);
  return found == counts.end() ? 0 : found->second;
}

std::uint64_t WireScan::count(const Descriptor& type, int field_number) const {
  return count(*type.FindFieldByNumber(field_number));
}

WireScan scan_wire(const grpc::ByteBuffer& bytes, const Descriptor& type) {
  grpc::ByteBuffer shared = bytes;  // the reader needs a mutable buffer; slices are shared
  grpc::ProtoBufferReader reader(&shared);
  CodedInputStream in(&reader);
  in.PushLimit(static_cast<int>(bytes.Length()));
  WireScan scan;
  scan.malformed = !Walk(in, scan).message(type);
  return scan;
}

grpc::ByteBuffer without_unknown_fields(grpc::ByteBuffer bytes, const Descriptor& type) {
  auto flat = std::make_unique<std::string>();
  flat->reserve(bytes.Length());
  std::vector<grpc::Slice> slices;
  if (!bytes.Dump(&slices).ok()) return {};
  bytes.Clear();
  for (grpc::Slice& slice : slices) {
    flat->append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    slice = grpc::Slice();  // not a second copy of the whole
  }
  flat->resize(compact(reinterpret_cast<std::uint8_t*>(flat->data()), flat->size(), type));
  std::string* const kept = flat.release();
  const grpc::Slice slice(
      kept->data(), kept->size(), [](void* string) { delete static_cast<std::string*>(string); },
      kept);
  return {&slice, 1};
}

}  // namespace weft::server
