// SPDX-License-Identifier: Apache-2.0
// The C interface: what libweft.so shows. No exception leaves it.
#include "weft/c.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "engine/base/arena.h"
#include "engine/c/c_error.h"
#include "engine/c/c_request.h"
#include "weft/weft.h"
#include "wire/errors.h"
#include "wire/request.h"
#include "wire/summary.h"

struct weft_mesh {
  weft::Mesh mesh;
  std::uint32_t threads;
  std::string summary;  // as a message
};

namespace weft {
namespace {

struct Watcher {
  weft_on_progress* on_progress;
  void* user;
};

std::uint32_t processors() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
    return std::max(1u, std::thread::hardware_concurrency());
  return static_cast<std::uint32_t>(std::max(1, CPU_COUNT(&allowed)));
}

// A run whose estimate is below this takes some milliseconds: other threads, and one to wait, cost
// more than they save. One that takes longer all the same begins again.
constexpr std::uint64_t kShortBytes = std::uint64_t{8} << 20;
constexpr std::chrono::seconds kShort{1};

constexpr std::uint32_t kMaxThreads = 1024;

// Calls the caller's function about ten times a second, until `work` is done on a thread beside it.
template <class F>
Result<Mesh> watched(Run& run, const Watcher& watcher, F&& work) {
  constexpr std::chrono::milliseconds kInterval{100};
  std::mutex mutex;  // guards the result
  std::condition_variable changed;
  std::optional<Result<Mesh>> result;
  std::thread worker([&] {
    Result<Mesh> made = work();
    const std::lock_guard lock(mutex);
    result.emplace(std::move(made));
    changed.notify_one();
  });
  std::unique_lock lock(mutex);
  while (!changed.wait_for(lock, kInterval, [&] { return result.has_value(); })) {
    lock.unlock();
    const Progress now = run.progress();
    const weft_progress told{static_cast<std::int32_t>(now.stage), now.triangles,
                             now.expected_triangles, now.fraction};
    if (watcher.on_progress(&told, watcher.user) != 0) run.cancel();
    lock.lock();
  }
  lock.unlock();
  worker.join();
  return std::move(*result);
}

Run::Clock::time_point deadline_of(double max_seconds) {
  constexpr double kDecades = 1e9;
  const double seconds = max_seconds > 0 ? std::min(max_seconds, kDecades) : kDecades;
  return Run::Clock::now() +
         std::chrono::duration_cast<Run::Clock::duration>(std::chrono::duration<double>(seconds));
}

weft_mesh* finished(Mesh made, std::uint32_t threads, bool want_quadtree) {
  std::string summary = wire::write_summary(made.summary, threads);
  if (want_quadtree) summary += wire::write_leaf_boxes(made.summary);
  return new weft_mesh{std::move(made), threads, std::move(summary)};
}

Result<weft_mesh*> make(std::string_view bytes, const Watcher& watcher) {
  const auto request = wire::read_request(bytes);
  if (!request) return tl::unexpected(request.error());
  Budget budget;
  if (request->max_triangles != 0) budget.max_triangles = request->max_triangles;
  if (request->max_bytes != 0) budget.max_bytes = request->max_bytes;
  const auto deadline = deadline_of(request->max_seconds);
  Run run(budget);
  const auto finish = [&](Result<Mesh> made, std::uint32_t threads) -> Result<weft_mesh*> {
    if (!made) return tl::unexpected(std::move(made).error());
    return finished(std::move(*made), threads, request->want_quadtree);
  };
  if (estimate(request->mesh, budget).bytes < kShortBytes) {
    const auto end = std::min(deadline, Run::Clock::now() + kShort);
    run.set_deadline(end);
    auto made = mesh(request->mesh, run);
    const bool took_long =
        !made && made.error().code == ErrorCode::kDeadlineExceeded && end < deadline;
    if (!took_long) return finish(std::move(made), 1);
    run.begin_again();
  }
  run.set_deadline(deadline);
  const std::uint32_t threads =
      request->threads != 0 ? std::min(request->threads, kMaxThreads) : processors();
  std::optional<ThreadPool> pool;
  [[maybe_unused]] static const int for_children =
      ::pthread_atfork([] { Arena::end_threads(); }, nullptr, nullptr);
  if (threads > 1) run.set_threads(pool.emplace(static_cast<int>(threads)));
  const auto work = [&] { return mesh(request->mesh, run); };
  return finish(watcher.on_progress != nullptr ? watched(run, watcher, work) : work(), threads);
}

}  // namespace

weft_error* error_of(const Error& what) try {
  return new weft_error{what, wire::write_status(wire::failure_of(what), "")};
} catch (const std::bad_alloc&) {
  return nullptr;
}

}  // namespace weft

extern "C" {

weft_mesh* weft_make(const weft_request* request, weft_on_progress* on_progress, void* user,
                     weft_error** error) {
  const auto make = [&]() -> weft::Result<weft_mesh*> {
    if (request->fault) return tl::unexpected(*request->fault);
    return weft::make(request->bytes, {on_progress, user});
  };
  return weft::made_by<weft_mesh>(make, error);
}

weft_mesh* weft_make_message(const void* bytes, size_t size, weft_on_progress* on_progress,
                             void* user, weft_error** error) {
  const std::string_view message(static_cast<const char*>(bytes), size);
  return weft::made_by<weft_mesh>([&] { return weft::make(message, {on_progress, user}); }, error);
}

void weft_mesh_free(weft_mesh* mesh) {
  delete mesh;
}

const char* weft_error_reason(const weft_error* error) {
  return weft::wire::row_of(weft::wire::reason_of(error->error.code)).name.data();
}
const char* weft_error_message(const weft_error* error) {
  return error->error.message.c_str();
}
const char* weft_error_field(const weft_error* error) {
  return error->error.field.c_str();
}
int weft_error_point(const weft_error* error, double* x, double* y) {
  if (!error->error.at) return 0;
  *x = error->error.at->x;
  *y = error->error.at->y;
  return 1;
}
const void* weft_error_status(const weft_error* error, size_t* size) {
  *size = error->status.size();
  return error->status.data();
}
void weft_error_free(weft_error* error) {
  delete error;
}

void weft_mesh_arrays(const weft_mesh* mesh, weft_arrays* arrays) {
  static_assert(sizeof(weft::Point) == 2 * sizeof(double) &&
                sizeof(weft::Box) == 4 * sizeof(double));
  static_assert(sizeof(weft::Chunk::Edge) == 4 * sizeof(std::uint32_t));
  const weft::Mesh& m = mesh->mesh;
  const weft_arrays all{
      .struct_size = arrays->struct_size,
      .vertex_count = m.vertices.size(),
      .triangle_count = m.triangles.size(),
      .edge_count = m.edges.size(),
      .input_point_count = m.input_points.size(),
      .leaf_count = m.summary.leaves.size(),
      .vertices = reinterpret_cast<const double*>(m.vertices.data()),
      .triangles = reinterpret_cast<const std::uint32_t*>(m.triangles.data()),
      .regions = m.regions.empty() ? nullptr : m.regions.data(),
      .edges = reinterpret_cast<const std::uint32_t*>(m.edges.data()),
      .input_points = reinterpret_cast<const std::uint32_t*>(m.input_points.data()),
      .leaves = reinterpret_cast<const double*>(m.summary.leaves.data()),
      .bulges = m.bulges.empty() ? nullptr : m.bulges.data()};
  std::memcpy(arrays, &all, std::min(arrays->struct_size, sizeof all));
}

const void* weft_mesh_summary(const weft_mesh* mesh, size_t* size) {
  *size = mesh->summary.size();
  return mesh->summary.data();
}

int weft_figure(const weft_mesh* mesh, const char* path, double* value) {
  const auto found = weft::wire::figure(mesh->mesh.summary, mesh->threads, path);
  if (found) *value = *found;
  return found.has_value();
}

const char* weft_version(void) {
  return WEFT_VERSION;
}
const char* weft_engine_version(void) {
  return weft::kEngineVersion.data();
}

}  // extern "C"
