// SPDX-License-Identifier: Apache-2.0
#include "client/report/mesh_text.h"

#include <algorithm>
#include <cstdio>

#include "client/report/mesh_figures.h"
#include "client/report/projection_report.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

double seconds_between(MeshTimes::Clock::time_point start, MeshTimes::Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

std::uint64_t without_exemption(const v1::Unrefined& unrefined) {
  return unrefined.precision() + unrefined.streaming();
}

Json unrefined_json(const v1::Unrefined& unrefined) {
  Json json = {{"small_input_angle", unrefined.small_input_angle()},
               {"edge_floor", unrefined.edge_floor()},
               {"kept", unrefined.kept()},
               {"budget", unrefined.budget()},
               {"precision", unrefined.precision()},
               {"streaming", unrefined.streaming()}};
  if (without_exemption(unrefined) > 0) {
    json["too_large"] = unrefined.too_large();
    json["at"] = {unrefined.x(), unrefined.y()};
  }
  if (unrefined.kept() > 0) json["kept_at"] = {unrefined.kept_x(), unrefined.kept_y()};
  return json;
}

Json merging_json(const v1::Merging& merging) {
  Json json = {{"tolerance", merging.tolerance()},
               {"points", merging.points()},
               {"segments", merging.segments()},
               {"farthest", merging.farthest()},
               {"vanished_faces", merging.vanished_faces()}};
  if (merging.farthest() > 0) json["farthest_at"] = {merging.farthest_x(), merging.farthest_y()};
  if (merging.vanished_faces() > 0)
    json["vanished_at"] = {merging.vanished_x(), merging.vanished_y()};
  return json;
}

// Null if none is outside.
Json outside_json(const v1::Summary& summary) {
  if (!summary.has_outside()) return nullptr;
  const v1::OutsideSegments& outside = summary.outside();
  return {{"segments", outside.segments()},
          {"first", outside.first()},
          {"at", {outside.x(), outside.y()}}};
}

// Null if the domain has no costly place.
Json narrow_json(const v1::Summary& summary) {
  if (!summary.has_narrow()) return nullptr;
  const v1::NarrowPlace& narrow = summary.narrow();
  return {{"segments", {narrow.segment(), narrow.other()}},
          {"at", {narrow.x(), narrow.y()}},
          {"width", narrow.width()},
          {"triangles", narrow.triangles()},
          {"in_all", narrow.in_all()},
          {"widest", narrow.widest()}};
}

// Three digits of a distance are enough for people.
std::string rounded(double distance) {
  return digits(distance, 3);
}

Json layers_json(const v1::Summary& summary) {
  if (!summary.has_layers()) return nullptr;
  const v1::LayerSummary& layers = summary.layers();
  return {{"triangles", layers.triangles()},
          {"least_thickness", layers.least_thickness()},
          {"at", {layers.x(), layers.y()}},
          {"cut", layers.cut()}};
}

Json simplification_json(const v1::Summary& summary) {
  if (!summary.has_simplification()) return nullptr;
  const v1::Simplification& made = summary.simplification();
  Json cuts = Json::array();
  for (int i = 0; i + 1 < made.cuts_size(); i += 2)
    cuts.push_back({made.cuts(i), made.cuts(i + 1)});
  return {{"points", made.points()},     {"islands", made.islands()},   {"waters", made.waters()},
          {"channels", made.channels()}, {"cut_off", made.cut_off()},   {"straits", made.straits()},
          {"area", made.area()},         {"farthest", made.farthest()}, {"cuts", std::move(cuts)}};
}

// "1 point", "1,200 points".
std::string counted(std::uint64_t count, const std::string& what) {
  return with_separators(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

Json summary_json(const v1::Summary& summary) {
  const v1::Timings& timings = summary.timings();
  Json json = figures_json({.vertices = summary.vertices(),
                            .triangles = summary.triangles(),
                            .edges = summary.edges(),
                            .area = summary.area(),
                            .min_angle_deg = summary.min_angle_deg(),
                            .max_angle_deg = summary.max_angle_deg(),
                            .min_angle_p1_deg = summary.min_angle_p1_deg(),
                            .mean_quality = summary.mean_quality(),
                            .ideal_ratio = summary.ideal_ratio()});
  json.update({{"chunks", summary.chunks()},
               {"lattice_share", summary.lattice_share()},
               {"streamed", summary.streamed()},
               {"unrefined", unrefined_json(summary.unrefined())},
               {"merging", merging_json(summary.merging())},
               {"overlap",
                {{"areas", summary.overlap().areas()},
                 {"area", summary.overlap().area()},
                 {"united", summary.overlap().united()}}},
               {"outside", outside_json(summary)},
               {"narrow", narrow_json(summary)},
               {"simplification", simplification_json(summary)},
               {"layers", layers_json(summary)},
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
                 {"engine", timings.engine_seconds()}}}});
  return json;
}

std::optional<std::string> budget_warning(const v1::Summary& summary, std::uint64_t max_triangles) {
  if (max_triangles == 0 || summary.triangles() <= max_triangles) return std::nullopt;
  return "the mesh has " + counted(summary.triangles(), "triangle") + ", more than the " +
         with_separators(max_triangles) +
         " of --max-triangles, because the domain alone, without refinement, has that many";
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
  if (report.projection) json["projection"] = projection_json(*report.projection);
  if (!report.warnings.empty()) json["warnings"] = report.warnings;
  return json;
}

std::string summary_text(const v1::Summary& summary) {
  const v1::Unrefined& unrefined = summary.unrefined();
  char angles[64];
  std::snprintf(angles, sizeof angles, "%.2f to %.2f degrees", summary.min_angle_deg(),
                summary.max_angle_deg());
  std::string text = with_separators(summary.triangles()) + " triangles, " +
                     with_separators(summary.vertices()) + " vertices, angles " + angles + "\n";
  const auto missed = [&text](std::uint64_t count, const std::string& why) {
    if (count > 0)
      text += with_separators(count) + (count == 1 ? " triangle misses" : " triangles miss") +
              " a bound because " + why + "\n";
  };
  missed(unrefined.small_input_angle(), "a small angle of the input forces it");
  missed(unrefined.edge_floor(), "edges would become too short");
  missed(unrefined.kept(), "segments are kept as they are; the largest is at " +
                               coordinates(unrefined.kept_x(), unrefined.kept_y()));
  missed(unrefined.budget(), "--max-triangles was reached");
  return text + unrefined_warning(unrefined) + merging_text(summary.merging()) +
         simplification_text(summary) + layers_text(summary) + overlap_text(summary) +
         narrow_text(summary);
}

std::string warnings_text(const v1::Summary& summary) {
  std::string text;
  for (const v1::SizeWarning& warning : summary.size_warnings())
    text += "WARNING: " + harmless(warning.message()) + "\n";
  if (summary.has_outside()) text += "WARNING: " + outside_warning(summary) + "\n";
  return text;
}

std::string outside_warning(const v1::Summary& summary) {
  if (!summary.has_outside()) return "";
  const v1::OutsideSegments& outside = summary.outside();
  return counted(outside.segments(), "segment") + (outside.segments() == 1 ? " lies" : " lie") +
         " outside of what is meshed, " + (outside.segments() == 1 ? "" : "the first ") + "at " +
         coordinates(outside.x(), outside.y()) + "; weft lint shows where lines do not close";
}

std::string unrefined_warning(const v1::Unrefined& unrefined) {
  const std::uint64_t count = without_exemption(unrefined);
  if (count == 0) return "";
  const std::uint64_t large = unrefined.too_large();
  std::string which;
  if (large > 0) which = with_separators(large) + " above the bound on their area";
  if (large > 0 && large < count) which += " and ";
  if (large < count) which += with_separators(count - large) + " below the minimum angle";
  std::string why;
  if (unrefined.precision() > 0) why = "double precision ends";
  if (unrefined.precision() > 0 && unrefined.streaming() > 0) why += ", or ";
  if (unrefined.streaming() > 0) why += "the mesh around had been sent already";
  return "WARNING: " + counted(count, "triangle") + " without exemption, " + which + ", because " +
         why + "; the first is at " + coordinates(unrefined.x(), unrefined.y()) + "\n";
}

std::string overlap_text(const v1::Summary& summary) {
  // What rounding makes where polygons share a border is not worth a line.
  constexpr double kMin = 1e-9;
  const v1::Overlap& overlap = summary.overlap();
  if (overlap.areas() == 0 || overlap.area() <= kMin * summary.area()) return "";
  return with_separators(overlap.areas()) + " polygons overlap on an area of " +
         rounded(overlap.area()) +
         (overlap.united() ? ", which is meshed once\n"
                           : ", not meshed where an even number of them does\n");
}

std::string simplification_text(const v1::Summary& summary) {
  if (!summary.has_simplification()) return "";
  const v1::Simplification& made = summary.simplification();
  if (made.farthest() == 0 && made.points() + made.islands() + made.waters() == 0)
    return "simplified: nothing was finer\n";
  return "simplified: " + counted(made.points(), "point") + ", " +
         counted(made.islands(), "island") + " and " + counted(made.waters(), "water") +
         " dropped, " + counted(made.channels(), "channel") + " cut, " +
         counted(made.cut_off(), "water") + " behind them dropped, " +
         counted(made.straits(), "strait") + " kept, area " + (made.area() > 0 ? "+" : "") +
         rounded(made.area()) + ", no line moved by more than " + rounded(made.farthest()) + "\n";
}

std::string layers_text(const v1::Summary& summary) {
  if (!summary.has_layers()) return "";
  const v1::LayerSummary& layers = summary.layers();
  const std::string text = "layers: " + counted(layers.triangles(), "triangle");
  if (layers.cut() == 0) return text + "\n";
  return text + ", thinner than asked for at " + counted(layers.cut(), "corner") +
         " for want of room, the least " + rounded(layers.least_thickness()) + " thick at " +
         coordinates(layers.x(), layers.y()) + "\n";
}

std::string narrow_text(const v1::Summary& summary) {
  if (!summary.has_narrow()) return "";
  const v1::NarrowPlace& narrow = summary.narrow();
  const std::string pair = "between segments " + std::to_string(narrow.segment()) + " and " +
                           std::to_string(narrow.other()) + ", " + rounded(narrow.width()) +
                           " apart at " + coordinates(narrow.x(), narrow.y());
  if (narrow.in_all() < 2 * narrow.triangles())
    return "at least " + with_separators(narrow.triangles()) + " triangles lie " + pair +
           ": if they should be one, --snap " + two_digits_above(narrow.width()) + " merges them\n";
  return "at least " + with_separators(narrow.in_all()) +
         " triangles lie where segments are up to " + rounded(narrow.widest()) +
         " apart, the most of them " + pair + ": if these should be one, --snap " +
         two_digits_above(narrow.widest()) + " merges them\n";
}

std::string merging_text(const v1::Merging& merging) {
  std::string text;
  if (merging.points() + merging.segments() > 0) {
    text = "merged within " + rounded(merging.tolerance()) + ": ";
    if (merging.points() > 0) text += counted(merging.points(), "point") + " moved, ";
    if (merging.segments() > 0) text += counted(merging.segments(), "segment") + " bent, ";
    text += "by " + rounded(merging.farthest()) + " at most, at " +
            coordinates(merging.farthest_x(), merging.farthest_y()) + "\n";
  }
  if (merging.vanished_faces() > 0) {
    text += counted(merging.vanished_faces(), "face") + " of the input vanished, " +
            (merging.vanished_faces() == 1 ? "" : "one ") + "at " +
            coordinates(merging.vanished_x(), merging.vanished_y()) + "\n";
  }
  return text;
}

std::string region_values_text(std::span<const RegionValue> values) {
  constexpr std::size_t kMaxListed = 20;
  std::string text;
  for (const auto& [id, value] : values.first(std::min(values.size(), kMaxListed)))
    text += "region " + std::to_string(id) + " = " + shortest(value) + "\n";
  if (values.size() > kMaxListed)
    text += "and " + std::to_string(values.size() - kMaxListed) + " more regions\n";
  return text;
}

Json region_values_json(std::span<const RegionValue> values) {
  Json json = Json::object();
  for (const auto& [id, value] : values) json[std::to_string(id)] = value;
  return json;
}

std::string mesh_text(const MeshReport& report, const MeshTimes& times) {
  const v1::Summary& summary = report.summary;
  std::string warnings;
  for (const std::string& warning : report.warnings) warnings += "WARNING: " + warning + "\n";
  return summary_text(summary) +
         (summary.cached() ? "found on the server, made earlier: engine " : "engine ") +
         seconds_text(summary.timings().engine_seconds()) + " on " +
         std::to_string(summary.threads()) + (summary.threads() == 1 ? " thread" : " threads") +
         ", total " + seconds_text(seconds_between(times.start, times.written)) + ", received " +
         bytes_text(report.bytes_received) + "\n" +
         (report.projection ? projection_text(*report.projection) : "") + warnings;
}

}  // namespace weft::client
