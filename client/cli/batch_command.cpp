// SPDX-License-Identifier: Apache-2.0
// The flags of `weft batch`.
#include <memory>
#include <string>
#include <vector>

#include "client/batch/manifest.h"
#include "client/cli/command_groups.h"
#include "client/cli/connect_flags.h"
#include "client/cli/flags.h"
#include "client/commands/commands.h"

namespace weft::client {
namespace {

constexpr char kManifest[] =
    R"(The manifest, in YAML; its keys are flags of `weft mesh`, its paths are relative to
it, and what is under `defaults` holds for all:
  defaults: {min-angle: 20}
  meshes:
    - name: pipe
      input: pipe.poly
      size: 0.4*hypot(x-200, y-200) + 1
      output: [out/pipe.vtu]
      draw: out/pipe.png
      require: {max-triangles: 5000}

Keys of a mesh: name, input, output, draw, and those that `defaults` may have, too:
)";

constexpr char kFiguresAndExamples[] =
    R"(Figures that --require and `require` know: min-angle, max-angle, min-triangles,
max-triangles, max-vertices, max-unrefined.

Examples:
  weft batch meshes.yaml                    # makes meshes.lock, too: commit it
  weft batch meshes.yaml --locked --require min-angle=20 \
    --junit report.xml --summary summary.md)";

// "  allow-unrefined, color, ...", in lines of a terminal.
std::string list_of_keys() {
  constexpr std::size_t kColumns = 80;
  std::string list;
  std::string line = " ";
  for (const std::string& key : manifest_keys()) {
    if (line.size() + key.size() + 2 > kColumns) {
      list += line + "\n";
      line = " ";
    }
    line += " " + key + ",";
  }
  line.back() = '\n';
  return list + line;
}

}  // namespace

void add_batch_command(CLI::App& app, Chosen& chosen) {
  struct Kept {
    BatchOptions options;
    std::vector<std::string> gates;
  };
  const auto kept = std::make_shared<Kept>();
  BatchOptions& options = kept->options;
  CLI::App& batch =
      *app.add_subcommand("batch", "Mesh the domains that a manifest lists, and check the meshes");
  batch.footer(kManifest + list_of_keys() + "\n" + kFiguresAndExamples);
  batch.add_option("MANIFEST", options.manifest, "List of meshes: .yaml")->required();
  batch
      .add_option("--require", kept->gates,
                  "Bound that every mesh must satisfy, such as min-angle=20; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto gate = QualityGate::parse(text);
            return gate ? std::string() : gate.error().message;
          },
          "", ""))
      ->type_name("FIGURE=BOUND");
  batch
      .add_flag("--locked", options.locked,
                "Fail if a mesh differs from the lock file, and do not write the file")
      ->envname("WEFT_LOCKED");
  batch
      .add_option("--lock", options.lock,
                  "File with the digest of each mesh. Default: beside the manifest, with the "
                  "extension .lock")
      ->type_name("FILE");
  batch.add_option("--junit", options.junit, "Report to write, as JUnit XML")->type_name("FILE");
  batch
      .add_option("--summary", options.summary,
                  "Page to write, as Markdown, with the drawings of the meshes")
      ->type_name("FILE");
  add_row(batch,
          {"jobs", "WEFT_CLIENT_JOBS", "Meshes made at the same time", std::to_string(options.jobs),
           number("N", &BatchOptions::jobs, 1, 256)},
          options);
  add_calls(batch, options.calls, WithoutServer::kPrivate, "Maximum time per mesh, in seconds");
  batch.add_flag("--quiet,-q", options.quiet, "Report only meshes that fail")
      ->envname("WEFT_QUIET");
  batch.callback([kept, &chosen] {
    for (const std::string& gate : kept->gates)
      kept->options.gates.push_back(*QualityGate::parse(gate));
    chosen.when_interrupted = "interrupted; meshes that are not named above were not written";
    chosen.run = [kept](std::stop_token stop) { return run_batch(kept->options, std::move(stop)); };
  });
}

}  // namespace weft::client
