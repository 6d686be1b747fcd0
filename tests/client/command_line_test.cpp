// SPDX-License-Identifier: Apache-2.0
// The binary as a user runs it, against a weftd that does what the test wants (support/fake_weftd).
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "files/formats/mesh_formats.h"
#include "files/geo/projection.h"
#include "tests/client/support/weft_process.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

class CommandLine : public WeftProcess {
 protected:
  // No output, no temporary folder, no server.
  void expect_nothing_left() const {
    EXPECT_EQ(left_in("out"), Words{});
    EXPECT_EQ(left_in("tmp"), Words{});
    if (std::filesystem::exists(folder_ / "pid")) {
      EXPECT_NE(::kill(std::stoi(contents_of(folder_ / "pid")), 0), 0);
    }
  }
};

TEST_F(CommandLine, MeshesThroughAPrivateServerAndEndsIt) {
  Words words = mesh_to("m.vtu");
  for (const char* word : {"-o", "n.node", "-o", "g.msh", "--draw", "d.png", "--draw", "d.svg"})
    words.push_back(word[0] == '-' ? word : (folder_ / "out" / word).string());
  EXPECT_EQ(run(words), 0) << err();
  EXPECT_EQ(left_in("out"),
            (Words{"d.png", "d.svg", "g.msh", "m.vtu", "n.ele", "n.node", "n.poly"}));
  EXPECT_EQ(left_in("tmp"), Words{});
  EXPECT_NE(::kill(std::stoi(contents_of(folder_ / "pid")), 0), 0);
  EXPECT_EQ(read_mesh(folder_ / "out" / "m.vtu").value(), square_mesh(4));
  EXPECT_TRUE(out().starts_with("32 triangles, 25 vertices, angles 45.00 to 90.00 degrees\n"))
      << out();
  EXPECT_EQ(err(), "weft: refining, 10 triangles so far\nweft: drawing\n");
}

TEST_F(CommandLine, PrintsOneJsonObject) {
  Words words = mesh_to("m.vtu");
  words.insert(words.end(), {"--json", "--quiet"});
  EXPECT_EQ(run(words), 0) << err();
  const auto json = nlohmann::json::parse(out());
  EXPECT_EQ(json["vertices"], 25);
  EXPECT_EQ(json["triangles"], 32);
  EXPECT_EQ(json["unrefined"], (nlohmann::json{{"small_input_angle", 0},
                                               {"edge_floor", 0},
                                               {"kept", 0},
                                               {"budget", 0},
                                               {"precision", 0},
                                               {"streaming", 0}}));
  EXPECT_EQ(json["merging"], (nlohmann::json{{"tolerance", 0.0},
                                             {"points", 0},
                                             {"segments", 0},
                                             {"farthest", 0.0},
                                             {"vanished_faces", 0}}));
  EXPECT_EQ(json["digest"].get<std::string>().size(), 64u);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_EQ(json["engine_seconds"], 0.5);
  EXPECT_EQ(json["seconds"], (nlohmann::json{{"triangulate", 0.0625},
                                             {"size", 0.125},
                                             {"prelude", 0.25},
                                             {"refine", 0.75},
                                             {"emit", 0.375},
                                             {"engine", 0.5}}));
  EXPECT_EQ(json["leaves"], 1);
  EXPECT_EQ(json["deferred"], 3);
  EXPECT_EQ(json["rounds"], 2);
  EXPECT_EQ(json["streamed"], false);
  for (const char* key : {"min_angle_deg", "max_angle_deg", "min_angle_p1_deg", "mean_quality",
                          "ideal_ratio", "lattice_share", "first_chunk_seconds", "total_seconds",
                          "peak_engine_bytes", "bytes_received"})
    EXPECT_TRUE(json[key].is_number()) << key;
  EXPECT_EQ(err(), "");
}

TEST_F(CommandLine, IsSilentWhenQuiet) {
  Words words = mesh_to("m.vtu");
  words.push_back("-q");
  EXPECT_EQ(run(words), 0);
  EXPECT_EQ(out() + err(), "");
}

TEST_F(CommandLine, RefusesUnknownExtensionsBeforeAnyWork) {
  EXPECT_EQ(run(mesh_to("m.stp")), 2);
  EXPECT_NE(err().find("'.stp' is not that of a mesh that is written: .vtu, .msh, .node, "),
            std::string::npos);
  EXPECT_EQ(run({"mesh", "in.stp", "-o", "m.vtu"}), 2);
  EXPECT_EQ(run({"mesh", "in.poly", "--draw", "m.gif"}), 2);
  EXPECT_EQ(run({"mesh", "in.poly"}), 2);
  EXPECT_EQ(run({"mesh"}), 2);
  EXPECT_EQ(run({"mush"}), 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(CommandLine, RefusesFlagsThatWouldDoNothing) {
  const auto refusal = [this](Words words) {
    EXPECT_EQ(run(words), 2) << words.back();
    return err();
  };
  EXPECT_NE(refusal({"mesh", "in.poly", "--detach", "--server", "unix:s", "--order", "2"})
                .find("--order requires --output"),
            std::string::npos)
      << err();
  EXPECT_NE(refusal({"submit", "in.poly", "--server", "unix:s", "--msh-version", "2.2"})
                .find("--msh-version requires --output"),
            std::string::npos)
      << err();
  EXPECT_NE(refusal({"mesh", "in.poly", "-o", "m.vtu", "--color", "angle"})
                .find("--color requires --draw"),
            std::string::npos)
      << err();
  EXPECT_NE(refusal({"mesh", "in.poly", "-o", "m.vtu", "--tls"}).find("--tls requires --server"),
            std::string::npos)
      << err();
  EXPECT_NE(refusal({"top", "--server", "unix:s", "--once", "--interval", "2"})
                .find("--interval excludes --once"),
            std::string::npos)
      << err();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(CommandLine, LetsTheEnvironmentNameWhatACommandHasNoUseFor) {
  EXPECT_EQ(run(mesh_to("m.vtu"), {"WEFT_COLOR=angle", "WEFT_TOKEN_FILE=/nowhere"}), 0) << err();
}

TEST_F(CommandLine, WarnsOfVariablesThatChangeTheMesh) {
  const std::string warning = "WARNING: the environment sets --min-angle: WEFT_MIN_ANGLE=25\n";
  EXPECT_EQ(run(mesh_to("m.vtu"), {"WEFT_MIN_ANGLE=25", "WEFT_CLIENT_THREADS=1"}), 0) << err();
  EXPECT_NE(out().find(warning), std::string::npos) << out();
  EXPECT_EQ(out().find("WEFT_CLIENT_THREADS"), std::string::npos) << out();
  Words given = mesh_to("m.vtu");
  given.insert(given.end(), {"--min-angle", "20"});
  EXPECT_EQ(run(given, {"WEFT_MIN_ANGLE=25"}), 0) << err();
  EXPECT_EQ(out().find("WARNING"), std::string::npos) << out();
}

TEST_F(CommandLine, IsNotEndedByWhatAVariableMeansToAnotherCommand) {
  const std::string wrong = "WEFT_MIN_ANGLE=61";
  EXPECT_EQ(run({"convert", (folder_ / "in.poly").string(), (folder_ / "out" / "d.poly").string()},
                {wrong}),
            0)
      << err();
  EXPECT_EQ(run({"check", "m.vtu"}, {wrong}), 2);
  EXPECT_NE(err().find("'61'"), std::string::npos) << err();
}

TEST_F(CommandLine, DrawsTheQuadtreeAndSaysOfHowManyLeaves) {
  const Words words = {"mesh", folder_ / "in.poly", "--draw", folder_ / "out" / "d.svg"};
  ASSERT_EQ(run(words), 0) << err();
  const std::string without = contents_of(folder_ / "out" / "d.svg");
  EXPECT_EQ(out().find("quadtree"), std::string::npos) << out();
  Words with = words;
  with.push_back("--draw-quadtree");
  ASSERT_EQ(run(with), 0) << err();
  EXPECT_GT(contents_of(folder_ / "out" / "d.svg").size(), without.size());
  EXPECT_NE(out().find("\nquadtree of 1 leaf\n"), std::string::npos) << out();
}

TEST_F(CommandLine, RefusesToDrawTheQuadtreeWithoutADrawing) {
  Words words = mesh_to("m.vtu");
  words.push_back("--draw-quadtree");
  EXPECT_EQ(run(words), 2);
  EXPECT_NE(err().find("--draw-quadtree needs a drawing: give --draw FILE, too"), std::string::npos)
      << err();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(CommandLine, RefusesToReplaceItsInput) {
  EXPECT_EQ(run({"mesh", folder_ / "in.poly", "-o", folder_ / "in.node"}), 2);
  EXPECT_NE(err().find("in.poly: would replace the input"), std::string::npos) << err();
  EXPECT_TRUE(contents_of(folder_ / "in.poly").starts_with("4 2 0 0\n"));
}

TEST_F(CommandLine, RefusesOneFileTwice) {
  Words words = mesh_to("m.vtu");
  words.insert(words.end(), {"-o", (folder_ / "out/../out/m.vtu").string()});
  EXPECT_EQ(run(words), 2);
}

TEST_F(CommandLine, NamesUnreadableInput) {
  EXPECT_EQ(run({"mesh", folder_ / "none.poly", "-o", folder_ / "out" / "m.vtu"}), 4);
  EXPECT_NE(err().find("none.poly: No such file or directory"), std::string::npos);
  expect_nothing_left();
}

TEST_F(CommandLine, NamesAMissingOutputFolderBeforeAnyWork) {
  EXPECT_EQ(run(mesh_to("no/m.vtu")), 5);
  EXPECT_NE(err().find("No such file or directory"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(CommandLine, SaysThatTheServerIsAbsent) {
  Words words = mesh_to("m.vtu");
  words.insert(words.end(),
               {"--server", "unix:" + (folder_ / "nobody").string(), "--retries", "1"});
  EXPECT_EQ(run(words), 78);
  EXPECT_NE(err().find("UNAVAILABLE"), std::string::npos) << err();
  expect_nothing_left();
}

TEST_F(CommandLine, AsksNoProxyForThisMachine) {
  const int proxy = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  ASSERT_EQ(::bind(proxy, reinterpret_cast<sockaddr*>(&at), size), 0);
  ASSERT_EQ(::listen(proxy, 1), 0);
  ASSERT_EQ(::getsockname(proxy, reinterpret_cast<sockaddr*>(&at), &size), 0);
  const std::string variable = "http_proxy=http://127.0.0.1:" + std::to_string(ntohs(at.sin_port));
  const auto call = [&](const std::string& address) {
    Words words = mesh_to("m.vtu");
    words.insert(words.end(), {"--server", address, "--retries", "0", "--timeout", "10"});
    return run(words, {variable});
  };
  EXPECT_EQ(call("127.0.0.1:1"), 78) << err();
  EXPECT_EQ(err().find("proxy"), std::string::npos) << err();
  EXPECT_LT(::accept(proxy, nullptr, nullptr), 0);
  ::close(proxy);
  EXPECT_EQ(call("mesh.invalid:7421"), 78);
  EXPECT_NE(err().find("it was called through the proxy 127.0.0.1:"), std::string::npos) << err();
  EXPECT_NE(err().find(", which http_proxy names"), std::string::npos) << err();
}

TEST_F(CommandLine, TakesTheServerFromTheEnvironment) {
  EXPECT_EQ(run(mesh_to("m.vtu"),
                {"WEFT_SERVER=unix:" + (folder_ / "nobody").string(), "WEFT_RETRIES=1"}),
            78);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(CommandLine, ShowsWhyThePrivateServerDidNotStart) {
  EXPECT_EQ(run(mesh_to("m.vtu"), {"FAKE_WEFTD=die"}), 6);
  EXPECT_NE(err().find("no luck today"), std::string::npos);
  expect_nothing_left();
}

// A file that is no library stands in for one that is missing: the loader looks there first.
TEST_F(CommandLine, NamesThePackageOfALibraryThatItCannotLoad) {
  std::ofstream(folder_ / "libcairo.so.2") << "no library";
  const std::string path = "LD_LIBRARY_PATH=" + folder_.path().string();
  EXPECT_EQ(run(mesh_to("m.vtu"), {path}), 0) << err();
  Words words = mesh_to("n.vtu");
  words.insert(words.end(), {"--draw", (folder_ / "out" / "d.png").string()});
  EXPECT_EQ(run(words, {path}), 1) << err();
  EXPECT_NE(err().find(" (Debian's package libcairo2); weft draws with cairo\n"), std::string::npos)
      << err();
  EXPECT_EQ(left_in("out"), Words{"m.vtu"});
  if (!Projection::available()) return;
  std::ofstream(folder_ / "libproj.so.25") << "no library";
  words = mesh_to("n.vtu");
  words.push_back("--lonlat");
  EXPECT_EQ(run(words, {path}), 1) << err();
  EXPECT_NE(
      err().find(" (Debian's package libproj25); weft projects longitude and latitude with PROJ\n"),
      std::string::npos)
      << err();
}

TEST_F(CommandLine, WritesNothingWhenTheServerIsKilledMidStream) {
  EXPECT_EQ(run(mesh_to("m.vtu"), {"FAKE_WEFTD=vanish"}), 78) << err();
  expect_nothing_left();
}

TEST_F(CommandLine, WritesNothingWhenTheStreamIsDamaged) {
  EXPECT_EQ(run(mesh_to("m.vtu"), {"FAKE_WEFTD=damage"}), 79);
  EXPECT_NE(err().find("chunk 1 does not match its SHA-256"), std::string::npos);
  expect_nothing_left();
}

TEST_F(CommandLine, GivesUpAfterItsTimeout) {
  Words words = mesh_to("m.vtu");
  words.insert(words.end(), {"--timeout", "0.2"});
  EXPECT_EQ(run(words, {"FAKE_WEFTD=hang"}), 68);
  expect_nothing_left();
}

// Waits until the private server has started.
void wait_for_file(const std::filesystem::path& path) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (contents_of(path).empty() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::yield();
}

TEST_F(CommandLine, EndsItsServerWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove(folder_ / "pid");
    Words words = mesh_to("m.vtu");
    words.insert(words.end(), {"-o", out_file("m.foam")});  // with folders of its own
    const pid_t pid = start(words, {"FAKE_WEFTD=hang"});
    wait_for_file(folder_ / "pid");
    ::kill(pid, signal);
    EXPECT_EQ(end_of(pid), 128 + signal);
    EXPECT_NE(err().find("interrupted"), std::string::npos);
    expect_nothing_left();
  }
}

TEST_F(CommandLine, HasSucceededWhenASignalComesAfterItsFiles) {
  // What it prints at the end waits until somebody reads.
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC | O_NONBLOCK), 0);
  const std::string page(4096, '.');
  while (::write(ends[1], page.data(), page.size()) > 0) {
  }
  ::fcntl(ends[1], F_SETFL, 0);
  const pid_t pid = start(mesh_to("m.vtu"), {}, ends[1]);
  ::close(ends[1]);
  wait_for_file(folder_ / "out" / "m.vtu");
  ::kill(pid, SIGINT);
  const std::string status = "/proc/" + std::to_string(pid) + "/status";
  // The signal was taken once it is no longer pending.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (contents_of(status).find("ShdPnd:\t0000000000000002") != std::string::npos &&
         std::chrono::steady_clock::now() < deadline)
    std::this_thread::yield();
  ::fcntl(ends[0], F_SETFL, 0);
  std::string text(page.size(), ' ');
  while (::read(ends[0], text.data(), text.size()) > 0) {
  }
  ::close(ends[0]);
  EXPECT_EQ(end_of(pid), 0) << err();
  EXPECT_EQ(err().find("interrupted"), std::string::npos) << err();
  EXPECT_EQ(left_in("out"), Words{"m.vtu"});
}

TEST_F(CommandLine, LeavesNothingWhenTheDiskIsFull) {
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{100'000, old.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const pid_t pid = start(mesh_to("m.vtu"), {"FAKE_WEFTD=large"});
  ::setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_EQ(end_of(pid), 5);
  EXPECT_NE(err().find("File too large"), std::string::npos) << err();
  expect_nothing_left();
}

TEST_F(CommandLine, RefusesAFileThatItWouldRepairIfThatIsWanted) {
  const std::string file = (folder_ / "two.csv").string();
  std::ofstream(file) << "0,0\n1,0\n1,1\n0,1\n\n3,3\n4,4\n3,3\n";
  const Words mesh = {"mesh", file, "-o", out_file("m.vtu")};
  EXPECT_EQ(run(mesh), 0) << err();
  const std::string warning = file + ": 1 ring without an area is left out: the ring from line 6";
  EXPECT_NE(out().find("WARNING: " + warning), std::string::npos) << out();
  std::filesystem::remove(out_file("m.vtu"));
  Words strict = mesh;
  strict.push_back("--strict");
  for (const auto& [words, variables] : {std::pair<Words, Words>{strict, {}},
                                         {mesh, {"WEFT_STRICT=1"}},
                                         {{"convert", file, out_file("d.poly"), "--strict"}, {}}}) {
    EXPECT_EQ(run(words, variables), 4) << out();
    EXPECT_NE(err().find(file + ": refused, because of --strict\n  " + warning), std::string::npos)
        << err();
  }
  expect_nothing_left();
}

TEST_F(CommandLine, RefusesNumbersThatAreNone) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  const auto refuses = [this](Words words, const std::string& name, const std::string& value,
                              const std::string& why) {
    words.push_back(name + "=" + value);
    EXPECT_EQ(run(words), 2) << name << " " << value << "\n" << out();
    EXPECT_TRUE(err().starts_with(name + ": '" + value + "' is not " + why + "\n")) << err();
  };
  const Words check = {"check", out_file("m.vtu"), "--domain", folder_ / "in.poly"};
  for (const char* value : {"nan", "-nan", "much"}) {
    refuses(check, "--min-angle", value, "a number");
    refuses(check, "--snap", value, "a number");
    refuses(check, "--simplify", value, "a number");
    for (const char* name :
         {"--timeout", "--min-angle", "--min-edge", "--snap", "--simplify", "--max-seconds"})
      refuses(mesh_to("n.vtu"), name, value, "a number");
    for (const char* command : {"batch", "get", "watch", "health", "list"})
      refuses({command, command == std::string("list") ? "--json" : "a"}, "--timeout", value,
              "a number");
    refuses({"top"}, "--interval", value, "a number");
  }
  refuses(check, "--min-angle", "60.1", "in the range 0 to 60");
  refuses(mesh_to("n.vtu"), "--timeout", "0", "in the range 0.001 to 1e+09");
  for (const char* value : {"-1", "-18446744073709551615", "1.5"}) {
    refuses(check, "--max-unrefined", value, "a count");
    refuses(mesh_to("n.vtu"), "--retries", value, "a count");
    refuses({"batch", "a"}, "--jobs", value, "a count");
    refuses({"list"}, "--limit", value, "a count");
  }
  refuses({"list"}, "--limit", "0", "in the range 1 or more");
  refuses({"batch", "a"}, "--jobs", "257", "in the range 1 to 256");
}

TEST_F(CommandLine, SuggestsWhatWasProbablyMeant) {
  EXPECT_EQ(run({"mseh", "a.poly"}), 2);
  EXPECT_TRUE(err().starts_with("no such command 'mseh'\n")) << err();
  EXPECT_NE(err().find("weft: did you mean `mesh`?\n"), std::string::npos) << err();
  EXPECT_EQ(run({"mseh", "--help"}), 0) << err();
  EXPECT_EQ(run({"mesh", "a.poly", "--sise", "1"}), 2);
  EXPECT_NE(err().find("weft: did you mean `--size`?\n"), std::string::npos) << err();
  EXPECT_EQ(run({"mesh", "a.poly", "--min-angel=20"}), 2);
  EXPECT_NE(err().find("`--min-angle`"), std::string::npos) << err();
  EXPECT_EQ(run({"mesh", "a.poly", "--wondrous"}), 2);
  EXPECT_EQ(err().find("did you mean"), std::string::npos) << err();
  EXPECT_EQ(run({"xy"}), 2);
  EXPECT_EQ(err().find("did you mean"), std::string::npos) << err();
}

TEST_F(CommandLine, DescribesMeshesAndDomains) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  EXPECT_EQ(run({"info", folder_ / "out" / "m.vtu"}), 0);
  EXPECT_NE(out().find("triangles  32\n"), std::string::npos) << out();
  EXPECT_NE(out().find("angles     45.0000 to 90.0000 degrees\n"), std::string::npos) << out();
  EXPECT_NE(out().find("regions    0 (16), 7 (16)\n"), std::string::npos) << out();
  EXPECT_NE(out().find("box        (0, 0) to (4, 4)\n"), std::string::npos) << out();
  EXPECT_EQ(run({"info", folder_ / "in.poly"}), 0);
  EXPECT_NE(out().find("markers    1 (1), 2 (1), 3 (1), 4 (1)\n"), std::string::npos) << out();
  EXPECT_EQ(run({"info", "a.stp"}), 2);
}

TEST_F(CommandLine, TellsTheQualityOfMeshes) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  const Words info = {"info", out_file("m.vtu"), "--quality"};
  const auto with = [&info](Words more) {
    more.insert(more.begin(), info.begin(), info.end());
    return more;
  };
  EXPECT_EQ(run(with({}), {"LC_ALL=C"}), 0) << err();
  EXPECT_NE(out().find("\n   45 to 50    ##"), std::string::npos) << out();
  EXPECT_EQ(out().find("area over its bound"), std::string::npos) << out();
  EXPECT_EQ(run(with({"--size", "x < 2 ? 1 : 0.4"}), {"LC_ALL=C.UTF-8"}), 0) << err();
  EXPECT_NE(out().find("█"), std::string::npos) << out();
  EXPECT_NE(out().find("area 1.25 of its bound\n"), std::string::npos) << out();
  EXPECT_EQ(run(with({"--json", "--size", "1"})), 0) << err();
  const auto json = nlohmann::json::parse(out());
  EXPECT_EQ(json["triangles"], 32);
  EXPECT_EQ(json["worst"]["by_area_over_bound"][0]["area_over_bound"], 0.5);
  EXPECT_EQ(run(with({"--size", "x +"})), 2);
  EXPECT_NE(err().find("the size: "), std::string::npos) << err();
  EXPECT_EQ(run({"info", folder_ / "in.poly", "--quality"}), 2);
  EXPECT_EQ(run({"info", out_file("m.vtu"), "--size", "1"}), 2);
}

TEST_F(CommandLine, FindsTheMarkersOfAMeshThatIsOnlyDrawn) {
  EXPECT_EQ(run({"mesh", folder_ / "in.poly", "--draw", out_file("d.png")}), 0) << err();
  EXPECT_EQ(out().find("WARNING"), std::string::npos) << out();
}

TEST_F(CommandLine, OffersColoursByBoundsWhereThereAreBounds) {
  const auto colors = [this](const char* command) {
    EXPECT_EQ(run({command, "--help"}), 0) << err();
    const std::size_t at = out().find("--color ") + 8;
    return out().substr(at, out().find(' ', at) - at);
  };
  for (const char* command : {"mesh", "submit", "fetch"})
    EXPECT_EQ(colors(command), "angle|size|region|none|auto") << command;
  EXPECT_EQ(colors("draw"), "angle|size|region|bound|none|auto");
}

TEST_F(CommandLine, ConvertsMeshes) {
  EXPECT_EQ(run(mesh_to("m.vtu")), 0) << err();
  EXPECT_EQ(run({"convert", out_file("m.vtu"), out_file("m.npz")}), 0) << err();
  EXPECT_TRUE(out().starts_with("32 triangles, 25 vertices\nwrote ")) << out();
  EXPECT_EQ(run({"convert", out_file("m.npz"), out_file("n.node"), "-q"}), 0) << err();
  EXPECT_EQ(out() + err(), "");
  EXPECT_EQ(read_mesh(out_file("n.node")).value(), square_mesh(4));
  EXPECT_EQ(run({"convert", out_file("m.vtu"), out_file("m.msh"), "--msh-version", "2.2", "--order",
                 "2"}),
            0)
      << err();
  EXPECT_TRUE(contents_of(out_file("m.msh")).starts_with("$MeshFormat\n2.2 0 8\n"));
}

TEST_F(CommandLine, ConvertNamesMarkersAndRegions) {
  Words named = mesh_to("m.vtu");
  for (const char* name : {"marker=1:inlet", "marker=2:outlet"})
    named.insert(named.end(), {"--names", name});
  ASSERT_EQ(run(named), 0) << err();
  EXPECT_EQ(run({"convert", out_file("m.vtu"), out_file("m.npz"), "--names", "marker=2:weir",
                 "--names", "region=7:fluid"}),
            0)
      << err();
  const Names both{{{1, "inlet"}, {2, "weir"}}, {{7, "fluid"}}};
  EXPECT_EQ(read_mesh(out_file("m.npz")).value().names, both);
  EXPECT_EQ(run({"convert", out_file("m.npz"), out_file("m.14"), "--names", "marker=3:sea",
                 "--open-boundary", "sea"}),
            0)
      << err();
  EXPECT_NE(out().find("m.14: the format does not carry these names: marker 1 'inlet'"),
            std::string::npos)
      << out();
  EXPECT_NE(contents_of(out_file("m.14")).find("open boundary 1, marker 3"), std::string::npos);
  EXPECT_EQ(run({"convert", out_file("m.npz"), out_file("m.vtu"), "--names", "marker=2:inlet"}), 2);
  EXPECT_NE(err().find("marker 2 is named 'inlet', as 1 is"), std::string::npos) << err();
  EXPECT_EQ(run({"convert", out_file("m.npz"), out_file("m.vtu"), "--names", "marker=two:inlet"}),
            2);
}

TEST_F(CommandLine, ConvertsDomainsAndWhatAMeshIsOf) {
  folder_.write("d.geojson", R"({"type": "Polygon", "coordinates": [
      [[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]], [[3, 3], [6, 3], [6, 6], [3, 6], [3, 3]]]})");
  EXPECT_EQ(run({"convert", folder_ / "d.geojson", out_file("d.poly")}), 0) << err();
  EXPECT_TRUE(out().starts_with("8 points, 8 segments, 1 holes, 0 regions\nwrote ")) << out();
  EXPECT_EQ(run(mesh_to("m.vtu")), 0) << err();
  EXPECT_EQ(run({"convert", out_file("m.vtu"), out_file("again.poly")}), 0) << err();
  EXPECT_TRUE(out().starts_with("19 points, 20 segments, 0 holes, 1 regions\n")) << out();
}

TEST_F(CommandLine, ConvertRefusesWhatMakesNoSense) {
  EXPECT_EQ(run({"convert", folder_ / "in.poly", out_file("m.vtu")}), 2);
  EXPECT_NE(err().find("is a domain; to mesh it: `weft mesh "), std::string::npos);
  EXPECT_EQ(run({"convert", "m.stl", out_file("m.vtu")}), 2);
  EXPECT_EQ(run({"convert", "m.vtu", out_file("m.stp")}), 2);
  EXPECT_EQ(run({"convert", folder_ / "in.poly", folder_ / "in.poly"}), 2);
  EXPECT_EQ(run({"convert", folder_ / "in.poly", out_file("m.poly"), "--order", "2"}), 2);
  EXPECT_EQ(run({"convert", folder_ / "in.poly", out_file("m.poly"), "--names", "marker=1:a"}), 2);
  EXPECT_NE(err().find("--names, --order"), std::string::npos) << err();
  EXPECT_EQ(run({"convert", folder_ / "none.vtu", out_file("m.msh")}), 4);
  EXPECT_EQ(left_in("out"), Words{});
}

TEST_F(CommandLine, OpensABoundaryByItsDepth) {
  Words words = mesh_to("m.14");
  words.insert(words.end(), {"--nodal", "depth=7", "--open-boundary", "deeper:6.5"});
  ASSERT_EQ(run(words), 0) << err();
  EXPECT_EQ(out().find("opens nothing"), std::string::npos) << out();
  const std::string whole_ring = "\n1 = Number of open boundaries\n";
  EXPECT_NE(contents_of(out_file("m.14")).find(whole_ring), std::string::npos);

  // The depths of a file count, too, and only files of models are opened.
  ASSERT_EQ(run({"convert", out_file("m.14"), out_file("n.gr3"), "--open-boundary", "deeper:6.5"}),
            0)
      << err();
  EXPECT_NE(contents_of(out_file("n.gr3")).find(whole_ring), std::string::npos);
  words.insert(words.end(), {"-o", out_file("m.vtu")});
  ASSERT_EQ(run(words), 0) << err();
  ASSERT_EQ(run(mesh_to("plain.vtu")), 0) << err();
  EXPECT_EQ(read_mesh(out_file("m.vtu")).value(), read_mesh(out_file("plain.vtu")).value());

  words.back() = out_file("m.14");
  words.insert(words.end(), {"--open-boundary", "deeper:7"});
  EXPECT_EQ(run(words), 2);
  EXPECT_NE(err().find("two depths are given"), std::string::npos) << err();
  EXPECT_EQ(run({"convert", out_file("m.14"), out_file("o.14"), "--open-boundary", "deeper:7"}), 0);
  EXPECT_NE(out().find("WARNING: --open-boundary deeper:7 opens nothing: nowhere are two edges in "
                       "a row of the outer boundary deeper than 7 m\n"),
            std::string::npos)
      << out();
}

TEST_F(CommandLine, ConvertsAGridWithTheOpenBoundariesThatItHas) {
  Words words = mesh_to("m.14");
  words.insert(words.end(), {"--open-boundary", "3"});
  ASSERT_EQ(run(words), 0) << err();
  const std::string grid = contents_of(out_file("m.14"));
  ASSERT_NE(grid.find("\n1 = Number of open boundaries\n"), std::string::npos);
  ASSERT_EQ(run({"convert", out_file("m.14"), out_file("n.14")}), 0) << err();
  EXPECT_EQ(contents_of(out_file("n.14")), grid);
  EXPECT_EQ(out().find("WARNING"), std::string::npos) << out();
  ASSERT_EQ(run({"convert", out_file("m.14"), out_file("m.vtu")}), 0) << err();
  EXPECT_EQ(out().find("WARNING"), std::string::npos) << out();
  // Those that are asked for replace them.
  ASSERT_EQ(run({"convert", out_file("m.14"), out_file("n.14"), "--open-boundary", "7"}), 0)
      << err();
  EXPECT_NE(contents_of(out_file("n.14")).find("\n0 = Number of open boundaries\n"),
            std::string::npos);
}

TEST_F(CommandLine, OpensNoBoundaryByADepthThatIsNotGiven) {
  const std::string needs =
      "--open-boundary deeper:50 needs the depths at the vertices: give --nodal depth=FILE";
  Words words = mesh_to("m.14");
  words.insert(words.end(), {"--nodal", "speed=7", "--open-boundary", "deeper:50"});
  EXPECT_EQ(run(words), 2);
  EXPECT_NE(err().find(needs), std::string::npos) << err();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
  ASSERT_EQ(run(mesh_to("m.vtu")), 0) << err();
  EXPECT_EQ(run({"convert", out_file("m.vtu"), out_file("m.14"), "--open-boundary", "deeper:50"}),
            2);
  EXPECT_NE(err().find(needs), std::string::npos) << err();
  EXPECT_FALSE(std::filesystem::exists(out_file("m.14")));
  for (const char* no_depth : {"deeper:", "deeper:fifty", "deeper:nan", "deeper:inf"}) {
    words.back() = no_depth;
    EXPECT_EQ(run(words), 2) << no_depth;
    EXPECT_NE(err().find("is not deeper:METRES, such as deeper:50"), std::string::npos) << err();
  }
}

TEST_F(CommandLine, RefusesFlagsOfFormatsThatAreNotWritten) {
  for (const Words& flags : {Words{"--order", "2", "-o", out_file("n.stl")}, Words{"--order", "3"},
                             Words{"--open-boundary", "1"}, Words{"--msh-version", "2.2"},
                             Words{"--msh-version", "3"}}) {
    Words words = mesh_to("m.vtu");
    words.insert(words.end(), flags.begin(), flags.end());
    EXPECT_EQ(run(words), 2) << flags[0] << " " << flags[1];
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "pid"));
}

TEST_F(CommandLine, AsksForHealthAndServerInfo) {
  EXPECT_EQ(run({"health"}), 0) << err();
  EXPECT_EQ(out(), "serving\n");
  EXPECT_EQ(run({"server-info"}), 0) << err();
  EXPECT_NE(out().find("most points            1,234,567\n"), std::string::npos) << out();
  EXPECT_EQ(run({"health", "--server", "unix:" + (folder_ / "nobody").string()}), 78);
}

TEST_F(CommandLine, ExplainsItself) {
  EXPECT_EQ(run({"--version"}), 0);
  EXPECT_TRUE(out().starts_with("weft ")) << out();
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_NE(out().find("Exit codes:"), std::string::npos);
  EXPECT_EQ(run({"mesh", "--help"}), 0);
  EXPECT_NE(out().find("Examples:"), std::string::npos);
}

}  // namespace
}  // namespace weft::client
