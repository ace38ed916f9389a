"""Programs from outside that tests ask: browsers, an office, compilers, judges, ROS. `make test` needs none of them.

A test asks for a program by `find_tool`, its name written out, or `find_judge`, and lets it judge by `run_judge`, which shows
its own words where it fails. Which tests do so is not marked by hand: it is found in their code, in that of their fixtures and of
their helpers. A test that runs such a program in another way fails, since the program is hidden from it.
"""

from __future__ import annotations

import dis
import functools
import importlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

import pytest

QUICK_START = ("-XX:TieredStopAtLevel=1", "-XX:+UseSerialGC")
"""Options of Java for judges that run some seconds: optimising their code costs more than it saves (12 s instead of 6 for 170 pages)."""
JUDGES_FOLDER = Path(__file__).parent / "judges"
_JUDGE_SECONDS = 800
"""Sooner than pytest ends the whole process (`faulthandler_timeout`): the test that waits fails, and says for what."""
_PACKAGES_OF_NPM = JUDGES_FOLDER / "node_modules"
TOOL_MARKS = ("browser", "office", "compilers", "judges", "ros")
"""The marks of tests that ask programs from outside."""
LATER_MARKS = {
    "browser": "want a browser",
    "office": "an office",
    "compilers": "compilers",
    "judges": "other judges",
    "ros": "ROS",
    "build": "build something",
    "slow": "take long or try further samples",
}
"""The marks of what `make test` leaves to `make test-all`, in the order in which its end counts them."""
_BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "firefox", "firefox-esr")
_MARK_BY_TOOL = {
    **dict.fromkeys(_BROWSERS, "browser"),
    **dict.fromkeys(("soffice", "pdftoppm", "pdftotext", "pdffonts", "pdfinfo"), "office"),
    **dict.fromkeys(("g++", "javac", "java", "luac5.1", "cmake"), "compilers"),
    **dict.fromkeys(("node", "plantuml", "shellcheck", "systemd-analyze", "uncrustify", "cpplint"), "judges"),
    **dict.fromkeys(("roslaunch", "rosmaster", "rostest", "roscore", "catkin_make"), "ros"),
}
_PACKAGES = {
    "soffice": "libreoffice-writer-nogui",
    **dict.fromkeys(("pdftoppm", "pdftotext", "pdffonts", "pdfinfo"), "poppler-utils"),
    "javac": "default-jdk-headless",
    "luac5.1": "lua5.1",
    "java": "default-jre-headless",
    "node": "npm",
    "systemd-analyze": "systemd",
    "roslaunch": "python3-roslaunch",
}
"""Debian's packages that are called otherwise than their program."""
_BARE_COMMANDS = frozenset(Path(__file__).with_name("bare_commands.txt").read_text("utf-8").split())
"""What every Debian has (coreutils, findutils, grep, sed, mawk, tar, gzip, diffutils, util-linux, libc-bin, two shells), git, make, and Pythons."""


def find_tool(*names: str) -> str:
    """Return the path of the first of some programs that is installed; where none is, the test fails."""
    unknown = [name for name in names if name not in _MARK_BY_TOOL]
    assert not unknown, f"{__name__} has no mark for {unknown}"
    found = next((path for name in names if (path := shutil.which(name))), None)
    packages = " or ".join(dict.fromkeys(_PACKAGES.get(name, name) for name in names))
    assert found is not None, f"this test needs Debian's {packages}: `make test-all` installs it"
    return found


def find_judge(path: str) -> Path:
    """Return a file of the judges that npm installs; where it is not there, the test fails."""
    found = _PACKAGES_OF_NPM / path
    assert found.exists(), f"this test needs {path} in tests/judges/node_modules: `make test-all` installs it"
    return found


def run_judge(
    *command: str | Path,
    statuses: Collection[int] = (0,),
    cwd: Path | None = None,
    env: Mapping[str, str] | None = None,
    stdin: str | None = None,
) -> subprocess.CompletedProcess[str]:
    """Run a program that judges or builds; where it ends with another status, its own words are shown."""
    words = [str(word) for word in command]
    done = subprocess.run(  # noqa: S603 - judges of our own choice
        words, cwd=cwd, env=env, input=stdin, capture_output=True, text=True, check=False, timeout=_JUDGE_SECONDS
    )
    said = f"{' '.join(words)[:300]} ended with {done.returncode}:\n{done.stdout}{done.stderr}"
    assert done.returncode in statuses, said
    return done


def ask_nu_checker(pages: Iterable[str | Path]) -> list[dict[str, Any]]:
    """Return what the Nu HTML checker says against pages, of all at once: Java takes longer to begin than to read one."""
    jar = find_judge("vnu-jar/build/dist/vnu.jar")
    # Without the language, which it would guess from ids. It ends with 1 where it found something.
    words = (*QUICK_START, "-Xss4m", "-jar", jar, "--no-langdetect", "--format", "json")
    said = run_judge(find_tool("java"), *words, *pages, statuses=(0, 1)).stderr
    messages: list[dict[str, Any]] = json.loads(said)["messages"]
    return messages


def ask_ros_parsers(cases: Sequence[object]) -> list[Any]:
    """Return what ROS's own parsers read, in the Python that Debian installs them for; None where they refuse it."""
    done = run_judge(find_system_python(), JUDGES_FOLDER / "ros_definitions.py", stdin=json.dumps(cases))
    read: list[Any] = json.loads(done.stdout)
    return read


def find_system_python() -> str:
    """Return the Python that Debian's packages of ROS are made for."""
    return "/usr/bin/python3"


def list_tool_marks(functions: Sequence[object]) -> frozenset[str]:
    """Return the marks of all programs that a test, given with its fixtures, asks for by `find_tool` or `find_judge`."""
    marks = set[str]()
    waiting = [each for function in functions for each in _list_functions(function)]
    seen = set(waiting)
    while waiting:
        own_marks, called = _read_function(waiting.pop())
        marks |= own_marks
        waiting += (each for each in called if each not in seen)
        seen.update(called)
    return frozenset(marks)


@cache
def _read_function(function: FunctionType) -> tuple[frozenset[str], tuple[FunctionType, ...]]:
    """Return the marks of the programs that a function names itself, and the functions of tests that it may call."""
    codes = list(_list_codes(function.__code__))
    names = {name for code in codes for name in code.co_names}
    marks = set[str]()
    if "find_tool" in names:
        marks |= {_MARK_BY_TOOL[tool] for code in codes for tool in _list_asked_tools(code)}
    if "find_judge" in names:
        marks.add("judges")
    if "find_system_python" in names:
        marks.add("ros")
    values = [function.__globals__[name] for name in names if name in function.__globals__]
    # What is imported inside of a function, and what is asked of a module.
    # Among a few tests nobody else has imported it.
    for name in filter(_is_of_tests, names):
        importlib.import_module(name)
    modules = [module for name in names if isinstance(module := sys.modules.get(name), ModuleType)]
    modules += [value for value in values if isinstance(value, ModuleType)]
    values += [getattr(module, name, None) for module in modules if _is_of_tests(module.__name__) for name in names]
    return frozenset(marks), tuple(called for value in values for called in _list_functions(value))


def _list_codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield from _list_codes(inner)


def _list_asked_tools(code: CodeType) -> Iterator[str]:
    """Yield the words, written out, that `find_tool` is called with."""
    is_called = False
    for instruction in dis.get_instructions(code):
        if instruction.argval == "find_tool":
            is_called = True
        elif is_called and instruction.opname == "LOAD_CONST" and isinstance(instruction.argval, str):
            yield instruction.argval
        elif instruction.opname.startswith("CALL"):
            is_called = False


def _list_functions(value: object) -> Iterator[FunctionType]:
    # Hypothesis has its own way to say what it wraps.
    value = getattr(getattr(value, "hypothesis", None), "inner_test", value)
    value = getattr(value, "__wrapped__", value)
    if isinstance(value, FunctionType) and _is_of_tests(value.__module__):
        yield value
    elif isinstance(value, type) and _is_of_tests(value.__module__):
        yield from (each for each in vars(value).values() if isinstance(each, FunctionType))


def _is_of_tests(module_name: str) -> bool:
    return module_name.startswith("tests.")


def describe_left_out(counts: Mapping[str, int], *, are_named: bool = False) -> Iterator[str]:
    """Say how many tests of each sort were left to `make test-all`; `all` is how many there are, some of several sorts.

    Where files or names of tests were given, they are only those among them.
    """
    counted = [f"{counts[mark]} {words}" for mark, words in LATER_MARKS.items() if counts.get(mark)]
    if counted:
        whose, here = (" of those named", ', and `-m ""` takes them in') if are_named else ("", "")
        left = f"{counts['all']} tests{whose} are left to `make test-all`"
        yield f"{left}, which installs what they need and runs them{here}: {', '.join(counted)}."


class ToolHiding:
    """Hides the programs from outside from the tests that do not ask for any."""

    def __init__(self, folder: Path) -> None:
        self._full_path = os.environ.get("PATH", os.defpath)
        self._bare_path = os.pathsep.join((str(Path(sys.executable).parent), str(folder)))
        self._is_hiding = False
        folder.mkdir(parents=True, exist_ok=True)
        for name in _BARE_COMMANDS:
            if (found := shutil.which(name)) and not (folder / name).exists():
                (folder / name).symlink_to(found)
        self._watch_processes()

    def hide_tools(self, *, hides: bool) -> None:
        """Hide the programs from the test that comes next, or show them to it."""
        if hides != self._is_hiding:
            self._is_hiding = hides
            os.environ["PATH"] = self._bare_path if hides else self._full_path

    def _watch_processes(self) -> None:
        # No audit hook: Python calls those also for each field that an object with slots is given, for a twentieth of all time.
        start_process = subprocess.Popen.__init__

        @functools.wraps(start_process)
        def start_allowed(
            process: subprocess.Popen[Any],
            args: Any,  # noqa: ANN401 - whatever subprocess takes
            bufsize: int = -1,
            executable: Any = None,  # noqa: ANN401 - as above
            *others: Any,  # noqa: ANN401 - as above
            **named: Any,  # noqa: ANN401 - as above
        ) -> None:
            if not named.get("shell"):
                self._refuse_tools(executable or (args if isinstance(args, str | bytes | os.PathLike) else args[0]))
            start_process(process, args, bufsize, executable, *others, **named)

        subprocess.Popen.__init__ = start_allowed  # type: ignore[assignment, method-assign]

    def _refuse_tools(self, path: str | bytes | os.PathLike[str]) -> None:
        # A path in full needs no search.
        if self._is_hiding:
            program = os.fsdecode(path)
            name = Path(program).name
            is_of_system = program.startswith(("/usr/", "/bin/", "/opt/")) and program != sys.executable
            if (is_of_system and name not in _BARE_COMMANDS) or name in _MARK_BY_TOOL or "/node_modules/" in program:
                pytest.fail(f"{program} is from outside: ask for it by `find_tool` of {__name__}")
