// SPDX-License-Identifier: Apache-2.0
#include "wire/options.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

// The numbers of the fields on the path; {0, 0} if there is no such field.
std::array<std::uint32_t, 2> numbers_of(std::string_view path, const FieldDescriptor*& last) {
  const std::size_t dot = path.find('.');
  last = v1::GenerateMeshRequest::descriptor()->FindFieldByName(std::string(path.substr(0, dot)));
  if (last == nullptr) return {};
  const auto first = static_cast<std::uint32_t>(last->number());
  if (dot == path.npos) return {first, 0};
  last = last->message_type()->FindFieldByName(std::string(path.substr(dot + 1)));
  if (last == nullptr) return {};
  return {first, static_cast<std::uint32_t>(last->number())};
}

Option::Kind kind_of(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return Option::Kind::kSwitch;
    case FieldDescriptor::CPPTYPE_ENUM:
      return Option::Kind::kChoice;
    case FieldDescriptor::CPPTYPE_STRING:
      return Option::Kind::kText;
    case FieldDescriptor::CPPTYPE_UINT32:
      return Option::Kind::kCount;
    case FieldDescriptor::CPPTYPE_UINT64:
      return Option::Kind::kLargeCount;
    default:
      return Option::Kind::kNumber;
  }
}

TEST(OptionTable, HaveTheNumbersAndTheKindsOfTheirFields) {
  for (const Option& option : kOptions) {
    const FieldDescriptor* field = nullptr;
    EXPECT_EQ(option.numbers, numbers_of(option.field, field)) << option.field;
    ASSERT_NE(field, nullptr) << option.field;
    EXPECT_EQ(option.kind, kind_of(*field)) << option.field;
    if (option.kind != Option::Kind::kChoice) continue;
    const auto& values = *field->enum_type();
    ASSERT_EQ(option.names.size() + 1, static_cast<std::size_t>(values.value_count()));
    for (std::size_t i = 0; i < option.names.size(); ++i) {
      std::string name(option.names[i]);
      std::transform(name.begin(), name.end(), name.begin(), ::toupper);
      EXPECT_TRUE(values.FindValueByNumber(static_cast<int>(i) + 1)->name().ends_with("_" + name));
    }
  }
}

bool has_option(const std::string& path) {
  return std::any_of(kOptions.begin(), kOptions.end(),
                     [&](const Option& option) { return option.field == path; });
}

// Fields of a stream, which are no options.
bool is_of_the_stream(const std::string& path) {
  return path == "first_chunk" || path == "no_cache";
}

TEST(OptionTable, AreAllFieldsThatAreOneValue) {
  const Descriptor& request = *v1::GenerateMeshRequest::descriptor();
  const auto expect = [](const FieldDescriptor& field, const std::string& path) {
    if (field.is_repeated() || field.message_type() != nullptr || is_of_the_stream(path)) return;
    EXPECT_TRUE(has_option(path)) << path;
  };
  for (int i = 0; i < request.field_count(); ++i) {
    const FieldDescriptor& field = *request.field(i);
    expect(field, field.name());
    if (field.message_type() == nullptr) continue;
    for (int k = 0; k < field.message_type()->field_count(); ++k)
      expect(*field.message_type()->field(k),
             field.name() + '.' + field.message_type()->field(k)->name());
  }
}

}  // namespace
}  // namespace weft::wire
