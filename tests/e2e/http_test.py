# SPDX-License-Identifier: Apache-2.0
"""Meshes by curl: the lines that docs/http.md has, and what they meet on the way."""
from __future__ import annotations

import concurrent.futures
import json
import math
import os
import pathlib
import re
import subprocess
import time

import pytest

MODELS = pathlib.Path(__file__).parents[1] / "models"
WEFT, WEFTD = os.environ["WEFT_BINARY"], os.environ["WEFT_WEFTD"]
COAST = MODELS / "us-east-coast.geojson"
KEY = MODELS / "key.poly"


class Server:
    """A weftd with --http, until the block ends."""

    def __init__(self, folder: pathlib.Path, *flags: str):
        self.folder, self.flags = folder, flags

    def __enter__(self) -> Server:
        ports = self.folder / "ports"
        ports.unlink(missing_ok=True)
        self.log = open(self.folder / "weftd.log", "w+")
        self.process = subprocess.Popen([WEFTD, "--listen", "127.0.0.1:0", "--http", "127.0.0.1:0", "--port-file", ports,
                                         *self.flags], stderr=self.log)
        while not ports.exists():
            assert self.process.poll() is None, self.text()
            time.sleep(0.01)
        lines = ports.read_text().split()
        self.grpc = lines[0]
        self.http = next(line.removeprefix("http=") for line in lines if line.startswith("http="))
        return self

    def text(self) -> str:
        return (self.folder / "weftd.log").read_text()

    def waits_for(self, words: str, seconds: float) -> bool:
        end = time.monotonic() + seconds
        while words not in self.text() and time.monotonic() < end:
            time.sleep(0.01)
        return words in self.text()

    def __exit__(self, *_: object) -> None:
        self.process.terminate()
        assert self.process.wait(60) == 0
        self.log.close()


def curl(folder: pathlib.Path, *words: object) -> tuple[int, str]:
    """The status of the answer, and what else curl prints."""
    done = subprocess.run(["curl", "-s", "-w", "\n%{http_code}", *map(str, words)], capture_output=True, text=True,
                          cwd=folder)
    body, _, status = done.stdout.rpartition("\n")
    return int(status), body


def test_a_mesh_is_that_of_weft_mesh(tmp_path):
    with Server(tmp_path) as server:
        url = f"http://{server.http}/v1/mesh"
        assert curl(tmp_path, "-T", COAST, url + "?edge=20000&lonlat&format=vtu", "-o", "coast.vtu")[0] == 200
        subprocess.run([WEFT, "mesh", "--server", server.grpc, COAST, "--edge", "20000", "--lonlat", "-o", "flags.vtu",
                        "-q"], cwd=tmp_path, check=True)
        assert (tmp_path / "coast.vtu").read_bytes() == (tmp_path / "flags.vtu").read_bytes()
        assert curl(tmp_path, "--data-binary", f"@{KEY}", url + "?size=0.01&min-angle=30&format=msh", "-OJ")[0] == 200
        checked = subprocess.run([WEFT, "check", "mesh.msh", "--domain", KEY, "--size", "0.01", "--min-angle", "30"],
                                 cwd=tmp_path, capture_output=True, text=True)
        assert checked.returncode == 0, checked.stdout + checked.stderr
        status, body = curl(tmp_path, f"http://{server.http}/v1/info")
        assert status == 200 and json.loads(body)["engine_version"]


def test_a_mesh_that_streams_is_that_of_weft_mesh(tmp_path):
    # So many points that they come in two chunks.
    ring = [(math.cos(i * math.tau / 80_000), math.sin(i * math.tau / 80_000)) for i in range(80_000)]
    (tmp_path / "disk.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": [[*ring, ring[0]]]}))
    with Server(tmp_path) as server:
        wish = f"http://{server.http}/v1/mesh?edge=5000&lonlat&format=geojson&stream"
        assert curl(tmp_path, "-T", "disk.geojson", wish, "-o", "streamed.geojson", "-D", "head")[0] == 200
        subprocess.run([WEFT, "mesh", "--server", server.grpc, "disk.geojson", "--edge", "5000", "--lonlat", "-o",
                        "flags.geojson", "-q"], cwd=tmp_path, check=True)
        assert (tmp_path / "streamed.geojson").read_bytes() == (tmp_path / "flags.geojson").read_bytes()
        assert re.search(r"^Weft-Triangles: \d{6}\r?$", (tmp_path / "head").read_text(), re.MULTILINE)


def test_a_bad_file_is_told_with_its_place(tmp_path):
    (tmp_path / "bad.geojson").write_text('{"type": "Polygon",\n"coordinates": [[[0, 0], [1, 0], [x, 1]]]}')
    with Server(tmp_path) as server:
        status, body = curl(tmp_path, "-T", "bad.geojson", f"http://{server.http}/v1/mesh/")
        assert status == 400
        problem = json.loads(body)
        assert problem["reason"] == "UNREADABLE_FILE" and problem["detail"].startswith("bad.geojson:2:")
        assert problem["errors"][0]["line"] == 2


def grid(x: float, y: float, cell: float, rows: list[list[float]]) -> str:
    return (f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcenter {x}\nyllcenter {y}\ncellsize {cell}\n"
            + "".join(" ".join(map(str, row)) + "\n" for row in rows))


def test_a_form_brings_the_fields_of_a_size(tmp_path):
    (tmp_path / "h.asc").write_text(grid(-10, -10, 60, [[1, 2, 4], [4, 8, 1], [2, 1, 3]]))
    edge = ["--edge", "min(h, 0.5 + 0.1*rim)", "--field", "h=h.asc", "--field", "rim=distance"]
    with Server(tmp_path) as server:
        url = f"http://{server.http}/v1/mesh"
        form = ["-F", f"domain=@{KEY}", "-F", "edge=min(h, 0.5 + 0.1*rim)", "-F", "field=rim=distance", "-F",
                "h=@h.asc"]
        status, body = curl(tmp_path, *form, url, "-o", "form.vtu")
        assert status == 200, body
        subprocess.run([WEFT, "mesh", "--server", server.grpc, KEY, *edge, "-o", "flags.vtu", "-q"], cwd=tmp_path,
                       check=True)
        assert (tmp_path / "form.vtu").read_bytes() == (tmp_path / "flags.vtu").read_bytes()
        for line, words in ((form[2:], "no file whose name is `domain`"),
                            ([*form, "-F", "edges=2"], "there is no such parameter"),
                            ([*form[:-1], f"h=@{KEY}"], "key.poly:"),
                            ([*form, "-F", "k=@h.asc", "-F", "k=@h.asc"], "k")):
            status, body = curl(tmp_path, *line, url)
            assert status == 400 and words in json.loads(body)["detail"], body


def test_layers_without_room_are_a_warning(tmp_path):
    (tmp_path / "channel.poly").write_text(
        "4 2 0 0\n1 0 0\n2 9 0\n3 9 1\n4 0 1\n4 1\n1 1 2 1\n2 2 3 2\n3 3 4 1\n4 4 1 2\n0\n")
    with Server(tmp_path) as server:
        url = f"http://{server.http}/v1/mesh/?layers=1:first=0.1,rows=9&edge=0.3"
        assert curl(tmp_path, "-T", "channel.poly", url, "-o", "mesh.vtu", "-D", "head")[0] == 200
    assert "Weft-Warning: layers thinner than asked for, for want of room, at 4 corners" in (tmp_path / "head").read_text()


def test_segments_that_are_nearly_one_are_a_warning_which_names_a_snap_that_merges_them(tmp_path):
    walls = [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]], [[9.003, 0], [18, 0], [18, 9], [9.003, 9], [9.003, 0]]]
    (tmp_path / "rooms.wkt").write_text("MULTIPOLYGON(" + ", ".join(
        "((" + ", ".join(f"{x} {y}" for x, y in wall) + "))" for wall in [*walls, [
            [0, 0], [18, 0], [18, 9], [0, 9], [0, 0]]]) + ")")
    with Server(tmp_path) as server:
        def warnings(*options: str) -> str:
            url = "&".join([f"http://{server.http}/v1/mesh/?edge=2", *options])
            assert curl(tmp_path, "-T", "rooms.wkt", url, "-o", "mesh.vtu", "-D", "head")[0] == 200
            return (tmp_path / "head").read_text()

        told = warnings()
        assert "Weft-Warning: triangles where segments are up to 0.003 apart: at least " in told
        assert "snap=0.0031 merges them" in told
        merged = warnings("snap=0.0031")
        assert "triangles where" not in merged
        assert "Weft-Warning: faces of the input that vanished, narrower than 0.0031: 1, one at (9, " in merged


def test_grids_of_a_domain_in_degrees_are_in_degrees(tmp_path):
    rows = [[8000 + 500 * (i + j) for i in range(40)] for j in range(40)]
    (tmp_path / "h.asc").write_text(grid(-90, 20, 1, rows))
    with Server(tmp_path) as server:
        status, body = curl(tmp_path, "-F", f"domain=@{COAST}", "-F", "to_metres=", "-F", "edge=h", "-F", "h=@h.asc",
                            f"http://{server.http}/v1/mesh?format=vtu", "-o", "coast.vtu")
    assert status == 200, body
    checked = subprocess.run([WEFT, "check", "coast.vtu", "--domain", COAST, "--to-metres", "--edge", "h*1.0001",
                              "--field", "h=h.asc"], cwd=tmp_path, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_tokens_and_certificates_are_those_of_grpc(tmp_path):
    (tmp_path / "tokens").write_text("ann 0123456789abcdef\n")
    (tmp_path / "tokens").chmod(0o600)
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", "key.pem", "-out", "cert.pem",
                    "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1"], cwd=tmp_path,
                   check=True, capture_output=True)
    with Server(tmp_path, "--tls-cert", str(tmp_path / "cert.pem"), "--tls-key", str(tmp_path / "key.pem"), "--tokens",
                str(tmp_path / "tokens")) as server:
        line = ["--cacert", "cert.pem", "-T", KEY, f"https://{server.http}/v1/mesh?size=0.1"]
        assert curl(tmp_path, *line)[0] == 401
        assert curl(tmp_path, "-H", "Authorization: Bearer 0123456789abcdef", "-o", "key.vtu", *line)[0] == 200
        assert "client=ann" in server.text()


def test_the_download_of_a_stored_mesh_goes_on_where_it_ended(tmp_path):
    with Server(tmp_path, "--data", str(tmp_path / "jobs")) as server:
        url = f"http://{server.http}/v1/jobs"
        job = json.loads(curl(tmp_path, "--data-binary", f"@{KEY}", url + "?size=0.1")[1])["job"]["id"]
        mesh = f"{url}/{job}/mesh?format=msh"
        while json.loads(curl(tmp_path, f"{url}/{job}")[1])["job"]["state"] != "JOB_STATE_SUCCEEDED":
            time.sleep(0.01)
        assert curl(tmp_path, mesh, "-o", "whole.msh", "-D", "head")[0] == 200
        tag = next(line.split()[1] for line in (tmp_path / "head").read_text().splitlines() if line.startswith("ETag"))
        whole = (tmp_path / "whole.msh").read_bytes()
        (tmp_path / "part.msh").write_bytes(whole[:5000])
        assert curl(tmp_path, "-C", "-", mesh, "-o", "part.msh", "-H", f"If-Range: {tag}")[0] == 206
        assert (tmp_path / "part.msh").read_bytes() == whole
        assert curl(tmp_path, mesh, "-H", "Range: bytes=-9", "-o", "end")[0] == 206
        assert (tmp_path / "end").read_bytes() == whole[-9:]
        assert curl(tmp_path, mesh, "-H", "Range: bytes=9-", "-H", 'If-Range: "another"', "-o", "all")[0] == 200
        assert curl(tmp_path, mesh, "-H", f"Range: bytes={len(whole)}-")[0] == 416


def test_what_is_too_large_is_refused(tmp_path):
    with Server(tmp_path, "--max-request-bytes", "1MiB") as server:
        (tmp_path / "large.csv").write_text("0,0\n" * (1 << 19))
        status, body = curl(tmp_path, "-T", "large.csv", f"http://{server.http}/v1/mesh")
        assert status == 413 and "1048576 bytes" in json.loads(body)["detail"]


def test_a_client_that_goes_away_ends_its_run(tmp_path):
    with Server(tmp_path) as server:
        client = subprocess.Popen(["curl", "-s", "-T", KEY, f"http://{server.http}/v1/mesh?size=2e-7", "-o",
                                   tmp_path / "key.vtu"])
        assert server.waits_for("event=call_started", 10)
        time.sleep(0.2)
        client.kill()
        client.wait()
        assert server.waits_for("reason=CANCELLED", 1), server.text()


def test_many_at_once_are_all_the_same(tmp_path):
    with Server(tmp_path, "--cache-bytes", "0") as server:
        line = ["-T", KEY, f"http://{server.http}/v1/mesh?size=0.1&format=msh"]
        with concurrent.futures.ThreadPoolExecutor(64) as clients:
            done = list(clients.map(lambda i: curl(tmp_path, *line, "-o", f"{i}.msh"), range(64)))
        assert {status for status, _ in done} == {200}
        assert len({(tmp_path / f"{i}.msh").read_bytes() for i in range(64)}) == 1
        assert not [name for name in os.listdir(f"/proc/{server.process.pid}/fd") if int(name) > 2
                    and "(deleted)" in os.readlink(f"/proc/{server.process.pid}/fd/{name}")]


if __name__ == "__main__":
    raise SystemExit(pytest.main([__file__]))
