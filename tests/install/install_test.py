# SPDX-License-Identifier: Apache-2.0
"""What `cmake --install` installs, below a prefix of its own: it works, and tells the truth."""
import os
import pathlib
import pty
import re
import select
import subprocess
import sys
import time

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["WEFT_BUILD"])
KEY = ROOT / "tests/models/key.poly"
COMPONENTS = ["weft", "weftd", "python3-weft", "protocol", "library", "libweft0"]
sys.path.insert(0, str(ROOT / "deploy/package"))
import program_help  # noqa: E402

CLEAN = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True,
                          **{"env": CLEAN} | options)
    assert done.returncode == 0, f"{words}: {done.stdout}{done.stderr}"
    return done.stdout


def install(prefix, *arguments):
    run(os.environ["CMAKE"], "--install", BUILD, "--prefix", prefix, *arguments)
    return prefix


def files_below(folder):
    return {path.relative_to(folder) for path in folder.rglob("*")
            if path.is_file() or path.is_symlink()}


@pytest.fixture(scope="session")
def prefix(tmp_path_factory):
    return install(tmp_path_factory.mktemp("prefix"))


@pytest.fixture(scope="session")
def pages(prefix):
    found = sorted(prefix.glob("share/man/man*/*.gz"))
    assert found
    return found


@pytest.fixture
def models(tmp_path):
    """A folder with two domains, and a file that is none."""
    for name in ("coast.poly", "coastal.geojson", "coast.txt"):
        (tmp_path / name).touch()
    return tmp_path


def test_the_components_are_all_of_it_and_share_no_file(prefix, tmp_path):
    parts = [files_below(install(tmp_path / name, "--component", name)) for name in COMPONENTS]
    assert set.union(*parts) == files_below(prefix)
    assert sum(map(len, parts)) == len(files_below(prefix))


def test_installed_programs_mesh_and_look_for_libraries_nowhere_else(prefix, tmp_path):
    run(prefix / "bin/weft", "mesh", KEY, "-o", tmp_path / "key.vtu")
    for program in ("weft", "weftd"):
        assert not re.search("RPATH|RUNPATH", run("readelf", "-d", prefix / "bin" / program))


def test_the_installed_package_for_python_meshes(prefix):
    folder, = prefix.glob("lib/python3*/dist-packages")
    printed = run("/usr/bin/python3", "-B", "-c",
                  "import sys, weft\n"
                  "with weft.local(sys.argv[1]) as client:\n"
                  "    print(len(client.mesh(sys.argv[2]).triangles))",
                  prefix / "bin/weftd", KEY, env=CLEAN | {"PYTHONPATH": str(folder)})
    assert int(printed) > 100


def test_the_package_for_python_loads_the_library(prefix, tmp_path):
    library = install(tmp_path, "--component", "libweft0") / "lib/libweft.so.0"
    assert {path.name for path in library.parent.iterdir()} == {
        "libweft.so.0", f"libweft.so.{program_help.version_of(prefix / 'bin/weft')}"}
    folder, = prefix.glob("lib/python3*/dist-packages")
    assert not list(folder.rglob("carried"))
    printed = run("/usr/bin/python3", "-B", "-c",
                  "import sys, weft; print(len(weft.mesh(sys.argv[1]).triangles))", KEY,
                  env=CLEAN | {"PYTHONPATH": str(folder), "LD_LIBRARY_PATH": str(library.parent)})
    assert int(printed) > 100


def test_licences_are_beside_each_component(prefix):
    for name in ("weft", "weftd", "python3-weft", "weft-protocol-dev", "libweft-dev", "libweft0"):
        folder = prefix / "share/doc" / name
        for licence in ROOT.glob("LICENSES/*.txt"):
            assert (folder / "LICENSES" / licence.name).read_bytes() == licence.read_bytes()
        for text in ("LICENSE", "NOTICE"):
            assert (folder / text).read_bytes() == (ROOT / text).read_bytes()


def test_the_protocol_is_found_by_pkg_config_and_compiles(prefix, tmp_path):
    environment = CLEAN | {"PKG_CONFIG_PATH": str(prefix / "share/pkgconfig")}
    version = run("pkg-config", "--modversion", "weft-protocol", env=environment).strip()
    assert version == program_help.version_of(prefix / "bin/weft")
    folder = run("pkg-config", "--variable=protodir", "weft-protocol", env=environment).strip()
    run("protoc", f"--proto_path={folder}", f"--descriptor_set_out={tmp_path / 'all'}",
        "weft/v1/mesh_service.proto", "weft/v1/job_service.proto")


def test_the_manual_has_no_fault(pages):
    environment = CLEAN | {"LC_ALL": "C.UTF-8", "MANWIDTH": "80", "MANPAGER": "cat"}
    for page in pages:
        done = subprocess.run(["man", "-l", "--warnings", page], capture_output=True, text=True,
                              env=environment)
        assert (done.returncode, done.stderr) == (0, "")
        run("mandoc", "-Tlint", "-Wwarning", page)


def test_the_manual_has_every_command_and_flag(prefix, pages):
    weft = prefix / "bin/weft"
    commands = [row.names[0] for row in program_help.commands_of(weft)]
    assert {page.name for page in pages} == {"weft.1.gz", "weftd.8.gz",
                                            *(f"weft-{name}.1.gz" for name in commands)}
    for page in pages:
        assert page.parent.name == f"man{page.name.split('.')[1]}"
    helps = {"weftd.8.gz": program_help.help_of(prefix / "bin/weftd")}
    helps |= {f"weft-{name}.1.gz": program_help.help_of(weft, name) for name in commands}
    by_name = {page.name: page for page in pages}
    for name, text in helps.items():
        printed = run("mandoc", "-Tascii", "-Owidth=200", by_name[name])
        printed = re.sub(".\b", "", printed)
        for flag in re.findall(r"^ {2,4}(-[^ {]*)", text, re.M):
            assert re.search(rf"^ +{flag.replace(',', ', ')}( |$)", printed, re.M), (name, flag)
        for variable in re.findall(r"^ {2,4}-.*\(Env:(\w+)\)", text, re.M):
            assert f"Environment: {variable}." in printed, name


def test_a_help_that_is_no_longer_understood_is_an_error():
    text = "Summary\nUsage: weft [OPTIONS]\n\nOptions:\n  --flag ODD THING (Env:WEFT_FLAG)\n" + \
        " " * 30 + "Text\n"
    with pytest.raises(ValueError):
        program_help.parse(text)


BASH = """
source "$1"
shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_$1 2>&1
printf '%s\\n' "${COMPREPLY[@]}"
"""
# What is typed, and what is offered; of files, and of flags by their beginning.
WORDS = [
    (["weft", "me"], {"mesh"}),
    (["weft", "--v"], {"--version"}),
    (["weft", "mesh", "--min"], {"--min-angle", "--min-edge"}),
    (["weft", "mesh", "coa"], {"coast.poly", "coastal.geojson"}),
    (["weft", "mesh", "coast.poly", "--placement", "l"], {"lattice"}),
    (["weft", "draw", "coast.vtu", "--color", "b"], {"bound"}),
    (["weftd", "--tls-c"], {"--tls-cert", "--tls-client-ca"}),
    (["weftd", "--log-format", ""], {"text", "json"}),
]


@pytest.mark.parametrize("words, offered", WORDS)
def test_bash_completes(prefix, models, words, offered):
    file = prefix / "share/bash-completion/completions" / words[0]
    printed = run("bash", "--norc", "-c", BASH, "bash", file, *words, cwd=models)
    assert set(printed.split()) == offered


def test_bash_completes_values_after_an_equals_sign(prefix, models):
    file = prefix / "share/bash-completion/completions/weft"
    for words in (["weft", "mesh", "--color", "="], ["weft", "mesh", "--color", "=", ""]):
        printed = run("bash", "--norc", "-c", BASH, "bash", file, *words, cwd=models)
        assert set(printed.split()) == {"angle", "auto", "none", "region", "size"}


@pytest.mark.parametrize("words, offered", WORDS)
def test_fish_completes(prefix, models, words, offered):
    folder = prefix / "share/fish/vendor_completions.d"
    printed = run("fish", "--no-config", "-c",
                  f"source {folder}/{words[0]}.fish; complete -C '{' '.join(words)}'", cwd=models,
                  env=CLEAN | {"HOME": str(models), "PATH": f"{prefix}/bin:{CLEAN['PATH']}"})
    found = {line.split("\t")[0] for line in printed.splitlines()}
    # fish offers other files, too, behind those that fit.
    assert offered <= found and found - offered <= {"coast.txt"}


# Control-X prints the line as it stands.
ZSHRC = """
fpath=("$FUNCTIONS" $fpath)
autoload -U compinit && compinit -u -D
unsetopt zle_bracketed_paste
show() { print -r "[$BUFFER]" }
zle -N show
bindkey '^X' show
PS1='ready> '
"""


def zsh_line(prefix, folder, typed):
    """What zsh makes of the typed text and a tab."""
    (folder / ".zshrc").write_text(ZSHRC)
    child, terminal = pty.fork()
    if child == 0:
        os.chdir(folder)
        os.execvpe("zsh", ["zsh", "-d", "-i"], CLEAN | {
            "TERM": "dumb", "ZDOTDIR": str(folder), "COLUMNS": "2000",
            "FUNCTIONS": str(prefix / "share/zsh/site-functions")})
    said = ""

    def wait_for(pattern):
        nonlocal said
        until = time.monotonic() + 180
        while not (found := re.search(pattern, said)):
            assert time.monotonic() < until, f"zsh does not say {pattern}: {said}"
            if select.select([terminal], [], [], 0.2)[0]:
                said += os.read(terminal, 65536).decode(errors="replace")
        return found

    try:
        wait_for("ready> ")
        os.write(terminal, typed.encode() + b"\t\x18")
        return wait_for(r"\[(weft.*)\]")[1].strip()
    finally:
        os.close(terminal)
        os.waitpid(child, 0)


@pytest.mark.parametrize("typed, line", [
    ("weft me", "weft mesh"),
    ("weft mesh --min", "weft mesh --min-"),
    ("weft mesh --min-an", "weft mesh --min-angle="),
    ("weft mesh coastal", "weft mesh coastal.geojson"),
    ("weft mesh coast.", "weft mesh coast.poly"),
    ("weft mesh --placement=la", "weft mesh --placement=lattice"),
    ("weftd --tls-cl", "weftd --tls-client-ca="),
])
def test_zsh_completes(prefix, models, typed, line):
    assert zsh_line(prefix, models, typed) == line


def test_the_unit_is_sound_and_confined(prefix):
    unit = prefix / "lib/systemd/system/weftd.service"
    done = subprocess.run(["systemd-analyze", "verify", "--man=no", unit], capture_output=True,
                          text=True)
    assert (done.returncode, done.stderr) == (0, "")
    printed = run("systemd-analyze", "security", "--offline=true", "--threshold=20", unit)
    assert re.search(r"exposure level.*: [01]\.\d|exposure level.*: 2\.0", printed)


def test_the_unit_gives_weftd_time_to_drain(prefix):
    unit = (prefix / "lib/systemd/system/weftd.service").read_text()
    rows = program_help.parse(program_help.help_of(prefix / "bin/weftd")).all_flags()
    drain, = (float(row.default) for row in rows if row.names == ["--drain"])
    assert float(re.search(r"^TimeoutStopSec=(\d+)$", unit, re.M)[1]) > drain


def test_the_variables_of_the_service_are_those_of_weftd(prefix):
    text = (prefix / "etc/default/weftd").read_text()
    assert f"EnvironmentFile=-{prefix}/etc/default/weftd" in (
        prefix / "lib/systemd/system/weftd.service").read_text()
    rows = program_help.parse(program_help.help_of(prefix / "bin/weftd")).all_flags()
    defaults = {row.variable: row.default for row in rows if row.variable}
    assert set(re.findall(r"^#?(WEFT_\w+)=", text, re.M)) <= set(defaults)
    given = dict(re.findall(r"^(WEFT_\w+)=(.*)", text, re.M))
    assert given.pop("WEFT_DATA") == "/var/lib/weftd"
    assert given == {"WEFT_LISTEN": defaults["WEFT_LISTEN"]}


def test_variables_that_were_changed_stay(tmp_path):
    install(tmp_path, "--component", "weftd")
    (tmp_path / "etc/default/weftd").write_text("WEFT_LISTEN=unix:/run/mine\n")
    install(tmp_path, "--component", "weftd")
    assert (tmp_path / "etc/default/weftd").read_text() == "WEFT_LISTEN=unix:/run/mine\n"
