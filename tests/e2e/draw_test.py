# SPDX-License-Identifier: Apache-2.0
"""`weft draw`, judged by what others read of its files: pixels by Pillow, PDF by poppler, SVG by an
XML parser."""
from __future__ import annotations

import json
import os
import pathlib
import re
import subprocess
import xml.etree.ElementTree as ElementTree

import PIL.Image
import pytest

MODELS = pathlib.Path(__file__).parents[1] / "models"
WEFT = os.environ["WEFT_BINARY"]


def weft(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([WEFT, *map(str, words)], capture_output=True, text=True)


def drawn(mesh: pathlib.Path, name: str, *flags: object) -> pathlib.Path:
    file = mesh.parent / name
    done = weft("draw", mesh, "-o", file, "--quiet", *flags)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", "")
    return file


def output_of(*words: object) -> str:
    return subprocess.run(list(map(str, words)), capture_output=True, text=True, check=True).stdout


@pytest.fixture(scope="module")
def key(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    file = tmp_path_factory.mktemp("draw") / "key.vtu"
    done = weft("mesh", MODELS / "key.poly", "-o", file, "--quiet")
    assert done.returncode == 0, done.stderr
    return file


@pytest.fixture
def square(tmp_path: pathlib.Path) -> pathlib.Path:
    """A unit square of two triangles."""
    file = tmp_path / "square.off"
    file.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")
    return file


def test_png_shows_the_mesh_on_paper(square: pathlib.Path) -> None:
    picture = PIL.Image.open(drawn(square, "s.png", "--draw-size", 600, "--no-legend")).convert("RGB")
    assert picture.size == (600, 600)
    assert picture.getpixel((3, 3)) == (255, 255, 255)
    assert max(picture.getpixel((10, 300))) < 80  # the left side
    assert max(picture.getpixel((299, 300))) < 120  # the diagonal
    assert picture.getpixel((200, 300)) == (255, 255, 255)


def test_legend_is_below_the_mesh(square: pathlib.Path) -> None:
    bare = PIL.Image.open(drawn(square, "bare.png", "--color", "angle", "--no-legend"))
    full = PIL.Image.open(drawn(square, "full.png", "--color", "angle")).convert("RGB")
    assert full.height > bare.height
    below = full.crop((0, bare.height, full.width, full.height))
    colours = {pixel for _, pixel in below.getcolors(1 << 24)}
    assert any(red < 80 and blue > 80 > green for red, green, blue in colours)  # viridis begins
    assert any(red > 240 and green > 220 and blue < 60 for red, green, blue in colours)  # and ends


def test_pdf_is_a_page_with_a_legend(key: pathlib.Path) -> None:
    file = drawn(key, "key.pdf", "--color", "angle", "--worst", 3)
    facts = dict(line.split(":", 1) for line in output_of("pdfinfo", file).splitlines())
    assert facts["Pages"].strip() == "1"
    width, height = (float(word) for word in facts["Page size"].split()[:3:2])
    assert width == 900
    assert 300 < height < 600
    text = output_of("pdftotext", "-layout", file, "-")
    assert "triangles" in text
    assert "smallest angle" in text
    assert "3 smallest angles" in text
    for tick in ("0°", "30°", "60°"):
        assert tick in text


def test_legend_has_the_names_of_regions(tmp_path: pathlib.Path) -> None:
    domain, mesh, pdf = (tmp_path / name for name in ("land.geojson", "land.vtu", "land.pdf"))
    domain.write_text(json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": properties,
         "geometry": {"type": "Polygon", "coordinates": [[[x, 0], [x + 1, 0], [x + 1, 1], [x, 1], [x, 0]]]}}
        for x, properties in enumerate(({"region": "Østerbro"}, {"region": 7}))]}))
    done = weft("mesh", domain, "-o", mesh, "--draw", pdf, "--color", "region", "--quiet")
    assert done.returncode == 0, done.stderr
    for file in (pdf, drawn(mesh, "again.pdf", "--color", "region")):
        assert re.search(r"region\s+Østerbro\s+7\n", output_of("pdftotext", "-layout", file, "-"))


def test_pdf_and_png_look_alike(key: pathlib.Path) -> None:
    png = PIL.Image.open(drawn(key, "alike.png", "--color", "size")).convert("RGB")
    pdf = drawn(key, "alike.pdf", "--color", "size")
    output_of("pdftoppm", "-r", 144, "-singlefile", pdf, pdf.with_suffix(""))
    other = PIL.Image.open(pdf.with_suffix(".ppm")).convert("RGB")
    assert abs(png.width - other.width) <= 2
    assert abs(png.height - other.height) <= 4
    small = [picture.resize((90, 45)).tobytes() for picture in (png, other)]
    assert sum(abs(a - b) for a, b in zip(*small)) / len(small[0]) < 6


def test_svg_is_well_formed(key: pathlib.Path) -> None:
    for flags in ((), ("--color", "region", "--labels", "--worst", "5")):
        root = ElementTree.parse(drawn(key, "key.svg", *flags)).getroot()
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 3


def test_a_dense_mesh_is_colour_and_not_grey(tmp_path: pathlib.Path) -> None:
    mesh = tmp_path / "dense.vtu"
    done = weft("mesh", MODELS / "key.poly", "-o", mesh, "--size", "1e-3 + 1e-2*(x>30)", "--quiet")
    assert done.returncode == 0, done.stderr
    picture = PIL.Image.open(drawn(mesh, "dense.png")).convert("RGB")
    assert picture.getpixel((900, 340))[2] > 0
    colours = picture.resize((180, 90)).getcolors(1 << 24)
    vivid = sum(count for count, (r, g, b) in colours if max(r, g, b) - min(r, g, b) > 60)
    assert vivid > 0.3 * 180 * 90


def test_areas_over_their_bounds(key: pathlib.Path) -> None:
    for name, bound, most in (("loose.pdf", ("--size", "1e6"), "1"),
                              ("tight.pdf", ("--size", "1e-6"), "2 and up"),
                              ("edge.pdf", ("--edge", "1e3", "--gradation", "0.5"), "1")):
        text = output_of("pdftotext", "-layout", drawn(key, name, *bound), "-")
        assert "area over its bound" in text
        assert re.search(rf"0\s.*\s{most}\n", text), text
    by_bound, by_size = (PIL.Image.open(drawn(key, "b.png", *flags)).convert("RGB").tobytes()
                         for flags in (("--size", "abs(y-46)+1"), ("--color", "size")))
    assert by_bound != by_size


def test_only_weft_draw_knows_bounds(tmp_path: pathlib.Path) -> None:
    done = weft("mesh", MODELS / "key.poly", "--draw", tmp_path / "m.png", "--color", "bound")
    assert done.returncode == 2
    assert "draw the mesh by `weft draw MESH --color bound --size EXPR`" in done.stderr


def test_degrees_are_as_long_as_on_the_ground(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "north.off"
    file.write_text("OFF\n4 2 0\n10 59.5 0\n11 59.5 0\n11 60.5 0\n10 60.5 0\n3 0 1 2\n3 0 2 3\n")
    plane = PIL.Image.open(drawn(file, "p.png", "--no-legend"))
    ground = PIL.Image.open(drawn(file, "g.png", "--no-legend", "--lonlat"))
    assert plane.width == plane.height == ground.height
    assert ground.width == pytest.approx(30 + (plane.width - 60) / 2 + 30, abs=3)  # cos 60 degrees
    pdf = drawn(file, "g.pdf", "--lonlat", "--color", "size")
    text = output_of("pdftotext", pdf, "-")
    assert "km" in text
    assert "area in km²" in text


@pytest.mark.parametrize("words, message, code", [
    (("-o", "m.gif"), "m.gif: the extension '.gif' is not that of a drawing: .png, .svg, .pdf", 2),
    (("-o", "no/m.png"), "no/m.png", 5),
    (("-o", "m.png", "--zoom", "1,2,3"), "--zoom: '1,2,3' is not a box x,y,width,height", 2),
    (("-o", "m.png", "--zoom", "1,2,0,1"), "--zoom: '1,2,0,1' is not a box", 2),
    (("-o", "m.png", "--zoom", "1,2,nan,1"), "--zoom: '1,2,nan,1' is not a box", 2),
    (("-o", "m.png", "--zoom", "0,0,1e-300,1"), "is not a box", 2),
    (("-o", "m.png", "--zoom", "5,5,1,1"), "square.off: nothing of the mesh is in --zoom", 2),
    (("-o", "m.png", "--draw-size", "100000"),
     "--draw-size: '100000' is not in the range 200 to 8192", 2),
    (("-o", "m.png", "--worst", "0"), "--worst: '0' is not in the range 1 to 1000", 2),
    (("-o", "m.png", "--color", "pink"), "--color: 'pink' is not angle, size, region, bound, none "
     "or auto",
     2),
    (("-o", "m.png", "--color", "bound"), "--color bound needs --size or --edge", 2),
    (("-o", "m.png", "--color", "size", "--size", "1"), "--size and --edge are for --color bound", 2),
    (("-o", "m.png", "--size", "x +"), "the size: ", 2),
    (("-o", "m.png", "--size", "x", "--edge", "1"), "--size and --edge exclude each other", 2),
    (("-o", "square.off"), "is not that of a drawing", 2),
])
def test_errors_are_named_and_leave_nothing(square: pathlib.Path, words: tuple[str, ...],
                                            message: str, code: int) -> None:
    done = subprocess.run([WEFT, "draw", square.name, *words], capture_output=True, text=True,
                          cwd=square.parent)
    assert message in done.stderr
    assert done.returncode == code
    assert [file.name for file in square.parent.iterdir()] == ["square.off"]


@pytest.mark.parametrize("text, message", [
    ("OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n", "hostile.off"),
    ("OFF\n3 1 0\n-1e308 0 0\n1e308 0 0\n0 1 0\n3 0 1 2\n",
     "the mesh has a coordinate of -1e+308, drawings go to 1e+100"),
])
def test_hostile_coordinates_are_an_error(tmp_path: pathlib.Path, text: str, message: str) -> None:
    file = tmp_path / "hostile.off"
    file.write_text(text)
    for name in ("m.png", "m.svg", "m.pdf"):
        done = weft("draw", file, "-o", tmp_path / name)
        assert message in done.stderr
        assert done.returncode == 4
        assert not (tmp_path / name).exists()


def test_degenerate_meshes_are_drawn(tmp_path: pathlib.Path) -> None:
    for text in ("OFF\n0 0 0\n", "OFF\n3 1 0\n1 1 0\n1 1 0\n1 1 0\n3 0 1 2\n",
                 "OFF\n3 1 0\n0 0 0\n1e90 0 0\n2e90 1 0\n3 0 1 2\n"):
        file = tmp_path / "m.off"
        file.write_text(text)
        for color in ("auto", "none", "angle", "size", "region"):
            for name in ("m.png", "m.svg", "m.pdf"):
                drawn(file, name, "--color", color, "--worst", 2, "--labels")
