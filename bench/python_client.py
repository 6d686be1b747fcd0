# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a mesh takes to arrive as numpy arrays, beyond what the engine takes to make it: the
cylinder over loopback from a weftd of its own, through both clients, and from the store of jobs.
Prints the table of bench/README.md.

    PYTHONPATH=build/release/python WEFT_WEFTD=build/release/weftd python3 bench/python_client.py
"""

import asyncio
import pathlib
import statistics
import tempfile
import time

import weft

RUNS = 9
MODEL = pathlib.Path(__file__).parents[1] / "tests/models/cylinder.poly"
SIZE = "((x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2) * {}"


def row(what, took):
    """A row of the table, of RUNS pairs of a mesh and its seconds."""
    beyond = [seconds - mesh.summary.timings.engine_seconds for mesh, seconds in took]
    mesh, _ = took[0]
    megabytes = (mesh.points.nbytes + mesh.triangles.nbytes) / 1e6
    print(f"| {what} | {len(mesh.triangles)} | {megabytes:.1f} "
          f"| {statistics.median(seconds for _, seconds in took):.3f} "
          f"| {statistics.median(m.summary.timings.engine_seconds for m, _ in took):.3f} "
          f"| {statistics.median(beyond):.3f} | {max(beyond):.3f} |")


def timed(make):
    start = time.perf_counter()
    return make(), time.perf_counter() - start


def listening_on_loopback(folder):
    server = weft.LocalServer(arguments=["--listen", "127.0.0.1:0", "--data", folder])
    return server, next(address for address in server.addresses if address.startswith("127.0.0.1:"))


async def through_aio(target, domain, size):
    async with weft.aio.Client(target) as client:
        took = []
        for _ in range(RUNS):
            start = time.perf_counter()
            mesh = await client.mesh(domain, size=size, no_cache=True)
            took.append((mesh, time.perf_counter() - start))
        return took


def main():
    domain = weft.Domain.read(MODEL)
    print("| | triangles | MB of arrays | whole call s | engine s | beyond it s | worst s |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        server, tcp = listening_on_loopback(folder)
        with server, weft.Client(tcp) as client, weft.Client(server.target) as local:
            for name, factor in (("1 M", 0.95), ("10 M", 0.095)):
                size = SIZE.format(factor)
                client.mesh(domain, size=size, no_cache=True)  # the server's first pages
                row(f"TCP, {name}", [timed(lambda: client.mesh(domain, size=size, no_cache=True)) for _ in range(RUNS)])
                row(f"unix socket, {name}",
                    [timed(lambda: local.mesh(domain, size=size, no_cache=True)) for _ in range(RUNS)])
                row(f"TCP, asyncio, {name}", asyncio.run(through_aio(tcp, domain, size)))
                job = client.wait(client.submit(domain, size=size))
                fetched = [timed(lambda: client.fetch(job)) for _ in range(RUNS)]
                print(f"| TCP, fetched from the store, {name} | {len(fetched[0][0].triangles)} | | "
                      f"{statistics.median(seconds for _, seconds in fetched):.3f} | | | |")


main()
