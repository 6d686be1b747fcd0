// SPDX-License-Identifier: Apache-2.0
// Flags that several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>

#include "client/call/mesh_request.h"
#include "client/geo/projection_options.h"
#include "client/report/mesh_output.h"

namespace weft::client {

// A number of seconds that makes sense as a time-out.
CLI::Range seconds_range();

void add_timeout(CLI::App& command, std::optional<double>& seconds, const std::string& help);

void add_retries(CLI::App& command, std::uint32_t& retries);

// INPUT, and what its mesh must satisfy.
void add_domain_and_request_options(CLI::App& command, std::filesystem::path& input,
                                    RequestOptions& request_options);

// How large triangles may be.
void add_size(CLI::App& command, RequestOptions& request_options);

// How meshes are written, if their format leaves a choice.
void add_writing(CLI::App& command, MeshWriteOptions& writing);

// Whether the domain is in longitude and latitude.
void add_projection_flags(CLI::App& command, ProjectionOptions& projection);

// What drawings show.
void add_drawing(CLI::App& command, DrawOptions& drawing);

// Files to write, and drawings; and the flags of the projection.
void add_output(CLI::App& command, MeshOutputOptions& output);

// Throws CLI::ParseError where a flag among the words of the command line would do nothing, for
// want of the one that it is about, or because of another one. Variables of the environment are
// there for all commands, and may well be of no use to one.
void refuse_idle_flags(const CLI::App& command, std::span<char* const> words);

void add_json(CLI::App& command, bool& json, const std::string& help);
void add_quiet(CLI::App& command, bool& quiet);

}  // namespace weft::client
