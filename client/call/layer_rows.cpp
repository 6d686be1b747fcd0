// SPDX-License-Identifier: Apache-2.0
#include "client/call/layer_rows.h"

#include <algorithm>
#include <string_view>

#include "files/base/text.h"

namespace weft::client {
namespace {

constexpr std::string_view kProperties[] = {"region", "marker", "max_edge", "max_area"};

// Returns what is wrong with it, or nothing.
std::string add_attribute(const std::string& text, LayerOptions& options) {
  const std::size_t at = text.find('=');
  const std::string property = text.substr(0, at);
  if (at == text.npos || at + 1 == text.size())
    return in_quotes(text) + " is not a property and an attribute, such as region=NAME";
  if (std::ranges::find(kProperties, property) == std::end(kProperties))
    return in_quotes(property) + " is not region, marker, max_edge or max_area";
  if (!options.attributes.emplace(property, text.substr(at + 1)).second)
    return in_quotes(property) + " has two attributes";
  return "";
}

}  // namespace

const OptionRows<LayerOptions>& layer_rows() {
  static const OptionRows<LayerOptions> rows = {
      {"layer",
       "",
       "Layer of the domain's file, such as a .gpkg, that is read. May be repeated",
       "the only layer",
       {"NAME", "", Arity::kList,
        [](const auto& texts, const auto&, LayerOptions& options) -> std::string {
          options.layers = texts;
          return "";
        }}},
      {"where",
       "",
       "Read only those features of the domain's file whose attributes fulfil this condition of "
       "SQL, such as \"depth < 5 and kind = 'quay'\"",
       "",
       {"SQL", "", Arity::kOne,
        [](const auto& texts, const auto&, LayerOptions& options) -> std::string {
          options.where = texts.front();
          return "";
        }}},
      {"attribute",
       "",
       "Attribute of the file's features that is their region, marker, max_edge or max_area, such "
       "as region=LANDUSE: a number, or a name. May be repeated",
       "the attribute called so",
       {"PROPERTY=NAME", "", Arity::kList,
        [](const auto& texts, const auto&, LayerOptions& options) -> std::string {
          options.attributes.clear();
          for (const std::string& text : texts)
            if (std::string wrong = add_attribute(text, options); !wrong.empty()) return wrong;
          return "";
        }}},
      {"strict", "WEFT_STRICT",
       "Refuse a domain of whose file something would be left out or repaired with a warning", "",
       on_or_off(&LayerOptions::strict)},
  };
  return rows;
}

}  // namespace weft::client
