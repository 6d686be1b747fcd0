// SPDX-License-Identifier: Apache-2.0
#include "wire/marker_options.h"

#include <utility>

#include "files/base/text.h"

namespace weft::wire {
namespace {

using files::in_quotes;

std::string read_kept(const std::string& text, MarkerOptions& options) {
  options.keep = text == "all" ? files::MarkerList() : files::MarkerList::parse(text);
  return options.keep ? "" : in_quotes(text) + " does not list markers, such as 2,inlet";
}

std::string read_periodic(const std::string& text, MarkerOptions& options) {
  auto pairs = files::parse_marker_pairs(text);
  if (!pairs) return in_quotes(text) + " is not pairs of markers, such as left:right,4:2";
  options.periodic = std::move(*pairs);
  return "";
}

template <class Item, std::vector<Item> MarkerOptions::*kField>
std::string read_one(const std::string& text, MarkerOptions& options) {
  auto one = Item::parse(text);
  if (!one) return one.error();
  (options.*kField).push_back(std::move(*one));
  return "";
}

template <class Field, Field MarkerOptions::*kField>
void clear(MarkerOptions& options) {
  options.*kField = Field();
}

// The text of an entry, if there is one.
template <class Item, std::vector<Item> MarkerOptions::*kField, std::string (*kText)(const Item&)>
std::string entry_of(const MarkerOptions& options, std::size_t index) {
  const std::vector<Item>& all = options.*kField;
  return index < all.size() ? kText(all[index]) : "";
}

std::string text_of(const files::EdgeAt& at) {
  return "marker=" + (at.name.empty() ? std::to_string(at.marker) : at.name);
}

std::string text_of(const files::MarkerPair& pair) {
  return pair.text();
}

std::string text_of(const files::WallLayers& layers) {
  return layers.marker;
}

template <class Item, std::vector<Item> MarkerOptions::*kField>
constexpr auto kEntry = &entry_of<Item, kField, &text_of>;

std::string at_entry(const char* field, std::size_t index) {
  return field + ("[" + std::to_string(index)) + "]";
}

void set(const files::WallLayers& layers, std::int32_t marker, v1::Layers& message) {
  message.set_marker(marker);
  message.set_first(layers.first);
  message.set_ratio(layers.ratio);
  message.set_rows(layers.rows);
  if (layers.region) message.set_region(*layers.region);
}

}  // namespace

const std::vector<MarkerOption>& marker_options() {
  static const std::vector<MarkerOption> all = {
      {"edge-at", "", "marker=M:LEN",
       "Maximum length LEN of edges on segments with the marker M, a number or a name. With a "
       "gradation G, the length grows from there by at most G per unit of distance",
       "size.at", true, &read_one<files::EdgeAt, &MarkerOptions::edge_at>,
       &clear<std::vector<files::EdgeAt>, &MarkerOptions::edge_at>,
       kEntry<files::EdgeAt, &MarkerOptions::edge_at>},
      {"keep", "WEFT_KEEP_SEGMENTS", "M,M",
       "Segments that stay as they are, by their markers, numbers or names, or all: no new point "
       "lies on them, and triangles there may miss their bounds",
       "quality.keep", false, &read_kept,
       &clear<std::optional<files::MarkerList>, &MarkerOptions::keep>,
       [](const MarkerOptions&, std::size_t) { return std::string(); }},
      {"periodic", "WEFT_PERIODIC", "M:M,M:M",
       "Sides that repeat each other, pairs of their markers, numbers or names: they get the same "
       "vertices, moved or turned from the first to the second",
       "quality.periodic", false, &read_periodic,
       &clear<std::vector<files::MarkerPair>, &MarkerOptions::periodic>,
       kEntry<files::MarkerPair, &MarkerOptions::periodic>},
      {"layers", "", "M:first=H,ratio=Q,rows=N,region=ID",
       "Rows of thin triangles along the segments with the marker M, a number or a name: the row "
       "at the wall is H high, each other Q times as high as the one before (Q is 1 if it is left "
       "out). They are the region ID, or one of their own",
       "quality.layers", true, &read_one<files::WallLayers, &MarkerOptions::layers>,
       &clear<std::vector<files::WallLayers>, &MarkerOptions::layers>,
       kEntry<files::WallLayers, &MarkerOptions::layers>},
  };
  return all;
}

std::optional<MarkerFault> fill(const MarkerOptions& options, const files::NameTable& markers,
                                v1::GenerateMeshRequest& request) {
  for (std::size_t i = 0; i < options.edge_at.size(); ++i) {
    const files::EdgeAt& given = options.edge_at[i];
    const auto marker = given.name.empty() ? files::Result<std::int32_t>(given.marker)
                                           : files::find_marker(given.name, markers);
    if (!marker) return MarkerFault{at_entry("size.at", i), marker.error()};
    v1::SizeAt& at = *request.mutable_size()->add_at();
    at.set_marker(*marker);
    at.set_max_edge(given.max_edge);
  }
  if (options.keep) {
    const auto kept = options.keep->numbers(markers);
    if (!kept) return MarkerFault{"quality.keep", kept.error()};
    request.mutable_quality()->mutable_keep()->mutable_markers()->Assign(kept->begin(),
                                                                         kept->end());
  }
  for (std::size_t i = 0; i < options.periodic.size(); ++i) {
    const auto sides = options.periodic[i].numbers(markers);
    if (!sides) return MarkerFault{at_entry("quality.periodic", i), sides.error()};
    v1::PeriodicSides& pair = *request.mutable_quality()->add_periodic();
    pair.set_from(sides->front());
    pair.set_to(sides->back());
  }
  for (std::size_t i = 0; i < options.layers.size(); ++i) {
    const auto marker = options.layers[i].number(markers);
    if (!marker) return MarkerFault{at_entry("quality.layers", i), marker.error()};
    set(options.layers[i], *marker, *request.mutable_quality()->add_layers());
  }
  return std::nullopt;
}

std::vector<std::array<std::int32_t, 2>> periodic_sides(const v1::Quality& quality) {
  std::vector<std::array<std::int32_t, 2>> sides;
  for (const v1::PeriodicSides& pair : quality.periodic())
    sides.push_back({pair.from(), pair.to()});
  return sides;
}

}  // namespace weft::wire
