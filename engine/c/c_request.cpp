// SPDX-License-Identifier: Apache-2.0
// Each call appends its fields to the message: fields of one message that come apart are merged.
#include "engine/c/c_request.h"

#include <algorithm>
#include <charconv>
#include <new>
#include <protozero/pbf_writer.hpp>
#include <string_view>
#include <utility>

#include "wire/options.h"

namespace weft {
namespace {

using protozero::pbf_writer;
using wire::Option;

constexpr std::uint32_t kDomain = 1;
constexpr std::uint32_t kSize = 2;
constexpr std::uint32_t kQuality = 3;
constexpr std::uint32_t kSizeFields = 5;
// Kinds of fields.
constexpr std::uint32_t kDistance = 2;
constexpr std::uint32_t kRaster = 3;
constexpr std::uint32_t kMesh = 4;
constexpr std::uint32_t kWidth = 5;

// Appends what `write` writes to the request, or keeps why it cannot.
template <class F>
void append(weft_request* request, F&& write) {
  const std::size_t before = request->bytes.size();
  const auto fail_with = [&](Error error) {
    request->bytes.resize(before);
    if (!request->fault) request->fault = std::move(error);
  };
  try {
    pbf_writer message(request->bytes);
    write(message);
  } catch (const Error& error) {
    fail_with(error);
  } catch (const std::exception&) {
    fail_with({ErrorCode::kOutOfMemory, "", "memory ran out"});
  }
}

// Of a field of the domain or of the size.
template <class F>
void append_to(weft_request* request, std::uint32_t field, F&& write) {
  append(request, [&](pbf_writer& message) {
    pbf_writer inner(message, field);
    write(inner);
  });
}

// Of a named field of the size; `kind` is its number.
template <class F>
void append_field(weft_request* request, const char* name, std::uint32_t kind, F&& write) {
  append_to(request, kSize, [&](pbf_writer& size) {
    pbf_writer field(size, kSizeFields);
    field.add_string(1, name == nullptr ? "" : name);
    // Writers leave messages out that stay empty, such as a distance to all segments.
    if (kind == kDistance || kind == kWidth) field.add_message(kind, "", 0);
    pbf_writer inner(field, kind);
    write(inner);
  });
}

// The end of an array, for an error's field.
template <class T>
const T* end_of(const T* numbers, std::size_t count, const char* field) {
  if (numbers == nullptr && count > 0)
    throw Error{ErrorCode::kBadOption, field,
                std::string(field) + " is NULL, but its count is " + std::to_string(count)};
  return numbers + count;
}

void add_bound(pbf_writer& message, std::uint32_t first_field, const weft_bound& bound) {
  if (bound.max_area != 0) message.add_double(first_field, bound.max_area);
  if (bound.max_edge != 0) message.add_double(first_field + 1, bound.max_edge);
}

void add_grid(pbf_writer& message, const weft_grid& grid) {
  message.add_double(1, grid.x);
  message.add_double(2, grid.y);
  message.add_double(3, grid.dx);
  message.add_double(4, grid.dy);
  message.add_uint32(5, grid.columns);
  message.add_uint32(6, grid.rows);
}

std::size_t nodes_of(const weft_grid& grid) {
  return std::size_t{grid.columns} * grid.rows;
}

[[noreturn]] void refuse(const Option& option, std::string_view text, const char* kind) {
  const std::string field(option.field);
  throw Error{ErrorCode::kBadOption, field,
              field + " is '" + std::string(text) + "', which is not " + kind};
}

template <class T>
T number_of(const Option& option, std::string_view text, const char* kind) {
  T value{};
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) refuse(option, text, kind);
  return value;
}

std::uint32_t choice_of(const Option& option, std::string_view text, const char* kind) {
  const auto found = std::find(option.names.begin(), option.names.end(), text);
  if (found == option.names.end()) refuse(option, text, kind);
  return static_cast<std::uint32_t>(found - option.names.begin() + 1);
}

constexpr std::string_view kSwitch[] = {"true", "false"};

void add_option(pbf_writer& message, std::uint32_t field, const Option& option,
                std::string_view text) {
  switch (option.kind) {
    case Option::Kind::kNumber:
      return message.add_double(field, number_of<double>(option, text, "a number"));
    case Option::Kind::kCount:
      return message.add_uint32(field, number_of<std::uint32_t>(option, text, "a count"));
    case Option::Kind::kLargeCount:
      return message.add_uint64(field, number_of<std::uint64_t>(option, text, "a count"));
    case Option::Kind::kText:
      return message.add_string(field, text.data(), text.size());
    case Option::Kind::kSwitch:
      return message.add_bool(
          field, choice_of({option.field, {}, {}, kSwitch}, text, "true or false") == 1);
    case Option::Kind::kChoice:
      return message.add_uint32(field, choice_of(option, text, "one of its names"));
  }
}

}  // namespace
}  // namespace weft

using protozero::pbf_writer;
using weft::append;
using weft::append_field;
using weft::append_to;
using weft::end_of;
using weft::kDistance;
using weft::kDomain;
using weft::kMesh;
using weft::kQuality;
using weft::kRaster;
using weft::kSize;
using weft::kWidth;

extern "C" {

weft_request* weft_request_new(void) {
  return new (std::nothrow) weft_request;
}
void weft_request_free(weft_request* request) {
  delete request;
}

void weft_set(weft_request* request, const char* field, const char* text) {
  append(request, [&](pbf_writer& message) {
    const auto& options = weft::wire::kOptions;
    const std::string_view name = field == nullptr ? "" : field;
    const auto option = std::find_if(options.begin(), options.end(),
                                     [&](const auto& row) { return row.field == name; });
    if (option == options.end())
      throw weft::Error{weft::ErrorCode::kBadOption, std::string(name),
                        '\'' + std::string(name) + "' is not an option"};
    const std::string_view value = text == nullptr ? "" : text;
    const auto [first, second] = option->numbers;
    if (second == 0) return weft::add_option(message, first, *option, value);
    pbf_writer inner(message, first);
    weft::add_option(inner, second, *option, value);
  });
}

void weft_set_points(weft_request* request, const double* xy, size_t count) {
  append_to(request, kDomain, [&](pbf_writer& domain) {
    domain.add_packed_double(1, xy, end_of(xy, 2 * count, "domain.points"));
  });
}

void weft_set_holes(weft_request* request, const double* xy, size_t count) {
  append_to(request, kDomain, [&](pbf_writer& domain) {
    domain.add_packed_double(4, xy, end_of(xy, 2 * count, "domain.holes"));
  });
}

void weft_set_segments(weft_request* request, const uint32_t* ends, const int32_t* markers,
                       const uint32_t* areas, size_t count) {
  append_to(request, kDomain, [&](pbf_writer& domain) {
    domain.add_packed_uint32(2, ends, end_of(ends, 2 * count, "domain.segments"));
    if (markers != nullptr) domain.add_packed_sint32(3, markers, markers + count);
    if (areas == nullptr) return;
    protozero::packed_field_uint32 field(domain, 11);  // 0 is none
    for (size_t i = 0; i < count; ++i) field.add_element(areas[i] + 1);
  });
}

void weft_set_arcs(weft_request* request, const uint32_t* segments, const double* bulges,
                   size_t count) {
  append_to(request, kDomain, [&](pbf_writer& domain) {
    domain.add_packed_uint32(12, segments, end_of(segments, count, "domain.arc_segments"));
    domain.add_packed_double(13, bulges, bulges + count);
  });
}

void weft_set_domain(weft_request* request, const weft_domain* domain) {
  append(request, [&](pbf_writer& message) {
    size_t size = 0;
    const void* bytes = weft_domain_message(domain, &size);
    message.add_message(kDomain, static_cast<const char*>(bytes), size);
  });
}

void weft_add_region(weft_request* request, double x, double y, int32_t id, weft_bound bound) {
  append_to(request, kDomain, [&](pbf_writer& domain) {
    pbf_writer region(domain, 5);
    region.add_double(1, x);
    region.add_double(2, y);
    region.add_sint32(3, id);
    weft::add_bound(region, 4, bound);
  });
}

void weft_add_area(weft_request* request, const int32_t* region, int32_t priority, weft_bound bound,
                   int is_hole) {
  append_to(request, kDomain, [&](pbf_writer& domain) {
    pbf_writer area(domain, 10);
    if (region != nullptr) area.add_sint32(1, *region);
    weft::add_bound(area, 2, bound);
    area.add_sint32(4, priority);
    area.add_bool(5, is_hole != 0);
  });
}

void weft_set_size_raster(weft_request* request, const weft_grid* grid, const double* values) {
  append_to(request, kSize, [&](pbf_writer& size) {
    pbf_writer raster(size, 3);
    weft::add_grid(raster, *grid);
    raster.add_packed_double(7, values,
                             end_of(values, weft::nodes_of(*grid), "size.raster.values"));
  });
}

void weft_add_size_at(weft_request* request, int32_t marker, double max_edge) {
  append_to(request, kSize, [&](pbf_writer& size) {
    pbf_writer at(size, 8);
    at.add_sint32(1, marker);
    at.add_double(2, max_edge);
  });
}

void weft_keep(weft_request* request, const int32_t* markers, size_t count) {
  append(request, [&](pbf_writer& message) {
    std::string keep;
    pbf_writer(keep).add_packed_sint32(1, markers, end_of(markers, count, "quality.keep"));
    pbf_writer(message, kQuality).add_message(5, keep);
  });
}

void weft_add_periodic(weft_request* request, int32_t from, int32_t to) {
  append_to(request, kQuality, [&](pbf_writer& quality) {
    pbf_writer sides(quality, 6);
    sides.add_sint32(1, from);
    sides.add_sint32(2, to);
  });
}

void weft_add_layers(weft_request* request, int32_t marker, double first, double ratio,
                     uint32_t rows, const int32_t* region) {
  append_to(request, kQuality, [&](pbf_writer& quality) {
    pbf_writer layers(quality, 7);
    layers.add_sint32(1, marker);
    layers.add_double(2, first);
    layers.add_double(3, ratio);
    layers.add_uint32(4, rows);
    if (region != nullptr) layers.add_sint32(5, *region);
  });
}

void weft_add_distance(weft_request* request, const char* name, const int32_t* markers,
                       size_t count) {
  append_field(request, name, kDistance, [&](pbf_writer& distance) {
    distance.add_packed_sint32(1, markers, end_of(markers, count, "size.fields"));
  });
}

void weft_add_distance_to(weft_request* request, const char* name, const double* xy,
                          size_t point_count, const uint32_t* ends, size_t segment_count) {
  append_field(request, name, kDistance, [&](pbf_writer& distance) {
    distance.add_packed_double(2, xy, end_of(xy, 2 * point_count, "size.fields"));
    distance.add_packed_uint32(3, ends, end_of(ends, 2 * segment_count, "size.fields"));
  });
}

void weft_add_raster(weft_request* request, const char* name, const weft_grid* grid,
                     const float* values) {
  append_field(request, name, kRaster, [&](pbf_writer& raster) {
    weft::add_grid(raster, *grid);
    raster.add_packed_float(7, values, end_of(values, weft::nodes_of(*grid), "size.fields"));
  });
}

void weft_add_mesh(weft_request* request, const char* name, const double* xy, const double* values,
                   size_t vertex_count, const uint32_t* triangles, size_t triangle_count) {
  append_field(request, name, kMesh, [&](pbf_writer& mesh) {
    mesh.add_packed_double(1, xy, end_of(xy, 2 * vertex_count, "size.fields"));
    mesh.add_packed_uint32(2, triangles, end_of(triangles, 3 * triangle_count, "size.fields"));
    mesh.add_packed_double(3, values, end_of(values, vertex_count, "size.fields"));
  });
}

void weft_add_width(weft_request* request, const char* name) {
  append_field(request, name, kWidth, [](pbf_writer&) {});
}

}  // extern "C"
