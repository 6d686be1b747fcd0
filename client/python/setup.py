# SPDX-License-Identifier: Apache-2.0
"""Generates what the package has from elsewhere in a clone: the protocol, compiled from proto/, the
version, from the CMakeLists.txt at the root, and the licence. Everything else is in pyproject.toml.

A source distribution has them already, and nothing of the clone around it.
"""

import pathlib
import re
import shutil
import subprocess

from setuptools import setup

HERE = pathlib.Path(__file__).resolve().parent
CLONE = HERE.parents[1]
PACKAGE = HERE / "src/weft"


def compile_protocol():
    proto = CLONE / "proto"
    try:
        subprocess.run(
            ["protoc", f"--proto_path={proto}", "--include_imports",
             f"--descriptor_set_out={PACKAGE / 'protocol.binpb'}",
             *map(str, sorted(proto.rglob("*.proto")))],
            check=True)
    except FileNotFoundError:
        raise SystemExit("weft is built with protoc: apt-get install protobuf-compiler") from None


def write_version():
    cmake = (CLONE / "CMakeLists.txt").read_text()
    version = re.search(r"^project\(weft VERSION ([0-9.]+)", cmake, re.M)[1]
    template = (HERE / "_version.py.in").read_text()
    (PACKAGE / "_version.py").write_text(template.replace("@PROJECT_VERSION@", version))


if (CLONE / "proto/weft").is_dir():
    compile_protocol()
    write_version()
    for text in ("LICENSE", "NOTICE"):
        shutil.copyfile(CLONE / text, HERE / text)

setup()
