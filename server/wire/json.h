// SPDX-License-Identifier: Apache-2.0
// Messages as JSON, with the names of weft.v1 and all fields that have no presence.
#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace weft::server {

// On several lines, for people.
std::string json_of(const google::protobuf::Message& message);

}  // namespace weft::server
