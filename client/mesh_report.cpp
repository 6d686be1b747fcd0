// SPDX-License-Identifier: Apache-2.0
#include "client/mesh_report.h"

#include <cstdio>

#include "client/text.h"

namespace weft::client {
namespace {

double seconds_between(MeshTimes::Clock::time_point start, MeshTimes::Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

}  // namespace

Json summary_json(const v1::Summary& summary) {
  const v1::Unrefined& unrefined = summary.unrefined();
  const v1::Timings& timings = summary.timings();
  return {{"vertices", summary.vertices()},
          {"triangles", summary.triangles()},
          {"edges", summary.edges()},
          {"chunks", summary.chunks()},
          {"area", summary.area()},
          {"min_angle_deg", summary.min_angle_deg()},
          {"max_angle_deg", summary.max_angle_deg()},
          {"unrefined",
           {{"small_input_angle", unrefined.small_input_angle()},
            {"edge_floor", unrefined.edge_floor()},
            {"budget", unrefined.budget()}}},
          {"digest", hex(summary.sha256())},
          {"engine_version", summary.engine_version()},
          {"threads", summary.threads()},
          {"cached", summary.cached()},
          {"engine_seconds", timings.engine_seconds()},
          {"peak_engine_bytes", summary.peak_engine_bytes()},
          {"insertions", summary.insertions()},
          {"exact_predicates", summary.exact_predicates()},
          {"leaves", summary.leaves()},
          {"deferred", summary.deferred()},
          {"rounds", summary.rounds()},
          {"seconds",
           {{"triangulate", timings.triangulate_seconds()},
            {"size", timings.size_seconds()},
            {"prelude", timings.prelude_seconds()},
            {"refine", timings.refine_seconds()},
            {"emit", timings.emit_seconds()},
            {"engine", timings.engine_seconds()}}}};
}

Json mesh_json(const MeshReport& report, const MeshTimes& times) {
  const v1::Timings& timings = report.summary.timings();
  Json json = summary_json(report.summary);
  json["engine_version"] = report.accepted.engine_version();
  json["first_chunk_seconds"] = report.first_chunk_seconds;
  json["total_seconds"] = seconds_between(times.start, times.written);
  json["bytes_received"] = report.bytes_received;
  json["timings"] = {{"triangulate_seconds", timings.triangulate_seconds()},
                     {"size_seconds", timings.size_seconds()},
                     {"refine_seconds", timings.refine_seconds()},
                     {"emit_seconds", timings.emit_seconds()},
                     {"read_seconds", seconds_between(times.start, times.read)},
                     {"connect_seconds", seconds_between(times.read, times.connected)},
                     {"stream_seconds", report.stream_seconds},
                     {"write_seconds", seconds_between(times.received, times.written)}};
  return json;
}

std::string summary_text(const v1::Summary& summary) {
  const v1::Unrefined& unrefined = summary.unrefined();
  char angles[64];
  std::snprintf(angles, sizeof angles, "%.2f to %.2f degrees", summary.min_angle_deg(),
                summary.max_angle_deg());
  std::string text = with_separators(summary.triangles()) + " triangles, " +
                     with_separators(summary.vertices()) + " vertices, angles " + angles + "\n";
  const auto missed = [&text](std::uint64_t count, const char* why) {
    if (count > 0) text += with_separators(count) + " triangles miss a bound: " + why + "\n";
  };
  missed(unrefined.small_input_angle(), "a small angle of the input forces it");
  missed(unrefined.edge_floor(), "edges would become too short");
  missed(unrefined.budget(), "the most triangles allowed were reached");
  return text;
}

std::string mesh_text(const MeshReport& report, const MeshTimes& times) {
  const v1::Summary& summary = report.summary;
  return summary_text(summary) +
         (summary.cached() ? "at hand on the server, made before: engine " : "engine ") +
         seconds_text(summary.timings().engine_seconds()) + " on " +
         std::to_string(summary.threads()) + (summary.threads() == 1 ? " thread" : " threads") +
         ", total " + seconds_text(seconds_between(times.start, times.written)) + ", received " +
         bytes_text(report.bytes_received) + "\n";
}

}  // namespace weft::client
