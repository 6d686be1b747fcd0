# SPDX-License-Identifier: Apache-2.0
"""Scripts whose server is away end by themselves, whatever way they take; what forks and proxies do to a client."""

import asyncio
import os
import signal
import subprocess
import sys

import pytest
import weft
from conftest import KEY
from weft import aio

TRIANGLE = [(0, 0), (1, 0), (0, 1)]
AWAY = "127.0.0.1:1"  # nobody may listen there but root
LONG = 100  # seconds: far more than a script takes on a busy machine, and less than for ever

CALL = f"client.mesh({TRIANGLE})"
PLAIN = f"import sys, weft\nclient = weft.Client('{AWAY}', retries=1)\n"
SCRIPTS = {
    "alone": PLAIN + CALL,
    "in a context": f"import weft\nwith weft.Client('{AWAY}', retries=1) as client:\n  {CALL}",
    "sys.exit": PLAIN + f"try:\n  {CALL}\nexcept weft.Unavailable:\n  sys.exit(1)",
    "a unary call": PLAIN + "client.server_info()",
    "in a function": f"import weft\ndef main():\n  client = weft.Client('{AWAY}', retries=1)\n  {CALL}\nmain()",
    "unittest": PLAIN + f"import unittest\nclass T(unittest.TestCase):\n  def test(self):\n    {CALL}\nunittest.main()",
    "asyncio": "import asyncio, weft\nasync def main():\n"
               f"  client = weft.aio.Client('{AWAY}', retries=1)\n  await {CALL}\nasyncio.run(main())",
    "asyncio in a context": "import asyncio, weft\nasync def main():\n"
                            f"  async with weft.aio.Client('{AWAY}', retries=1) as client:\n    await {CALL}\n"
                            "asyncio.run(main())",
}


@pytest.mark.parametrize("script", SCRIPTS.values(), ids=SCRIPTS)
def test_a_script_ends(script):
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=LONG)
    assert done.returncode == 1, done.stderr


def test_tests_of_pytest_end(tmp_path):
    (tmp_path / "away_test.py").write_text(PLAIN + f"def test_it():\n  {CALL}")
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", tmp_path / "away_test.py"],
                          capture_output=True, text=True, timeout=LONG)
    assert done.returncode == 1 and "Unavailable" in done.stdout, done.stdout


def test_ctrl_c_ends_the_wait_for_a_server():
    script = f"import weft\nclient = weft.Client('{AWAY}', retries=1000)\n{CALL}"
    with subprocess.Popen([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True) as process:
        assert "trying again" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=LONG)[1]
    assert process.returncode == -signal.SIGINT and "KeyboardInterrupt" in said


def in_a_fork(function):
    """The exit code that a function gives in a child."""
    process = os.fork()
    if process == 0:
        try:
            code = function()
        except BaseException:
            code = 70
        os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])


@pytest.mark.parametrize("used", [False, True])
def test_a_client_says_that_it_does_not_work_in_a_fork(server, used):
    with weft.Client(server.target, retries=0) as client:
        if used:
            client.mesh(KEY, size=2)

        def call():
            try:
                client.mesh(KEY, size=2)
            except weft.WeftError as error:
                client.close()
                return 7 if "make a Client in each process" in str(error) else 71
            return 72
        assert in_a_fork(call) == 7
        assert client.mesh(KEY, size=2).summary.triangles > 0


def test_a_client_of_asyncio_says_so_too(server):
    async def call():
        client = aio.Client(server.target)
        client._own_channel._process -= 1  # as in a fork, which an event loop does not survive
        with pytest.raises(weft.WeftError, match="in each process"):
            await client.mesh(KEY, size=2)
        await client.close()
    asyncio.run(call())


def test_the_end_of_a_fork_leaves_the_server_of_its_parent():
    script = ("import os, sys, weft\n"
              "with weft.local() as client:\n"
              "  if (child := os.fork()) == 0:\n    sys.exit(7)\n"
              "  assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7\n"
              f"  client.mesh({TRIANGLE})\n")
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=LONG)
    assert done.returncode == 0, done.stderr


def test_a_proxy_is_not_asked_for_this_machine(monkeypatch):
    monkeypatch.setenv("http_proxy", f"http://{AWAY}")
    with weft.LocalServer(arguments=["--listen", "127.0.0.1:0"]) as local:
        address = next(a for a in local.addresses if a.startswith("127.0.0.1:"))
        for target in (address, address.replace("127.0.0.1", "localhost"), local.target):
            with weft.Client(target, retries=0) as client:
                assert client.server_info().version == weft.__version__


@pytest.mark.parametrize("variables, words", [
    ({"http_proxy": "http://user:secret@127.0.0.1:1/"}, "the proxy 127.0.0.1:1, which http_proxy names"),
    ({"http_proxy": "http://127.0.0.1:2", "grpc_proxy": "http://127.0.0.1:1"}, "127.0.0.1:1, which grpc_proxy names"),
    ({"http_proxy": "http://127.0.0.1:1", "no_proxy": "a.test, invalid"}, None)])
def test_a_proxy_is_named_if_there_is_no_way_through_it(monkeypatch, variables, words):
    for name in ("grpc_proxy", "https_proxy", "http_proxy", "no_grpc_proxy", "no_proxy"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    with weft.Client("mesh.invalid:7421", retries=0) as client:
        with pytest.raises(weft.Unavailable) as raised:
            client.server_info()
    assert (words or "mesh.invalid") in str(raised.value) and "secret" not in str(raised.value)
    assert ("proxy" in str(raised.value)) == (words is not None)
