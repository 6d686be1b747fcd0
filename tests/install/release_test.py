# SPDX-License-Identifier: Apache-2.0
"""What deploy/release.sh is made of. tests/package.sh tries the packages themselves."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import jinja2
import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["WEFT_BUILD"])
sys.path.insert(0, str(ROOT / "deploy/package"))
import bill_of_materials  # noqa: E402
import components  # noqa: E402
import wheels  # noqa: E402


@pytest.fixture
def tree(tmp_path):
    """A clone in small, with nothing in it that builds."""
    folder = tmp_path / "tree"
    (folder / "deploy").mkdir(parents=True)
    shutil.copy(ROOT / "deploy/release.sh", folder / "deploy")
    git = ["git", "-C", folder, "-c", "user.name=test", "-c", "user.email=test@example.org"]
    for words in (["init", "-q"], ["add", "-A"], ["commit", "-q", "-m", "All"]):
        subprocess.run([*git, *words], check=True)
    return folder


def release(tree, out):
    return subprocess.run([tree / "deploy/release.sh", out], capture_output=True, text=True)


def test_changes_that_are_not_committed_are_not_released(tree, tmp_path):
    (tree / "new.cpp").touch()
    done = release(tree, tmp_path / "out")
    assert done.returncode == 1 and "new.cpp" in done.stderr
    assert not (tmp_path / "out").exists()


def test_nothing_is_released_into_a_folder_with_something_else(tree, tmp_path):
    (tmp_path / "old.whl").touch()
    done = release(tree, tmp_path)
    assert (done.returncode, done.stderr) == (1, f"release.sh: {tmp_path} is not empty\n")


def test_the_changelog_begins_with_the_version_that_is_released():
    version, = re.findall(r"^project\(weft VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)
    headings = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.M)
    assert headings[0] == version


def test_the_recipe_for_conda_is_of_this_version_and_brings_what_is_loaded_later():
    version, = re.findall(r"^project\(weft VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)
    text = (ROOT / "deploy/conda/meta.yaml").read_text()
    strict = jinja2.Environment(undefined=jinja2.StrictUndefined)
    recipe = yaml.safe_load(strict.from_string(text).render(compiler=lambda language: language))
    assert recipe["package"] == {"name": "weft", "version": version}
    assert (ROOT / recipe["about"]["license_file"]).is_file()
    needs = recipe["requirements"]
    assert set(needs["run"]) - {"fonts-conda-forge"} <= set(needs["host"])
    later = "".join((BUILD / "loaded_later" / program).read_text() for program in ("weft", "weftd"))
    assert {re.sub(r"^lib(?!pq|lzma)|[.]so.*", "", name) for name in later.split()} <= set(needs["run"])


@pytest.fixture(scope="module")
def bill():
    return bill_of_materials.bill(BUILD)


def judged(bill, folder):
    """The exit code and the words of the judge by CycloneDX's schema."""
    (folder / "bill.json").write_text(json.dumps(bill))
    done = subprocess.run(["node", ROOT / "deploy/check-bill.mjs", folder / "bill.json"],
                          capture_output=True, text=True)
    return done.returncode, done.stderr


def test_the_bill_of_materials_fits_its_schema(bill, tmp_path):
    assert judged(bill, tmp_path) == (0, "")
    wrong = {**bill, "components": [{"type": "no such type", "name": "x"}]}
    assert judged(wrong, tmp_path)[0] == 1


@pytest.mark.parametrize("program", ["weft", "weftd"])
def test_the_bill_has_what_the_programs_are_made_of(bill, program):
    on, = (each["dependsOn"] for each in bill["dependencies"] if each["ref"] == program)
    by_reference = {each["bom-ref"]: each for each in bill["components"]}
    names = {by_reference[reference]["name"] for reference in on}
    assert {"libc6", "libprotobuf-dev", "libgrpc-dev"} <= names
    assert ("libcgal-dev" in names) == (program == "weftd")
    assert ("libcairo2" in names) == ("libproj25" in names) == ("liblzma5" in names) == (program == "weft")
    assert ("libpq5" in names) == (program == "weftd")  # loaded when it is needed, as are those three
    loaded = components.packages_of(components.loaded_by(BUILD / program).values())
    assert {package.name for package in loaded} <= names


@pytest.mark.parametrize("program", ["weft", "weftd"])
def test_who_runs_a_program_installs_what_it_loads_later(program):
    group = re.search(rf"^{program}=\(([^)]*)\)", (ROOT / "deploy/install-deps.sh").read_text(), re.M)[1]
    later = (BUILD / "loaded_later" / program).read_text().split()
    paths = components.loaded_by(BUILD / program)
    packages = components.packages_of({paths[name] for name in later})
    assert {package.name for package in packages} <= set(group.split())


def test_the_bill_has_what_the_library_is_made_of(bill):
    on = {each["ref"]: each["dependsOn"] for each in bill["dependencies"]}
    names = {reference.split("/")[-1].split("@")[0] for reference in on["libweft0"]}
    assert {"libc6", "libtbb12", "libcgal-dev"} <= names and "libprotobuf32" not in names
    assert "libweft0" in on["release"]


def test_the_bill_tells_tools_from_what_is_released(bill):
    scopes = {each["name"]: each.get("scope") for each in bill["components"]}
    assert scopes["@bufbuild/buf"] == scopes["@grpc/grpc-js"] == "excluded"
    assert scopes["grpcio"] is scopes["libssl3"] is None


def test_a_file_of_no_package_has_no_place_in_the_bill(tmp_path):
    with pytest.raises(LookupError, match="strange.so"):
        components.packages_of([tmp_path / "strange.so"])


def test_what_is_not_of_the_sysroot_is_of_this_machine(tmp_path):
    """As the compiler's headers are, which are in what is made for arm64."""
    library, database = tmp_path / "usr/lib/libx.so", tmp_path / "var/lib/dpkg"
    for folder in (library.parent, database / "info"):
        folder.mkdir(parents=True)
    library.touch()
    (database / "info/libx.list").write_text("/usr/lib/libx.so\n")
    (database / "status").write_text("Package: libx\nStatus: install ok installed\nVersion: 1\nArchitecture: arm64\n"
                                     "Maintainer: nobody\nDescription: x\n\n")
    found = components.packages_of({library, pathlib.Path("/usr/include/stdio.h")}, tmp_path)
    assert {package.name: package.root for package in found} == {"libx": tmp_path, "libc6-dev": pathlib.Path("/")}


@pytest.fixture
def carried(tmp_path):
    """weftd as a wheel carries it."""
    wheels.carry(BUILD, tmp_path)
    return tmp_path


def test_a_wheel_carries_what_its_programs_load(carried, monkeypatch):
    monkeypatch.setattr(wheels, "UNDER_THE_GPL", set())  # this build has PROJ
    assert list(wheels.faults(carried)) == []
    assert (carried / "lib/libcairo.so.2").exists() and (carried / "lib/libpq.so.5").exists()
    (carried / "lib/libtbb.so.12").unlink()
    assert "weftd needs libtbb.so.12, which the system need not have" in wheels.faults(carried)


def test_a_wheel_needs_no_newer_system_than_it_says(carried, monkeypatch):
    monkeypatch.setitem(wheels.NEWEST, "GLIBC", (2, 33))
    assert "weftd needs GLIBC_2.34 of libc.so.6" in wheels.faults(carried)


def test_a_wheel_looks_for_libraries_in_itself(carried):
    shutil.copy(BUILD / "weftd", carried / "bin/weftd")
    assert "weftd looks for libraries in []" in wheels.faults(carried)


def test_a_wheel_carries_nothing_under_the_gpl(carried):
    (carried / "lib/libreadline.so.8").symlink_to("libtbb.so.12")
    assert "libreadline.so.8 is under the GPL" in wheels.faults(carried)
