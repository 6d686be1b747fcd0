# SPDX-License-Identifier: GPL-3.0-or-later
"""What the console's bridge costs: a mesh that the server has in memory, by gRPC and by gRPC-Web over
loopback, in turns, from a weftd of its own. Both clients read bytes and drop them. Prints the table
of bench/README.md.

    /usr/bin/python3 bench/console_bridge.py build/release [RUNS]
"""
import importlib
import pathlib
import socket
import statistics
import subprocess
import sys
import tempfile
import time

import grpc

ROOT = pathlib.Path(__file__).resolve().parents[1]
METHOD = "/weft.v1.MeshService/GenerateMesh"
SIZES = [1e-6, 1e-7]  # bounds on areas, in the unit square


def protocol(folder):
    subprocess.run(["protoc", f"-I{ROOT}/proto", f"--python_out={folder}",
                    "weft/v1/mesh_service.proto"], check=True)
    sys.path.insert(0, folder)
    return importlib.import_module("weft.v1.mesh_service_pb2")


def square(messages, size):
    request = messages.GenerateMeshRequest()
    request.domain.points.extend([0, 0, 1, 0, 1, 1, 0, 1])
    request.domain.segments.extend([0, 1, 1, 2, 2, 3, 3, 0])
    request.size.constant = size
    return request.SerializeToString()


def start(build, folder):
    """A weftd: its process, and the addresses for gRPC and for browsers."""
    ports = pathlib.Path(folder) / "ports"
    server = subprocess.Popen(
        [build / "weftd", "--listen", "127.0.0.1:0", "--console", "127.0.0.1:0", "--port-file", ports,
         "--cache-bytes", "1GiB", "--exit-with-stdin"],
        stdin=subprocess.PIPE, stderr=subprocess.DEVNULL)
    while not ports.exists():
        time.sleep(0.01)
    plain, console = ports.read_text().split()
    return server, plain, console.removeprefix("console=")


def by_grpc(channel, request):
    """Bytes of messages."""
    return sum(len(message) for message in channel.unary_stream(METHOD)(request))


def by_web(address, request):
    """Bytes of the response, which its last chunk ends."""
    host, port = address.rsplit(":", 1)
    frame = b"\0" + len(request).to_bytes(4, "big") + request
    with socket.create_connection((host, int(port))) as connection:
        connection.sendall(
            f"POST {METHOD} HTTP/1.1\r\nHost: {address}\r\nContent-Length: {len(frame)}\r\n"
            "Content-Type: application/grpc-web+proto\r\n\r\n".encode() + frame)
        buffer = bytearray(1 << 20)
        total, end = 0, b""
        while not end.endswith(b"\r\n0\r\n\r\n"):
            count = connection.recv_into(buffer)
            if count == 0:
                raise RuntimeError("the response is cut off")
            total += count
            end = (end + buffer[max(0, count - 64):count])[-64:]
    if b"grpc-status: 0" not in end:
        raise RuntimeError(end)
    return total


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    print("| area | MB | gRPC MB/s | gRPC-Web MB/s | of gRPC |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        messages = protocol(folder)
        server, plain, console = start(build, folder)
        channel = grpc.insecure_channel(plain, [("grpc.max_receive_message_length", -1)])
        for size in SIZES:
            request = square(messages, size)
            by_grpc(channel, request)  # from here on the mesh is in memory
            rates = {by_grpc: [], by_web: []}
            for _ in range(runs):
                for call, address in ((by_grpc, channel), (by_web, console)):
                    began = time.perf_counter()
                    count = call(address, request)
                    rates[call].append(count / (time.perf_counter() - began) / 1e6)
            grpc_rate, web_rate = (statistics.median(rates[call]) for call in (by_grpc, by_web))
            print(f"| {size} | {count / 1e6:.1f} | {grpc_rate:.0f} | {web_rate:.0f} "
                  f"| {100 * web_rate / grpc_rate:.0f} % |")
        server.stdin.close()
        server.wait()


if __name__ == "__main__":
    main()
