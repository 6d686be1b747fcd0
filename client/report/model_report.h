// SPDX-License-Identifier: Apache-2.0
// What `weft check --for` prints of checker/models/model_rules.h.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "checker/models/model_rules.h"
#include "client/report/json_line.h"

namespace weft::client {

// As --for spells them, and their names.
std::vector<std::pair<std::string, std::optional<check::Model>>> models();
std::string model_name(check::Model model);  // "ADCIRC"

// The rules that the model has, as they are judged of a mesh. `has_open`: whether boundaries are
// known to be open.
struct ModelView {
  check::Model model = check::Model::kAdcirc;
  const check::ModelReport& report;
  bool has_open = false;
  bool has_depths = false;

  bool holds() const;  // no fault; there may be advice
};

// One line per rule, and the first places where it is violated below; the last line is "the mesh
// holds for ADCIRC" or "the mesh fails for ADCIRC".
std::string model_text(const ModelView& view);

// {"model": "adcirc", "holds": true, "rules": {"pinched-vertex": {"grade": "fault", "violations":
// 0},
// ...}, "violations": [{"rule": ..., "at": [x, y], "measure": ...}], "max_valence": 7, ...};
// lengths in metres.
Json model_json(const ModelView& view);

}  // namespace weft::client
