// SPDX-License-Identifier: Apache-2.0
#include "client/report/picture_terminal.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>

#include "client/base/option_row.h"
#include "files/base/atomic_file.h"

namespace weft::client {
namespace {

constexpr char kEscape = '\033';
// Asks for a picture of one pixel in kitty's protocol, which is checked but not shown; then for the
// attributes of the device (DA1), in which 4 stands for sixel.
constexpr std::string_view kQuestion = "\033_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\033\\\033[c";
constexpr std::size_t kLongestAnswer = 256;

// While it lives, keys are read at once and are not echoed.
class RawKeys {
 public:
  RawKeys() {
    is_set_ = ::tcgetattr(STDIN_FILENO, &before_) == 0;
    termios keys = before_;
    keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    keys.c_cc[VMIN] = 0;
    keys.c_cc[VTIME] = 0;
    is_set_ = is_set_ && ::tcsetattr(STDIN_FILENO, TCSANOW, &keys) == 0;
  }
  ~RawKeys() {
    if (is_set_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  RawKeys(const RawKeys&) = delete;
  RawKeys& operator=(const RawKeys&) = delete;

  explicit operator bool() const { return is_set_; }

 private:
  termios before_{};
  bool is_set_ = false;
};

bool is_one_terminal() {
  std::array<struct stat, 3> all{};
  for (int fd = 0; fd < 3; ++fd)
    if (::isatty(fd) == 0 || ::fstat(fd, &all[static_cast<std::size_t>(fd)]) != 0) return false;
  return all[0].st_rdev == all[1].st_rdev && all[1].st_rdev == all[2].st_rdev &&
         ::tcgetpgrp(STDIN_FILENO) == ::getpgrp();
}

bool may_be_asked() {
  const char* const term = std::getenv("TERM");
  const std::string_view name = term == nullptr ? "" : term;
  constexpr std::array<std::string_view, 4> kOthers = {"dumb", "linux", "screen", "tmux"};
  return !name.empty() && std::none_of(kOthers.begin(), kOthers.end(),
                                       [name](auto other) { return name.starts_with(other); });
}

bool is_something_typed() {
  int bytes = 0;
  return ::ioctl(STDIN_FILENO, FIONREAD, &bytes) != 0 || bytes > 0;
}

// WEFT_TERMINAL_WAIT, in seconds, if it is a number up to a minute.
std::chrono::duration<double> patience() {
  constexpr double kDefault = 0.2;
  constexpr double kMax = 60;
  const char* const text = std::getenv("WEFT_TERMINAL_WAIT");
  const auto seconds = text == nullptr ? std::nullopt : value_of<double>(text);
  return std::chrono::duration<double>(seconds && *seconds >= 0 && *seconds <= kMax ? *seconds
                                                                                    : kDefault);
}

std::optional<PictureProtocol> ask() {
  using Clock = std::chrono::steady_clock;
  const RawKeys raw;
  if (!raw || is_something_typed()) return std::nullopt;
  if (!write_all(STDOUT_FILENO, kQuestion.data(), kQuestion.size())) return std::nullopt;
  PictureAnswers answers;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(patience());
  while (!answers.complete()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    const int count = left > 0 ? ::poll(&keys, 1, static_cast<int>(left)) : 0;
    if (count < 0 && errno == EINTR) continue;
    char byte = 0;  // one byte at a time: what follows the answer belongs to others
    if (count <= 0 || ::read(STDIN_FILENO, &byte, 1) != 1) break;
    answers.add({&byte, 1});
  }
  return answers.protocol();
}

std::uint32_t small_side() {
  constexpr double kUnknown = 400;
  constexpr double kMin = 200;
  constexpr double kMax = 800;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_xpixel == 0 || size.ws_ypixel == 0)
    return static_cast<std::uint32_t>(kUnknown);
  return static_cast<std::uint32_t>(
      std::clamp(std::min(0.5 * size.ws_xpixel, 0.6 * size.ws_ypixel), kMin, kMax));
}

bool has_attribute(std::string_view list, std::string_view wanted) {
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t end = std::min(list.find(';', start), list.size());
    if (list.substr(start, end - start) == wanted) return true;
    start = end + 1;
  }
  return false;
}

}  // namespace

void PictureAnswers::add(std::string_view bytes) {
  for (const char byte : bytes) {
    if (byte == kEscape && !sequence_.starts_with("\033_")) sequence_.clear();
    if (sequence_.empty() && byte != kEscape) continue;  // typed
    sequence_ += byte;
    end_sequence();
    if (sequence_.size() > kLongestAnswer) sequence_.clear();
  }
}

// ESC _ G i=31;OK ESC \ and ESC [ ? 62 ; 4 c
void PictureAnswers::end_sequence() {
  const std::string_view all = sequence_;
  if (all.starts_with("\033_")) {
    if (!all.ends_with("\033\\")) return;
    kitty_ = kitty_ || (all.starts_with("\033_Gi=31") && all.ends_with(";OK\033\\"));
  } else if (all.starts_with("\033[")) {
    const char last = all.back();
    if (all.size() < 3 || last < '@' || last > '~') return;  // its parameters
    if (all.starts_with("\033[?") && last == 'c') {
      complete_ = true;
      sixel_ = has_attribute(all.substr(3, all.size() - 4), "4");
    }
  } else if (all.size() < 2) {
    return;
  }
  sequence_.clear();
}

std::optional<PictureProtocol> PictureAnswers::protocol() const {
  if (kitty_) return PictureProtocol::kKitty;
  if (sixel_) return PictureProtocol::kSixel;
  return std::nullopt;
}

std::optional<PictureTerminal> find_picture_terminal() {
  if (!is_one_terminal() || !may_be_asked()) return std::nullopt;
  const auto protocol = ask();
  if (!protocol) return std::nullopt;
  return PictureTerminal{*protocol, small_side()};
}

}  // namespace weft::client
