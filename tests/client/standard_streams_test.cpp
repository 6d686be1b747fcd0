// SPDX-License-Identifier: Apache-2.0
// `-` on the command line of the binary.
#include "files/formats/standard_streams.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "files/base/atomic_file.h"
#include "files/formats/mesh_formats.h"
#include "tests/client/support/weft_process.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

class StandardStreams : public WeftProcess {
 protected:
  // Runs with the file as standard input.
  int run_on(const std::filesystem::path& file, const Words& words) {
    const FileDescriptor input(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    input_ = input.get();
    const int code = run(words);
    input_ = -1;
    return code;
  }
  bool says(const std::string& text) const { return err().find(text) != std::string::npos; }
};

TEST_F(StandardStreams, MeshesFromOneToTheOther) {
  ASSERT_EQ(run_on(folder_ / "in.poly", {"mesh", "-", "--from", "poly", "--to", "vtu", "-o", "-"}),
            0)
      << err();
  folder_.write("piped.vtu", out());
  EXPECT_EQ(read_mesh(folder_ / "piped.vtu").value(), square_mesh(4));
  EXPECT_TRUE(says("32 triangles, 25 vertices")) << err();
  EXPECT_TRUE(says("wrote /dev/stdout, ")) << err();
  EXPECT_EQ(left_in("tmp"), Words{});
  EXPECT_EQ(left_in("out"), Words{});

  const std::string piped = out();
  ASSERT_EQ(run(mesh_to("m.vtu")), 0) << err();
  EXPECT_EQ(contents_of(out_file("m.vtu")), piped);
  ASSERT_EQ(run_on(folder_ / "in.poly",
                   {"mesh", "-", "--from", ".POLY", "--to", "msh", "-o", "-", "--json"}),
            0)
      << err();
  EXPECT_TRUE(out().starts_with("$MeshFormat\n")) << out();
  EXPECT_EQ(nlohmann::json::parse(err().substr(err().find('{')))["triangles"], 32);
}

TEST_F(StandardStreams, ConvertsChecksAndDescribes) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0) << err();
  const std::string mesh = out_file("m.vtu");
  ASSERT_EQ(run_on(mesh, {"convert", "-", "-", "--from", "vtu", "--to", "npz"}), 0) << err();
  folder_.write("piped.npz", out());
  EXPECT_EQ(read_mesh(folder_ / "piped.npz").value(), square_mesh(4));
  EXPECT_TRUE(says("32 triangles")) << err();
  ASSERT_EQ(run_on(mesh, {"info", "-", "--from", "vtu"}), 0) << err();
  EXPECT_NE(out().find("triangles  32\n"), std::string::npos) << out();
  const std::string domain = folder_ / "in.poly";
  EXPECT_EQ(run({"check", mesh, "--domain", domain}), 3) << err();
  const std::string report = out();
  EXPECT_EQ(run_on(mesh, {"check", "-", "--from", "vtu", "--domain", domain}), 3) << err();
  EXPECT_EQ(out(), report);
  EXPECT_EQ(run_on(folder_ / "in.poly", {"lint", "-", "--from", "poly"}), 0) << err();

  folder_.write("in.geojson", R"({"type": "Polygon", "coordinates": [[[0,0],[1,0],[0,1],[0,0]]]})");
  ASSERT_EQ(
      run_on(folder_ / "in.geojson", {"convert", "-", "-", "--from", "geojson", "--to", "poly"}), 0)
      << err();
  EXPECT_TRUE(out().starts_with("3 2 0 ")) << out();
  EXPECT_TRUE(says("3 points, 3 segments")) << err();
}

TEST_F(StandardStreams, AFormatGoesBeforeTheName) {
  std::filesystem::rename(folder_ / "in.poly", folder_ / "in.txt");
  ASSERT_EQ(
      run({"mesh", folder_ / "in.txt", "--from", "poly", "-o", out_file("m.dat"), "--to", "vtu"}),
      0)
      << err();
  ASSERT_EQ(run({"convert", out_file("m.dat"), out_file("n"), "--from", "vtu", "--to", "off"}), 0)
      << err();
  EXPECT_TRUE(contents_of(out_file("n")).starts_with("OFF\n"));
}

TEST_F(StandardStreams, SaysWhereAFaultIs) {
  folder_.write("bad.poly", "3 2 0 0\n1 0 0\n2 4 zero\n");
  EXPECT_EQ(run_on(folder_ / "bad.poly", {"lint", "-", "--from", "poly"}), 4);
  EXPECT_TRUE(says("/dev/stdin:3:5: ")) << err();
  folder_.write("none.poly", "0 2 0 0\n0 0\n0\n");
  EXPECT_EQ(run_on(folder_ / "none.poly", {"lint", "-", "--from", "poly"}), 4);
  EXPECT_TRUE(says("the points are in a .node file, ")) << err();
  EXPECT_EQ(out(), "");
  EXPECT_EQ(left_in("tmp"), Words{});
}

TEST_F(StandardStreams, RefusesWhatItCannotBe) {
  const auto refusal = [this](const Words& words) {
    EXPECT_EQ(run_on(folder_ / "in.poly", words), 2) << words.back();
    EXPECT_EQ(out(), "");
    return err();
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string in = folder_ / "in.poly";
  EXPECT_TRUE(
      has(refusal({"lint", "-"}), "standard input needs a format: --from FORMAT, one of .poly, "))
      << err();
  EXPECT_TRUE(has(refusal({"lint", "-", "--from", "stp"}), "'stp' is none of .poly, ")) << err();
  EXPECT_TRUE(has(refusal({"lint", "-", "--from", "shp"}),
                  "standard input cannot be a .shp, which is read by its name"))
      << err();
  EXPECT_TRUE(has(refusal({"info", "-", "--from", "ele"}), "cannot be a .ele, ")) << err();
  EXPECT_TRUE(has(refusal({"check", "-", "--from", "poly", "--domain", in}),
                  "'.poly' is not that of a mesh"))
      << err();
  EXPECT_TRUE(has(refusal({"mesh", in, "-o", "-"}),
                  "standard output needs a format: --to FORMAT, one of .vtu, "))
      << err();
  EXPECT_TRUE(has(refusal({"mesh", in, "-o", "-", "--to", "node"}),
                  "standard output is one file, and .node is written as several"))
      << err();
  EXPECT_TRUE(has(refusal({"mesh", in, "-o", "-", "-o", out_file("m.msh"), "--to", "vtu"}),
                  "is the format of one file"))
      << err();
  EXPECT_TRUE(has(refusal({"convert", in, "-"}),
                  "standard output needs a format: --to FORMAT, one of .poly, .pb, .vtu"))
      << err();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(StandardStreams, ASignalEndsTheWaitForInput) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  const FileDescriptor reader(ends[0]);
  const FileDescriptor writer(ends[1]);
  input_ = reader.get();
  const pid_t pid = start({"lint", "-", "--from", "poly"});
  // More than the pipe holds: the last byte fits once the process reads.
  const std::string comments(1 << 17, '#');
  ASSERT_TRUE(client::write_all(writer.get(), comments.data(), comments.size()));
  ::kill(pid, SIGINT);
  EXPECT_EQ(end_of(pid), 128 + SIGINT);
  EXPECT_EQ(left_in("tmp"), Words{});
}

TEST_F(StandardStreams, NothingIsWrittenUnlessTheMeshIsWhole) {
  EXPECT_NE(run({"mesh", folder_ / "in.poly", "-o", "-", "--to", "vtu"}, {"FAKE_WEFTD=damage"}), 0);
  EXPECT_EQ(out(), "");
}

}  // namespace
}  // namespace weft::client
