// SPDX-License-Identifier: Apache-2.0
// Sentences from parts: say("vertex ", 3, " at ", point). Doubles are written shortest such that
// they read back as the same double, whatever the locale.
#pragma once

#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

#include "checker/domain.h"

namespace weft::check {

inline void append_text(std::string& out, std::string_view part) {
  out += part;
}

template <class Number>
requires std::integral<Number> || std::floating_point<Number>
void append_text(std::string& out, Number value) {
  char digits[64];
  out.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

inline void append_text(std::string& out, Vec2 p) {
  out += '(';
  append_text(out, p.x);
  out += ", ";
  append_text(out, p.y);
  out += ')';
}

template <class... Parts>
std::string say(const Parts&... parts) {
  std::string out;
  (append_text(out, parts), ...);
  return out;
}

}  // namespace weft::check
