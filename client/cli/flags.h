// SPDX-License-Identifier: Apache-2.0
// Flags that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/base/option_row.h"
#include "client/call/connect_options.h"
#include "client/call/mesh_request.h"
#include "client/cli/command_groups.h"
#include "client/cli/connect_flags.h"
#include "client/report/mesh_output.h"
#include "files/formats/layer_options.h"
#include "files/geo/projection_options.h"

namespace weft::client {

// A flag that sets `options`, which outlive the command. Numbers have such flags, because CLI11's
// own readers take NaN for a number in every range and -1 for a large count.
template <class Options>
CLI::Option& add_row(CLI::App& command, const std::type_identity_t<OptionRow<Options>>& row,
                     Options& options) {
  const std::string flag = "--" + row.name;
  CLI::Option& option = *command.add_option(
      flag,
      [read = row.value.read, &options, flag](const CLI::results_t& texts) {
        const std::string fault = read(texts, "", options);
        if (!fault.empty()) throw CLI::ValidationError(flag, fault);
        return true;
      },
      row.help());
  option.envname(row.variable)->type_name(row.value.unit);
  if (row.value.arity == Arity::kSwitch)
    option.multi_option_policy(CLI::MultiOptionPolicy::TakeLast)->expected(0);
  if (row.value.arity == Arity::kList)
    option.expected(CLI::detail::expected_max_vector_size)->allow_extra_args(false);
  return option;
}

// `seconds` is a double or an std::optional<double>.
template <class Seconds>
void add_timeout(CLI::App& command, Seconds& seconds, const std::string& about,
                 const std::string& default_text) {
  add_row(command,
          {"timeout", "WEFT_TIMEOUT", about, default_text, number<Seconds>("S", 0.001, 1e9)},
          seconds);
}

// Which server, how long and how often. The default of the time-out is what `calls` has.
void add_calls(CLI::App& command, CallOptions& calls, WithoutServer without,
               const std::string& timeout_about);
// Of a command that makes one mesh.
void add_mesh_call(CLI::App& command, CallOptions& calls);

// The file that the command reads, or `-`, and --from, its format.
void add_input(CLI::App& command, const std::string& name, const std::string& about, DataPath& file,
               Chosen& chosen);

// The file that `weft convert` writes, or `-`, and --to, its format.
void add_converted(CLI::App& command, DataPath& file);

// INPUT, and what its mesh must satisfy.
void add_domain_and_request_options(CLI::App& command, DataPath& input, LayerOptions& layers,
                                    RequestOptions& request_options, Chosen& chosen);
void add_request_options(CLI::App& command, RequestOptions& request_options);

// What of the domain's file is read.
void add_layers(CLI::App& command, LayerOptions& layers);

// Adds a warning for each variable of the environment that changes the mesh, so that nobody wonders
// why another machine makes another. Call when the command line has been read.
void warn_of_variables(const CLI::App& command, RequestOptions& request_options);

// How large triangles may be.
void add_size(CLI::App& command, RequestOptions& request_options);

// What markers and regions are called.
void add_names(CLI::App& command, RequestOptions& request_options);

// How meshes are written, if their format leaves a choice.
void add_writing(CLI::App& command, MeshWriteOptions& writing);

// Whether the domain is in longitude and latitude.
void add_projection_flags(CLI::App& command, ProjectionOptions& projection);

// What drawings of a file show.
void add_drawing(CLI::App& command, DrawOptions& drawing);

// The same of a domain, without a mesh; and the drawings.
void add_domain_drawing(CLI::App& command, std::vector<std::filesystem::path>& drawings,
                        DrawOptions& drawing);

// The files of a mesh.
void add_files(CLI::App& command, std::vector<DataPath>& files);
// Files to write, and drawings; and the flags of the projection.
void add_output(CLI::App& command, MeshOutputOptions& output);

// Throws CLI::ParseError if a flag among the words of the command line would do nothing, for
// want of the one that it is about, or because of another one. Variables of the environment are
// there for all commands, and may well be of no use to one.
void refuse_idle_flags(const CLI::App& command, std::span<char* const> words);

void add_json(CLI::App& command, bool& json, const std::string& help);
void add_quiet(CLI::App& command, bool& quiet);

}  // namespace weft::client
