// SPDX-License-Identifier: Apache-2.0
#include "files/base/stream_copy.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "files/base/atomic_file.h"

namespace weft::files {
namespace {

struct Pipe {
  Pipe() {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    out = FileDescriptor(ends[0]);
    in = FileDescriptor(ends[1]);
  }
  FileDescriptor out;
  FileDescriptor in;
};

TEST(StreamCopy, CopiesToTheEnd) {
  const std::string text(50'000, 'x');  // less than a pipe holds, more than a block
  Pipe from;
  Pipe to;
  ASSERT_TRUE(write_all(from.in.get(), text.data(), text.size()));
  from.in.reset();
  EXPECT_EQ(copy_stream(from.out.get(), to.in.get(), {}, text.size()), 0);
  std::string copied(text.size() + 1, '\0');
  std::size_t size = 0;
  while (size < text.size())
    size +=
        static_cast<std::size_t>(::read(to.out.get(), copied.data() + size, copied.size() - size));
  EXPECT_EQ(copied.substr(0, size), text);
}

TEST(StreamCopy, EndsAtItsLimit) {
  Pipe from;
  Pipe to;
  ASSERT_TRUE(write_all(from.in.get(), "12345", 5));
  from.in.reset();
  EXPECT_EQ(copy_stream(from.out.get(), to.in.get(), {}, 4), EFBIG);
}

TEST(StreamCopy, AStopEndsItsWaiting) {
  Pipe from;
  Pipe to;
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(copy_stream(from.out.get(), to.in.get(), stop.get_token()), ECANCELED);
}

}  // namespace
}  // namespace weft::files
