// SPDX-License-Identifier: Apache-2.0
// The flags of `weft mesh`, `weft draw`, `weft check`, `weft convert`, `weft info` and `weft lint`.
#include <memory>

#include "client/call/request_rows.h"
#include "client/cli/command_groups.h"
#include "client/cli/flags.h"
#include "client/commands/commands.h"
#include "client/commands/job_commands.h"
#include "client/report/model_report.h"
#include "client/report/output_rows.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "files/lint/domain_lint.h"

namespace weft::client {
namespace {

constexpr std::uint32_t kMaxCells = 512;  // whose square the server takes

constexpr char kMeshExamples[] =
    R"(.node writes Triangle's .node, .ele and .poly, .14 and .grd ADCIRC's grid,
.gr3 SCHISM's, .nc UGRID, .slf TELEMAC's SELAFIN, .xdmf its arrays in .xdmf.bin, .foam OpenFOAM's
constant/polyMesh beside it, .exo Exodus, .disv the grid of MODFLOW 6, .inp Abaqus and CalculiX.

Exit codes (all of them: weft --help):
  0        every triangle is within its bounds, or exempt, and the files are written
  2        the command line is wrong
  4        the input is missing, unreadable or malformed
  5        the output cannot be written; nothing is left behind
  64 + n   gRPC status n: 67 the request is wrong, 68 a deadline passed, 72 a limit was
           exceeded, 73 the mesh misses its bounds, 78 the server is absent

Examples:
  weft mesh coast.geojson -o coast.vtu --size 0.001
  weft mesh pipe.poly -o pipe.msh --size '0.4*hypot(x-200, y-200) + 1' --min-angle 30
  weft mesh coast.geojson -o coast.vtu --size sizes.asc
  weft mesh coast.geojson -o coast.vtu --edge 'min(0.02 + 0.15*shore, 1)' --field shore=distance
  weft mesh coast.geojson -o coast.vtu --lonlat --size 1e8
  weft mesh coast.geojson -o coast.14 --lonlat --edge 2000 --simplify 0.5
  weft mesh key.poly -o key.vtu -o key.node --draw key.png --color angle
  weft mesh coast.shp -o fort.14 --open-boundary deeper:50 --nodal depth=depth.tif --lonlat
  weft mesh cylinder.poly --size 1e-2 --draw cylinder.png --draw-quadtree
  weft mesh key.poly -o key.vtu --server mesh.example.org:7421 --json
  weft mesh coast.geojson --size 1e-6 --server mesh.example.org:7421 --detach)";

constexpr char kDrawExamples[] =
    R"(Triangles that are too small to be seen are drawn as pixels, in the colour of their mean
area.

Examples:
  weft draw key.vtu -o key.png
  weft draw key.vtu -o key.pdf --color angle --worst 10
  weft draw key.vtu -o key.png --color bound --size '0.02*abs(y-46)+0.1'
  weft draw coast.14 -o coast.png --lonlat --color size
  weft draw coast.14 -o harbour.svg --lonlat --zoom=-74.3,40.4,0.5,0.4 --labels)";

constexpr char kCheckExamples[] =
    R"(Give the bounds that the mesh was made with. With --for, faults are what the model refuses,
and the exit code is 3; advice does not change it. A mesh of a domain in longitude and latitude
is checked in metres: write it with --to-metres, too.

Examples:
  weft check pipe.msh --domain pipe.poly --size '0.4*hypot(x-200, y-200) + 1' --min-angle 30
  weft check coast.msh --domain coast.geojson --to-metres --size 1e8
  weft check key.vtu --domain key.poly --json
  weft check fort.14 --for adcirc --open-boundary 1 --lonlat)";

constexpr char kConvertExamples[] =
    R"(A mesh is written as it is, vertex by vertex; what the new format does not carry is lost.
A domain, or that of a mesh, is written as a .poly file; every hole gets a seed.

Examples:
  weft convert key.vtu key.msh --msh-version 2.2
  weft convert key.msh key.vtu --order 2
  weft convert coast.msh fort.14 --open-boundary 1 --open-boundary 2
  weft convert coast.vtu coast.exo --names marker=2:inlet --names region=1:fluid
  weft convert coast.msh coast.nc --nodal depth=depth.tif --renumber rcm --parts 8
  weft convert coast.geojson coast.poly)";

constexpr char kRemeshExamples[] =
    R"(Vertices, triangles and edges outside stay as they are, and so do the edges between: triangles
there may miss the bounds that are given. Values at vertices are taken over, linear inside.

Examples:
  weft remesh coast.vtu --within harbour.geojson --edge 50 -o nested.vtu
  weft remesh fort.14 --within inlet.geojson --lonlat --edge 200 --gradation 0.2 -o finer.14
  weft remesh key.msh --within key-way.poly --size 0.01 --min-angle 25 -o key2.msh --draw key2.png)";

constexpr char kStitchExamples[] =
    R"(Vertices, triangles and edges of the first mesh come first, with their numbers. Where an outline
has a vertex on an edge of the other one, or meshes overlap, the first place is named and nothing is
written.

Examples:
  weft stitch land.vtu sea.vtu -o both.vtu
  weft stitch inner.14 outer.14 -o fort.14 --tolerance 1e-6)";

constexpr char kInfoExamples[] =
    R"(The aspect ratio is the circumradius over twice the inradius: 1 if the triangle is equilateral. Bounds
are those of the size flags, in the unit of the mesh's own coordinates; a field of distance measures
to the segments of the mesh. Bars are plain ASCII if the locale is not UTF-8.

Examples:
  weft info coast.geojson
  weft info key.vtu --quality --size '0.02*abs(y-46)+0.1'
  weft info key.vtu --quality --json)";

constexpr char kLintExamples[] =
    R"(Needs no server. Ends with 0 if there are no faults, with 3 if there are. Text has at most 20 findings
of a kind, JSON, layers and drawings 1000; all are counted.

Examples:
  weft lint coast.geojson
  weft lint yard.poly --draw faults.png -o faults.geojson
  weft lint yard.poly --snap 0.01 --ignore crossing --ignore junction
  weft lint coast.shp --json)";

constexpr char kSizeExamples[] =
    R"(Takes what `weft mesh` takes, and ends before the mesh: for how fine a domain will be, and how large
its mesh. A grid has the length of edges in each cell, -9999 outside of the domain and where nothing
bounds it; with --lonlat it lies in metres of the projection.

Examples:
  weft size coast.geojson --edge 'min(0.02 + 0.15*shore, 1)' --field shore=distance
  weft size coast.shp --lonlat --edge '0.1*depth' --field depth=depth.tif --gradation 0.15 -o edges.asc
  weft size key.poly --size 0.1 --cells-across 4 --json)";

// Submits, as `weft submit` does. Files are written later, by `weft fetch`.
Result<ExitCode> detach(const MeshOptions& options, std::stop_token stop) {
  if (!options.output.empty() || options.output.draw_quadtree)
    return fail(ExitCode::kUsage,
                "--detach ends before there is a mesh to write: leave out -o and --draw, and write "
                "the mesh later with `weft fetch ID -o FILE`");
  SubmitOptions submit;
  submit.input = options.input;
  submit.layers = options.layers;
  submit.request_options = options.request_options;
  submit.output.projection = options.output.projection;
  submit.calls = options.calls;
  submit.json = options.json;
  submit.quiet = options.quiet;
  return run_submit(submit, std::move(stop));
}

void add_mesh(CLI::App& app, Chosen& chosen) {
  struct Kept {
    MeshOptions options;
    bool detach = false;
  };
  const auto kept = std::make_shared<Kept>();
  MeshOptions& options = kept->options;
  CLI::App& mesh = *app.add_subcommand("mesh", "Mesh a domain and write the mesh to files");
  mesh.footer(kMeshExamples);
  add_domain_and_request_options(mesh, options.input, options.layers, options.request_options,
                                 chosen);
  add_mesh_call(mesh, options.calls);
  add_output(mesh, options.output);
  mesh.add_flag("--detach", kept->detach,
                "Submit a job, print its id and end, as `weft submit` does; needs --server");
  add_json(mesh, options.json, "Print one JSON object on standard output");
  add_quiet(mesh, options.quiet);
  mesh.add_flag("--lint", options.lint,
                "First list the faults of the domain on standard error, as `weft lint` does");
  mesh.add_flag("--no-picture", options.no_picture,
                "Show no picture of the mesh at the end, on a terminal that can show one (kitty's "
                "protocol or sixel)")
      ->envname("WEFT_NO_PICTURE");
  mesh.callback([kept, &mesh, &chosen] {
    warn_of_variables(mesh, kept->options.request_options);
    chosen.run = [kept](std::stop_token stop) {
      return kept->detach ? detach(kept->options, std::move(stop))
                          : run_mesh(kept->options, std::move(stop));
    };
  });
}

void add_size_command(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<SizeOptions>();
  SizeOptions& options = *kept;
  CLI::App& size = *app.add_subcommand("size", "Tell what a size asks for, without a mesh");
  size.footer(kSizeExamples);
  add_domain_and_request_options(size, options.input, options.layers, options.request_options,
                                 chosen);
  size.add_option("-o,--output", options.grids,
                  "Grid of the lengths of edges to write, may be repeated: .asc")
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_row(size,
          {"cells", "", "Cells of the grid along the longer side of the domain", "256",
           number("N", &SizeOptions::cells, 1, kMaxCells)},
          options);
  add_projection_flags(size, options.projection);
  add_mesh_call(size, options.calls);
  add_json(size, options.json, "Print one JSON object on standard output");
  add_quiet(size, options.quiet);
  size.callback([kept, &size, &chosen] {
    warn_of_variables(size, kept->request_options);
    chosen.run = [kept](std::stop_token stop) { return run_size(*kept, std::move(stop)); };
  });
}

void add_draw(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<DrawMeshOptions>();
  CLI::App& draw = *app.add_subcommand("draw", "Draw a mesh");
  draw.footer(kDrawExamples);
  add_input(draw, "MESH", "Mesh: " + read_mesh_extensions(), kept->mesh, chosen);
  draw.add_option("-o,--output", kept->drawings,
                  "Drawing to write, may be repeated: .png, .svg, .pdf")
      ->required()
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_drawing(draw, kept->drawing);
  add_size(draw, kept->size);
  draw.add_flag("--lonlat", kept->lonlat,
                "The mesh is in longitude and latitude, in degrees: it is drawn as long as it is "
                "on the ground at its middle latitude, and areas and angles are those on the "
                "ground");
  add_quiet(draw, kept->quiet);
  draw.callback([kept, &chosen] {
    chosen.run = [kept](std::stop_token stop) { return run_draw(*kept, std::move(stop)); };
  });
}

void add_check(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<CheckOptions>();
  CheckOptions& options = *kept;
  CLI::App& check = *app.add_subcommand("check", "Check a mesh with the independent checker");
  check.footer(kCheckExamples);
  add_input(check, "MESH", "Mesh: " + read_mesh_extensions(), options.mesh, chosen);
  check
      .add_option("--domain", options.domain,
                  "Domain that was meshed: " + domain_extensions() + ". Required without --for")
      ->type_name("INPUT");
  add_layers(check, options.layers);
  add_size(check, options.size);
  add_row(check,
          {"min-angle", "WEFT_MIN_ANGLE", "Minimum angle of every triangle, in degrees", "20",
           number("DEG", &CheckOptions::min_angle_deg, 0, 60)},
          options);
  add_row(
      check,
      {"snap", "WEFT_SNAP", "Distance within which features were merged, as given to `weft mesh`",
       "", number("D", &CheckOptions::snap)},
      options);
  add_row(check,
          {"simplify", "WEFT_SIMPLIFY",
           "Share of the size to which the domain was simplified, as given to `weft mesh`", "",
           number("F", &CheckOptions::simplify)},
          options);
  add_row(
      check,
      {"keep", "WEFT_KEEP_SEGMENTS",
       "Segments that have no new points, as given to `weft mesh`; with it goes --max-unrefined",
       "", marker_value("keep")},
      options.size);
  add_row(check,
          {"periodic", "WEFT_PERIODIC", "Sides that repeat each other, as given to `weft mesh`", "",
           marker_value("periodic")},
          options.size);
  add_row(check,
          {"layers", "", "Layers along walls, as given to `weft mesh`", "", marker_value("layers")},
          options.size);
  add_row(check,
          {"fill", "WEFT_FILL", "What was meshed where polygons overlap, as given to `weft mesh`",
           "union", fill_value(&CheckOptions::fill)},
          options);
  add_row(check,
          {"max-unrefined", "",
           "Triangles that may miss a bound, as `weft mesh` counted them (all but those with small "
           "input angles, which are exempt)",
           "0", number("N", &CheckOptions::max_unrefined)},
          options);
  add_row(
      check,
      {"for", "",
       "Judge what this model asks of a mesh, too: boundaries, channels, triangles at a vertex, "
       "links between cells, the time step. With depths in MESH, in metres",
       "", one_of(&CheckOptions::model, models())},
      options);
  add_row(check,
          {"open-boundary", "",
           "Marker of the segments that are open boundary, by number or by name, or "
           "deeper:METRES: where the bed along the outer boundary is deeper than that, for --for. "
           "May be repeated",
           "", open_boundaries()},
          options.writing);
  add_projection_flags(check, options.projection);
  add_json(check, options.json, "Print one JSON object, with exact figures, on standard output");
  check.callback(
      [kept, &chosen] { chosen.run = [kept](std::stop_token) { return run_check(*kept); }; });
}

void add_convert(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<ConvertOptions>();
  CLI::App& convert = *app.add_subcommand("convert", "Write a mesh or a domain in another format");
  convert.footer(kConvertExamples);
  add_input(convert, "IN",
            "Mesh: " + read_mesh_extensions() + "; or domain: " + domain_extensions(), kept->input,
            chosen);
  add_converted(convert, kept->output);
  add_layers(convert, kept->layers);
  add_names(convert, kept->names);
  add_writing(convert, kept->writing);
  add_json(convert, kept->json, "Print counts, coordinate system and warnings as one JSON object");
  add_quiet(convert, kept->quiet);
  convert.callback([kept, &chosen] {
    chosen.run = [kept](std::stop_token stop) { return run_convert(*kept, std::move(stop)); };
  });
}

void add_remesh(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<RemeshOptions>();
  RemeshOptions& options = *kept;
  CLI::App& remesh = *app.add_subcommand("remesh", "Mesh a part of a mesh anew");
  remesh.footer(kRemeshExamples);
  add_input(remesh, "MESH", "Mesh: " + read_mesh_extensions(), options.mesh, chosen);
  remesh
      .add_option(
          "--within", options.within,
          "Polygons around the triangles that are meshed anew, those with all three corners "
          "inside: " +
              domain_extensions())
      ->required()
      ->type_name("POLYGONS");
  add_layers(remesh, options.layers);
  add_request_options(remesh, options.request_options);
  add_mesh_call(remesh, options.calls);
  add_output(remesh, options.output);
  add_json(remesh, options.json, "Print one JSON object on standard output");
  add_quiet(remesh, options.quiet);
  remesh.callback([kept, &remesh, &chosen] {
    warn_of_variables(remesh, kept->request_options);
    chosen.run = [kept](std::stop_token stop) { return run_remesh(*kept, std::move(stop)); };
  });
}

void add_stitch(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<StitchMeshOptions>();
  StitchMeshOptions& options = *kept;
  CLI::App& stitch =
      *app.add_subcommand("stitch", "Join meshes whose outlines meet vertex by vertex");
  stitch.footer(kStitchExamples);
  stitch
      .add_option(
          "MESHES",
          [&options](const CLI::results_t& texts) {
            options.meshes.assign(texts.begin(), texts.end());
            return true;
          },
          "Meshes, two or more, each of which meets those before it: " + read_mesh_extensions())
      ->required()
      ->type_name("TEXT")
      ->expected(2, CLI::detail::expected_max_vector_size)
      ->allow_extra_args();
  add_files(stitch, options.files);
  add_row(stitch,
          {"tolerance", "",
           "Distance within which vertices of two outlines are one, in the unit of the points",
           "1e-9 of the extent", number("D", &StitchMeshOptions::tolerance, 0, 1e50)},
          options);
  add_json(stitch, options.json, "Print one JSON object on standard output");
  add_quiet(stitch, options.quiet);
  stitch.callback([kept, &chosen] {
    chosen.run = [kept](std::stop_token stop) { return run_stitch(*kept, std::move(stop)); };
  });
}

void add_info(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<InfoOptions>();
  CLI::App& info = *app.add_subcommand("info", "Describe a mesh or a domain");
  info.footer(kInfoExamples);
  add_input(info, "FILE", "Mesh or domain", kept->file, chosen);
  info.add_flag("--quality", kept->quality,
                "Print histograms of the angles, the aspect ratios and, with a size, the areas "
                "over their bounds; and the worst triangles. For meshes only");
  add_size(info, kept->size);
  add_layers(info, kept->layers);
  add_json(info, kept->json,
           "Print the quality as one JSON object, with the figures of `weft mesh --json`");
  info.callback(
      [kept, &chosen] { chosen.run = [kept](std::stop_token) { return run_info(*kept); }; });
}

void add_lint(CLI::App& app, Chosen& chosen) {
  const auto kept = std::make_shared<LintOptions>();
  LintOptions& options = *kept;
  CLI::App& lint = *app.add_subcommand("lint", "List all faults of a domain");
  lint.footer(kLintExamples);
  add_input(lint, "FILE",
            "Domain: " + domain_extensions() + "; or a mesh: " + read_mesh_extensions(),
            options.file, chosen);
  add_layers(lint, options.layers);
  add_row(
      lint,
      {"snap", "WEFT_SNAP", "Leave out what `weft mesh --snap D` merges, and look at what is left",
       "", number("D", &LintOptions::snap)},
      options);
  add_row(lint,
          {"fill", "WEFT_FILL",
           "What is meshed where polygons overlap, as given to `weft mesh`: with even-odd an "
           "overlap is no fault, with difference none with another polygon than the first",
           "union", fill_value(&LintOptions::fill)},
          options);
  lint.add_flag(
      "--lonlat", options.lonlat,
      "The domain is in longitude and latitude, in degrees: it is judged and drawn as on the "
      "ground; lengths and --snap are in metres, areas in square metres");
  lint.add_option("--ignore", options.ignored,
                  "Kind of fault to leave out, may be repeated: " + fault_kinds() + ", warning")
      ->allow_extra_args(false)
      ->type_name("KIND");
  lint.add_option("-o,--output", options.layer_files,
                  "Layer of the findings to write, may be repeated: .geojson")
      ->allow_extra_args(false)
      ->type_name("FILE");
  add_domain_drawing(lint, options.drawings, options.drawing);
  add_json(lint, options.json, "Print one JSON object on standard output");
  lint.callback([kept, &chosen] {
    chosen.run = [kept](std::stop_token stop) { return run_lint(*kept, std::move(stop)); };
  });
}

}  // namespace

void add_mesh_commands(CLI::App& app, Chosen& chosen) {
  add_mesh(app, chosen);
  add_size_command(app, chosen);
  add_draw(app, chosen);
  add_check(app, chosen);
  add_convert(app, chosen);
  add_remesh(app, chosen);
  add_stitch(app, chosen);
  add_info(app, chosen);
  add_lint(app, chosen);
}

}  // namespace weft::client
