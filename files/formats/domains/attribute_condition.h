// SPDX-License-Identifier: Apache-2.0
// A condition of SQL on the attributes of a feature, for readers without GDAL, as GDAL understands
// it: =, <>, !=, <, <=, >, >=, IN, LIKE, ILIKE, BETWEEN and IS NULL, with AND, OR, NOT and
// parentheses. Names are in double quotation marks or bare, in capitals or not; texts are in single
// ones. = takes no notice of capitals, nor does ILIKE; LIKE does. What is compared with an
// attribute that is not there is neither true nor false.
//
//   const auto condition = AttributeCondition::parse("Layer = 'CUT' AND NOT Linetype LIKE 'DASH%'",
//                                                    names);
//   if (condition->holds([&](std::size_t attribute) { return ...; })) ...
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "files/base/error.h"

namespace weft::files {

// Nothing, a number or a text.
using AttributeValue = std::variant<std::monostate, double, std::string>;
// By the number of an attribute in the list of their names.
using AttributeValues = std::function<AttributeValue(std::size_t attribute)>;

class AttributeCondition {
 public:
  // Errors (kUnreadableInput) are a sentence that says what is wrong, and where in the text. An
  // empty text holds of all.
  static Result<AttributeCondition> parse(std::string_view text,
                                          std::span<const std::string_view> attributes);

  bool holds(const AttributeValues& values) const {
    return !test_ || test_(values).value_or(false);
  }

 private:
  std::function<std::optional<bool>(const AttributeValues&)> test_;
};

}  // namespace weft::files
