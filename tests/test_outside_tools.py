"""`make test` needs no program from outside, and says which tests it leaves to `make test-all`."""

from __future__ import annotations

import functools
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.outside_tools import (
    LATER_MARKS,
    TOOL_MARKS,
    describe_left_out,
    find_judge,
    find_system_python,
    find_tool,
    list_tool_marks,
    run_judge,
)
from tests.plugins.ros_code.cpp_compiler import compile_package
from tests.property_sizes import try_some
from tests.running import ROOT

_ASK_COMPILER = functools.partial(find_tool, "javac")
_ASK_JUDGE = functools.partial(find_judge, "nothing/there")
"""In a form that marks no test that calls them."""


def _ask_browser() -> None:
    find_tool("chromium", "firefox")


@contextmanager
def _ask_in_a_context() -> Iterator[None]:
    _ask_browser()
    yield


class _Asking:
    def ask_judge(self) -> None:
        find_judge("axe-core/axe.min.js")


def _ask_all() -> None:
    def ask_office() -> str:
        return find_tool("soffice")

    _Asking().ask_judge()
    ask_office()
    with _ask_in_a_context():
        find_system_python()


@pytest.mark.parametrize(
    ("function", "marks"),
    [
        (_ask_browser, {"browser"}),
        (_ask_in_a_context, {"browser"}),
        (_ask_all, {"browser", "judges", "office", "ros"}),
        (compile_package, {"compilers"}),
        (describe_left_out, set()),
        (run_judge, set()),
    ],
)
def test_the_programs_that_a_test_asks_are_found_in_its_code(function: Callable[..., object], marks: set[str]) -> None:
    assert list_tool_marks([function]) == marks


def _print_later() -> None:
    from tests.emit.docx.judges import pages

    pages(Path("nothing.docx"))


_PRINT_LATER = functools.partial(_print_later)


def test_what_a_function_imports_is_looked_into_where_nobody_else_imported_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "tests.emit.docx.judges", raising=False)
    assert list_tool_marks([_PRINT_LATER.func]) == {"office"}


def test_who_asks_for_nothing_sees_no_program_from_outside() -> None:
    assert shutil.which("git")
    for name in ("g++", "javac", "chromium", "soffice", "node", "shellcheck", "pkill"):
        assert shutil.which(name) is None
        assert subprocess.run(["sh", "-c", f"command -v {name}"], check=False).returncode == 127  # noqa: S603, S607 - asks only
    # Nor by its full path, whether it is installed or not.
    for path in ("/usr/bin/g++", "/usr/bin/python3", f"{ROOT}/tests/judges/node_modules/.bin/ooxml-validator"):
        with pytest.raises(pytest.fail.Exception, match="is from outside: ask for it by `find_tool`"):
            subprocess.run([path, "--version"], check=False)  # noqa: S603 - it is not run


def test_a_judge_that_fails_has_its_own_words_in_the_message() -> None:
    command = ("sh", "-c", "echo line 3 is wrong; echo a note >&2; exit 3")
    with pytest.raises(AssertionError, match="ended with 3:\nline 3 is wrong\na note"):
        run_judge(*command)
    done = run_judge(*command, statuses=(0, 3))
    assert (done.returncode, done.stdout, done.stderr) == (3, "line 3 is wrong\n", "a note\n")


def test_a_program_that_is_missing_is_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    with pytest.raises(
        AssertionError, match="this test needs Debian's default-jdk-headless: `make test-all` installs it"
    ):
        _ASK_COMPILER()
    with pytest.raises(AssertionError, match="this test needs nothing/there in tests/judges/node_modules"):
        _ASK_JUDGE()


def test_each_mark_is_left_out_by_make_test_and_tried_by_make_test_all() -> None:
    settings, makefile = ((ROOT / name).read_text(encoding="utf-8") for name in ("pyproject.toml", "Makefile"))
    assert set(TOOL_MARKS) < set(LATER_MARKS)
    (left_out,) = re.findall(r"-m '(.*)'", settings)
    assert set(left_out.split(" and ")) == {f"not {mark}" for mark in LATER_MARKS}
    (tried,) = re.findall(r'-m "(slow .*?)"', makefile)
    assert set(tried.split(" or ")) == set(LATER_MARKS)


def test_the_end_says_what_was_left_out() -> None:
    counts = {"all": 12, "browser": 3, "ros": 1, "slow": 9}
    (line,) = describe_left_out(counts)
    assert line == (
        "12 tests are left to `make test-all`, which installs what they need and runs them: "
        "3 want a browser, 1 ROS, 9 take long or try further samples."
    )
    (line,) = describe_left_out(counts, are_named=True)
    assert line == (
        "12 tests of those named are left to `make test-all`, which installs what they need and runs them, "
        'and `-m ""` takes them in: 3 want a browser, 1 ROS, 9 take long or try further samples.'
    )
    assert list(describe_left_out({})) == []


_MARKED_TESTS = """
import pytest

def test_quick(): pass

@pytest.mark.slow
def test_long(): pass

@pytest.mark.slow
@pytest.mark.browser
def test_long_page(): pass

@pytest.mark.build
def test_wheel(): pass
"""


@pytest.mark.parametrize(
    ("words", "counts"),
    try_some(
        [
            (("-k", "test_long"), {"all": 2, "browser": 1, "slow": 2}),
            ((), {"all": 3, "browser": 1, "build": 1, "slow": 2}),
            # It leaves out what is marked, and marks leave out nothing more.
            (("-k", "quick"), {}),
            (("-m", ""), {}),
            (("-m", "slow"), {}),
        ]
    ),
)
def test_only_what_the_marks_leave_out_is_counted(
    words: tuple[str, ...], counts: dict[str, int], tmp_path: Path
) -> None:
    (tmp_path / "test_marked.py").write_text(_MARKED_TESTS, encoding="utf-8")
    options = (
        "--co",
        "-q",
        "-p",
        "no:xdist",
        "-p",
        "tests.conftest",
        f"--rootdir={ROOT}",
        "-c",
        ROOT / "pyproject.toml",
    )
    command: list[str | Path] = [sys.executable, "-m", "pytest", *options, *words, tmp_path / "test_marked.py"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)  # noqa: S603 - our own tests
    said = [line for line in done.stdout.splitlines() if "left to" in line]
    assert said == list(describe_left_out(counts, are_named=True)), done.stdout + done.stderr
