# SPDX-License-Identifier: Apache-2.0
"""The clients of client/examples, compiled as their README says, against a real weftd."""

import os
import pathlib
import re
import shutil
import subprocess

import pytest
import weft

ROOT = pathlib.Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "client/examples"
CLEAN = {k: v for k, v in os.environ.items() if not k.startswith("WEFT_")}
TOKEN = "secret-of-the-examples"


@pytest.fixture(scope="session")
def node():
    """As the README says; npm ci only if the lockfile is newer."""
    folder = EXAMPLES / "node"
    installed = folder / "node_modules/.package-lock.json"
    lock = folder / "package-lock.json"
    if not installed.exists() or installed.stat().st_mtime < lock.stat().st_mtime:
        subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"], cwd=folder,
                       check=True)
    return ["node", folder / "mesh.mjs"]


@pytest.fixture(scope="session")
def go(tmp_path_factory):
    """As the README says, in a copy; what Go compiled is kept in the build folder."""
    folder = tmp_path_factory.mktemp("go")
    for part in ("proto", "client/examples"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("node_modules"))
    readme = (EXAMPLES / "README.md").read_text()
    blocks = re.findall(r"^```sh\n(.*?)^```", readme, re.M | re.S)
    commands, = (block for block in blocks if "go build" in block)
    subprocess.run(["bash", "-euc", commands], cwd=folder, check=True, env=CLEAN | {
        "GOCACHE": str(pathlib.Path(os.environ["WEFT_BUILD"], "go-cache"))})
    return [folder / "mesh"]


@pytest.fixture(params=["node", "go"])
def example(request):
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="session")
def server():
    with weft.LocalServer(arguments=["--listen", "127.0.0.1:0"]) as server:
        yield tcp_address(server)


@pytest.fixture(scope="session")
def guarded(tmp_path_factory):
    """A server with a certificate and a token: its address, and the certificate."""
    folder = tmp_path_factory.mktemp("guarded")
    (folder / "tokens").write_text(f"ada {TOKEN}\n")
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt",
                    "ec_paramgen_curve:prime256v1", "-nodes", "-days", "1", "-subj", "/CN=weft.test",
                    "-addext", "subjectAltName=DNS:localhost", "-keyout", folder / "key.pem",
                    "-out", folder / "cert.pem"], check=True, capture_output=True)
    with weft.LocalServer(arguments=[
            "--listen", "127.0.0.1:0", "--tls-cert", str(folder / "cert.pem"), "--tls-key",
            str(folder / "key.pem"), "--tokens", str(folder / "tokens")]) as server:
        address = tcp_address(server).replace("127.0.0.1", "localhost")
        yield address, str(folder / "cert.pem")


def tcp_address(server):
    return next(address for address in server.addresses if address.startswith("127.0.0.1:"))


def run(example, *arguments, **variables):
    return subprocess.run([*example, *arguments], capture_output=True, text=True, timeout=100,
                          env=CLEAN | {f"WEFT_{name}": text for name, text in variables.items()})


def test_the_mesh_is_whole(example, server):
    done = run(example, SERVER=server)
    assert (done.returncode, done.stderr) == (0, "")
    found = re.fullmatch(r"(\d+) triangles, (\d+) vertices in (\d+) chunks, "
                         r"angles ([\d.]+) to ([\d.]+) degrees, area ([\d.]+)\n", done.stdout)
    assert found, done.stdout
    triangles, vertices, chunks, smallest, _, area = map(float, found.groups())
    assert triangles > 1000 and vertices > triangles / 2 and chunks >= 1
    assert smallest >= 25
    assert area == pytest.approx(60 - 12 * 0.2588190451, abs=1e-3)
    assert f"```text\n{done.stdout}```" in (EXAMPLES / "README.md").read_text()


def test_an_error_of_the_request_names_its_field(example, server):
    done = run(example, "89", SERVER=server)
    code, reason, field = done.stderr.splitlines()
    assert (done.returncode, done.stdout) == (1, "")
    assert re.fullmatch("(INVALID_ARGUMENT|InvalidArgument): .* must be from 0 to 36 degrees", code)
    assert (reason, field) == ("  reason BAD_OPTION", "  field quality.min_angle_deg")


def test_a_token_and_a_certificate_let_in(example, guarded):
    server, certificate = guarded
    done = run(example, SERVER=server, TLS_CA=certificate, TOKEN=TOKEN)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_wrong_token_is_refused(example, guarded):
    server, certificate = guarded
    done = run(example, SERVER=server, TLS_CA=certificate, TOKEN="wrong")
    assert done.returncode == 1
    assert re.match("(?i)unauthenticated: .*\n  reason UNAUTHENTICATED\n", done.stderr)


def test_a_server_that_is_not_there_is_said(example):
    done = run(example, SERVER="127.0.0.1:1")
    assert done.returncode == 1
    assert re.match("(?i)unavailable: ", done.stderr)
