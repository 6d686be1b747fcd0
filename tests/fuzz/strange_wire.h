// SPDX-License-Identifier: Apache-2.0
// Bytes that are nearly a message: fields of its type, spelled in every way that the wire format
// admits and in some that it does not. Numbers come packed and one by one, lengths and tags in more
// bytes than they need, fields with the wire types of others, fields that the type does not have,
// groups in groups, and now and then a length beyond all bounds.
#pragma once

#include <google/protobuf/descriptor.h>

#include <string>

#include "tests/fuzz/byte_source.h"

namespace weft::fuzz {

std::string strange_wire(const google::protobuf::Descriptor& type, ByteSource& bytes,
                         int depth = 0);

}  // namespace weft::fuzz
