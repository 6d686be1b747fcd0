# SPDX-License-Identifier: Apache-2.0
"""Callbacks of jobs, from real servers to real receivers on loopback."""
from __future__ import annotations

import base64
import hmac
import http.server
import json
import os
import pathlib
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator

import pytest

SOURCE = pathlib.Path(__file__).parents[2]
sys.path.append(str(SOURCE / "tests" / "documents"))
from postgres import Postgres  # noqa: E402

KEY = SOURCE / "tests" / "models" / "key.poly"
WEFT, WEFTD = os.environ["WEFT_BINARY"], os.environ["WEFT_WEFTD"]
SECRET = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"
PATIENCE = 120  # seconds; nothing waits as long unless it is broken
ALLOWED = ("--notify-allow", "127.0.0.0/8")


def wait_until(is_so: Callable[[], bool], what: str = "what was waited for") -> None:
    end = time.monotonic() + PATIENCE
    while not is_so():
        assert time.monotonic() < end, what
        time.sleep(0.01)


class Receiver:
    """Verifies callbacks, and treats those of one id as one. `answers` are the statuses of the first; then it is 200.
    0 is no answer."""

    def __init__(self, *answers: int, port: int = 0, tls: ssl.SSLContext | None = None):
        self.ids: list[str] = []
        self.effects: dict[str, dict] = {}
        self.forged = 0
        self.end = threading.Event()
        answer = iter(answers)
        receiver = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                body = self.rfile.read(int(self.headers["content-length"]))
                job, timestamp = self.headers["webhook-id"], self.headers["webhook-timestamp"]
                key = base64.b64decode(SECRET.removeprefix("whsec_"))
                wanted = base64.b64encode(hmac.digest(key, f"{job}.{timestamp}.".encode() + body, "sha256")).decode()
                genuine = f"v1,{wanted}" in self.headers["webhook-signature"].split(" ")
                receiver.forged += not genuine or abs(time.time() - int(timestamp)) > PATIENCE
                receiver.ids.append(job)
                status = next(answer, 200)
                if status == 0:
                    receiver.end.wait()
                    return
                if status == 200:
                    receiver.effects.setdefault(job, json.loads(body)["job"])
                self.send_response(status)
                self.end_headers()

            def log_message(self, *_: object) -> None:
                pass

        class Server(http.server.ThreadingHTTPServer):
            def handle_error(self, *_: object) -> None:  # clients that are killed, or trust nobody
                pass

        self.server = Server(("127.0.0.1", port), Handler)
        if tls:
            self.server.socket = tls.wrap_socket(self.server.socket, server_side=True)
        self.port = self.server.server_address[1]
        self.url = f"http://127.0.0.1:{self.port}/hook"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self) -> Receiver:
        return self

    def __exit__(self, *_: object) -> None:
        self.end.set()
        self.server.shutdown()
        self.server.server_close()


class Server:
    """A weftd that keeps jobs and may send callbacks."""

    def __init__(self, folder: pathlib.Path, *flags: object, data: str = "data",
                 environment: dict[str, str] | None = None):
        (folder / "secrets").write_text(f"* {SECRET}\n")
        (folder / "secrets").chmod(0o600)
        self.ports = folder / f"ports{len(list(folder.glob('ports*')))}"
        self.log = folder / "weftd.log"
        store = ["--data", folder / data] if data else []
        with open(self.log, "a") as log:
            self.process = subprocess.Popen(
                [WEFTD, "--listen", "127.0.0.1:0", "--http", "127.0.0.1:0", "--port-file", self.ports,
                 "--notify-secrets", folder / "secrets", *store, *map(str, flags)], stderr=log,
                env=os.environ | (environment or {}))
        wait_until(lambda: self.ports.exists() or self.process.poll() is not None)
        assert self.process.poll() is None, self.log.read_text()
        lines = self.ports.read_text().split()
        self.address = lines[0]
        self.http = next(line.removeprefix("http=") for line in lines if line.startswith("http="))

    def weft(self, *words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([WEFT, *map(str, words), "--server", self.address], capture_output=True, text=True)

    def submit(self, url: str, *words: object, size: str = "0.1") -> str:
        done = self.weft("submit", KEY, "--size", size, "--notify", url, *words)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    def callback(self, job: str) -> dict:
        done = self.weft("get", job, "--json")
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)["callback"]

    def settled(self, job: str) -> dict:
        wait_until(lambda: self.callback(job)["state"] != "pending", self.log.read_text())
        return self.callback(job)

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.process.terminate()
            assert self.process.wait(PATIENCE) == 0
        assert SECRET not in self.log.read_text()


def test_a_receiver_is_told_of_the_end_of_a_job(tmp_path: pathlib.Path) -> None:
    with Receiver() as receiver, Server(tmp_path, *ALLOWED) as server:
        job = server.submit(receiver.url)
        assert server.settled(job) == {"url": receiver.url, "state": "delivered", "attempts": 1, "error": ""}
        told = receiver.effects[job]
        assert told["state"] == "JOB_STATE_SUCCEEDED" and int(told["summary"]["triangles"]) > 1000
        assert told["create_time"] <= told["start_time"] <= told["end_time"]
        # The mesh is kept: the next job ends as it is accepted.
        again = server.submit(receiver.url)
        assert server.settled(again)["state"] == "delivered"
        failed = server.submit(receiver.url, size="x-1e9")
        assert server.settled(failed)["state"] == "delivered"
        assert receiver.effects[failed]["error"]["message"]
        assert receiver.ids == [job, again, failed] and receiver.forged == 0
        assert f"event=callback_sent job={job}" in server.log.read_text()


def test_by_http_it_is_a_parameter(tmp_path: pathlib.Path) -> None:
    def post(notify: str) -> tuple[int, dict]:
        done = subprocess.run(["curl", "-s", "-w", "\n%{http_code}", "--data-binary", f"@{KEY}",
                               f"http://{server.http}/v1/jobs?size=0.1&notify={notify}"], capture_output=True, text=True)
        body, _, status = done.stdout.rpartition("\n")
        return int(status), json.loads(body)

    with Receiver() as receiver, Server(tmp_path, *ALLOWED) as server:
        status, made = post(receiver.url)
        assert status == 201 and made["job"]["callback"]["url"] == receiver.url
        assert server.settled(made["job"]["id"])["state"] == "delivered"
        status, problem = post("http://10.1.2.3/")
        assert (status, problem["errors"][0]["field"]) == (400, "notify")


def test_a_failure_is_tried_again(tmp_path: pathlib.Path) -> None:
    with Receiver(500) as receiver, Server(tmp_path, *ALLOWED) as server:
        job = server.submit(receiver.url)
        assert server.settled(job)["attempts"] == 2
        assert receiver.ids == [job, job] and list(receiver.effects) == [job] and receiver.forged == 0


# The receiver has the callback, and the server never knows.
def test_a_server_that_is_killed_while_it_tells_tells_again(tmp_path: pathlib.Path) -> None:
    with Receiver(0) as receiver:
        server = Server(tmp_path, *ALLOWED)
        job = server.submit(receiver.url)
        wait_until(lambda: receiver.ids == [job])
        server.kill()
        with Server(tmp_path, *ALLOWED) as server:
            assert server.settled(job)["state"] == "delivered"
        assert receiver.ids == [job, job] and list(receiver.effects) == [job] and receiver.forged == 0


# Nobody has it: the job has ended, but whoever is to be told is away.
def test_a_server_that_is_killed_before_it_tells_tells_later(tmp_path: pathlib.Path) -> None:
    with socket.socket() as reserved:
        reserved.bind(("127.0.0.1", 0))
        port = reserved.getsockname()[1]
        server = Server(tmp_path, *ALLOWED)
        job = server.submit(f"http://127.0.0.1:{port}/hook", "--wait", "--quiet")
        server.kill()
    with Receiver(port=port) as receiver, Server(tmp_path, *ALLOWED) as server:
        assert server.settled(job)["state"] == "delivered"
        assert receiver.ids == [job] and list(receiver.effects) == [job]


# What names this machine, or its network, in whatever way.
LITERAL = ["127.0.0.1", "[::1]", "0.0.0.0", "[::]", "[::ffff:127.0.0.1]", "[64:ff9b::7f00:1]", "169.254.169.254",
           "10.0.0.1", "192.168.1.1", "172.16.0.1", "100.64.0.1", "[fd00::1]", "[fe80::1]", "[2002:7f00:1::]"]
RESOLVED = ["2130706433", "0x7f000001", "017700000001", "0177.0.0.1", "127.1", "0x7f.0.0.1", "localhost"]


def test_hostile_addresses_are_refused(tmp_path: pathlib.Path) -> None:
    with Receiver() as receiver, Server(tmp_path) as server:
        for host in LITERAL:
            done = server.weft("submit", KEY, "--notify", f"http://{host}:{receiver.port}/")
            assert done.returncode != 0 and "callbacks may not go to" in done.stderr, host
        for url in (f"http://ann@example.org:{receiver.port}/", "ftp://example.org/", "http://exa mple.org/"):
            assert "notify" in server.weft("submit", KEY, "--notify", url).stderr, url
        jobs = {host: server.submit(f"http://{host}:{receiver.port}/") for host in RESOLVED}
        for host, job in jobs.items():
            callback = server.settled(job)
            assert (callback["state"], callback["attempts"]) == ("failed", 1), host
            assert callback["error"] == "the host has no address that callbacks may go to", host
        assert not receiver.ids


def test_a_redirection_is_not_followed(tmp_path: pathlib.Path) -> None:
    class Redirect(http.server.BaseHTTPRequestHandler):
        def do_POST(self) -> None:
            self.send_response(307)
            self.send_header("Location", f"http://[::1]:{receiver.port}/")
            self.end_headers()

    with Receiver() as receiver, http.server.HTTPServer(("127.0.0.1", 0), Redirect) as redirect:
        threading.Thread(target=redirect.serve_forever, daemon=True).start()
        with Server(tmp_path, *ALLOWED) as server:
            job = server.submit(f"http://127.0.0.1:{redirect.server_address[1]}/")
            wait_until(lambda: server.callback(job)["attempts"] > 1)
            assert server.callback(job)["error"] == "the answer has status 307"
        redirect.shutdown()
        assert not receiver.ids


def test_a_receiver_that_never_answers_holds_back_no_other(tmp_path: pathlib.Path) -> None:
    with Receiver(*[0] * 100) as silent, Receiver() as receiver, Server(tmp_path, *ALLOWED) as server:
        for _ in range(8):
            server.submit(silent.url)
        wait_until(lambda: len(silent.ids) >= 4)
        began = len(silent.ids)
        assert server.settled(server.submit(receiver.url))["state"] == "delivered"
        assert began == 4


def test_tls_is_verified(tmp_path: pathlib.Path) -> None:
    for name, alternative in (("good", "IP:127.0.0.1"), ("other", "DNS:other.example.org")):
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
                        "-days", "1", "-subj", f"/CN={name}", "-addext", f"subjectAltName={alternative}", "-keyout",
                        f"{name}.key", "-out", f"{name}.pem"], cwd=tmp_path, check=True, capture_output=True)
    (tmp_path / "all.pem").write_text((tmp_path / "good.pem").read_text() + (tmp_path / "other.pem").read_text())

    def receiver_as(name: str) -> Receiver:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(tmp_path / f"{name}.pem", tmp_path / f"{name}.key")
        return Receiver(tls=context)

    with receiver_as("good") as good, receiver_as("other") as other:
        urls = [receiver.url.replace("http", "https") for receiver in (good, other)]
        with Server(tmp_path, *ALLOWED, environment={"SSL_CERT_FILE": str(tmp_path / "all.pem")}) as server:
            assert server.settled(server.submit(urls[0]))["state"] == "delivered"
            job = server.submit(urls[1])
            wait_until(lambda: "verify failed" in server.callback(job)["error"])
        with Server(tmp_path, *ALLOWED, data="again") as server:  # whose system has no such authority
            job = server.submit(urls[0])
            wait_until(lambda: "verify failed" in server.callback(job)["error"])
        assert len(good.ids) == 1 and not other.ids


@pytest.fixture
def database() -> Iterator[Postgres]:
    # Not in tmp_path: what pytest makes is closed to other users, and the database is one.
    with tempfile.TemporaryDirectory(prefix="weft-") as folder:
        database = Postgres(pathlib.Path(folder))
        yield database
        database.close()


def test_of_several_servers_of_a_store_one_tells(database: Postgres, tmp_path: pathlib.Path) -> None:
    store = ("--store", database.uri, *ALLOWED)
    with Receiver() as receiver, Server(tmp_path, *store, data="") as one, Server(tmp_path, *store, data="") as two:
        jobs = [server.submit(receiver.url) for _ in range(8) for server in (one, two)]
        for job in jobs:
            assert one.settled(job) == {"url": receiver.url, "state": "delivered", "attempts": 1, "error": ""}
        assert sorted(receiver.ids) == sorted(jobs) and receiver.forged == 0


def test_callbacks_are_off_unless_a_client_has_a_secret(tmp_path: pathlib.Path) -> None:
    with Server(tmp_path, *ALLOWED) as server:
        (tmp_path / "secrets").write_text(f"ann {SECRET}\n")
        wait_until(lambda: "event=secrets_read" in server.log.read_text())
        done = server.weft("submit", KEY, "--notify", "http://127.0.0.1:9/")
        assert "the server has no secret for callbacks of this client" in done.stderr


if __name__ == "__main__":
    raise SystemExit(pytest.main([__file__]))
