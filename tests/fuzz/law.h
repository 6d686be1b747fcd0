// SPDX-License-Identifier: Apache-2.0
// What a fuzz target does with a law that does not hold.
//
// The process ends, as libFuzzer and ctest want it, after the law and the evidence were printed.
// For runs of hours, WEFT_FUZZ_FINDINGS names a folder instead: the input and the evidence are kept
// there as LAW-HASH and LAW-HASH.txt, at most kKept of a law, and the run goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace weft::fuzz {

inline constexpr int kKept = 12;

// `law` is short, without blanks or slashes: the name of a file begins with it.
void broken(std::string_view law, const std::string& evidence, const std::uint8_t* input,
            std::size_t size);

}  // namespace weft::fuzz
