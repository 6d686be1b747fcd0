// SPDX-License-Identifier: Apache-2.0
// Bytes as a protobuf message of a given type: fields of all kinds, nested ones, unknown ones,
// packed arrays and strings that are no UTF-8, all as the bytes choose.
#pragma once

#include <google/protobuf/message.h>

#include "tests/fuzz/byte_source.h"

namespace weft::fuzz {

// Sets fields until the bytes are used up, or each was passed once.
void fill(google::protobuf::Message& message, ByteSource& bytes, int depth = 0);

// What a hostile double or number looks like; mostly small whole numbers, so that domains come out.
double any_double(ByteSource& bytes);
std::uint64_t any_number(ByteSource& bytes);

}  // namespace weft::fuzz
