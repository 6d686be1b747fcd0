// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/lexer.h"

#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include "engine/size/expression/source_position.h"

namespace weft::expr {

namespace {

// Not <cctype>: its answers depend on the locale.
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

// Longer ones first.
constexpr std::array<std::string_view, 19> kSymbols = {"||", "&&", "<=", ">=", "==", "!=", "?",
                                                       ":",  "!",  "<",  ">",  "+",  "-",  "*",
                                                       "/",  "^",  "(",  ")",  ","};

// What users of other languages write.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kForeign = {{
    {"**", "a power is written ^"},
    {"=", "equality is written =="},
    {"&", "logical and is written &&"},
    {"|", "logical or is written ||"},
    {"%", "there is no remainder operator"},
}};

std::string hexadecimal(unsigned char byte) {
  constexpr std::string_view digits = "0123456789abcdef";
  return {'0', 'x', digits[byte >> 4], digits[byte & 15]};
}

}  // namespace

Token Lexer::take(Token::Kind kind, std::size_t length) {
  Token token{.kind = kind, .text = source_.substr(at_, length), .offset = at_, .problem = {}};
  at_ += length;
  return token;
}

Token Lexer::next() {
  while (at_ < source_.size() && is_space(source_[at_])) ++at_;
  if (at_ == source_.size()) return take(Token::Kind::kEnd, 0);
  const char c = source_[at_];
  if (is_digit(c) || c == '.') return number();
  if (is_letter(c)) return name();
  return symbol();
}

Token Lexer::number() {
  std::size_t end = at_;
  const auto digits = [&] {
    while (end < source_.size() && (is_digit(source_[end]) || source_[end] == '.')) ++end;
  };
  digits();
  // An e begins an exponent only if digits follow: "2e" is a number and a name.
  if (end < source_.size() && (source_[end] == 'e' || source_[end] == 'E')) {
    std::size_t exponent = end + 1;
    if (exponent < source_.size() && (source_[exponent] == '+' || source_[exponent] == '-')) {
      ++exponent;
    }
    if (exponent < source_.size() && is_digit(source_[exponent])) {
      end = exponent;
      digits();
    }
  }
  Token token = take(Token::Kind::kNumber, end - at_);
  const char* const last = token.text.data() + token.text.size();
  const auto [stop, error] = std::from_chars(token.text.data(), last, token.value);
  if (stop != last) {
    token.kind = Token::Kind::kBad;
    token.problem = "malformed number " + quoted(token.text);
  } else if (error != std::errc{}) {
    token.kind = Token::Kind::kBad;
    token.problem = "the number " + quoted(token.text) + " is outside the range of a double";
  }
  return token;
}

Token Lexer::name() {
  std::size_t end = at_;
  while (end < source_.size() && (is_letter(source_[end]) || is_digit(source_[end]))) ++end;
  return take(Token::Kind::kName, end - at_);
}

Token Lexer::symbol() {
  const std::string_view rest = source_.substr(at_);
  const auto bad = [&](std::size_t length, std::string problem) {
    Token token = take(Token::Kind::kBad, length);
    token.problem = std::move(problem);
    return token;
  };
  if (rest.starts_with("**")) return bad(2, std::string(kForeign[0].second));
  for (std::string_view symbol : kSymbols) {
    if (rest.starts_with(symbol)) return take(Token::Kind::kSymbol, symbol.size());
  }
  for (const auto& [symbol, advice] : kForeign) {
    if (rest.starts_with(symbol)) {
      return bad(1, "unexpected " + quoted(symbol) + "; " + std::string(advice));
    }
  }
  const auto byte = static_cast<unsigned char>(rest[0]);
  if (byte > ' ' && byte <= '~') return bad(1, "unexpected character " + quoted(rest.substr(0, 1)));
  return bad(1, "unexpected byte " + hexadecimal(byte) +
                    "; an expression is printable ASCII, spaces and newlines");
}

}  // namespace weft::expr
