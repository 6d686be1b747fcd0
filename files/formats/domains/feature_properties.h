// SPDX-License-Identifier: Apache-2.0
// What is read of a feature's properties, whatever the file calls them: members, fields, columns.
//   marker, region            a whole number of 32 bits, or a name
//   marker_name, region_name  the name of that number
//   max_area, max_edge        a positive number
// A text that is a number is that number, as programs write columns without a type; a text of
// blanks is no value. What is none of these, and a second name, is left out with a warning.
//
//   const auto properties = feature_properties(builder, "record 3, field ", property);
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "files/base/error.h"
#include "files/formats/domains/geometry_builder.h"

namespace weft::files {

// A property as the file has it: a number, a text, something else, or nothing.
struct PropertyValue {
  std::optional<double> number;
  std::string text;
  std::string other;  // as errors show it: "true"
};

// Of a table: those of many formats have no nulls, but 0. So a bound of 0 is none.
PropertyValue number_of_table(const std::string& name, double number);

using Properties = std::function<PropertyValue(const char* name)>;

// Errors (kUnreadableInput) name the property: `place` and its name. A value of another kind is an
// error for bounds, and a warning for markers, regions and their names.
Result<GeometryProperties> feature_properties(GeometryBuilder& builder, const std::string& place,
                                              const Properties& properties);

}  // namespace weft::files
