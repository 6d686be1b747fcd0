# SPDX-License-Identifier: GPL-3.0-or-later
"""What light calls wait for beside meshes over HTTP, and beside the same meshes over gRPC: 64 connections ask for
one request without a pause, by /v1/mesh or by GenerateMesh, in turns, and a client of its own makes light calls by
gRPC. From a weftd of its own; all clients read bytes and drop them. Prints the table of bench/README.md.

    /usr/bin/python3 bench/http_load.py build/release [ROUNDS [SECONDS]]
"""
import http.client
import multiprocessing
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import grpc

import console_bridge

MESH = "/weft.v1.MeshService/GenerateMesh"
LIGHT = ["/grpc.health.v1.Health/Check", "/weft.v1.MeshService/GetServerInfo"]
PROCESSES, CONNECTIONS = 4, 64
SIZE = 1e-4  # bound on areas, in the unit square
PAUSE = 0.003  # between light calls


def by_grpc(address, request):
    return lambda call=grpc.insecure_channel(address, [("grpc.use_local_subchannel_pool", 1)]).unary_stream(MESH): [
        None for _ in call(request)]


def by_http(address, request):
    connection = http.client.HTTPConnection(address)

    def mesh():
        connection.request("POST", "/v1/mesh?format=vtu", request, {"Content-Type": "application/x-protobuf"})
        answer = connection.getresponse()
        answer.read()
        if answer.status not in (200, 429):
            raise RuntimeError(answer.status)
    return mesh


def ask(make, address, request, stop, meshes):
    """Has its share of the connections ask until `stop`."""
    def loop():
        mesh = make(address, request)
        while not stop.is_set():
            mesh()
            with meshes.get_lock():
                meshes.value += 1
    threads = [threading.Thread(target=loop) for _ in range(CONNECTIONS // PROCESSES)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def light(address, seconds):
    """Seconds of each light call."""
    channel = grpc.insecure_channel(address)
    calls = [channel.unary_unary(method) for method in LIGHT]
    took = []
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for call in calls:
            start = time.monotonic()
            call(b"")
            took.append(time.monotonic() - start)
            time.sleep(PAUSE)
    return sorted(took)


def beside(make, address, plain, request, seconds):
    """p50 and p99 of light calls in ms, and meshes per second."""
    workers, stop, meshes = [], multiprocessing.Event(), multiprocessing.Value("q", 0)
    if make is not None:
        workers = [multiprocessing.Process(target=ask, args=(make, address, request, stop, meshes))
                   for _ in range(PROCESSES)]
    for worker in workers:
        worker.start()
    time.sleep(2)  # until all are at work
    before = meshes.value
    took = light(plain, seconds)
    made = meshes.value - before
    stop.set()
    for worker in workers:
        worker.join()
    return 1e3 * statistics.median(took), 1e3 * took[len(took) * 99 // 100], made / seconds


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else 5
    multiprocessing.set_start_method("spawn")
    with tempfile.TemporaryDirectory() as folder:
        request = console_bridge.square(console_bridge.protocol(folder), SIZE)
        request += b"\x40\x01"  # no_cache
        server, plain, web = console_bridge.start(build, folder)
        rows = {"none": (None, ""), "gRPC": (by_grpc, plain), "HTTP": (by_http, web)}
        results = {name: [] for name in rows}
        for _ in range(rounds):
            for name, (make, address) in rows.items():
                results[name].append(beside(make, address, plain, request, seconds))
                print(name, *(f"{value:.2f}" for value in results[name][-1]), file=sys.stderr)
        server.stdin.close()
        server.wait()
    print("| meshes over | p50 of light calls, ms | p99 | meshes/s |\n|---|---|---|---|")
    for name, measured in results.items():
        p50, p99, rate = (statistics.median(column) for column in zip(*measured))
        print(f"| {name} | {p50:.2f} | {p99:.2f} | {rate:.0f} |")


if __name__ == "__main__":
    main()
