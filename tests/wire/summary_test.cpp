// SPDX-License-Identifier: Apache-2.0
#include "wire/summary.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {
namespace {

using google::protobuf::FieldDescriptor;

std::optional<double> number_of(const google::protobuf::Message& message,
                                const FieldDescriptor* field) {
  const auto& reflection = *message.GetReflection();
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.GetDouble(message, field);
    case FieldDescriptor::CPPTYPE_UINT32:
      return reflection.GetUInt32(message, field);
    case FieldDescriptor::CPPTYPE_UINT64:
      return static_cast<double>(reflection.GetUInt64(message, field));
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.GetBool(message, field);
    default:
      return std::nullopt;
  }
}

// Compares all numbers of the message with the figures of their names. Returns how many there are.
int compare(const google::protobuf::Message& message, const Summary& summary,
            const std::string& path) {
  int numbers = 0;
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->is_repeated()) continue;
    if (field->message_type() != nullptr) {
      numbers += compare(message.GetReflection()->GetMessage(message, field), summary,
                         path + field->name() + '.');
      continue;
    }
    const auto number = number_of(message, field);
    if (!number) continue;
    EXPECT_EQ(figure(summary, 3, path + field->name()), number) << path << field->name();
    ++numbers;
  }
  return numbers;
}

TEST(Figure, IsTheNumberThatTheMessageHas) {
  Summary summary;
  summary.vertices = 1;
  summary.area = 2.5;
  summary.streamed = true;
  summary.unrefined = {11, 12, 61, 13, 27, 28, 29};
  summary.unrefined_at = {30, 31};
  summary.kept_at = {62, 63};
  summary.merging = {32, 33, 34, 35, {36, 37}, 38, {39, 40}};
  summary.overlap = {3, 0.5, true};
  summary.narrow = NarrowPlace{51, 52, {53, 54}, 55, 56, 57, 58};
  summary.outside = {65, 66, {67, 68}};
  summary.simplified = Simplification{57, 58, 59, 60, 63, 64, 61, 62, {{71, 72}, {73, 74}}};
  summary.sampled_bounds = {75, 76};
  summary.expected_triangles = 77.5;
  summary.engine_seconds = 18;
  v1::Summary message;
  ASSERT_TRUE(message.ParseFromString(write_summary(summary, 3)));
  EXPECT_EQ(message.GetReflection()->GetUnknownFields(message).field_count(), 0);
  EXPECT_EQ(compare(message, summary, ""), 5 + 11 + 9 + 3 + 8 + 4 + 8 + 1);
  EXPECT_EQ(figure(summary, 3, "exact_predicates"), 0);
  EXPECT_EQ(message.expected_triangles(), 77u);
  const auto& bounds = message.sampled_bounds();
  EXPECT_EQ(std::vector<double>(bounds.begin(), bounds.end()), (std::vector<double>{75, 76}));
  const auto& cuts = message.simplification().cuts();
  EXPECT_EQ(std::vector<double>(cuts.begin(), cuts.end()), (std::vector<double>{71, 72, 73, 74}));
}

TEST(Figure, IsNothingIfThereIsNoSuchNumber) {
  EXPECT_EQ(figure({}, 1, "narrow.width"), std::nullopt);
  EXPECT_EQ(figure({}, 1, "unrefined"), std::nullopt);
  EXPECT_EQ(figure({}, 1, "unrefined."), std::nullopt);
  EXPECT_EQ(figure({}, 1, "engine_version"), std::nullopt);
  EXPECT_EQ(figure({}, 1, ""), std::nullopt);
}

}  // namespace
}  // namespace weft::wire
