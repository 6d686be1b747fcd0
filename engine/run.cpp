// SPDX-License-Identifier: Apache-2.0
#include "weft/run.h"

#include "engine/base/context.h"

namespace weft {

ThreadPool::ThreadPool(int threads) : arena_(std::make_unique<Arena>(threads)) {}
ThreadPool::~ThreadPool() = default;

int ThreadPool::threads() const {
  return arena_->threads();
}

Run::Run(const Budget& budget) : context_(std::make_unique<ExecutionContext>(budget)) {}
Run::~Run() = default;

void Run::set_deadline(Clock::time_point deadline) noexcept {
  context_->set_deadline(deadline);
}
void Run::set_threads(ThreadPool& pool, int threads) noexcept {
  context_->set_arena(*pool.arena_, threads);
}
void Run::set_memory(MemorySource& source, std::uint64_t granted) noexcept {
  context_->set_memory(source, granted);
}
void Run::begin_again() noexcept {
  context_->begin_again();
}

void Run::cancel() noexcept {
  context_->cancel();
}
std::optional<Error> Run::poll() const {
  return context_->poll();
}
Progress Run::progress() const noexcept {
  return context_->progress();
}
std::uint64_t Run::pulse() const noexcept {
  return context_->pulse();
}

}  // namespace weft
