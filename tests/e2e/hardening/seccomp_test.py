# SPDX-License-Identifier: Apache-2.0
"""weftd under deploy/seccomp/weftd.json: it does all its work, and what is not its work is refused."""
from __future__ import annotations

import http.server
import json
import os
import pathlib
import signal
import ssl
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator

import pytest
import seccomp
import seccomp_profile

SOURCE = pathlib.Path(__file__).parents[3]
sys.path.append(str(SOURCE / "tests" / "documents"))
from postgres import Postgres  # noqa: E402

PROFILE = SOURCE / "deploy" / "seccomp" / "weftd.json"
KEY = [SOURCE / "tests" / "models" / "key.poly", "--size", "0.02*abs(y-46)+0.1"]
WEFT, WEFTD = os.environ["WEFT_BINARY"], os.environ["WEFT_WEFTD"]
UNDER_PROFILE = [sys.executable, "-B", seccomp_profile.__file__, str(PROFILE)]


@pytest.fixture(scope="module", autouse=True)
def _filters_can_be_loaded() -> None:
    done = subprocess.run([*UNDER_PROFILE, "/bin/true"], capture_output=True, text=True)
    if done.returncode == seccomp_profile.CANNOT_LOAD:
        pytest.skip(done.stderr)
    assert done.returncode == 0, done.stderr


def run(*command: object) -> str:
    """What a command prints; it must succeed."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


class Server:
    """A weftd under the profile, on a socket and on the addresses in `arguments`."""

    def __init__(self, folder: pathlib.Path, *arguments: object):
        self.socket = f"unix:{folder}/socket"
        ready = folder / "ready"
        with open(folder / "log", "w") as log:
            self.process = subprocess.Popen(
                [*UNDER_PROFILE, WEFTD, "--listen", self.socket, "--port-file", ready,
                 *map(str, arguments)], stderr=log)
        while not ready.exists():
            assert self.process.poll() is None, (folder / "log").read_text()
            time.sleep(0.01)
        self.addresses = ready.read_text().splitlines()

    def weft(self, *words: object) -> str:
        return run(WEFT, *words, "--server", self.socket)

    def end(self) -> int:
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(60)


@pytest.fixture
def certificate(tmp_path: pathlib.Path) -> pathlib.Path:
    """Its key is in key.pem beside it."""
    run("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
        "-nodes", "-days", "1", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost",
        "-keyout", tmp_path / "key.pem", "-out", tmp_path / "cert.pem")
    return tmp_path / "cert.pem"


@pytest.fixture
def server(tmp_path: pathlib.Path, certificate: pathlib.Path) -> Iterator[Server]:
    server = Server(tmp_path, "--data", tmp_path / "data", "--listen", "localhost:0",
                    "--tls-cert", certificate, "--tls-key", tmp_path / "key.pem",
                    "--metrics", "127.0.0.1:0", "--console", "127.0.0.1:0", "--http", "127.0.0.1:0")
    yield server
    server.process.kill()
    server.process.wait()


def test_weftd_is_under_the_filter(server: Server) -> None:
    status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text().splitlines()
    assert "Seccomp:\t2" in status
    assert "NoNewPrivs:\t1" in status


def test_meshes_come_over_tls_and_are_the_same(server: Server, certificate: pathlib.Path,
                                               tmp_path: pathlib.Path) -> None:
    # The name is resolved under the profile, too: by the server that listens on it.
    port = next(address for address in server.addresses if "unix" not in address
                and "=" not in address).rsplit(":", 1)[1]
    over_tls = json.loads(run(WEFT, "mesh", *KEY, "--json", "--quiet", "-o", tmp_path / "a.vtu",
                              "--server", f"localhost:{port}", "--tls-ca", certificate))
    alone = json.loads(run(WEFT, "mesh", *KEY, "--json", "--quiet", "-o", tmp_path / "b.vtu"))
    assert over_tls["digest"] == alone["digest"]


def test_jobs_are_kept_and_fetched(server: Server, tmp_path: pathlib.Path) -> None:
    job = server.weft("submit", *KEY, "--quiet").strip()
    server.weft("fetch", job, "--wait", "--quiet", "-o", tmp_path / "job.vtu")
    server.weft("mesh", *KEY, "--quiet", "-o", tmp_path / "mesh.vtu")
    assert (tmp_path / "job.vtu").read_bytes() == (tmp_path / "mesh.vtu").read_bytes()


@pytest.fixture
def database() -> Iterator[Postgres]:
    # Not in tmp_path: what pytest makes is closed to other users, and the database is one.
    with tempfile.TemporaryDirectory(prefix="weft-") as folder:
        database = Postgres(pathlib.Path(folder))
        yield database
        database.close()


def test_jobs_are_kept_in_postgresql(database: Postgres, tmp_path: pathlib.Path) -> None:
    server = Server(tmp_path, "--store", database.uri)
    job = server.weft("submit", *KEY, "--quiet").strip()
    server.weft("fetch", job, "--wait", "--quiet", "-o", tmp_path / "job.vtu")
    assert server.end() == 0


def test_metrics_are_shown(server: Server) -> None:
    address = next(line for line in server.addresses if "=" in line).split("=")[1]
    with urllib.request.urlopen(f"http://{address}/metrics") as answer:
        assert b"\nweft_build_info{" in answer.read()


def test_a_callback_is_sent(tmp_path: pathlib.Path) -> None:
    told = []

    class Receiver(http.server.BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            told.append(self.headers["webhook-id"])
            self.send_response(204)
            self.end_headers()

    (tmp_path / "secrets").write_text("* whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw\n")
    server = Server(tmp_path, "--data", tmp_path / "data", "--notify-secrets", tmp_path / "secrets",
                    "--notify-allow", "127.0.0.0/8")
    with http.server.HTTPServer(("127.0.0.1", 0), Receiver) as receiver:
        job = server.weft("submit", *KEY, "--quiet", "--notify",
                          f"http://localhost:{receiver.server_address[1]}/").strip()
        receiver.timeout = 60
        receiver.handle_request()
    assert told == [job]
    assert server.end() == 0


def test_the_console_is_served(server: Server, certificate: pathlib.Path) -> None:
    port = next(line for line in server.addresses if line.startswith("console=")).rsplit(":", 1)[1]
    trusting = ssl.create_default_context(cafile=str(certificate))
    call = urllib.request.Request(f"https://localhost:{port}/grpc.health.v1.Health/Check", bytes(5),
                                  {"Content-Type": "application/grpc-web+proto"})
    with urllib.request.urlopen(call, context=trusting) as answer:
        assert b"grpc-status: 0\r\n" in answer.read()


def test_meshes_come_over_http(server: Server, certificate: pathlib.Path, tmp_path: pathlib.Path) -> None:
    port = next(line for line in server.addresses if line.startswith("http=")).rsplit(":", 1)[1]
    trusting = ssl.create_default_context(cafile=str(certificate))
    server.weft("mesh", KEY[0], "--size", 0.01, "--quiet", "-o", tmp_path / "mesh.vtu")
    call = urllib.request.Request(f"https://localhost:{port}/v1/mesh?size=0.01&from=poly", KEY[0].read_bytes())
    with urllib.request.urlopen(call, context=trusting) as answer:
        assert answer.read() == (tmp_path / "mesh.vtu").read_bytes()
    coast = SOURCE / "tests" / "models" / "us-east-coast.geojson"
    call = urllib.request.Request(f"https://localhost:{port}/v1/mesh?edge=50000&lonlat", coast.read_bytes())
    with urllib.request.urlopen(call, context=trusting) as answer:
        assert answer.status == 200


def test_the_health_check_of_the_image_works_under_the_profile(server: Server) -> None:
    run(*UNDER_PROFILE, WEFTD, "--health", "--listen", server.socket)


def test_sigterm_drains(server: Server) -> None:
    assert server.end() == 0


def number(call: str) -> int:
    """Of a call of the system, on this processor."""
    return seccomp.resolve_syscall(seccomp.Arch.NATIVE, call)


# What an attacker in weftd would want. None of it needs a right, so a kernel without the filter grants
# it, or refuses it with another error than EPERM.
FORBIDDEN = {
    "fork": "libc.fork()",
    "unshare": "libc.unshare(0)",
    "ptrace": "libc.ptrace(0, 0, 0, 0)",  # PTRACE_TRACEME
    "process_vm_readv": "libc.process_vm_readv(libc.getpid(), None, 0, None, 0, 0)",
    "keyctl": f"libc.syscall({number('keyctl')}, 0, -3, 0)",
    "io_uring_setup": f"libc.syscall({number('io_uring_setup')}, 0, None)",
    "userfaultfd": f"libc.syscall({number('userfaultfd')}, 1)",  # UFFD_USER_MODE_ONLY
    "memfd_create": "libc.memfd_create(b'x', 0)",
    "socket of AF_ALG": "libc.socket(38, 5, 0)",
    "socket of AF_VSOCK": "libc.socket(40, 1, 0)",
    "netlink of NETLINK_KOBJECT_UEVENT": "libc.socket(16, 3, 15)",
    "ioctl TIOCSTI": "libc.ioctl(0, 0x5412, b'x')",
    "memory to write and execute": f"libc.syscall({number('mmap')}, None, 4096, 7, 34, -1, 0)",
    "memory made executable": "libc.mprotect(page, 4096, 5)",
}


@pytest.mark.parametrize("call", FORBIDDEN)
def test_what_weftd_does_not_need_is_refused(call: str) -> None:
    """Everything is imported before the filter is loaded: the filter is for weftd, not for Python."""
    printed = run(sys.executable, "-B", "-c", f"""
import ctypes, mmap, os, sys
sys.path.append({os.path.dirname(__file__)!r})
import seccomp_profile
libc = ctypes.CDLL(None, use_errno=True)
own = mmap.mmap(-1, 4096)
page = ctypes.c_void_p(ctypes.addressof(ctypes.c_char.from_buffer(own)))
seccomp_profile.load({str(PROFILE)!r})
result = {FORBIDDEN[call]}
print(result, ctypes.get_errno(), flush=True)
os._exit(0)
""")
    assert printed == "-1 1\n"


def test_threads_are_made_without_clone3() -> None:
    printed = run(sys.executable, "-B", "-c", f"""
import ctypes, sys, threading
sys.path.append({os.path.dirname(__file__)!r})
import seccomp_profile
libc = ctypes.CDLL(None, use_errno=True)
seccomp_profile.load({str(PROFILE)!r})
libc.syscall({number('clone3')}, None, 0)
thread = threading.Thread(target=lambda: print(ctypes.get_errno()))
print(ctypes.get_errno(), flush=True)
thread.start()
thread.join()
""")
    assert printed == "38\n0\n"
