// SPDX-License-Identifier: Apache-2.0
#include "wire/summary.h"

#include <concepts>
#include <protozero/pbf_writer.hpp>

#include "weft/weft.h"

namespace weft::wire {
namespace {

using protozero::pbf_writer;

// Writes what it is shown as a message.
class MessageWriter {
 public:
  explicit MessageWriter(std::string& bytes) : out_(bytes) {}

  void number(std::uint32_t field, const char*, double value) { out_.add_double(field, value); }
  void number(std::uint32_t field, const char*, std::unsigned_integral auto value) {
    out_.add_uint64(field, value);
  }
  void text(std::uint32_t field, std::string_view value) {
    out_.add_bytes(field, value.data(), value.size());
  }
  template <class Counts>
  void counts(std::uint32_t field, const Counts& counts) {
    out_.add_packed_uint64(field, counts.begin(), counts.end());
  }
  void points(std::uint32_t field, const std::vector<Point>& points) {
    protozero::packed_field_double out(out_, field);
    for (const Point p : points) {
      out.add_element(p.x);
      out.add_element(p.y);
    }
  }
  void values(std::uint32_t field, const std::vector<double>& values) {
    out_.add_packed_double(field, values.begin(), values.end());
  }
  template <class F>
  void message(std::uint32_t field, const char*, F&& show) {
    MessageWriter inner(out_, field);
    show(inner);
  }

 private:
  MessageWriter(pbf_writer& outer, std::uint32_t field) : out_(outer, field) {}

  pbf_writer out_;
};

// Keeps the number at a path of what it is shown.
class FigureFinder {
 public:
  explicit FigureFinder(std::string_view path) : path_(path) {}
  std::optional<double> found() const { return found_; }

  template <class T>
  void number(std::uint32_t, const char* name, T value) {
    if (path_ == name) found_ = static_cast<double>(value);
  }
  void text(std::uint32_t, std::string_view) {}
  template <class Counts>
  void counts(std::uint32_t, const Counts&) {}
  void points(std::uint32_t, const std::vector<Point>&) {}
  void values(std::uint32_t, const std::vector<double>&) {}
  template <class F>
  void message(std::uint32_t, const char* name, F&& show) {
    const std::size_t dot = path_.find('.');
    if (dot == path_.npos || path_.substr(0, dot) != name) return;
    FigureFinder inner(path_.substr(dot + 1));
    show(inner);
    found_ = inner.found();
  }

 private:
  std::string_view path_;
  std::optional<double> found_;
};

void show(const Unrefined& unrefined, Point at, Point kept_at, auto& out) {
  out.number(1, "small_input_angle", unrefined.small_input_angle);
  out.number(2, "edge_floor", unrefined.edge_floor);
  out.number(3, "budget", unrefined.budget);
  out.number(4, "precision", unrefined.precision);
  out.number(5, "streaming", unrefined.streaming);
  out.number(6, "too_large", unrefined.too_large);
  if (unrefined.without_exemption() > 0) {
    out.number(7, "x", at.x);
    out.number(8, "y", at.y);
  }
  out.number(9, "kept", unrefined.kept);
  if (unrefined.kept == 0) return;
  out.number(10, "kept_x", kept_at.x);
  out.number(11, "kept_y", kept_at.y);
}

void show(const Merging& merging, auto& out) {
  out.number(1, "tolerance", merging.tolerance);
  out.number(2, "points", merging.points);
  out.number(3, "segments", merging.segments);
  out.number(4, "farthest", merging.farthest);
  if (merging.farthest > 0) {
    out.number(5, "farthest_x", merging.farthest_at.x);
    out.number(6, "farthest_y", merging.farthest_at.y);
  }
  out.number(7, "vanished_faces", merging.vanished_faces);
  if (merging.vanished_faces > 0) {
    out.number(8, "vanished_x", merging.vanished_at.x);
    out.number(9, "vanished_y", merging.vanished_at.y);
  }
}

void show(const Overlap& overlap, auto& out) {
  out.number(1, "areas", overlap.areas);
  out.number(2, "area", overlap.area);
  out.number(3, "united", overlap.united);
}

void show(const LayerSummary& layers, auto& out) {
  out.number(1, "triangles", layers.triangles);
  out.number(2, "least_thickness", layers.least_thickness);
  out.number(3, "x", layers.at.x);
  out.number(4, "y", layers.at.y);
  out.number(5, "cut", layers.cut);
}

void show(const Simplification& simplified, auto& out) {
  out.number(1, "points", simplified.points);
  out.number(2, "islands", simplified.islands);
  out.number(3, "waters", simplified.waters);
  out.number(4, "channels", simplified.channels);
  out.number(5, "area", simplified.area);
  out.number(6, "farthest", simplified.farthest);
  out.number(7, "cut_off", simplified.cut_off);
  out.number(8, "straits", simplified.straits);
  out.points(9, simplified.cuts);
}

void show(const OutsideSegments& outside, auto& out) {
  out.number(1, "segments", outside.segments);
  out.number(2, "first", outside.first);
  out.number(3, "x", outside.at.x);
  out.number(4, "y", outside.at.y);
}

void show(const NarrowPlace& narrow, auto& out) {
  out.number(1, "segment", narrow.segment);
  out.number(2, "other", narrow.other);
  out.number(3, "x", narrow.at.x);
  out.number(4, "y", narrow.at.y);
  out.number(5, "width", narrow.width);
  out.number(6, "triangles", static_cast<std::uint64_t>(narrow.triangles));
  out.number(7, "in_all", static_cast<std::uint64_t>(narrow.in_all));
  out.number(8, "widest", narrow.widest);
}

void show(const SizeWarning& warning, auto& out) {
  // The protocol's kinds follow one that is never sent.
  out.number(1, "kind", static_cast<std::uint32_t>(warning.kind) + 1);
  out.text(2, warning.field);
  out.text(3, warning.message);
}

void show_timings(const Summary& summary, auto& out) {
  out.number(1, "triangulate_seconds", summary.triangulate_seconds);
  out.number(2, "size_seconds", summary.size_seconds);
  out.number(3, "refine_seconds", summary.refine_seconds);
  out.number(4, "emit_seconds", summary.emit_seconds);
  out.number(5, "engine_seconds", summary.engine_seconds);
  out.number(6, "prelude_seconds", summary.coarse_seconds);
}

// Shows all fields of the message, by their numbers and names.
void show(const Summary& summary, std::uint32_t threads, auto& out) {
  out.number(1, "vertices", summary.vertices);
  out.number(2, "triangles", summary.triangles);
  out.number(3, "edges", summary.edges);
  out.number(4, "chunks", summary.chunks);
  out.number(5, "area", summary.area);
  out.number(6, "min_angle_deg", summary.min_angle_deg);
  out.number(7, "max_angle_deg", summary.max_angle_deg);
  out.counts(8, summary.angle_histogram);
  out.counts(9, summary.aspect_histogram);
  out.counts(10, summary.size_histogram);
  out.message(11, "unrefined", [&](auto& in) {
    show(summary.unrefined, summary.unrefined_at, summary.kept_at, in);
  });
  out.message(12, "timings", [&](auto& in) { show_timings(summary, in); });
  out.number(13, "peak_engine_bytes", summary.peak_bytes);
  out.number(14, "insertions", summary.insertions);
  out.number(15, "exact_predicates", summary.exact_predicates);
  out.text(16, {reinterpret_cast<const char*>(summary.digest.data()), summary.digest.size()});
  out.number(17, "threads", threads);
  out.number(18, "deferred", summary.deferred);
  out.number(19, "rounds", summary.rounds);
  out.number(20, "leaves", summary.leaves.size());
  out.text(22, kEngineVersion);
  out.message(24, "merging", [&](auto& in) { show(summary.merging, in); });
  out.number(25, "mean_quality", summary.mean_quality);
  out.number(26, "min_angle_p1_deg", summary.min_angle_p1_deg);
  out.number(27, "ideal_ratio", summary.ideal_ratio);
  out.number(28, "lattice_share", summary.lattice_share);
  out.number(29, "streamed", summary.streamed);
  for (const SizeWarning& warning : summary.size_warnings)
    out.message(31, "size_warnings", [&](auto& in) { show(warning, in); });
  if (summary.overlap.areas > 0)
    out.message(32, "overlap", [&](auto& in) { show(summary.overlap, in); });
  if (summary.narrow) out.message(33, "narrow", [&](auto& in) { show(*summary.narrow, in); });
  if (summary.simplified)
    out.message(34, "simplification", [&](auto& in) { show(*summary.simplified, in); });
  if (summary.layers) out.message(36, "layers", [&](auto& in) { show(*summary.layers, in); });
  if (summary.outside.segments > 0)
    out.message(35, "outside", [&](auto& in) { show(summary.outside, in); });
  if (summary.sampled_bounds.empty()) return;
  out.values(37, summary.sampled_bounds);
  out.number(38, "expected_triangles", static_cast<std::uint64_t>(summary.expected_triangles));
}

}  // namespace

std::string write_summary(const Summary& summary, std::uint32_t threads) {
  std::string bytes;
  MessageWriter out(bytes);
  show(summary, threads, out);
  return bytes;
}

std::string write_leaf_boxes(const Summary& summary) {
  std::string bytes;
  if (summary.leaves.size() > kMaxLeafBoxes) return bytes;
  static_assert(sizeof(Box) == 4 * sizeof(double));
  const auto* const sides = reinterpret_cast<const double*>(summary.leaves.data());
  pbf_writer(bytes).add_packed_double(21, sides, sides + 4 * summary.leaves.size());
  return bytes;
}

std::optional<double> figure(const Summary& summary, std::uint32_t threads, std::string_view path) {
  FigureFinder finder(path);
  show(summary, threads, finder);
  return finder.found();
}

}  // namespace weft::wire
