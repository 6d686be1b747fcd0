# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python package share."""

import json
import os
import pathlib
import subprocess

import pytest
import weft

os.environ["PATH"] = f"{pathlib.Path(os.environ['WEFT_BINARY']).parent}:{os.environ['PATH']}"
MODELS = pathlib.Path(os.environ["WEFT_MODELS"])
KEY, KEY_SIZE = MODELS / "key.poly", "0.02*abs(y-46)+0.1"


@pytest.fixture(scope="session")
def server():
    with weft.LocalServer() as server:
        yield server


@pytest.fixture(scope="session")
def client(server):
    with weft.Client(server.target, retries=0) as client:
        yield client


@pytest.fixture(scope="session")
def job_server(tmp_path_factory):
    with weft.LocalServer(arguments=["--data", str(tmp_path_factory.mktemp("jobs"))]) as server:
        yield server


@pytest.fixture(scope="session")
def messages(server):
    """The messages of a mesh of several chunks, as they came."""
    from weft import _protocol, _requests
    request = _requests.mesh_request(weft.Domain.read(KEY), 0.002, 20, {})
    with weft.Client(server.target) as client:
        call = client._channel.unary_stream(_protocol.GENERATE_MESH.path,
                                            _protocol.GENERATE_MESH.request.SerializeToString)
        return list(call(request))


@pytest.fixture
def run_weft():
    """Runs the command line; gives what it printed, and ends the test where it fails."""
    def run(*arguments):
        done = subprocess.run([os.environ["WEFT_BINARY"], *map(str, arguments)],
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout
    return run


@pytest.fixture
def digest_of(run_weft, server, tmp_path):
    """The digest that the command line gets for a mesh."""
    def digest(domain, *bounds):
        return json.loads(run_weft("mesh", domain, "--json", "--quiet", "--server", server.target,
                                   "-o", tmp_path / "digest.vtu", *bounds))["digest"]
    return digest
