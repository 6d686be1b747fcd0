// SPDX-License-Identifier: Apache-2.0
// Cuts an expression into tokens.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace weft::expr {

struct Token {
  enum class Kind { kNumber, kName, kSymbol, kEnd, kBad };
  Kind kind = Kind::kEnd;
  std::string_view text;
  std::size_t offset = 0;  // of the text in the source
  double value = 0;        // of kNumber; finite
  std::string problem;     // of kBad: what is wrong with it
};

class Lexer {
 public:
  explicit Lexer(std::string_view source) : source_(source) {}

  // Returns the next token; kEnd after the last, however often it is called.
  Token next();

 private:
  Token number();
  Token name();
  Token symbol();
  Token take(Token::Kind kind, std::size_t length);

  std::string_view source_;
  std::size_t at_ = 0;
};

}  // namespace weft::expr
