// SPDX-License-Identifier: Apache-2.0
// What a misspelled word of the command line was probably meant to be.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weft::client {

// The candidate that takes the fewest insertions, deletions, replacements and swaps of neighbouring
// letters to become `word`, if these are at most two and fewer than half of its letters; of equals
// the first. Otherwise empty.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

// "did you mean `mesh`?" for the first word that is no command of `app`, or no flag of the command
// that it names; empty if all are known or nothing is near. `words` are argv.
std::string suggestion(const CLI::App& app, std::span<char* const> words);

}  // namespace weft::client
