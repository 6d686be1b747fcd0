// SPDX-License-Identifier: Apache-2.0
#include "files/base/stream_copy.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <climits>

#include "files/base/atomic_file.h"

namespace weft::files {
namespace {

// Waits until the descriptor is ready, or a stop was requested, which `wake` tells. Returns an
// errno.
int wait_for(int fd, short events, int wake) {
  for (;;) {
    pollfd fds[] = {{wake, POLLIN, 0}, {fd, events, 0}};
    const int ready = ::poll(fds, 2, -1);
    if (ready < 0 && errno != EINTR) return errno;
    if (fds[0].revents != 0) return ECANCELED;
    if (ready > 0) return 0;
  }
}

}  // namespace

int copy_stream(int from, int to, const std::stop_token& stop, std::uint64_t limit) {
  const FileDescriptor wake(::eventfd(0, EFD_CLOEXEC));
  if (!wake.is_open()) return errno;
  const std::stop_callback on_stop(stop, [&wake] {
    const std::uint64_t one = 1;
    (void)write_all(wake.get(), &one, sizeof one);
  });
  char block[PIPE_BUF];  // which a pipe that is ready takes without waiting
  for (std::uint64_t copied = 0;;) {
    if (const int problem = wait_for(from, POLLIN, wake.get())) return problem;
    const ssize_t got = ::read(from, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) return 0;
    copied += static_cast<std::uint64_t>(got);
    if (copied > limit) return EFBIG;
    if (const int problem = wait_for(to, POLLOUT, wake.get())) return problem;
    if (!write_all(to, block, static_cast<std::size_t>(got))) return errno;
  }
}

}  // namespace weft::files
