// SPDX-License-Identifier: Apache-2.0
#include "files/formats/nodal_option.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/formats/bed.h"

namespace weft::files {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMaxLetters = 16;  // of the name of a variable in SELAFIN
// Names that some format uses for something else, in lower case.
constexpr std::string_view kTaken[] = {
    "points",      "triangles",  "regions",      "edges",      "edge_markers", "parts",  // .npz
    "edge_bulges", "marker_ids", "marker_names", "region_ids", "region_names",           // .npz
    "node_x",      "node_y",     "node_z",       "region",     "edge_marker",  "part",   // UGRID
    "edge_nodes",  "face_nodes", "bottom"};  // UGRID, SELAFIN

bool is_name(const std::string& text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && text.size() <= kMaxLetters && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(),
                     [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::optional<double> number_of(const std::string& text) {
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, number);
  if (problem != std::errc() || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

RasterBox box_of(const MeshView& mesh) {
  if (mesh.coordinates.empty()) return {};
  RasterBox box{mesh.coordinates[0], mesh.coordinates[1], mesh.coordinates[0], mesh.coordinates[1]};
  for (const std::size_t v : mesh.up_to(mesh.vertex_count())) {
    box.min_x = std::min(box.min_x, mesh.coordinates[2 * v]);
    box.max_x = std::max(box.max_x, mesh.coordinates[2 * v]);
    box.min_y = std::min(box.min_y, mesh.coordinates[2 * v + 1]);
    box.max_y = std::max(box.max_y, mesh.coordinates[2 * v + 1]);
  }
  return box;
}

// The two nodes of an axis that are around a place, and the weight of the second one.
struct Between {
  std::size_t first;
  std::size_t second;  // the first one again if it has no weight
  double weight;
};

// REQUIRES: the place is at most half a step outside.
Between between(double place, std::uint32_t count) {
  const double at = std::clamp(place, 0.0, count - 1.0);
  const auto first = static_cast<std::size_t>(at);
  const double weight = at - static_cast<double>(first);
  return {first, weight > 0 ? first + 1 : first, weight};
}

double value_at(const FieldRaster& raster, double x, double y) {
  const double column = (x - raster.x) / raster.dx;
  const double row = (y - raster.y) / raster.dy;
  if (!(column >= -0.5 && column <= raster.columns - 0.5 && row >= -0.5 &&
        row <= raster.rows - 0.5))
    return kNoValue;
  const Between i = between(column, raster.columns);
  const Between j = between(row, raster.rows);
  const auto along = [&](std::size_t at) {
    const float* values = &raster.values[at * raster.columns];
    const double first = values[i.first];
    return first + i.weight * (values[i.second] - first);
  };
  const double first = along(j.first);
  return first + j.weight * (along(j.second) - first);
}

Result<FieldRaster> read_in_plane(const std::filesystem::path& file, const std::string& band,
                                  const RasterBox& box, const NodalPlane& plane,
                                  std::uint64_t max_values) {
  if (!plane.crs.empty())
    return read_field_raster_projected(file, band, box, plane.crs, max_values);
  if (plane.system) return read_field_raster_in(file, band, box, *plane.system, max_values);
  return read_field_raster(file, band, box, max_values);
}

// The option with that name; the end if there is none.
template <class Options>
auto named(Options& options, const std::string& name) {
  return std::find_if(options.begin(), options.end(),
                      [&name](const NodalOption& option) { return option.name == name; });
}

}  // namespace

std::string nodal_name_fault(const std::string& name, const std::vector<NodalOption>& options) {
  if (!is_name(name))
    return in_quotes(name) + " is not a name of values: at most " + std::to_string(kMaxLetters) +
           " letters, digits and underscores, the first a letter";
  const std::string lower = lower_case(name);
  if (std::find(std::begin(kTaken), std::end(kTaken), lower) != std::end(kTaken))
    return in_quotes(name) + " is the name of something else in the files; choose another";
  if (Bed::is_bed(lower) && name != lower)
    return in_quotes(name) + " is not the bed, which is called " + lower;
  if (Bed::is_bed(name) && named(options, name == "depth" ? "elevation" : "depth") != options.end())
    return "depth and elevation are the same values, positive down and positive up: give one";
  return "";
}

std::string add_nodal(const std::string& text, const std::filesystem::path& folder,
                      std::vector<NodalOption>& options) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    return in_quotes(text) + " is not NAME=FILE or NAME=NUMBER, such as depth=FILE.tif";
  const std::string name = text.substr(0, equals);
  const std::string source = text.substr(equals + 1);
  if (std::string fault = nodal_name_fault(name, options); !fault.empty()) return fault;
  auto option = named(options, name);
  if (option == options.end()) option = options.insert(options.end(), {name, {}});
  if (const auto number = number_of(source))
    option->sources.emplace_back(*number);
  else
    option->sources.emplace_back(split_raster_path((folder / source).string()));
  return "";
}

Result<void> check_nodal_sources(const NodalOption& option, const RasterBox& box,
                                 const NodalPlane& plane) {
  constexpr std::uint64_t kFew = 1 << 12;
  for (const auto& source : option.sources)
    if (const auto* raster = std::get_if<RasterPath>(&source))
      if (auto read = read_in_plane(raster->file, raster->band, box, plane, kFew); !read)
        return tl::unexpected(read.error());
  return {};
}

Result<SampledValues> sample_nodal(const NodalOption& option, const MeshView& mesh,
                                   const NodalPlane& plane, std::span<const double> places) {
  SampledValues sampled{ScratchArray<double>(mesh.pages, mesh.vertex_count()), {}};
  ScratchArray<double>& values = sampled.values;
  for (const std::size_t v : mesh.up_to(mesh.vertex_count())) values[v] = kNoValue;
  if (mesh.vertex_count() == 0) return sampled;
  const RasterBox box = box_of(mesh);
  for (const auto& source : option.sources) {
    if (const double* number = std::get_if<double>(&source)) {
      for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
        if (std::isnan(values[v])) values[v] = *number;
      continue;
    }
    const auto& [file, band] = std::get<RasterPath>(source);
    auto raster = read_in_plane(file, band, box, plane, kMaxFieldValues);
    if (!raster) return tl::unexpected(raster.error());
    sampled.warnings.insert(sampled.warnings.end(), raster->warnings.begin(),
                            raster->warnings.end());
    for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
      if (std::isnan(values[v]))
        values[v] = value_at(*raster, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1]);
  }

  std::size_t missing = 0;
  std::size_t first = 0;
  std::size_t negative = 0;
  for (const std::size_t v : mesh.up_to(mesh.vertex_count())) {
    if (std::isnan(values[v]) && missing++ == 0) first = v;
    negative += values[v] < 0;
  }
  if (missing > 0)
    return fail(
        ExitCode::kUnreadableInput,
        option.name + " has no value at vertex " + std::to_string(first) + ", " +
            coordinates(places[2 * first], places[2 * first + 1]) +
            (missing == 1 ? std::string() : ", and at " + with_separators(missing - 1) + " more") +
            "; --nodal " + option.name +
            "=NUMBER, after the others, is the value where they have none");
  if (option.name == "depth" && negative * 2 > mesh.vertex_count())
    sampled.warnings.push_back("depth is negative at " + with_separators(negative) + " of " +
                               with_separators(mesh.vertex_count()) +
                               " vertices, but it is positive down; if the file has elevations, "
                               "positive up, name it: --nodal elevation=FILE");
  return sampled;
}

}  // namespace weft::files
