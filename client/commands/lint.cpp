// SPDX-License-Identifier: Apache-2.0
// `weft lint`: all faults of a domain, at once.
#include <cmath>
#include <utility>
#include <vector>

#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/lint/lint_report.h"
#include "files/base/text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "files/lint/domain_lint.h"

namespace weft::client {
namespace {

Result<void> check_options(const LintOptions& options) {
  if (options.snap && !(std::isfinite(*options.snap) && *options.snap >= 0))
    return fail(ExitCode::kUsage,
                "--snap is " + shortest(*options.snap) + "; it must be finite and 0 or more");
  for (const std::string& kind : options.ignored)
    if (!is_fault_kind(kind))
      return fail(ExitCode::kUsage, "--ignore: " + in_quotes(kind) +
                                        " is not a kind of fault: " + fault_kinds() + ", warning");
  for (const auto& layer : options.layer_files)
    if (const std::string extension = lower_extension(layer);
        extension != ".geojson" && extension != ".json")
      return fail(ExitCode::kUsage, layer.string() + ": the findings are written to .geojson");
  for (const auto& drawing : options.drawings)
    if (!draw_format(drawing))
      return fail(ExitCode::kUsage, drawing.string() + ": the extension " +
                                        in_quotes(drawing.extension().string()) +
                                        " is not that of a drawing: .png, .svg, .pdf");
  for (const auto* files : {&options.layer_files, &options.drawings})
    for (const auto& file : *files) {
      std::error_code ignored;
      if (std::filesystem::equivalent(file, options.file, ignored))
        return fail(ExitCode::kUsage, file.string() + ": would replace the input");
    }
  return {};
}

Result<void> write_files(const LintOptions& options, const Domain& domain, const Lint& lint,
                         const std::stop_token& stop) {
  std::vector<OutputFile> files;
  const auto open = [&](const std::filesystem::path& name) -> Result<void> {
    auto file = OutputFile::create(name, stop);
    if (!file) return tl::unexpected(file.error());
    files.push_back(std::move(*file));
    return {};
  };
  for (const auto& name : options.layer_files) {
    if (auto opened = open(name); !opened) return opened;
    write_lint_layer(lint, files.back());
  }
  if (!options.drawings.empty()) {
    DrawOptions wanted = options.drawing;
    if (options.lonlat) wanted.unit = DrawnUnit::kDegrees;
    Drawing drawing(wanted);
    draw_lint(domain, lint, drawing);
    for (const auto& name : options.drawings) {
      if (auto opened = open(name); !opened) return opened;
      if (auto drawn = drawing.draw(*draw_format(name), {}, files.back()); !drawn) return drawn;
    }
  }
  return commit(files);
}

}  // namespace

Result<ExitCode> run_lint(const LintOptions& options, std::stop_token stop) {
  if (auto ok = check_options(options); !ok) return tl::unexpected(ok.error());
  LayerOptions how = options.layers;
  how.lonlat = options.lonlat;
  how.even_odd = options.fill == PolygonFill::kEvenOdd;
  auto domain = read_domain(options.file, how);
  if (!domain) return tl::unexpected(domain.error());
  if (!options.lonlat)
    warn_of_degrees(options.file, *domain);
  else if (auto ok = check_lonlat(options.file, *domain); !ok)
    return tl::unexpected(ok.error());
  fill_polygons(*domain, options.fill);
  const auto lint = lint_domain(
      *domain, options.file,
      {.snap = options.snap.value_or(0), .lonlat = options.lonlat, .ignored = options.ignored});
  if (!lint) return tl::unexpected(lint.error());
  if (auto written = write_files(options, *domain, *lint, stop); !written)
    return tl::unexpected(written.error());
  const auto printed = print(options.json ? json_line(lint_json(*lint)) : lint_text(*lint));
  if (!printed) return printed;
  return lint->total == 0 ? ExitCode::kOk : ExitCode::kCheckFailed;
}

}  // namespace weft::client
