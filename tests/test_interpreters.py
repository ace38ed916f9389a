"""Every Python that archgen supports makes the same bytes: partners and build servers need not agree on one.

Interpreters are looked for on the path and among pyenv's and uv's. Each gets an environment of its own, with the libraries
of the one that runs the tests in the same versions (from the package index), and archgen from this checkout.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib import metadata
from pathlib import Path

import pytest

from tests.determined_project import make_every_output_once, make_project, run_every_output
from tests.property_sizes import DRAWS_ANEW
from tests.running import RAMCIP, REVISION, ROOT, contents, made_once

pytestmark = [pytest.mark.build, pytest.mark.hypothesis]
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
NEWEST = "newest"
"""The last of these versions that is found beside the one that runs the tests."""
TRIED = VERSIONS if DRAWS_ANEW else (NEWEST,)
"""Of each interpreter there is a job of its own in the workflow, too."""
OTHER = Path("ramcip")
"""Stands for the changed copy of the case study."""
PRINTED = (
    ("check", "--format", "json", RAMCIP),
    ("check", "--strict", "examples/first_robot"),
    ("timing", "--format", "json", RAMCIP),
    ("timing", RAMCIP),
    ("timing", "--sensitivity", "fall_to_call", RAMCIP),
    ("timing", "--format", "json", "examples/reference_system"),
    ("simulate", "--seconds", "2", "--seeds", "2", "--format", "json", RAMCIP),
    ("diff", "--format", "json", RAMCIP, OTHER),
    ("diff", OTHER, RAMCIP),
    ("list", "--of", "connections", "--format", "csv", "-C", RAMCIP),
    ("stats", "--format", "json", RAMCIP),
    ("owners", RAMCIP),
    ("explain",),
)
SHOWN = PRINTED if DRAWS_ANEW else PRINTED[::3]
EDITS = {
    "groups/environment_state.yaml": ("object_recognition:", "recognition_of_objects:"),
    "timing.yaml": ("deadline: 350 ms", "deadline: 90 ms"),
    "nodes/action.yaml": ("planner_server:", "route_server:"),
}


def find_interpreter(version: str) -> Path | None:
    """Find a Python of a version, the one that runs the tests first."""
    homes = (
        Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv") / "versions",
        Path.home() / ".local" / "share" / "uv" / "python",
    )
    named = shutil.which(f"python{version}")
    candidates = [
        Path(sys.executable),
        *(file for home in homes for file in sorted(home.glob("*/bin/python3"))),
        *([Path(named)] if named else []),
    ]
    return next((python for python in candidates if version_of(python) == version), None)


def find_newest_version() -> str:
    """Return the newest version that another Python than that of the tests has, or where there is none the newest one."""
    others = (
        version for version in reversed(VERSIONS) if find_interpreter(version) not in {None, Path(sys.executable)}
    )
    return next(others, VERSIONS[-1])


def version_of(python: Path) -> str:
    """Ask an interpreter for its version; a shim of one that is not installed answers with an error."""
    words = (python, "-c", "import sys, venv; print('%d.%d' % sys.version_info[:2])")
    done = subprocess.run(words, capture_output=True, text=True, check=False)  # noqa: S603 - an interpreter
    return done.stdout.strip()


def pinned_libraries() -> Iterator[str]:
    """Name the libraries that archgen stands on, directly or not, in the versions that the tests run with."""
    waiting, seen = ["archgen"], set[str]()
    while waiting:
        for requirement in metadata.requires(waiting.pop()) or ():
            name = re.split(r"[^\w.-]", requirement, maxsplit=1)[0]
            if "extra ==" in requirement or name in seen:
                continue
            seen.add(name)
            try:
                version = metadata.version(name)
            except metadata.PackageNotFoundError:  # of another system or another Python
                continue
            waiting.append(name)
            yield f"{name}=={version}"


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """Copy the case study, with some changes; beside it stands what the Python of the tests prints, by number."""
    base = tmp_path_factory.getbasetemp()
    place = (base if worker_id == "master" else base.parent) / "printed"

    def make(folder: Path) -> None:
        shutil.copytree(RAMCIP, folder / OTHER, ignore=shutil.ignore_patterns("archgen-out"))
        for name, (old, new) in EDITS.items():
            text = (folder / OTHER / name).read_text(encoding="utf-8")
            assert old in text
            (folder / OTHER / name).write_text(text.replace(old, new), encoding="utf-8")
        for number, words in enumerate(SHOWN):
            shown = run(sys.executable, *name_call(words, folder)).replace(bytes(folder), bytes(place))
            (folder / str(number)).write_bytes(shown)

    return made_once(place, make)


@pytest.fixture(scope="module")
def python(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """Find a Python and give it the libraries that archgen stands on, once for all workers."""
    version = find_newest_version() if request.param == NEWEST else request.param
    interpreter = find_interpreter(version)
    if interpreter is None:
        pytest.skip(f"no Python {version} was found here")
    if interpreter == Path(sys.executable):
        pytest.skip(f"Python {version} runs the tests: the others are held against it")
    base = tmp_path_factory.getbasetemp()
    place = base if worker_id == "master" else base.parent

    def make(folder: Path) -> None:
        # Debian's own Python has no pip of its own.
        run(interpreter, "-m", "venv", "--without-pip", folder)
        pip = (sys.executable, "-m", "pip", "--python", folder / "bin" / "python")
        run(*pip, "install", "--quiet", "--only-binary", ":all:", *pinned_libraries())

    program = made_once(place / f"python-{version}", make) / "bin" / "python"
    assert version_of(program) == version
    return program


def run(*words: str | Path) -> bytes:
    """Run a program with archgen from this checkout; give what it prints, and its exit status."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": ""}
    done = subprocess.run(  # noqa: S603 - our own program, pip or venv
        [*map(str, words)], cwd=ROOT, env=environment, capture_output=True, check=False, timeout=1800
    )
    assert done.returncode in {0, 1}, done.stdout.decode()[-3000:] + done.stderr.decode()[-3000:]
    return b"%b\nstatus %d" % (done.stdout + done.stderr, done.returncode)


@pytest.mark.parametrize("python", [NEWEST], indirect=True)
def test_another_python_makes_the_same_files_of_the_case_study(python: Path, ramcip: Path, tmp_path: Path) -> None:
    words = ("build", RAMCIP, "--backend", "wiki", "--revision", REVISION, "--no-history", "-o", tmp_path / "out")
    cache_of_its_own = ("env", f"XDG_CACHE_HOME={tmp_path / 'cache'}")
    run(*cache_of_its_own, python, "-m", "archgen", *words)
    made, expected = contents(tmp_path / "out"), contents(ramcip)
    assert sorted(made) == sorted(expected)
    assert [path for path, data in expected.items() if made[path] != data] == []


@pytest.mark.parametrize("python", TRIED, indirect=True)
def test_every_python_prints_the_same(python: Path, printed: Path) -> None:
    for number, words in enumerate(SHOWN):
        assert run(python, *name_call(words, printed)) == (printed / str(number)).read_bytes(), words


def name_call(words: Sequence[str | Path], printed: Path) -> tuple[str | Path, ...]:
    """Return the arguments of a call, in which the changed copy stands below a folder."""
    return ("-m", "archgen", *(printed / OTHER if word == OTHER else word for word in words))


@pytest.mark.parametrize("python", TRIED, indirect=True)
def test_every_python_makes_the_same_bytes_of_every_output(
    python: Path, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, worker_id: str
) -> None:
    expected = make_every_output_once(tmp_path_factory, worker_id)
    settings = {"PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path / "cache")}
    made = run_every_output(python, make_project(tmp_path / "robot"), tmp_path / "out", settings)
    assert sorted(made) == sorted(expected)
    assert [name for name, data in expected.items() if made[name] != data] == []
