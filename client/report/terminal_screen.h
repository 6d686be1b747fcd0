// SPDX-License-Identifier: Apache-2.0
// A separate screen on the terminal, redrawn in place. The destructor restores the terminal's
// contents, the cursor and the echo of keys.
//
//   TerminalScreen screen;
//   do screen.show(text(screen.size()));
//   while (screen.wait(std::chrono::seconds(1), stop));
//
// REQUIRES: stdout is a terminal. One instance per process; not thread-safe.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>

#include "client/report/screen_size.h"

namespace weft::client {

class TerminalScreen {
 public:
  TerminalScreen();
  ~TerminalScreen();
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  ScreenSize size() const;
  // `text` is lines that fit into the size. Returns false if the terminal cannot be written to.
  bool show(const std::string& text);
  // Returns false as soon as a stop is requested or `q` is typed, true when the time is over.
  bool wait(std::chrono::milliseconds time, const std::stop_token& stop);

 private:
  std::optional<termios> before_;  // of stdin, if it is a terminal
};

// The bytes that replace a terminal's screen by `text` without flicker.
std::string redraw(const std::string& text);

}  // namespace weft::client
