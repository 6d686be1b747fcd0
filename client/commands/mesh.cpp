// SPDX-License-Identifier: Apache-2.0
// `weft mesh`: reads a domain, has it meshed, writes files and drawings.
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/commands/mesh_into.h"
#include "client/drawing/draw.h"
#include "client/lint/lint_report.h"
#include "client/lint/near_places.h"
#include "client/report/mesh_text.h"
#include "client/report/picture_terminal.h"
#include "client/report/progress_bar.h"
#include "client/report/terminal_picture.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "files/lint/domain_lint.h"

namespace weft::client {
namespace {

// The small picture that ends the command.
class Picture {
 public:
  Picture(const PictureTerminal& terminal, DrawnUnit unit)
      : protocol_(terminal.protocol),
        drawing_({.pixels = terminal.long_side, .no_legend = true, .unit = unit}) {}

  Drawing& drawing() { return drawing_; }
  Result<ExitCode> show() const {
    const auto image = drawing_.image();
    if (!image) return tl::unexpected(image.error());
    const auto text = terminal_picture(*image, protocol_);
    if (!text) return tl::unexpected(text.error());
    return print(*text);
  }

 private:
  PictureProtocol protocol_;
  Drawing drawing_;
};

// What cannot be judged, the server will refuse.
void print_faults(const Domain& domain, const MeshOptions& options) {
  const double snap = options.request_options.asked.domain().snap();
  const auto lint = lint_domain(domain, options.input,
                                {.snap = std::isfinite(snap) && snap > 0 ? snap : 0,
                                 .lonlat = options.output.projection.wanted()});
  if (lint) std::fputs(lint_text(*lint).c_str(), stderr);
}

}  // namespace

Result<ExitCode> run_mesh(const MeshOptions& options, std::stop_token stop) {
  MeshTimes times;
  if (!is_domain_path(options.input)) return unknown_domain_format(options.input);
  auto output = MeshOutput::open(options.output, options.input, stop);
  if (!output) return tl::unexpected(output.error());
  const auto input =
      read_input_domain(options.input, options.request_options, options.output.projection,
                        options.layers, [&options](const Domain& read) {
                          if (options.lint) print_faults(read, options);
                        });
  if (!input) return tl::unexpected(input.error());
  const Domain& domain = input->domain;
  auto request_options = with_size(options.request_options, domain, input->projection.get());
  if (!request_options) return tl::unexpected(request_options.error());
  std::optional<Picture> picture;
  std::FILE* const text_stream = options.output.text_stream();
  if (!options.no_picture && !options.quiet && !options.json && text_stream == stdout)
    if (const auto terminal = find_picture_terminal()) {
      picture.emplace(*terminal,
                      options.output.projection.wanted() ? DrawnUnit::kMetres : DrawnUnit::kNone);
      output->also_draw(picture->drawing());
    }
  times.read = MeshTimes::Clock::now();

  const auto connection = connect_for_mesh(options.calls.server, stop);
  if (!connection) return tl::unexpected(connection.error());
  times.connected = MeshTimes::Clock::now();

  ProgressBar progress(stderr, options.quiet ? ProgressStyle::kNone : progress_style_of(stderr));
  const MeshCallOptions call = shown_call(options.calls, progress, input->projection.get());
  request_options->asked.set_want_quadtree(options.output.draw_quadtree);
  const auto received = [&] {
    times.received = MeshTimes::Clock::now();
    if (output->drawing() != nullptr) progress.say("drawing");
  };
  auto report = mesh_into(*connection, *input, *request_options, call, &*output, received, stop);
  if (!report) return tl::unexpected(report.error());
  times.written = MeshTimes::Clock::now();
  progress.clear();

  if (options.json) {
    Json json = mesh_json(*report, times);
    if (!domain.region_values.empty())
      json["region_values"] = region_values_json(domain.region_values);
    return print(json_line(json), text_stream);
  }
  if (options.quiet) return ExitCode::kOk;
  const auto printed =
      print(mesh_text(*report, times) + near_places_text(domain, options.input, report->summary) +
                region_values_text(domain.region_values) + output->text(report->summary),
            text_stream);
  return printed && picture ? picture->show() : printed;
}

}  // namespace weft::client
