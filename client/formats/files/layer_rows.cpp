// SPDX-License-Identifier: Apache-2.0
#include "client/formats/files/layer_rows.h"

namespace weft::client {

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
      {"strict", "WEFT_STRICT",
       "Refuse a domain of whose file something would be left out or repaired with a warning", "",
       on_or_off(&LayerOptions::strict)},
  };
  return rows;
}

}  // namespace weft::client
