// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/source_position.h"

#include <algorithm>

namespace weft::expr {

namespace {

constexpr std::size_t kBefore = 40;  // bytes shown before the caret
constexpr std::size_t kAfter = 32;
constexpr std::size_t kLongestName = 40;

std::string printable(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c == '\t' || c == '\r') c = ' ';
    if (c < ' ' || c > '~') c = '?';
  }
  return result;
}

std::size_t line_begin(std::string_view source, std::size_t offset) {
  const std::size_t newline = source.substr(0, offset).rfind('\n');
  return newline == std::string_view::npos ? 0 : newline + 1;
}

}  // namespace

std::string position(std::string_view source, std::size_t offset) {
  const std::string_view before = source.substr(0, offset);
  const auto newlines = std::count(before.begin(), before.end(), '\n');
  return "line " + std::to_string(newlines + 1) + ", column " +
         std::to_string(offset - line_begin(source, offset) + 1);
}

std::string describe(std::string_view source, std::size_t offset, std::string_view what) {
  const std::size_t line = line_begin(source, offset);
  const std::size_t line_end = std::min(source.find('\n', offset), source.size());
  const bool cut_left = offset - line > kBefore;
  const bool cut_right = line_end - offset > kAfter;
  const std::size_t begin = cut_left ? offset - kBefore : line;
  const std::size_t end = cut_right ? offset + kAfter : line_end;

  std::string text = position(source, offset) + ": " + std::string(what) + "\n  ";
  if (cut_left) text += "...";
  text += printable(source.substr(begin, end - begin));
  if (cut_right) text += "...";
  text += "\n  " + std::string((cut_left ? 3 : 0) + (offset - begin), ' ') + "^";
  return text;
}

std::string quoted(std::string_view text) {
  std::string name = printable(text.substr(0, kLongestName));
  if (text.size() > kLongestName) name += "...";
  return "'" + name + "'";
}

}  // namespace weft::expr
