# SPDX-License-Identifier: Apache-2.0
"""A shell or a Python that runs one block after the other, as somebody at a terminal would."""

from __future__ import annotations

import os
import pathlib
import select
import subprocess

PATIENCE = 300  # seconds for a block: the machine may be busy

# Given two descriptors, reads the files to run from the first and answers on the second: `done`, or
# the line that failed. A failure ends the shell, unless `shown` is asked for: then the page shows
# what it says.
SHELL = r"""
set -Eeuo pipefail
readonly blocks=$1 answers=$2
status=0
trap 'echo "$LINENO" >&$answers' ERR
trap 'echo end >&$answers; kill $(jobs -p) 2>/dev/null; wait' EXIT
while read -r -u $blocks how block; do
  if [[ $how == shown ]]; then
    { (exit $status); source "$block"; } && status=0 || status=$?  # for `echo $?`
  else
    source "$block"
  fi
  echo done >&$answers
done
"""
PYTHON = r"""
import os, sys, traceback
blocks, answers = map(int, sys.argv[1:])
os.set_inheritable(blocks, False), os.set_inheritable(answers, False)
answer, scope = os.fdopen(answers, "w", buffering=1), {"__name__": "__main__"}
for words in os.fdopen(blocks):
    path = words.split()[1]
    try:
        exec(compile(open(path).read(), path, "exec"), scope)
    except BaseException as error:
        traceback.print_exc()
        frames = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == path]
        frames = frames or [getattr(error, "lineno", 0)]
        print(frames[-1], file=answer)
        sys.exit(1)
    finally:
        sys.stdout.flush()
    print("done", file=answer)
"""


class Failed(Exception):
    """`line`: of the page; 0 where it is not known."""

    def __init__(self, line: int, what: str):
        super().__init__(what)
        self.line = line


class Interpreter:
    """Runs code in a folder. It, and what it has started, ends with whoever made it."""

    def __init__(self, command: list[str], folder: pathlib.Path, environment: dict[str, str]):
        self.output = open(folder / ".output", "ab+", buffering=0)
        blocks, self.blocks = os.pipe()
        self.answers, answers = os.pipe()
        self.process = subprocess.Popen(
            ["setpriv", "--pdeathsig", "TERM", "--", *command, str(blocks), str(answers)],
            cwd=folder, env=environment,
            stdin=subprocess.DEVNULL, stdout=self.output, stderr=self.output,
            pass_fds=[blocks, answers])
        os.close(blocks)
        os.close(answers)
        self.path = folder / f".block-{self.process.pid}"
        self.buffered = ""

    def run(self, code: str, shown: bool = False) -> str:
        """What it prints. Raises Failed."""
        self.path.write_text(code)
        start = self.output.seek(0, os.SEEK_END)
        os.write(self.blocks, f"{'shown' if shown else 'run'} {self.path}\n".encode())
        answer = self._answer()
        self.output.seek(start)
        printed = self.output.read().decode(errors="replace")
        if answer != "done":
            raise Failed(int(answer) if answer.isdigit() else 0, f"this fails, and prints\n{printed}")
        return printed

    def _answer(self) -> str:
        while "\n" not in self.buffered:
            if not select.select([self.answers], [], [], PATIENCE)[0]:
                raise Failed(0, f"it has not ended after {PATIENCE} s")
            self.buffered += os.read(self.answers, 4096).decode() or "end\n"
        answer, self.buffered = self.buffered.split("\n", 1)
        return answer

    def close(self) -> None:
        os.close(self.blocks)
        try:
            self.process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        os.close(self.answers)
        self.output.close()


def shell(folder: pathlib.Path, environment: dict[str, str]) -> Interpreter:
    return Interpreter(["bash", "-c", SHELL, "bash"], folder, environment)


def python(folder: pathlib.Path, environment: dict[str, str]) -> Interpreter:
    return Interpreter(["/usr/bin/python3", "-B", "-c", PYTHON], folder, environment)
