// SPDX-License-Identifier: Apache-2.0
// Writes the sample mesh to the files that are named as arguments.
#include <cstdio>
#include <utility>
#include <vector>

#include "client/formats/mesh_formats.h"
#include "tests/client/support/sample_mesh.h"

int main(int argc, char** argv) {
  using namespace weft::client;
  const Mesh mesh = square_mesh(10);
  for (int i = 1; i < argc; ++i) {
    std::vector<OutputFile> files;
    for (const auto& name : mesh_files(argv[i])) {
      auto file = OutputFile::create(name, {});
      if (!file) return std::puts(file.error().message.c_str()), 1;
      files.push_back(std::move(*file));
    }
    write_mesh(*mesh_format(argv[i]), mesh.view(), files);
    if (auto done = commit(files); !done) return std::puts(done.error().message.c_str()), 1;
  }
  return 0;
}
