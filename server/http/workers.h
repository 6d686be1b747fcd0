// SPDX-License-Identifier: Apache-2.0
// Threads that read and write files, which the thread of the connections must not wait for. Work
// that is short never waits behind work that is not.
//
//   Workers::run(workers.for_short(), io, [bytes] { return read(bytes); }, [this](auto read) { ...
//   });
//
// Thread-safe.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <exception>
#include <new>
#include <stdexcept>
#include <tl/expected.hpp>
#include <utility>

#include "server/console/problem.h"

namespace weft::server {

template <class T>
using Outcome = tl::expected<T, Problem>;

inline Problem out_of_memory() {
  return {.status = 429,
          .reason = "OUT_OF_MEMORY",
          .detail = "the server has no memory for this request now",
          .retry = true};
}

class Workers {
 public:
  using Executor = boost::asio::any_io_executor;

  // `threads`: for work that takes long.
  explicit Workers(std::size_t threads) : threads_(threads), long_(threads) {}
  // Waits for what is at work. What has not begun never will.
  void finish() {
    for (boost::asio::thread_pool* const pool : {&short_, &long_}) {
      pool->stop();
      pool->join();
    }
  }

  std::size_t threads() const { return threads_; }
  Executor for_short() { return short_.get_executor(); }
  // What is given to one of these runs one after the other.
  Executor line_for_long() { return boost::asio::make_strand(long_); }

  // `task` returns an Outcome, which `then` gets on the thread of `io`. What it throws is a
  // problem.
  template <class Task, class Then>
  static void run(const Executor& where, boost::asio::io_context& io, Task task, Then then) {
    boost::asio::post(where, [&io, task = std::move(task), then = std::move(then)]() mutable {
      auto outcome = attempt(task);
      boost::asio::post(io, [then = std::move(then), outcome = std::move(outcome)]() mutable {
        then(std::move(outcome));
      });
    });
  }

 private:
  template <class Task>
  static auto attempt(Task& task) -> decltype(task()) try {
    return task();
  } catch (const std::bad_alloc&) {
    return tl::unexpected(out_of_memory());
  } catch (const std::exception& fault) {
    return tl::unexpected(Problem{.status = 500, .reason = "INTERNAL", .detail = fault.what()});
  }

  const std::size_t threads_;
  boost::asio::thread_pool short_{1};
  boost::asio::thread_pool long_;
};

}  // namespace weft::server
