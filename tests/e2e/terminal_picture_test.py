# SPDX-License-Identifier: Apache-2.0
"""`weft mesh` on a terminal that shows pictures, and on some that do not: the test is the terminal."""
from __future__ import annotations

import base64
import fcntl
import io
import os
import pathlib
import pty
import re
import select
import struct
import subprocess
import termios
import time

import PIL.Image
import pytest

KEY = pathlib.Path(__file__).parents[1] / "models" / "key.poly"
WEFT = os.environ["WEFT_BINARY"]
QUESTION = b"\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\\x1b[c"
KITTY = b"\x1b_Gi=31;OK\x1b\\\x1b[?62;c"
SIXEL = b"\x1b[?62;4;22c"
NEITHER = b"\x1b[?62;22;44c"
PATIENCE = 120  # seconds


class Terminal:
    """80 columns and 24 rows of 10 x 20 pixels, unless it does not say."""

    def __init__(self, pixels: tuple[int, int] = (800, 480)) -> None:
        self.master, self.slave = pty.openpty()
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, *pixels))
        self.before = termios.tcgetattr(self.slave)
        self.shown = b""

    def close(self) -> None:
        os.close(self.master)
        os.close(self.slave)

    def type(self, keys: bytes) -> None:
        os.write(self.master, keys)

    def type_before(self, keys: bytes) -> None:
        """Types while no program runs. The kernel hands keys over when it has time, and echoes them then."""
        self.type(keys)
        echo = b""
        while keys.strip() not in echo:
            echo += os.read(self.master, 1 << 16)

    def typed(self) -> bytes:
        """What is there for the next program to read; it is not for weft to take."""
        raw = termios.tcgetattr(self.slave)
        raw[3] &= ~termios.ICANON
        raw[6][termios.VMIN] = 0
        termios.tcsetattr(self.slave, termios.TCSANOW, raw)
        return os.read(self.slave, 1000)

    def run(self, *words: object, answer: bytes = b"", term: str = "xterm-256color",
            stdin: int | None = None) -> int:
        """Runs weft in the foreground, answers once if it asks, and gives its exit code."""
        def take_terminal() -> None:
            fcntl.ioctl(1, termios.TIOCSCTTY, 0)

        # A busy machine may answer late; what is no whole answer is not waited for.
        patience = {"WEFT_TERMINAL_WAIT": "60"} if re.search(rb"\x1b\[\?[\d;]*c", answer) else {}

        weft = subprocess.Popen([WEFT, *map(str, words)], stdin=self.slave if stdin is None else stdin,
                                stdout=self.slave, stderr=self.slave, start_new_session=True,
                                preexec_fn=take_terminal,
                                env={**os.environ, "TERM": term, **patience})
        end = time.monotonic() + PATIENCE
        while True:
            ended = weft.poll() is not None
            while select.select([self.master], [], [], 0.05)[0]:
                self.shown += os.read(self.master, 1 << 16)
            if answer and QUESTION in self.shown:
                self.type(answer)
                answer = b""
            if ended:
                return weft.returncode
            if time.monotonic() > end:
                weft.kill()
                pytest.fail(f"weft has not ended; the terminal shows {self.shown!r}")

    def text(self) -> bytes:
        return self.shown.replace(QUESTION, b"")


@pytest.fixture
def terminal() -> Terminal:
    made = Terminal()
    yield made
    made.close()


@pytest.fixture
def mesh(tmp_path: pathlib.Path) -> tuple[object, ...]:
    return ("mesh", KEY, "-o", tmp_path / "key.vtu")


def kitty_picture(shown: bytes) -> PIL.Image.Image:
    pieces = re.findall(rb"\x1b_G([^;\x1b]*);([^\x1b]*)\x1b\\", shown)
    assert pieces[0][0].startswith(b"a=T,f=100,q=2,m=")
    assert all(len(piece) <= 4096 for _, piece in pieces)
    assert [keys[-3:] for keys, _ in pieces] == [b"m=1"] * (len(pieces) - 1) + [b"m=0"]
    return PIL.Image.open(io.BytesIO(base64.b64decode(b"".join(piece for _, piece in pieces))))


def sixel_picture(shown: bytes) -> PIL.Image.Image:
    """Of pixels that are all painted once."""
    found = re.search(rb'\x1bP0;1;0q"1;1;(\d+);(\d+)([^\x1b]*)\x1b\\', shown)
    assert found
    width, height = int(found[1]), int(found[2])
    picture = PIL.Image.new("RGB", (width, height), (255, 0, 255))
    colours: dict[int, tuple[int, ...]] = {}
    colour, x, top, painted = 0, 0, 0, 0
    for word in re.finditer(rb"#(\d+)(?:;2;(\d+);(\d+);(\d+))?|!(\d+)([?-~])|([?-~])|[$]|-", found[3]):
        if word[1]:
            colour = int(word[1])
            if word[2]:
                colours[colour] = tuple(int(word[i]) * 255 // 100 for i in (2, 3, 4))
        elif word[0] in (b"$", b"-"):
            x = 0
            top += 6 * (word[0] == b"-")
        else:
            for _ in range(int(word[5] or 1)):
                for bit in range(6):
                    if (word[6] or word[7])[0] - 63 >> bit & 1:
                        picture.putpixel((x, top + bit), colours[colour])
                        painted += 1
                x += 1
    assert painted == width * height
    return picture


def is_the_key(picture: PIL.Image.Image, long_side: int) -> None:
    """White paper, black outline, the key's length and height, something at its bow."""
    picture = picture.convert("RGB")
    assert picture.width == long_side
    assert picture.height == pytest.approx(long_side * 28.2 / 68.62, rel=0.1)
    pixels = list(picture.getdata())
    white = sum(min(pixel) > 250 for pixel in pixels) / len(pixels)
    assert 0.3 < white < 0.9
    dark = sum(max(pixel) < 110 for pixel in pixels) / len(pixels)
    assert 0.005 < dark < 0.4


def test_kitty_gets_a_png(terminal: Terminal, mesh: tuple[object, ...]) -> None:
    assert terminal.run(*mesh, answer=KITTY) == 0
    assert terminal.shown.count(QUESTION) == 1
    text = terminal.text()
    assert text.index(b"wrote ") < text.index(b"\x1b_G")
    is_the_key(kitty_picture(text), 288)  # 0.6 of the height
    assert termios.tcgetattr(terminal.slave) == terminal.before
    assert terminal.typed() == b""


def test_sixel_is_for_terminals_that_have_it_alone(terminal: Terminal,
                                                   mesh: tuple[object, ...]) -> None:
    assert terminal.run(*mesh, answer=SIXEL) == 0
    is_the_key(sixel_picture(terminal.text()), 288)
    assert terminal.typed() == b""


def test_both_protocols_show_the_same(mesh: tuple[object, ...]) -> None:
    pictures = []
    for answer, decode in ((KITTY, kitty_picture), (SIXEL, sixel_picture)):
        terminal = Terminal(pixels=(0, 0))  # does not say how large it is
        assert terminal.run(*mesh, "--size", "0.01", answer=answer) == 0
        pictures.append(decode(terminal.text()).convert("RGB"))
        terminal.close()
    assert [picture.width for picture in pictures] == [400, 400]
    first, second = (picture.tobytes() for picture in pictures)
    assert len({pixel for pixel in pictures[0].getdata()}) > 256
    assert sum(abs(a - b) for a, b in zip(first, second)) / len(first) < 5


@pytest.mark.parametrize("answer", [b"", NEITHER, b"\x1b_Gi=31;ENOTSUPPORTED:no\x1b\\" + NEITHER,
                                    b"\x1b_Gi=31;OK", b"\xff\x00\x1b\x1b[\x1b_" + b"x" * 5000])
def test_other_terminals_get_no_picture(terminal: Terminal, mesh: tuple[object, ...],
                                        answer: bytes) -> None:
    assert terminal.run(*mesh, answer=answer) == 0
    assert terminal.shown.count(QUESTION) == 1
    text = re.sub(rb"\r\x1b\[K[^\r\n]*?(?=\r)", b"", terminal.text())  # the bar of progress
    assert b"wrote " in text
    assert b"\x1b_G" not in text and b"\x1bP" not in text
    assert termios.tcgetattr(terminal.slave) == terminal.before


@pytest.mark.parametrize("words, term", [
    (("--no-picture",), "xterm-256color"), (("--quiet",), "xterm-256color"),
    (("--json",), "xterm-256color"), ((), "dumb"), ((), "screen.xterm-256color"),
    ((), "tmux-256color"), ((), "linux"), ((), "")])
def test_nothing_is_asked_without_need(terminal: Terminal, mesh: tuple[object, ...],
                                       words: tuple[str, ...], term: str) -> None:
    assert terminal.run(*mesh, *words, answer=KITTY, term=term) == 0
    assert b"\x1b_G" not in terminal.shown


def test_nothing_is_asked_if_input_is_no_terminal(terminal: Terminal,
                                                  mesh: tuple[object, ...]) -> None:
    with open(os.devnull, "rb") as empty:
        assert terminal.run(*mesh, answer=KITTY, stdin=empty.fileno()) == 0
    assert b"\x1b_G" not in terminal.shown


def test_what_is_typed_before_stays(terminal: Terminal, mesh: tuple[object, ...]) -> None:
    for keys in (b"half a line", b"a line\n"):
        terminal.type_before(keys)
        assert terminal.run(*mesh, answer=KITTY) == 0
        assert b"\x1b_G" not in terminal.shown
        assert terminal.typed() == keys
        termios.tcsetattr(terminal.slave, termios.TCSANOW, terminal.before)


def test_what_is_typed_behind_the_answer_stays(terminal: Terminal,
                                               mesh: tuple[object, ...]) -> None:
    assert terminal.run(*mesh, answer=b"x" + KITTY + b"ls\n") == 0
    is_the_key(kitty_picture(terminal.text()), 288)
    assert terminal.typed() == b"ls\n"


def test_a_manifest_has_no_such_key(tmp_path: pathlib.Path) -> None:
    manifest = tmp_path / "meshes.yaml"
    manifest.write_text(f"meshes:\n  - name: key\n    input: {KEY}\n    output: key.vtu\n"
                        "    no-picture: true\n")
    done = subprocess.run([WEFT, "batch", manifest], capture_output=True, text=True)
    assert done.returncode == 4
    assert "no-picture" in done.stderr
