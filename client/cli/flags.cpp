// SPDX-License-Identifier: Apache-2.0
#include "client/cli/flags.h"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "client/call/layer_rows.h"
#include "client/call/projection_rows.h"
#include "client/call/request_rows.h"
#include "client/report/output_rows.h"
#include "files/base/text.h"
#include "files/base/words.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

// A flag of each row. `options` outlive the command.
template <class Options>
void add_rows(CLI::App& command, const OptionRows<Options>& rows, Options& options) {
  for (const OptionRow<Options>& row : rows) add_row(command, row, options);
}

void add_drawings(CLI::App& command, std::vector<std::filesystem::path>& drawings) {
  command.add_option("--draw", drawings, "Drawing to write, may be repeated: .png, .svg, .pdf")
      ->allow_extra_args(false)
      ->type_name("FILE");
}

// A flag for the format of files that were given before it.
void add_format(CLI::App& command, const std::string& flag, const std::string& about,
                bool (*is_known)(const DataPath&), const std::string& formats,
                const std::function<void(const std::string&)>& set) {
  command
      .add_option(
          flag,
          [=](const CLI::results_t& texts) {
            DataPath known;
            known.format = lower_case(texts.front());
            if (!known.format.starts_with('.')) known.format.insert(0, 1, '.');
            if (!is_known(known))
              throw CLI::ValidationError(flag, in_quotes(texts.front()) + " is none of " + formats);
            set(known.format);
            return true;
          },
          about)
      ->type_name("FORMAT");
}

bool is_written(const DataPath& file) {
  const MeshFormat* const format = mesh_format(file);
  return format != nullptr && format->write != nullptr;
}

}  // namespace

void add_input(CLI::App& command, const std::string& name, const std::string& about, DataPath& file,
               Chosen& chosen) {
  command
      .add_option(
          name,
          [&file, &chosen](const CLI::results_t& texts) {
            static_cast<std::filesystem::path&>(file) =
                texts.front() == "-" ? kStandardInput : texts.front();
            chosen.input = &file;
            return true;
          },
          about + "; or - for standard input")
      ->type_name("TEXT")
      ->required();
  add_format(command, "--from",
             "Format of " + name + ", whatever its name is, such as poly; - needs it",
             is_domain_path, domain_extensions() + ", " + read_mesh_extensions(),
             [&file](const std::string& format) { file.format = format; });
}

void add_converted(CLI::App& command, DataPath& file) {
  command
      .add_option(
          "OUT",
          [&file](const CLI::results_t& texts) {
            static_cast<std::filesystem::path&>(file) =
                texts.front() == "-" ? kStandardOutput : texts.front();
            return true;
          },
          "Mesh: " + written_mesh_extensions() + "; or domain: .poly; or - for standard output")
      ->type_name("TEXT")
      ->required();
  add_format(
      command, "--to", "Format of OUT, whatever its name is, such as vtu; - needs it",
      [](const DataPath& f) { return is_written(f) || f.format == ".poly" || f.format == ".pb"; },
      ".poly, .pb, " + written_mesh_extensions(),
      [&file](const std::string& format) { file.format = format; });
}

void add_calls(CLI::App& command, CallOptions& calls, WithoutServer without,
               const std::string& timeout_about) {
  add_server_flags(command, calls.server, without);
  add_timeout(command, calls.timeout_seconds, timeout_about,
              calls.timeout_seconds ? shortest(*calls.timeout_seconds) : "none");
  add_row(command,
          {"retries", "WEFT_RETRIES",
           "Maximum retries, with growing waits, while the server is unavailable or busy",
           std::to_string(calls.retries), number<std::uint32_t>("N")},
          calls.retries);
}

void add_mesh_call(CLI::App& command, CallOptions& calls) {
  add_calls(command, calls, WithoutServer::kPrivate, "Maximum time of the whole call, in seconds");
}

void add_domain_and_request_options(CLI::App& command, DataPath& input, LayerOptions& layers,
                                    RequestOptions& request_options, Chosen& chosen) {
  add_input(command, "INPUT",
            "Domain: " + domain_extensions() +
                "; or a mesh, to mesh its domain anew: " + read_mesh_extensions(),
            input, chosen);
  add_layers(command, layers);
  add_request_options(command, request_options);
}

void add_request_options(CLI::App& command, RequestOptions& request_options) {
  add_rows(command, request_rows(), request_options);
}

void warn_of_variables(const CLI::App& command, RequestOptions& request_options) {
  static const std::set<std::string> harmless_ones = {"allow-unrefined", "max-seconds", "threads",
                                                      "no-cache"};
  for (const auto& row : request_rows()) {
    const char* const value = row.variable.empty() ? nullptr : std::getenv(row.variable.c_str());
    const CLI::Option* const option = command.get_option_no_throw("--" + row.name);
    if (value == nullptr || option == nullptr || harmless_ones.contains(row.name)) continue;
    if (option->results() == std::vector<std::string>{value})
      request_options.warnings.push_back("the environment sets --" + row.name + ": " +
                                         row.variable + "=" + harmless(value));
  }
}

void add_size(CLI::App& command, RequestOptions& request_options) {
  add_rows(command, size_rows(), request_options);
}

void add_names(CLI::App& command, RequestOptions& request_options) {
  add_rows(command, name_rows(), request_options);
}

void add_writing(CLI::App& command, MeshWriteOptions& writing) {
  add_rows(command, writing_rows(), writing);
}

void add_layers(CLI::App& command, LayerOptions& layers) {
  add_rows(command, layer_rows(), layers);
}

void add_projection_flags(CLI::App& command, ProjectionOptions& projection) {
  add_rows(command, projection_rows(), projection);
}

void add_drawing(CLI::App& command, DrawOptions& drawing) {
  add_rows(command, drawing_rows(), drawing);
}

void add_domain_drawing(CLI::App& command, std::vector<std::filesystem::path>& drawings,
                        DrawOptions& drawing) {
  add_drawings(command, drawings);
  add_rows(command, drawing_rows_of_domain(), drawing);
}

void add_files(CLI::App& command, std::vector<DataPath>& files) {
  command
      .add_option(
          "-o,--output",
          [&files](const CLI::results_t& texts) {
            for (const std::string& text : texts)
              files.emplace_back(text == "-" ? kStandardOutput : text);
            return true;
          },
          "File to write, or - for standard output, may be repeated: " + written_mesh_extensions())
      ->expected(CLI::detail::expected_max_vector_size)
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_format(command, "--to",
             "Format of the file to write, whatever its name is, such as vtu; -o - needs it",
             is_written, written_mesh_extensions(), [&files](const std::string& format) {
               if (files.size() > 1)
                 throw CLI::ValidationError("--to", "is the format of one file: give one -o");
               for (DataPath& file : files) file.format = format;
             });
}

void add_output(CLI::App& command, MeshOutputOptions& output) {
  add_files(command, output.files);
  add_writing(command, output.writing);
  add_drawings(command, output.drawings);
  add_rows(command, drawing_rows_of_new_mesh(), output.drawing);
  add_rows(command, quadtree_rows(), output);
  add_projection_flags(command, output.projection);
}

void refuse_idle_flags(const CLI::App& command, std::span<char* const> words) {
  struct Pair {
    std::string flag;
    std::string other;
  };
  std::vector<Pair> needs = {{"--to", "--output"},
                             {"--tls", "--server"},
                             {"--tls-ca", "--server"},
                             {"--tls-cert", "--server"},
                             {"--tls-key", "--server"},
                             {"--tls-server-name", "--server"},
                             {"--token-file", "--server"},
                             {"--insecure", "--server"},
                             {"--json", "--quality"},
                             {"--layer", "--domain"},
                             {"--where", "--domain"},
                             {"--strict", "--domain"},
                             {"--simplify", "--domain"},
                             {"--min-angle", "--domain"},
                             {"--snap", "--domain"},
                             {"--fill", "--domain"},
                             {"--max-unrefined", "--domain"},
                             {"--open-boundary", "--for"}};
  for (const auto& row : writing_rows()) needs.push_back({"--" + row.name, "--output"});
  for (const auto& row : drawing_rows()) needs.push_back({"--" + row.name, "--draw"});
  for (const auto& row : size_rows())
    for (const char* other : {"--quality", "--domain"}) needs.push_back({"--" + row.name, other});
  const Pair excludes[] = {{"--interval", "--once"}, {"--lint", "--detach"}};
  const auto is_given = [words](const std::string& flag) {
    return std::any_of(words.begin(), words.end(), [&flag](std::string_view word) {
      return word == flag || word.starts_with(flag + "=");
    });
  };
  for (const auto& [flag, other] : needs) {
    const CLI::Option* const needed = command.get_option_no_throw(other);
    if (needed != nullptr && needed->count() == 0 && is_given(flag))
      throw CLI::RequiresError(flag, other);
  }
  for (const auto& [flag, other] : excludes)
    if (is_given(flag) && is_given(other)) throw CLI::ExcludesError(flag, other);
}

void add_json(CLI::App& command, bool& json, const std::string& help) {
  command.add_flag("--json", json, help);
}

void add_quiet(CLI::App& command, bool& quiet) {
  command.add_flag("--quiet,-q", quiet, "Print no progress and no summary")->envname("WEFT_QUIET");
}

}  // namespace weft::client
