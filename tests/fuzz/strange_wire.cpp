// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/strange_wire.h"

#include <google/protobuf/wire_format.h>

#include <cstdint>

#include "tests/fuzz/random_message.h"

namespace weft::fuzz {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormat;
using google::protobuf::internal::WireFormatLite;

constexpr int kDeepest = 6;

// In `padding` more bytes than it needs.
std::string varint(std::uint64_t value, std::size_t padding = 0) {
  std::string out;
  for (; value >= 128; value >>= 7) out += static_cast<char>(value | 128);
  out += static_cast<char>(value);
  if (padding == 0) return out;
  out.back() = static_cast<char>(out.back() | 128);
  return out.append(padding - 1, static_cast<char>(128)) + '\0';
}

std::size_t padding(ByteSource& bytes) {
  return bytes.below(16) == 1 ? bytes.below(4) : 0;
}

std::string number(WireFormatLite::WireType wire, ByteSource& bytes) {
  if (wire == WireFormatLite::WIRETYPE_VARINT) return varint(any_number(bytes), padding(bytes));
  std::string out(bytes.take(wire == WireFormatLite::WIRETYPE_FIXED64 ? 8 : 4));
  out.resize(wire == WireFormatLite::WIRETYPE_FIXED64 ? 8 : 4);
  return out;
}

std::string with_length(const std::string& content, ByteSource& bytes) {
  std::uint64_t length = content.size();
  const std::size_t choice = bytes.byte();
  if (choice == 1) length += 1 + bytes.below(9);
  if (choice == 2) length = std::uint64_t{1} << (7 + bytes.below(57));
  return varint(length, padding(bytes)) + content;
}

std::string content_of(const FieldDescriptor* field, ByteSource& bytes, int depth) {
  if (field == nullptr || field->type() == FieldDescriptor::TYPE_STRING)
    return std::string(bytes.take(bytes.below(40)));
  if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE)
    return depth < kDeepest ? strange_wire(*field->message_type(), bytes, depth + 1) : "";
  std::string packed;
  for (std::size_t n = bytes.below(24); n > 0 && bytes.left() > 0; --n)
    packed += number(WireFormat::WireTypeForFieldType(field->type()), bytes);
  return packed;
}

}  // namespace

std::string strange_wire(const Descriptor& type, ByteSource& bytes, int depth) {
  std::string out;
  for (std::size_t n = bytes.below(12); n > 0 && bytes.left() > 0; --n) {
    const std::size_t choice = bytes.byte();
    const FieldDescriptor* field = nullptr;
    if (choice % 8 != 0 && type.field_count() > 0)
      field = type.field(static_cast<int>(choice / 8) % type.field_count());
    WireFormatLite::WireType wire = WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
    if (field != nullptr && !(field->is_packable() && bytes.flag()))
      wire = WireFormat::WireTypeForFieldType(field->type());
    if (field == nullptr || choice == 255)
      wire = static_cast<WireFormatLite::WireType>(bytes.below(8));
    const int number_of_field = field != nullptr ? field->number() : 20 + bytes.two_bytes() % 400;
    out += varint(WireFormatLite::MakeTag(number_of_field, wire), padding(bytes));
    switch (wire) {
      case WireFormatLite::WIRETYPE_LENGTH_DELIMITED:
        out += with_length(content_of(field, bytes, depth), bytes);
        break;
      case WireFormatLite::WIRETYPE_START_GROUP:
        if (depth < kDeepest) out += strange_wire(type, bytes, depth + 1);
        if (bytes.below(16) != 1)
          out +=
              varint(WireFormatLite::MakeTag(number_of_field, WireFormatLite::WIRETYPE_END_GROUP));
        break;
      case WireFormatLite::WIRETYPE_END_GROUP:
        break;
      default:
        out += number(wire, bytes);
    }
  }
  return out;
}

}  // namespace weft::fuzz
