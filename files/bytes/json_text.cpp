// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/json_text.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace weft::files {
namespace {

std::string place(const std::string& name, std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, offset);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  const std::size_t column =
      start == std::string_view::npos ? before.size() + 1 : before.size() - start;
  return name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

// The place where brackets nest deeper than allowed; brackets in strings do not count.
std::optional<std::size_t> too_deep(std::string_view text, int max_depth) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') {
        ++i;
      } else if (c == '"') {
        in_string = false;
      }
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > max_depth) return i;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return std::nullopt;
}

// The text with null for NaN and Infinity outside of strings, which JSON has no word for, but
// Python writes; empty if there are none.
std::string without_nan(std::string_view text) {
  std::string out;
  bool in_string = false;
  std::size_t copied = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (in_string) {
      if (text[i] == '\\')
        ++i;
      else if (text[i] == '"')
        in_string = false;
      continue;
    }
    in_string = text[i] == '"';
    for (const std::string_view word : {"NaN", "-Infinity", "Infinity"}) {
      if (!text.substr(i).starts_with(word)) continue;
      out += text.substr(copied, i - copied);
      out += "null";
      i += word.size() - 1;
      copied = i + 1;
      break;
    }
  }
  return copied == 0 ? "" : out + std::string(text.substr(copied));
}

// The message of a parse error of the JSON library, without the parts that the caller says itself:
// "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error ...".
std::string reason(std::string_view what) {
  if (const std::size_t end = what.find("] "); end != std::string_view::npos)
    what.remove_prefix(end + 2);
  if (what.starts_with("parse error"))
    if (const std::size_t end = what.find(": "); end != std::string_view::npos)
      what.remove_prefix(end + 2);
  std::string out;
  for (const char c : what.substr(0, 300)) out += c >= 0x20 && c < 0x7f ? c : '?';
  return out;
}

}  // namespace

Result<nlohmann::json> parse_json(const std::string& name, std::string_view text, int max_depth) {
  if (const auto offset = too_deep(text, max_depth))
    return fail(ExitCode::kUnreadableInput, place(name, text, *offset) + "nested deeper than " +
                                                std::to_string(max_depth) + " levels");
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    if (const std::string other = without_nan(text); !other.empty())
      return parse_json(name, other, max_depth);
    const std::size_t offset = error.byte > 0 ? error.byte - 1 : 0;
    return fail(ExitCode::kUnreadableInput,
                place(name, text, std::min(offset, text.size())) + reason(error.what()));
  } catch (const nlohmann::json::exception& error) {
    return fail(ExitCode::kUnreadableInput, name + ": " + reason(error.what()));
  }
}

}  // namespace weft::files
