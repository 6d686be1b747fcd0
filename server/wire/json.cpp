// SPDX-License-Identifier: Apache-2.0
#include "server/wire/json.h"

#include <google/protobuf/util/json_util.h>

namespace weft::server {

std::string json_of(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  // Fails for messages of unknown types in it alone.
  (void)google::protobuf::util::MessageToJsonString(message, &text, options);
  return text;
}

}  // namespace weft::server
