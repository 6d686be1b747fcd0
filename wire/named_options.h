// SPDX-License-Identifier: Apache-2.0
// The options of a request: the fields of GenerateMeshRequest that weft.v1.option annotates. Flags,
// variables, keys of manifests and their help are made of them.
//
//   v1::GenerateMeshRequest request;
//   for (const NamedOption& option : named_options())
//     if (option.name() == "min-angle") set(option, "25", request);  // ""
//   // request.quality().min_angle_deg() is 25
#pragma once

#include <google/protobuf/descriptor.h>

#include <string>
#include <string_view>
#include <vector>

#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {

struct NamedOption {
  std::string path;       // as errors call it, such as "quality.min_angle_deg"
  v1::Option annotation;  // with its defaults filled in, but the bounds

  // The message of the request that has the field; null if it is the request itself.
  const google::protobuf::FieldDescriptor* part = nullptr;
  const google::protobuf::FieldDescriptor* field = nullptr;

  const std::string& name() const { return annotation.name(); }
  // What values are within, such as "1 or more"; empty: the server judges it.
  std::string range() const;
  bool is_switch() const {
    return field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_BOOL;
  }
};

// In the order of the request's fields. Made once.
const std::vector<NamedOption>& named_options();

// Sets the option and returns an empty text, or leaves the request alone and returns what the text
// is not, such as "a number" of "much". Numbers are rounded to the nearest, counts may be
// hexadecimal.
std::string set(const NamedOption& option, const std::string& text,
                v1::GenerateMeshRequest& request);

}  // namespace weft::wire
