// SPDX-License-Identifier: Apache-2.0
#include "wire/named_options.h"

#include <google/protobuf/message.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace weft::wire {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

std::string shortest(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

// What people call a value, such as "lattice" of PLACEMENT_LATTICE.
std::string name_of(const EnumDescriptor& type, int index) {
  std::string name = type.value(index)->name().substr(type.name().size() + 1);
  std::transform(name.begin(), name.end(), name.begin(), ::tolower);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

// All but the first value, which stands for none of them.
std::string names_of(const EnumDescriptor& type, const char* between, const char* last) {
  std::string list;
  for (int i = 1; i < type.value_count(); ++i)
    list += (i == 1 ? "" : i + 1 == type.value_count() ? last : between) + name_of(type, i);
  return list;
}

NamedOption option_at(const FieldDescriptor* part, const FieldDescriptor& field) {
  NamedOption option{(part == nullptr ? "" : part->name() + '.') + field.name(),
                     field.options().GetExtension(v1::option), part, &field};
  v1::Option& annotation = option.annotation;
  if (annotation.name().empty()) {
    annotation.set_name(field.name());
    std::replace(annotation.mutable_name()->begin(), annotation.mutable_name()->end(), '_', '-');
  }
  if (annotation.variable().empty()) {
    std::string& variable = *annotation.mutable_variable();
    variable = "WEFT_" + annotation.name();
    std::transform(variable.begin(), variable.end(), variable.begin(),
                   [](char c) { return c == '-' ? '_' : static_cast<char>(std::toupper(c)); });
  }
  if (field.enum_type() != nullptr) annotation.set_unit(names_of(*field.enum_type(), "|", "|"));
  return option;
}

void add_options(const Descriptor& message, const FieldDescriptor* part,
                 std::vector<NamedOption>& options) {
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    if (field.options().HasExtension(v1::option)) options.push_back(option_at(part, field));
    if (part == nullptr && field.message_type() != nullptr)
      add_options(*field.message_type(), &field, options);
  }
}

std::optional<double> number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || std::isnan(value)) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> count_of(std::string_view text) {
  const bool is_hex = text.starts_with("0x");
  if (is_hex) text.remove_prefix(2);
  std::uint64_t value = 0;
  const auto [end, problem] =
      std::from_chars(text.data(), text.data() + text.size(), value, is_hex ? 16 : 10);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<int> choice_of(const EnumDescriptor& type, const std::string& text) {
  for (int i = 1; i < type.value_count(); ++i)
    if (name_of(type, i) == text) return type.value(i)->number();
  return std::nullopt;
}

std::optional<bool> switch_of(const std::string& text) {
  if (text == "true" || text == "1" || text == "on" || text == "yes") return true;
  if (text == "false" || text == "0" || text == "off" || text == "no") return false;
  return std::nullopt;
}

// What the value is not; empty if it is within the bounds.
std::string out_of_range(const NamedOption& option, double value) {
  const v1::Option& bounds = option.annotation;
  const bool is_within =
      (!bounds.has_min() || value >= bounds.min()) && (!bounds.has_max() || value <= bounds.max());
  return is_within ? "" : "in the range " + option.range();
}

// What the text is not; empty if it was set.
std::string set_field(const NamedOption& option, const std::string& text, Message& message) {
  const auto& reflection = *message.GetReflection();
  const FieldDescriptor* const field = option.field;
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL: {
      const auto value = switch_of(text);
      if (!value) return "true or false";
      reflection.SetBool(&message, field, *value);
      return "";
    }
    case FieldDescriptor::CPPTYPE_ENUM: {
      const auto value = choice_of(*field->enum_type(), text);
      if (!value) return names_of(*field->enum_type(), ", ", " or ");
      reflection.SetEnumValue(&message, field, *value);
      return "";
    }
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      const auto value = number_of(text);
      if (!value) return "a number";
      std::string fault = out_of_range(option, *value);
      if (fault.empty()) reflection.SetDouble(&message, field, *value);
      return fault;
    }
    default: {  // a count
      const auto value = count_of(text);
      const bool is_small = field->cpp_type() == FieldDescriptor::CPPTYPE_UINT32;
      if (!value || (is_small && *value > UINT32_MAX)) return "a count";
      std::string fault = out_of_range(option, static_cast<double>(*value));
      if (!fault.empty()) return fault;
      if (is_small)
        reflection.SetUInt32(&message, field, static_cast<std::uint32_t>(*value));
      else
        reflection.SetUInt64(&message, field, *value);
      return "";
    }
  }
}

}  // namespace

std::string NamedOption::range() const {
  if (annotation.has_max()) return shortest(annotation.min()) + " to " + shortest(annotation.max());
  return annotation.has_min() ? shortest(annotation.min()) + " or more" : "";
}

const std::vector<NamedOption>& named_options() {
  static const std::vector<NamedOption> options = [] {
    std::vector<NamedOption> all;
    add_options(*v1::GenerateMeshRequest::descriptor(), nullptr, all);
    return all;
  }();
  return options;
}

std::string set(const NamedOption& option, const std::string& text,
                v1::GenerateMeshRequest& request) {
  if (option.part == nullptr) return set_field(option, text, request);
  const auto& reflection = *request.GetReflection();
  const bool had_part = reflection.HasField(request, option.part);
  std::string fault = set_field(option, text, *reflection.MutableMessage(&request, option.part));
  if (!fault.empty() && !had_part) reflection.ClearField(&request, option.part);
  return fault;
}

}  // namespace weft::wire
