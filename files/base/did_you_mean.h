// SPDX-License-Identifier: Apache-2.0
// What a misspelled word was probably meant to be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft::files {

// "did you mean `size`?" of the candidate that takes the fewest insertions, deletions, replacements
// and swaps of neighbouring letters to become `word`, if these are at most two and fewer than half
// of its letters; of equals the first. Otherwise empty.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace weft::files
