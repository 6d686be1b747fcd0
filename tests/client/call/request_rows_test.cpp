// SPDX-License-Identifier: Apache-2.0
// Every row of the tables, as a flag of `weft mesh` and `weft submit`, as a variable of the
// environment, and as a key of a manifest: all of them ask for the same.
#include "client/call/request_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "client/batch/manifest.h"
#include "client/call/layer_rows.h"
#include "client/call/projection_rows.h"
#include "client/report/output_rows.h"
#include "files/geo/projection.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/job_commands.h"
#include "tests/client/support/sample_stream.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

// The parts of a row that do not depend on whose options it sets.
struct Row {
  std::string name;
  std::string variable;
  Arity arity;
  bool has_range;
  bool of_request;
};

std::vector<Row> all_rows() {
  std::vector<Row> all;
  const auto add = [&all](const auto& rows, bool of_request) {
    for (const auto& row : rows)
      all.push_back(
          {row.name, row.variable, row.value.arity, !row.value.range.empty(), of_request});
  };
  add(request_rows(), true);
  add(writing_rows(), false);
  add(drawing_rows(), false);
  add(quadtree_rows(), false);
  if (Projection::available()) add(projection_rows(), false);
  return all;
}

// A value that is not the default, and a file whose contents show it.
struct Sample {
  std::string value;
  std::string file = "m.vtu";
};

// A new row needs a sample here.
const std::map<std::string, Sample>& samples() {
  static const std::map<std::string, Sample> all = {{"size", {"x + 1"}},
                                                    {"edge", {"x + 2"}},
                                                    {"field", {"d=distance"}},
                                                    {"edge-at", {"marker=3:0.5"}},
                                                    {"gradation", {"0.25"}},
                                                    {"gradation-within", {"true"}},
                                                    {"cells-across", {"3"}},
                                                    {"points-per-circle", {"36"}},
                                                    {"min-angle", {"25"}},
                                                    {"min-edge", {"0.0010549"}},
                                                    {"keep", {"2,5"}},
                                                    {"periodic", {"4:2"}},
                                                    {"layers", {"4:first=0.125,rows=2"}},
                                                    {"placement", {"circumcentre"}},
                                                    {"optimise", {"3"}},
                                                    {"snap", {"0.0014385"}},
                                                    {"simplify", {"0.625"}},
                                                    {"fill", {"even-odd"}},
                                                    {"allow-unrefined", {"true"}},
                                                    {"max-triangles", {"9"}},
                                                    {"max-seconds", {"4.5"}},
                                                    {"threads", {"3"}},
                                                    {"names", {"marker=3:inlet", "m.msh"}},
                                                    {"no-cache", {"true"}},
                                                    {"order", {"2"}},
                                                    {"msh-version", {"2.2", "m.msh"}},
                                                    {"open-boundary", {"1", "m.14"}},
                                                    {"nodal", {"depth=7", "m.14"}},
                                                    {"renumber", {"rcm"}},
                                                    {"parts", {"2"}},
                                                    {"color", {"angle", "m.svg"}},
                                                    {"zoom", {"1,1,2,2", "m.svg"}},
                                                    {"worst", {"2", "m.svg"}},
                                                    {"labels", {"true", "m.svg"}},
                                                    {"no-legend", {"true", "m.svg"}},
                                                    {"draw-size", {"900", "m.svg"}},
                                                    {"draw-quadtree", {"true", "m.svg"}},
                                                    {"lonlat", {"true"}},
                                                    {"crs", {"EPSG:32631"}},
                                                    {"to-metres", {"true"}}};
  return all;
}

class RequestRows : public JobCommands {
 protected:
  // What the server was asked for, and the file that was written.
  using Made = std::pair<std::string, std::string>;

  Words flag(const Row& row, const std::string& value) const {
    if (row.arity == Arity::kSwitch && value == "true") return {"--" + row.name};
    return {"--" + row.name + "=" + value};
  }
  static bool is_drawing(const std::string& file) { return file.ends_with(".svg"); }

  Made made(const std::string& file) const {
    const auto requests = meshes_.service().requests();
    EXPECT_FALSE(requests.empty());
    return {requests.empty() ? "" : requests.back().SerializeAsString(),
            contents_of(out_file(file))};
  }
  Made mesh(const std::string& file, const Words& flags, const Words& variables = {}) {
    std::filesystem::remove(out_file(file));
    Words words = {"mesh",
                   folder_ / "in.poly",
                   "--server",
                   address_,
                   is_drawing(file) ? "--draw" : "-o",
                   out_file(file)};
    words.insert(words.end(), flags.begin(), flags.end());
    EXPECT_EQ(run(words, variables), 0) << err();
    return made(file);
  }
  std::string manifest(const std::string& file, const std::string& key,
                       const std::string& value) const {
    return folder_.write("m.yaml", "meshes:\n  - name: m\n    input: in.poly\n    " +
                                       std::string(is_drawing(file) ? "draw: " : "output: ") +
                                       "out/" + file + "\n    " + key + ": " + value + "\n");
  }
  Made batch(const std::string& file, const std::string& key, const std::string& value) {
    std::filesystem::remove(out_file(file));
    EXPECT_EQ(run({"batch", manifest(file, key, value), "--server", address_}), 0) << err();
    return made(file);
  }

  const std::string address_ = "unix:" + (folder_ / "meshes").string();
  mutable FakeServer meshes_{Script{stream_of(square_mesh(4), 3)}, address_};
};

TEST_F(RequestRows, AskForTheSameAsFlagVariableAndKey) {
  for (const Row& row : all_rows()) {
    SCOPED_TRACE(row.name);
    ASSERT_TRUE(samples().contains(row.name));
    const auto& [value, file] = samples().at(row.name);
    const Made by_flag = mesh(file, flag(row, value));
    EXPECT_NE(by_flag, mesh(file, {}));
    EXPECT_EQ(by_flag, batch(file, row.name, value));
    if (!row.variable.empty()) {
      EXPECT_EQ(by_flag, mesh(file, {}, {row.variable + "=" + value}));
    }
  }
}

// in.poly has no layers.
TEST_F(RequestRows, OfLayersReachTheReaderAsFlagAndKey) {
  const std::string refusal = "in.poly: --layer, --where and --attribute are for files with layers";
  for (const auto& row : layer_rows()) {
    if (row.name == "strict") continue;  // for all files
    SCOPED_TRACE(row.name);
    EXPECT_EQ(run({"mesh", folder_ / "in.poly", "-o", out_file("m.vtu"), "--server", address_,
                   "--" + row.name, "region=x"}),
              2);
    EXPECT_THAT(err(), ::testing::HasSubstr(refusal));
    EXPECT_EQ(run({"batch", manifest("m.vtu", row.name, "region=x"), "--server", address_}), 2);
    EXPECT_THAT(err(), ::testing::HasSubstr(refusal));
  }
}

TEST_F(RequestRows, OfAttributesNameAPropertyOnce) {
  for (const auto& [text, fault] :
       {std::pair{"LANDUSE", "'LANDUSE' is not a property and an attribute, such as region=NAME"},
        {"region=", "'region=' is not a property and an attribute"},
        {"name=LANDUSE", "'name' is not region, marker, max_edge or max_area"}}) {
    EXPECT_EQ(run({"mesh", folder_ / "in.poly", "-o", out_file("m.vtu"), "--attribute", text}), 2);
    EXPECT_THAT(err(), ::testing::HasSubstr(fault));
  }
  EXPECT_EQ(run({"mesh", folder_ / "in.poly", "-o", out_file("m.vtu"), "--attribute", "region=A",
                 "--attribute", "region=B"}),
            2);
  EXPECT_THAT(err(), ::testing::HasSubstr("'region' has two attributes"));
}

// Whether the request has something in the field.
bool has(const google::protobuf::Message& request, const std::string& field) {
  const std::size_t dot = std::min(field.find('.'), field.size());
  const auto* const part = request.GetDescriptor()->FindFieldByName(field.substr(0, dot));
  if (part == nullptr) return false;
  const auto& reflection = *request.GetReflection();
  if (part->is_repeated()) return reflection.FieldSize(request, part) > 0;
  if (!reflection.HasField(request, part)) return false;
  return dot == field.size() || has(reflection.GetMessage(request, part), field.substr(dot + 1));
}

TEST_F(RequestRows, SetTheirFieldsOfTheRequestAndAreNamedByThem) {
  for (const auto& row : request_rows()) {
    if (row.name == "names" || row.name == "fill") continue;  // a file may give these, too
    SCOPED_TRACE(row.name);
    RequestOptions options;
    EXPECT_EQ(option_of(row.field, options), "");
    ASSERT_EQ(row.value.read({samples().at(row.name).value}, "", options), "");
    const auto read = with_size(options, square_domain(4));
    ASSERT_TRUE(read);
    EXPECT_TRUE(has(make_request(square_domain(4), *read), row.field));
    EXPECT_FALSE(has(make_request(square_domain(4), {}), row.field));
    EXPECT_EQ(option_of(row.field, *read), "--" + row.name);
    options.from_manifest = true;
    EXPECT_EQ(option_of(row.field, options), row.name);
  }
}

TEST(OptionOf, AFieldIsTheOneThatSetTheInnermostOfThose) {
  RequestOptions options;
  const auto give = [&options](const std::string& name, const std::vector<std::string>& texts) {
    for (const auto& row : request_rows())
      if (row.name == name) {
        EXPECT_EQ(row.value.read(texts, "", options), "");
      }
  };
  give("edge-at", {"marker=2:500", "marker=inlet:3"});
  EXPECT_EQ(option_of("size", options), "--edge-at") << "nothing else has set the size";
  give("edge", {"a + b"});
  give("field", {"a=distance", "b=width"});
  EXPECT_EQ(option_of("size", options), "--edge");
  EXPECT_EQ(option_of("size.expression", options), "--edge");
  EXPECT_EQ(option_of("size.fields", options), "--field");
  EXPECT_EQ(option_of("size.fields[1]", options), "--field b");
  EXPECT_EQ(option_of("size.fields[0].distance.markers", options), "--field a");
  EXPECT_EQ(option_of("size.fields[2].name", options), "--field") << "there is no such field";
  EXPECT_EQ(option_of("size.at[0].marker", options), "--edge-at marker=2");
  EXPECT_EQ(option_of("size.at[1].max_edge", options), "--edge-at marker=inlet");
  give("snap", {"0.1"});
  EXPECT_EQ(option_of("domain.snap", options), "--snap");
  EXPECT_EQ(option_of("domain", options), "");
  EXPECT_EQ(option_of("domain.snapped", options), "");
  EXPECT_EQ(option_of("threads", options), "") << "it was not given";
  EXPECT_EQ(option_of("", options), "");
}

TEST_F(RequestRows, AskForTheSameAsFlagsOfSubmit) {
  for (const Row& row : all_rows()) {
    if (!row.of_request) continue;
    SCOPED_TRACE(row.name);
    const auto& [value, file] = samples().at(row.name);
    v1::GenerateMeshRequest asked;
    ASSERT_TRUE(asked.ParseFromString(mesh(file, flag(row, value)).first));
    ASSERT_EQ(ask(submit(flag(row, value))), 0) << err();
    const v1::SubmitJobRequest job = jobs_.submissions().back();
    EXPECT_EQ(job.no_cache(), asked.no_cache());
    asked.clear_no_cache();
    EXPECT_EQ(job.mesh().SerializeAsString(), asked.SerializeAsString());
  }
}

TEST_F(RequestRows, RefuseABadValueInTheSameWords) {
  for (const Row& row : all_rows()) {
    if (row.name == "size" || row.name == "edge") continue;  // it is the server that reads it
    if (row.name == "open-boundary" || row.name == "keep") continue;  // any text may be a name
    for (const std::string value : {"?", "0"}) {
      if (value == "0" && !row.has_range) continue;
      SCOPED_TRACE(row.name + " " + value);
      const std::string path = manifest("m.vtu", row.name, "'" + value + "'");
      const auto read = read_manifest(path);
      ASSERT_FALSE(read);
      EXPECT_EQ(read.error().exit, ExitCode::kUnreadableInput);
      const std::string place = path + ":5: ";
      ASSERT_TRUE(read.error().message.starts_with(place + row.name + ": '" + value + "' is not "))
          << read.error().message;
      Words words = {"mesh", "in.poly"};
      for (const std::string& word : flag(row, value)) words.push_back(word);
      EXPECT_EQ(run(words), 2);
      EXPECT_TRUE(err().starts_with("--" + read.error().message.substr(place.size()) + "\n"))
          << err();
    }
  }
  EXPECT_TRUE(meshes_.service().requests().empty());
}

TEST_F(RequestRows, AreListedByTheHelpOfBatch) {
  EXPECT_EQ(run({"batch", "--help"}), 0);
  const std::string help = out();
  const std::string keys = help.substr(help.find("Keys of a mesh"));
  for (const Row& row : all_rows())
    EXPECT_NE(keys.substr(0, keys.find("\n\n")).find(" " + row.name), std::string::npos)
        << row.name;
}

}  // namespace
}  // namespace weft::client
