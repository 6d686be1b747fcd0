# SPDX-License-Identifier: Apache-2.0
"""A page that is wrong makes the test of the pages fail, at the line that is wrong."""

import os
import pathlib
import shutil

import documents
import pytest

BUILD = pathlib.Path(os.environ["WEFT_BUILD"])
DRAWING = "```sh\nweft mesh tests/models/key.poly -o key.vtu --quiet --draw key.png\n```\n\n"

WRONG = {
    "a command fails": ("```sh\ntrue\nfalse\n```\n", 3, "this fails"),
    "a command of a pipe fails": ("```sh\nweft info none.vtu | cat\n```\n", 2, "none.vtu"),
    "the shell ends": ("```sh\nexit 3\n```\n", 2, "this fails"),
    "a console shows another output": ("```console\n$ echo 1\n1\n$ echo 2\n3\n```\n", 5, "prints\n2"),
    "a console shows another exit code": ("```console\n$ false\n$ echo $?\n0\n```\n", 4, "prints\n1"),
    "a console hides a failure": ("```console\n$ weft info none.vtu\n```\n", 3, "none.vtu"),
    "a file is not what a command wants": ("```csv\n# a.csv\n0,0\n```\n\n```sh\nweft info a.csv\n```\n",
                                           7, "this fails"),
    "Python raises": ("```python\nx = 1\nassert x == 2\n```\n", 3, "AssertionError"),
    "Python is no Python": ("```python\n\nx = (\n```\n", 3, "SyntaxError"),
    "a number of another machine is too far": ("```console\n$ echo 1.00000001\n1.00000002\n```\n", 3, "prints\n1"),
    "a count is another": ("```console\n$ echo 17,997 triangles\n17,998 triangles\n```\n", 3, "prints\n17"),
    "a digest is another": ("```console\n$ echo 11e2\n12e2\n```\n", 3, "prints\n11e2"),
    "Python prints something else": ("```python\nprint(1)\n```\n\n```text\n2\n```\n", 6, "prints\n1"),
    "a server does not start": ("```sh\nweftd --threads 0 2> log &\ntrue\n```\n", 2, "has ended"),
    "a picture that nothing draws": ("![a](other.png)\n", 1, "draws other.png"),
    "a picture that is not there": (DRAWING + "![a](none/key.png)\n", 5, "there is no picture"),
    "a picture of something else": (DRAWING + "![a](pictures/key.png)\n", 5, "does not look like"),
    "a link to no file": ("[a](none.md)\n", 1, "leads nowhere: none.md"),
    "a link to no heading": ("# A\n\n[a](#a)\n[b](#b)\n", 4, "leads nowhere: #b"),
    "a source that is not there": ("\n`engine/engine.h` and `engine/none.h`\n", 2, "there is no engine/none.h"),
    "commands that nobody runs": ("```bash\nweft info a\n```\n", 2, "are not run"),
    "output of nothing": ("```text\n1\n```\n", 2, "no block above"),
    "a block without an end": ("```sh\ntrue\n", 2, "no end"),
    "a fence with more than a language": ("```sh title\ntrue\n```\n", 1, "begins no block"),
}


@pytest.fixture
def run(tmp_path):
    """Whether a page is well, and what is said of it."""
    def run_it(text, anew=False):
        page = tmp_path / "page.md"
        page.write_text(text)
        return documents.run_page(BUILD, page, anew)
    return run_it


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_page_is_told_by_its_line(run, tmp_path, what):
    text, line, said = WRONG[what]
    (tmp_path / "pictures").mkdir()
    shutil.copy(documents.ROOT / "docs/pictures/pipe.png", tmp_path / "pictures/key.png")
    good, found = run(text)
    assert not good
    assert f"page.md:{line}: " in found
    assert said in found


def test_what_varies_may_vary(run):
    good, found = run("```console\n$ echo engine 0.1 s on 3 threads; echo 01M7X1A35W9ZDPEA399XA0S1TN\n"
                      "engine 2.5 s on 1 threads\n01AAAAAAAAAAAAAAAAAAAAAAAA\n```\n")
    assert good, found


def test_last_digits_may_be_those_of_another_processor(run):
    good, found = run("```console\n$ echo drag 29.134024615825442, -1.5e-12 of 1,234,567\n"
                      "drag 29.13402461582536, -1.5000000001e-12 of 1,234,567\n```\n")
    assert good, found


def test_a_page_can_ask_for_another_tolerance(run):
    page = "<!-- within 1e-3: as scipy has it -->\n```console\n$ echo 17,997 in a row\n17,998 in a row\n```\n"
    good, found = run(page)
    assert good, found
    good, found = run(page + page.split("\n", 1)[1])
    assert not good and "page.md:8: " in found


def test_lines_left_out_may_be_any(run):
    good, found = run("```console\n$ seq 9\n1\n...\n5\n6\n...\n9\n```\n")
    assert good, found
    good, found = run("```console\n$ seq 9\n1\n...\n6\n5\n...\n```\n")
    assert not good


def test_a_page_keeps_its_variables_its_server_and_its_errors(run):
    good, found = run(
        "```sh\nname=key\nweftd --data jobs 2> log &\nweft health --server 127.0.0.1:7421\n```\n\n"
        "```text\nserving\n```\n\n```python\nn = 1\n```\n\n```python\nprint(n + 1)\n```\n\n"
        "```text\n2\n```\n\n"
        "```console\n$ echo $name\nkey\n$ weft info none.vtu\n...\n$ echo $?\n4\n```\n")
    assert good, found


def test_what_is_not_run_is_told_with_its_reason(run):
    good, found = run("<!-- not run: needs the moon -->\n```sh\nfalse\n```\n")
    assert good
    assert "page.md:3 is not run: needs the moon" in found


def test_a_page_is_written_anew(run, tmp_path):
    good, found = run("```console\n$ echo 1; \\\n  echo 2\n0\n$ echo 3\n```\n\n```python\nprint(4)\n```\n\n"
                      "```text\n5\n6\n```\n\n" + DRAWING + "![a](drawn/key.png)\n", anew=True)
    assert good, found
    page = (tmp_path / "page.md").read_text()
    assert page.startswith("```console\n$ echo 1; \\\n  echo 2\n1\n2\n$ echo 3\n3\n```\n\n```python\nprint(4)\n"
                           "```\n\n```text\n4\n```\n")
    good, found = run(page)
    assert good, found
