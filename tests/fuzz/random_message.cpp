// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/random_message.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/unknown_field_set.h>

#include <array>
#include <limits>
#include <string>

namespace weft::fuzz {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr int kDeepest = 4;

void set(Message& message, const FieldDescriptor& field, ByteSource& bytes, int depth) {
  const Reflection& reflection = *message.GetReflection();
  const auto put = [&](auto setter, auto adder, auto value) {
    if (field.is_repeated())
      (reflection.*adder)(&message, &field, value);
    else
      (reflection.*setter)(&message, &field, value);
  };
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return put(&Reflection::SetInt32, &Reflection::AddInt32,
                 static_cast<std::int32_t>(any_number(bytes)));
    case FieldDescriptor::CPPTYPE_INT64:
      return put(&Reflection::SetInt64, &Reflection::AddInt64,
                 static_cast<std::int64_t>(any_number(bytes)));
    case FieldDescriptor::CPPTYPE_UINT32:
      return put(&Reflection::SetUInt32, &Reflection::AddUInt32,
                 static_cast<std::uint32_t>(any_number(bytes)));
    case FieldDescriptor::CPPTYPE_UINT64:
      return put(&Reflection::SetUInt64, &Reflection::AddUInt64, any_number(bytes));
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return put(&Reflection::SetDouble, &Reflection::AddDouble, any_double(bytes));
    case FieldDescriptor::CPPTYPE_FLOAT:
      return put(&Reflection::SetFloat, &Reflection::AddFloat,
                 static_cast<float>(bytes.byte()) - 128);
    case FieldDescriptor::CPPTYPE_BOOL:
      return put(&Reflection::SetBool, &Reflection::AddBool, bytes.flag());
    case FieldDescriptor::CPPTYPE_ENUM:
      return put(&Reflection::SetEnumValue, &Reflection::AddEnumValue,
                 static_cast<int>(bytes.byte()) - 1);
    case FieldDescriptor::CPPTYPE_STRING:
      return put(&Reflection::SetString, &Reflection::AddString,
                 std::string(bytes.take(bytes.below(40))));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (depth < kDeepest)
        fill(field.is_repeated() ? *reflection.AddMessage(&message, &field)
                                 : *reflection.MutableMessage(&message, &field),
             bytes, depth + 1);
  }
}

}  // namespace

double any_double(ByteSource& bytes) {
  constexpr std::array<double, 12> kNasty{std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity(),
                                          -std::numeric_limits<double>::infinity(),
                                          std::numeric_limits<double>::max(),
                                          -std::numeric_limits<double>::max(),
                                          std::numeric_limits<double>::denorm_min(),
                                          -0.0,
                                          1e-300,
                                          1e154,
                                          34,
                                          0.5,
                                          1e-9};
  const std::size_t choice = bytes.byte();
  if (choice < kNasty.size()) return kNasty[choice];
  return static_cast<double>(choice) - 16;
}

std::uint64_t any_number(ByteSource& bytes) {
  const std::uint64_t choice = bytes.byte();
  if (choice < 200) return choice;
  return std::uint64_t{bytes.byte()} << (choice - 200) | (choice & 1 ? ~std::uint64_t{0} << 32 : 0);
}

void fill(Message& message, ByteSource& bytes, int depth) {
  const auto& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count() && bytes.left() > 0; ++i) {
    const std::size_t wish = bytes.byte();
    if (wish % 2 == 0) continue;
    const FieldDescriptor& field = *type.field(i);
    const std::size_t times = field.is_repeated() ? wish / 2 % 32 : 1;
    for (std::size_t n = 0; n < times && bytes.left() > 0; ++n) set(message, field, bytes, depth);
  }
  if (bytes.left() > 0 && bytes.below(16) == 1)
    message.GetReflection()->MutableUnknownFields(&message)->AddVarint(
        1 + static_cast<int>(bytes.two_bytes() % 18'000), any_number(bytes));
}

}  // namespace weft::fuzz
