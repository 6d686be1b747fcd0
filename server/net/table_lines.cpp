// SPDX-License-Identifier: Apache-2.0
#include "server/net/table_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace weft::server {
namespace {

constexpr std::size_t kLongestName = 128;

// Takes the first word out of the line.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kSpace = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kSpace));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace

std::vector<TableLine> table_lines(std::string_view text) {
  std::vector<TableLine> lines;
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    TableLine row{.number = number};
    for (auto word = next_word(line); !word.empty(); word = next_word(line))
      row.words.push_back(word);
    if (!row.words.empty() && row.words.front().front() != '#') lines.push_back(std::move(row));
  }
  return lines;
}

bool visible_ascii(std::string_view word) {
  return std::ranges::all_of(word, [](char c) { return c > ' ' && c < 0x7f; });
}

tl::unexpected<std::string> bad_line(const TableLine& line, std::string_view reason) {
  return tl::unexpected(fmt::format("line {}: {}", line.number, reason));
}

std::string fault_of_name(std::string_view name) {
  return visible_ascii(name) && name.size() <= kLongestName
             ? ""
             : "a name is up to 128 visible ASCII characters";
}

}  // namespace weft::server
