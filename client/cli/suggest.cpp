// SPDX-License-Identifier: Apache-2.0
#include "client/cli/suggest.h"

#include <algorithm>
#include <string_view>

#include "client/base/files.h"
#include "files/base/did_you_mean.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

bool is_known(const std::string& word, const std::vector<std::string>& candidates) {
  return std::find(candidates.begin(), candidates.end(), word) != candidates.end();
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  return commands;
}

}  // namespace

std::string unknown_command(const CLI::App& app, std::span<char* const> words) {
  if (words.size() < 2) return "";
  const std::string first = words[1];
  if (first.starts_with("-") || is_known(first, commands_of(app))) return "";
  return "no such command " + in_quotes(first);
}

std::string suggestion(const CLI::App& app, std::span<char* const> words) {
  const std::vector<std::string> commands = commands_of(app);
  if (words.size() < 2) return "";
  const std::string first = words[1];
  if (first.starts_with("-")) return "";
  if (!is_known(first, commands)) return did_you_mean(first, commands);

  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_subcommand(first)->get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  for (const std::string_view word : words.subspan(2)) {
    if (word == "--") break;
    const std::string flag(word.substr(0, word.find('=')));
    if (!flag.starts_with("--") || is_known(flag, flags)) continue;
    return did_you_mean(flag, flags);
  }
  return "";
}

}  // namespace weft::client
