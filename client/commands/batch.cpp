// SPDX-License-Identifier: Apache-2.0
// `weft batch`: meshes what a manifest lists, and judges what comes back.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <thread>

#include "client/batch/batch_report.h"
#include "client/batch/lock_file.h"
#include "client/batch/manifest.h"
#include "client/commands/commands.h"
#include "client/commands/input_domain.h"
#include "client/commands/mesh_into.h"
#include "client/report/mesh_text.h"
#include "files/base/text.h"

namespace weft::client {
namespace {

Result<void> write_text(const std::filesystem::path& file, const std::string& text) {
  auto output = OutputFile::create(file, {});
  if (!output) return tl::unexpected(output.error());
  output->put(text);
  std::vector<OutputFile> files;
  files.push_back(std::move(*output));
  return commit(files);
}

// The first drawing that a page of HTML can show; empty if there is none.
std::filesystem::path picture_of(const MeshOutputOptions& output) {
  const auto found =
      std::find_if(output.drawings.begin(), output.drawings.end(),
                   [](const auto& file) { return draw_format(file) != DrawFormat::kPdf; });
  return found == output.drawings.end() ? std::filesystem::path() : *found;
}

Result<MeshReport> make_mesh(const BatchMesh& mesh, const Connection& connection,
                             const BatchOptions& options, const std::stop_token& stop) {
  const auto input =
      read_input_domain(mesh.input, mesh.request_options, mesh.output.projection, mesh.layers);
  if (!input) return tl::unexpected(input.error());
  auto request_options = with_size(mesh.request_options, input->domain, input->projection.get());
  if (!request_options) return tl::unexpected(request_options.error());
  request_options->asked.set_want_quadtree(mesh.output.draw_quadtree);
  std::optional<MeshOutput> output;
  if (!mesh.output.empty()) {
    MeshOutputOptions wanted = mesh.output;
    wanted.make_folders = true;  // a fresh checkout has none
    auto opened = MeshOutput::open(wanted, mesh.input, stop);
    if (!opened) return tl::unexpected(opened.error());
    output.emplace(std::move(*opened));
  }
  return mesh_into(
      connection, *input, *request_options,
      {.timeout_seconds = options.calls.timeout_seconds,
       .retries = options.calls.retries,
       .projection = input->projection.get()},
      output ? &*output : nullptr, [] {}, stop);
}

std::string line_of(const BatchOutcome& outcome) {
  std::string line = (outcome.passed() ? "passed  "
                      : outcome.error  ? "ERROR   "
                                       : "FAILED  ") +
                     harmless(outcome.name);
  if (outcome.summary)
    line += "  " + with_separators(outcome.summary->triangles()) + " triangles, " +
            seconds_text(outcome.seconds);
  if (outcome.summary) {
    std::string warning = unrefined_warning(outcome.summary->unrefined());
    if (!warning.empty()) warning.pop_back();
    if (!warning.empty()) line += "\n        " + warning;
  }
  for (const std::string& warning : outcome.warnings)
    line += "\n        WARNING: " + harmless(warning);
  if (outcome.error) line += "\n        " + outcome.error->message;
  for (const std::string& failure : outcome.failures) line += "\n        " + failure;
  return line + "\n";
}

// Makes all meshes, several at a time, and reports each one as it is done.
std::vector<BatchOutcome> make_all(const std::vector<BatchMesh>& meshes,
                                   const Connection& connection, const BatchOptions& options,
                                   const std::optional<LockFile>& locked, LockFile& made,
                                   const std::stop_token& stop) {
  std::vector<BatchOutcome> outcomes(meshes.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // guards `made` and standard output
  const auto work = [&] {
    for (std::size_t i = next++; i < meshes.size(); i = next++) {
      const BatchMesh& mesh = meshes[i];
      BatchOutcome& outcome = outcomes[i];
      outcome.name = mesh.name;
      outcome.drawing = picture_of(mesh.output);
      const auto start = MeshTimes::Clock::now();
      auto report = make_mesh(mesh, connection, options, stop);
      outcome.seconds = std::chrono::duration<double>(MeshTimes::Clock::now() - start).count();
      const std::lock_guard lock(mutex);
      if (report) {
        const v1::Summary& summary = report->summary;
        made.add(mesh.name, summary);
        for (const auto* gates : {&mesh.gates, &options.gates})
          for (const QualityGate& gate : *gates)
            if (auto why = gate.violation(summary)) outcome.failures.push_back(*why);
        if (locked)
          if (auto why = locked->change(mesh.name, made)) outcome.failures.push_back(*why);
        outcome.warnings = std::move(report->warnings);
        outcome.summary = std::move(report->summary);
      } else {
        outcome.error = report.error();
      }
      if (!options.quiet || !outcome.passed()) std::fputs(line_of(outcome).c_str(), stdout);
      std::fflush(stdout);
    }
  };
  std::vector<std::jthread> threads;
  for (std::uint32_t t = 0; t < std::min<std::size_t>(options.jobs, meshes.size()); ++t)
    threads.emplace_back(work);
  threads.clear();
  return outcomes;
}

Result<void> write_reports(const std::vector<BatchOutcome>& outcomes, const BatchOptions& options) {
  if (!options.junit.empty())
    if (auto ok = write_text(options.junit, junit_xml(outcomes)); !ok) return ok;
  if (options.summary.empty()) return {};
  const auto folder = options.summary.parent_path();
  return write_text(
      options.summary,
      markdown_summary(outcomes, folder.empty() ? std::filesystem::path(".") : folder));
}

}  // namespace

Result<ExitCode> run_batch(const BatchOptions& options, std::stop_token stop) {
  const auto meshes = read_manifest(options.manifest);
  if (!meshes) return tl::unexpected(meshes.error());
  const auto lock_path = options.lock.empty()
                             ? std::filesystem::path(options.manifest).replace_extension(".lock")
                             : options.lock;
  std::optional<LockFile> locked;
  if (options.locked) {
    auto read = read_lock_file(lock_path);
    if (!read) return tl::unexpected(read.error());
    locked = std::move(*read);
  }
  const auto connection = connect(options.calls.server, stop);
  if (!connection) return tl::unexpected(connection.error());

  LockFile made;
  const auto outcomes = make_all(*meshes, *connection, options, locked, made, stop);
  if (auto written = write_reports(outcomes, options); !written)
    return tl::unexpected(written.error());
  bool all_passed = true;
  for (const BatchOutcome& outcome : outcomes) {
    if (outcome.error)
      return fail(outcome.error->exit, harmless(outcome.name) + ": " + outcome.error->message);
    all_passed &= outcome.passed();
  }
  if (locked) {
    for (const auto& [name, mesh] : locked->meshes) {
      if (made.meshes.contains(name)) continue;
      std::printf("FAILED  %s\n        locked, but %s has no such mesh\n", harmless(name).c_str(),
                  options.manifest.c_str());
      all_passed = false;
    }
  }
  if (!all_passed) return ExitCode::kCheckFailed;
  if (!locked)
    if (auto written = write_lock_file(lock_path, made); !written)
      return tl::unexpected(written.error());
  return ExitCode::kOk;
}

}  // namespace weft::client
