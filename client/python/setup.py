# SPDX-License-Identifier: Apache-2.0
"""Compiles the protocol into the package; everything else is in pyproject.toml.

In a source distribution, which has no proto/ beside it, it is there already.
"""

import pathlib
import subprocess

from setuptools import setup

HERE = pathlib.Path(__file__).resolve().parent
PROTO = HERE.parents[1] / "proto"

if (PROTO / "weft").is_dir():
    try:
        subprocess.run(
            ["protoc", f"--proto_path={PROTO}", "--include_imports",
             f"--descriptor_set_out={HERE / 'src/weft/protocol.binpb'}",
             *map(str, sorted(PROTO.rglob("*.proto")))],
            check=True)
    except FileNotFoundError:
        raise SystemExit("weft is built with protoc: apt-get install protobuf-compiler") from None

setup()
