// SPDX-License-Identifier: Apache-2.0
// What a misspelled word of the command line was probably meant to be.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace weft::client {

// "no such command 'mseh'" if the first word is neither a command of `app` nor a flag; otherwise
// empty. `words` are argv.
std::string unknown_command(const CLI::App& app, std::span<char* const> words);

// "did you mean `mesh`?" for the first word that is no command of `app`, or no flag of the command
// that it names; empty if all are known or nothing is near. `words` are argv.
std::string suggestion(const CLI::App& app, std::span<char* const> words);

}  // namespace weft::client
