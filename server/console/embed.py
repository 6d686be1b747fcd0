#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the console's application with npm and writes its files, compressed, as C++ (assets.h).

    server/console/embed.py [--or-none] ROOT WORK OUT.cpp

ROOT is the repository, which is not written to; WORK is a folder that keeps the packages of npm for
the next time. If npm fails, the exit code is 1; with --or-none, OUT.cpp has no files instead, and a
warning says so.
"""
import argparse
import gzip
import hashlib
import pathlib
import shutil
import subprocess
import sys

TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".wasm": "application/wasm",
    ".woff2": "font/woff2",
}
# Not sources: what npm and the application's own build leave there.
MADE = shutil.ignore_patterns("node_modules", "dist", "gen")


def copy(source, target):
    """Replaces all of the target but its packages."""
    target.mkdir(parents=True, exist_ok=True)
    for old in target.iterdir():
        if old.name == "node_modules":
            continue
        shutil.rmtree(old) if old.is_dir() else old.unlink()
    shutil.copytree(source, target, ignore=MADE, dirs_exist_ok=True)


def build(root, work):
    """Returns the folder of the built application."""
    console = work / "console"
    copy(root / "console", console)
    copy(root / "proto", work / "proto")
    lock = (console / "package-lock.json").read_bytes()
    installed = work / "installed-lock.json"
    if not installed.exists() or installed.read_bytes() != lock:
        npm(console, "ci", "--include=dev", "--ignore-scripts", "--no-audit", "--no-fund")
        installed.write_bytes(lock)
    npm(console, "run", "build", "--", "--outDir", str(work / "dist"))
    return work / "dist"


def npm(folder, *arguments):
    done = subprocess.run(["npm", *arguments], cwd=folder, text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.stderr.write(done.stdout)
        raise RuntimeError(f"npm {arguments[0]} failed")


def literal(data):
    """Octal escapes have three digits at most, so none takes in what follows it."""
    out = "".join(chr(b) if 32 <= b < 127 and b not in b'"\\?' else f"\\{b:03o}" for b in data)
    return f'std::string_view("{out}", {len(data)})'


def asset(folder, file):
    data = file.read_bytes()
    path = "/" + file.relative_to(folder).as_posix()
    if file.suffix not in TYPES:
        raise RuntimeError(f"{path}: embed.py knows no MIME type for {file.suffix}")
    # Vite names what it writes to assets/ after its bytes.
    immutable = "true" if path.startswith("/assets/") else "false"
    etag = '"' + hashlib.sha256(data).hexdigest()[:16] + '"'
    packed = gzip.compress(data, 9, mtime=0)
    return (f"    {{{literal(path.encode())}, {literal(TYPES[file.suffix].encode())},\n"
            f"     {literal(packed)},\n     {literal(etag.encode())}, {immutable}}},\n")


def source(folder):
    files = sorted(f for f in folder.rglob("*") if f.is_file()) if folder else []
    rows = "".join(asset(folder, file) for file in files)
    return ('#include "server/console/assets.h"\n\nnamespace weft::server {\n\n'
            "std::span<const Asset> console_assets() {\n"
            + (f"  static constexpr Asset kAssets[] = {{\n{rows}  }};\n  return kAssets;\n"
               if rows else "  return {};\n")
            + "}\n\n}  // namespace weft::server\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--or-none", action="store_true")
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        folder = build(arguments.root, arguments.work)
    except (RuntimeError, OSError) as error:
        if not arguments.or_none:
            sys.exit(f"the console: {error}; -DWEFT_CONSOLE=OFF builds weftd without it")
        print(f"warning: the console: {error}; weftd is built without it. Remove {arguments.out} "
              "to try again", file=sys.stderr)
        folder = None
    arguments.out.write_text(source(folder))


if __name__ == "__main__":
    main()
