// SPDX-License-Identifier: Apache-2.0
// Whether the terminal shows pictures, and how large one may be. Terminals do not say so in the
// environment: it is asked, and answers on standard input.
//
//   if (const auto terminal = find_picture_terminal()) ...
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace weft::client {

enum class PictureProtocol : std::uint8_t {
  kSixel,  // of DEC's terminals
  kKitty,  // https://sw.kovidgoyal.net/kitty/graphics-protocol
};

struct PictureTerminal {
  PictureProtocol protocol = PictureProtocol::kSixel;
  std::uint32_t long_side = 0;  // of a small picture, in pixels
};

// What a terminal has answered so far to the question of find_picture_terminal. Answers may come in
// any pieces; what is no answer is passed over.
class PictureAnswers {
 public:
  void add(std::string_view bytes);
  // Every terminal answers the last part of the question, so no more will come.
  bool complete() const { return complete_; }
  std::optional<PictureProtocol> protocol() const;

 private:
  void end_sequence();

  std::string sequence_;  // begun, not ended
  bool complete_ = false;
  bool kitty_ = false;
  bool sixel_ = false;
};

// Asks the terminal, and waits 0.2 s at most for the answer, or WEFT_TERMINAL_WAIT seconds. Returns
// nullopt if it shows no pictures or does not answer; without asking if standard input, output and
// error are not one terminal, of which this process has the foreground, if TERM says that it would
// not pass the question on (screen, tmux) or not understand it, or if something is typed already,
// which stays to be read. What is typed while the answer is awaited is lost. Not thread-safe.
std::optional<PictureTerminal> find_picture_terminal();

}  // namespace weft::client
