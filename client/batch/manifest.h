// SPDX-License-Identifier: Apache-2.0
// The meshes that a pipeline wants, as a YAML file. The keys are the flags of `weft mesh`, made
// from the same rows (call/request_rows.h, report/output_rows.h); paths are relative to the file;
// `defaults` hold if a mesh has no such key.
//
//   defaults: {min-angle: 20, require: {min-angle: 20}}
//   meshes:
//     - name: pipe
//       input: models/pipe.poly
//       size: 0.4*hypot(x-200, y-200) + 1
//       output: [out/pipe.vtu]
//       draw: out/pipe.png
//       require: {max-triangles: 5000}
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/batch/quality_gate.h"
#include "client/call/mesh_request.h"
#include "client/report/mesh_output.h"
#include "files/base/error.h"
#include "files/formats/layer_options.h"

namespace weft::client {

struct BatchMesh {
  std::string name;  // unique
  std::filesystem::path input{};
  LayerOptions layers{};
  RequestOptions request_options{};
  MeshOutputOptions output{};
  std::vector<QualityGate> gates{};
};

// The keys of a mesh that `defaults` may have, too, sorted.
std::vector<std::string> manifest_keys();

// At least one mesh, in the order of the file. An error (kUnreadableInput) names file, line, key
// and value.
Result<std::vector<BatchMesh>> read_manifest(const std::filesystem::path& file);

}  // namespace weft::client
