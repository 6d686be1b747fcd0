// SPDX-License-Identifier: Apache-2.0
// A screen of its own on the terminal, drawn anew in place. What was on the terminal before, the
// cursor and the echo of keys come back with the destructor.
//
//   TerminalScreen screen;
//   do screen.show(text(screen.size()));
//   while (screen.wait(std::chrono::seconds(1), stop));
//
// REQUIRES: stdout is a terminal. One instance a process; not thread-safe.
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
  // `text` is lines that fit into the size. False if the terminal takes it no more.
  bool show(const std::string& text);
  // False as soon as a stop was asked for or `q` was typed, true when the time is over.
  bool wait(std::chrono::milliseconds time, const std::stop_token& stop);

 private:
  std::optional<termios> before_;  // of stdin, where that is a terminal
};

// `text` as it is sent to a terminal to replace all that its screen shows, without flicker.
std::string redraw(const std::string& text);

}  // namespace weft::client
