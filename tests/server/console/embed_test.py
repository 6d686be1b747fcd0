#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""server/console/embed.py with an npm that does what the test says.

    tests/server/console/embed_test.py
"""
import ast
import gzip
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

EMBED = pathlib.Path(__file__).resolve().parents[3] / "server/console/embed.py"
# Writes an application to the folder that `npm run build` is given, and a line per call to the log.
NPM = """#!/bin/sh
echo "$1" >>"$NPM_LOG"
[ "$1" != "$NPM_FAILS" ] || exit 1
[ "$1" = run ] || exit 0
cp -r ../../files "$5"
"""
FILES = {
    "index.html": b"<!doctype html>\n",
    "assets/main-1a2b.js": bytes(range(256)) + b'"\\??/7' * 50,
}


class Embed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "proto").mkdir()
        (self.folder / "console").mkdir()
        (self.folder / "console/package-lock.json").write_text("{}")
        for name, data in FILES.items():
            self.write(name, data)
        npm = self.folder / "npm"
        npm.write_text(NPM)
        npm.chmod(0o755)

    def write(self, name, data):
        file = self.folder / "files" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)

    def embed(self, *flags, npm_fails=""):
        environment = dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}",
                           NPM_LOG=str(self.folder / "log"), NPM_FAILS=npm_fails)
        return subprocess.run(
            [EMBED, *flags, self.folder, self.folder / "work", self.folder / "out.cpp"],
            env=environment, text=True, capture_output=True)

    def rows(self):
        """The files in what was written: by path, (type, bytes, immutable)."""
        text = (self.folder / "out.cpp").read_text()
        views = re.findall(r'std::string_view\("([^"]*)", (\d+)\)', text)
        for literal, size in views:
            self.assertEqual(len(ast.literal_eval(f'b"{literal}"')), int(size))
        values = [ast.literal_eval(f'b"{literal}"') for literal, _ in views]
        immutable = re.findall(r"\), (true|false)},", text)
        return {values[i].decode(): (values[i + 1].decode(), gzip.decompress(values[i + 2]),
                                     immutable[i // 4] == "true")
                for i in range(0, len(values), 4)}

    def test_every_file_is_there_with_its_bytes_and_type(self):
        done = self.embed()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.rows(), {
            "/index.html": ("text/html; charset=utf-8", FILES["index.html"], False),
            "/assets/main-1a2b.js": ("text/javascript; charset=utf-8",
                                     FILES["assets/main-1a2b.js"], True)})

    def test_packages_are_installed_once_and_again_for_another_lockfile(self):
        self.embed()
        self.embed()
        (self.folder / "console/package-lock.json").write_text("{ }")
        self.embed()
        self.assertEqual((self.folder / "log").read_text().split(),
                         ["ci", "run", "run", "ci", "run"])

    def test_a_file_of_an_unknown_type_is_an_error(self):
        self.write("assets/a.strange", b"")
        done = self.embed()
        self.assertEqual(done.returncode, 1)
        self.assertIn(".strange", done.stderr)

    def test_npm_that_fails_is_an_error_or_no_files(self):
        for step in ("ci", "run"):
            done = self.embed(npm_fails=step)
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"npm {step} failed; -DWEFT_CONSOLE=OFF", done.stderr)
            self.assertFalse((self.folder / "out.cpp").exists())
        done = self.embed("--or-none", npm_fails="run")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("weftd is built without it", done.stderr)
        self.assertEqual(self.rows(), {})


if __name__ == "__main__":
    unittest.main()
