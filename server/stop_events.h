// SPDX-License-Identifier: Apache-2.0
// What may end the process, and what asks it to reload, as events that one thread waits for:
// SIGTERM, SIGINT, SIGHUP, the end of standard input, and a note from another thread. Signals
// arrive by a file descriptor: nothing runs in a signal handler.
//
// Construct before any other thread starts: they inherit the blocked signals.
#pragma once

namespace weft::server {

class StopEvents {
 public:
  enum class Kind { kSignal, kInputEnded, kNotified };
  struct Event {
    Kind kind;
    int signal;  // of kSignal
  };

  // REQUIRES: no other object of this kind in the process.
  explicit StopEvents(bool watch_input);
  ~StopEvents();
  StopEvents(const StopEvents&) = delete;
  StopEvents& operator=(const StopEvents&) = delete;

  // Waits for the next event. The end of input comes once.
  Event wait();

  // Makes `wait` return kNotified. From any thread.
  void notify();

 private:
  const int signals_;
  const int notes_;
  bool watch_input_;
};

}  // namespace weft::server
