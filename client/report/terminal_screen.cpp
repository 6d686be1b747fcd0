// SPDX-License-Identifier: Apache-2.0
#include "client/report/terminal_screen.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include "client/base/files.h"
#include "files/base/atomic_file.h"

namespace weft::client {
namespace {

constexpr std::string_view kEnter = "\033[?1049h\033[?25l";  // another screen, no cursor
constexpr std::string_view kLeave = "\033[?25h\033[?1049l";

}  // namespace

TerminalScreen::TerminalScreen() {
  termios keys{};
  if (::tcgetattr(STDIN_FILENO, &keys) == 0) {
    before_ = keys;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    ::tcsetattr(STDIN_FILENO, TCSANOW, &keys);
  }
  (void)write_all(STDOUT_FILENO, kEnter.data(), kEnter.size());
}

TerminalScreen::~TerminalScreen() {
  (void)write_all(STDOUT_FILENO, kLeave.data(), kLeave.size());
  if (before_) ::tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

ScreenSize TerminalScreen::size() const {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
    return {};
  return {size.ws_col, size.ws_row};
}

bool TerminalScreen::show(const std::string& text) {
  const std::string sent = redraw(text);
  return write_all(STDOUT_FILENO, sent.data(), sent.size());
}

bool TerminalScreen::wait(std::chrono::milliseconds time, const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  FileDescriptor stopped(::eventfd(0, EFD_CLOEXEC));
  const std::stop_callback wake(stop, [&stopped] {
    const std::uint64_t one = 1;
    (void)write_all(stopped.get(), &one, sizeof one);
  });
  const auto end = Clock::now() + time;
  pollfd fds[] = {{stopped.get(), POLLIN, 0}, {before_ ? STDIN_FILENO : -1, POLLIN, 0}};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    const int count =
        ::poll(fds, 2, static_cast<int>(std::clamp<std::int64_t>(left, 0, 86'400'000)));
    if (count < 0 && errno == EINTR) continue;
    if (fds[0].revents != 0) return false;
    if (count == 0) return true;
    char key = 0;
    if (::read(STDIN_FILENO, &key, 1) != 1 || key == 'q') return false;
  }
}

std::string redraw(const std::string& text) {
  // Each line is cleared before it is written, because afterwards the cursor may stand on its last
  // character. The last line clears all below it, and has no line feed, because that would scroll a
  // full screen.
  std::string out = "\033[H";
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const bool last = end + 1 >= text.size();
    out.append(last ? "\033[J" : "\033[K").append(text, start, end - start);
    if (!last) out += "\r\n";
    start = end + 1;
  }
  return out;
}

}  // namespace weft::client
