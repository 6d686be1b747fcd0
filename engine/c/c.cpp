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
#include <new>
#include <thread>

#include "engine/base/arena.h"
#include "engine/c/c_request.h"
#include "engine/c/error_names.h"
#include "weft/weft.h"

struct weft_error {
  weft::Error error;
};

struct weft_mesh {
  weft::Mesh mesh;
  std::uint32_t threads;
};

namespace weft {
namespace {

// A structure as the caller has it, whose end may be missing, over the defaults.
template <class T>
T completed(const T& given, T defaults) {
  std::memcpy(&defaults, &given, std::min(given.struct_size, sizeof(T)));
  return defaults;
}

// Writes as much of it as the caller has room for.
template <class T>
void give(T from, T* to) {
  const std::size_t size = std::min(to->struct_size, sizeof(T));
  from.struct_size = to->struct_size;
  std::memcpy(to, &from, size);
}

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

// Calls the caller's function some times a second, until `work` is done on a thread beside it.
template <class F>
Result<Mesh> watched(Run& run, const weft_control& control, F&& work) {
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
    if (control.on_progress(&told, control.user) != 0) run.cancel();
    lock.lock();
  }
  lock.unlock();
  worker.join();
  return std::move(*result);
}

Run::Clock::time_point deadline_of(const weft_control& control) {
  constexpr double kDecades = 1e9;
  const double seconds =
      control.max_seconds > 0 ? std::min(control.max_seconds, kDecades) : kDecades;
  return Run::Clock::now() +
         std::chrono::duration_cast<Run::Clock::duration>(std::chrono::duration<double>(seconds));
}

Result<weft_mesh*> make(const weft_request& given, const weft_control& control) {
  const auto request = to_engine(given);
  if (!request) return tl::unexpected(request.error());
  if (!(control.max_seconds >= 0))
    return fail(ErrorCode::kBadOption, "budget.max_seconds",
                "budget.max_seconds is negative or not a number");
  Budget budget;
  if (control.max_triangles != 0) budget.max_triangles = control.max_triangles;
  if (control.max_bytes != 0) budget.max_bytes = control.max_bytes;
  const auto deadline = deadline_of(control);
  Run run(budget);
  const auto finish = [](Result<Mesh> made, std::uint32_t threads) -> Result<weft_mesh*> {
    if (!made) return tl::unexpected(std::move(made).error());
    return new weft_mesh{std::move(*made), threads};
  };
  if (estimate(*request, budget).bytes < kShortBytes) {
    const auto end = std::min(deadline, Run::Clock::now() + kShort);
    run.set_deadline(end);
    auto made = mesh(*request, run);
    const bool took_long =
        !made && made.error().code == ErrorCode::kDeadlineExceeded && end < deadline;
    if (!took_long) return finish(std::move(made), 1);
    run.begin_again();
  }
  run.set_deadline(deadline);
  const std::uint32_t threads = control.threads != 0 ? control.threads : processors();
  std::optional<ThreadPool> pool;
  [[maybe_unused]] static const int for_children =
      ::pthread_atfork([] { Arena::end_threads(); }, nullptr, nullptr);
  if (threads > 1) run.set_threads(pool.emplace(static_cast<int>(threads)));
  const auto work = [&] { return mesh(*request, run); };
  return finish(control.on_progress != nullptr ? watched(run, control, work) : work(), threads);
}

}  // namespace
}  // namespace weft

extern "C" {

weft_mesh* weft_make(const weft_request* request, const weft_control* control, weft_error** error) {
  const auto tell = [&](const weft::Error& what) -> weft_mesh* {
    if (error != nullptr) *error = new (std::nothrow) weft_error{what};
    return nullptr;
  };
  try {
    auto made =
        weft::make(weft::completed(*request, weft_request WEFT_REQUEST),
                   control == nullptr ? weft_control WEFT_CONTROL
                                      : weft::completed(*control, weft_control WEFT_CONTROL));
    return made ? *made : tell(made.error());
  } catch (const std::bad_alloc&) {
    return tell({weft::ErrorCode::kOutOfMemory, "", "memory ran out"});
  } catch (const std::exception& e) {
    return tell({weft::ErrorCode::kInternal, "", e.what()});
  }
}

void weft_mesh_free(weft_mesh* mesh) {
  delete mesh;
}

const char* weft_error_reason(const weft_error* error) {
  return weft::name_of(error->error.code);
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
void weft_error_free(weft_error* error) {
  delete error;
}

void weft_mesh_arrays(const weft_mesh* mesh, weft_arrays* arrays) {
  static_assert(sizeof(weft::Point) == 2 * sizeof(double) &&
                sizeof(weft::Box) == 4 * sizeof(double));
  static_assert(sizeof(weft::Chunk::Edge) == 4 * sizeof(std::uint32_t));
  const weft::Mesh& m = mesh->mesh;
  weft::give({.struct_size = 0,
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
              .leaves = reinterpret_cast<const double*>(m.summary.leaves.data())},
             arrays);
}

void weft_mesh_summary(const weft_mesh* mesh, weft_summary* summary) {
  const weft::Summary& from = mesh->mesh.summary;
  weft_summary to WEFT_SUMMARY;
  std::copy(from.digest.begin(), from.digest.end(), to.digest);
  to.chunks = from.chunks;
  to.rounds = from.rounds;
  to.threads = mesh->threads;
  to.streamed = from.streamed;
  to.has_narrow = from.narrow.has_value();
  to.area = from.area;
  to.min_angle_deg = from.min_angle_deg;
  to.max_angle_deg = from.max_angle_deg;
  to.min_angle_p1_deg = from.min_angle_p1_deg;
  to.mean_quality = from.mean_quality;
  to.ideal_ratio = from.ideal_ratio;
  to.lattice_share = from.lattice_share;
  std::copy(from.angle_histogram.begin(), from.angle_histogram.end(), to.angle_histogram);
  std::copy(from.aspect_histogram.begin(), from.aspect_histogram.end(), to.aspect_histogram);
  std::copy(from.size_histogram.begin(), from.size_histogram.end(), to.size_histogram);
  to.small_input_angle = from.unrefined.small_input_angle;
  to.edge_floor = from.unrefined.edge_floor;
  to.budget = from.unrefined.budget;
  to.precision = from.unrefined.precision;
  to.streaming = from.unrefined.streaming;
  to.too_large = from.unrefined.too_large;
  if (from.unrefined.without_exemption() > 0) {
    to.unrefined_x = from.unrefined_at.x;
    to.unrefined_y = from.unrefined_at.y;
  }
  to.merge_tolerance = from.merging.tolerance;
  to.merged_points = from.merging.points;
  to.merged_segments = from.merging.segments;
  to.farthest = from.merging.farthest;
  if (from.merging.farthest > 0) {
    to.farthest_x = from.merging.farthest_at.x;
    to.farthest_y = from.merging.farthest_at.y;
  }
  to.vanished_faces = from.merging.vanished_faces;
  if (from.merging.vanished_faces > 0) {
    to.vanished_x = from.merging.vanished_at.x;
    to.vanished_y = from.merging.vanished_at.y;
  }
  to.overlap_areas = from.overlap.areas;
  to.overlap_area = from.overlap.area;
  to.overlap_united = from.overlap.united;
  to.outside_segments = from.outside.segments;
  to.outside_first = from.outside.first;
  to.outside_x = from.outside.at.x;
  to.outside_y = from.outside.at.y;
  if (from.narrow) {
    to.narrow_segment = from.narrow->segment;
    to.narrow_other = from.narrow->other;
    to.narrow_x = from.narrow->at.x;
    to.narrow_y = from.narrow->at.y;
    to.narrow_width = from.narrow->width;
    to.narrow_triangles = from.narrow->triangles;
    to.narrow_in_all = from.narrow->in_all;
    to.narrow_widest = from.narrow->widest;
  }
  to.triangulate_seconds = from.triangulate_seconds;
  to.size_seconds = from.size_seconds;
  to.coarse_seconds = from.coarse_seconds;
  to.refine_seconds = from.refine_seconds;
  to.emit_seconds = from.emit_seconds;
  to.engine_seconds = from.engine_seconds;
  to.peak_bytes = from.peak_bytes;
  to.insertions = from.insertions;
  to.deferred = from.deferred;
  to.exact_predicates = from.exact_predicates;
  to.warning_count = from.size_warnings.size();
  to.has_simplification = from.simplified.has_value();
  if (from.simplified) {
    to.simplified_points = from.simplified->points;
    to.dropped_islands = from.simplified->islands;
    to.dropped_waters = from.simplified->waters;
    to.cut_channels = from.simplified->channels;
    to.cut_off_waters = from.simplified->cut_off;
    to.straits = from.simplified->straits;
    to.simplified_area = from.simplified->area;
    to.simplified_farthest = from.simplified->farthest;
  }
  weft::give(to, summary);
}

const char* weft_warning_kind(const weft_mesh* mesh, size_t index) {
  switch (mesh->mesh.summary.size_warnings[index].kind) {
    case weft::SizeWarning::Kind::kBoundsNothing:
      return "bounds_nothing";
    case weft::SizeWarning::Kind::kCoarseRaster:
      return "coarse_raster";
    case weft::SizeWarning::Kind::kFieldNotNamed:
      return "field_not_named";
    case weft::SizeWarning::Kind::kGradationWithinAlone:
      return "gradation_within_alone";
  }
  return "";
}
const char* weft_warning_field(const weft_mesh* mesh, size_t index) {
  return mesh->mesh.summary.size_warnings[index].field.c_str();
}
const char* weft_warning_message(const weft_mesh* mesh, size_t index) {
  return mesh->mesh.summary.size_warnings[index].message.c_str();
}

const char* weft_version(void) {
  return WEFT_VERSION;
}
const char* weft_engine_version(void) {
  return weft::kEngineVersion.data();
}

}  // extern "C"
