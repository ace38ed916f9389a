"""Every module with logic is imported by a test of its room, or tests/covered_by.yaml names the test that covers it.

What the table says is proved by running: the slow test runs each test that it names, and looks whether the module's
functions were executed. Before that, cheaply: the test exists, and imports lead from it to the module.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import coverage
import pytest
import yaml

from tests.enough_executed import (
    CONTEXT_VARIABLE,
    LEAST_EXECUTED_SHARE,
    WANTED_FILE,
    choose_context,
    executed_share,
)
from tests.running import ROOT, made_once

TABLE = ROOT / "tests" / "covered_by.yaml"
COVERED_BY: dict[str, list[str]] = yaml.safe_load(TABLE.read_text(encoding="utf-8"))
"""Modules by the test that covers them."""
COVERED_MODULES = [module for modules in COVERED_BY.values() for module in modules]
_FROM_IMPORT = re.compile(r"^ *from ((?:archgen|tests)[\w.]*) import (?:\(([^)]*)\)|(.*))", re.MULTILINE)
_FUNCTION = re.compile(r"^ *def ", re.MULTILINE)
_ATTRIBUTE = re.compile(r"\b(\w+)\.(\w+)")


@dataclass(frozen=True)
class SourceFile:
    """What a Python file imports: what each name stands for (`module` or `module.name`), and whether it has functions.

    Read by patterns: ruff writes imports in one way, and Python's own parser takes five times as long for 700 files.
    """

    text: str
    imported: Mapping[str, str]
    has_functions: bool


@cache
def _read_source(path: Path) -> SourceFile:
    text = path.read_text(encoding="utf-8")
    imported: dict[str, str] = {}
    for module, in_brackets, in_line in _FROM_IMPORT.findall(text):
        for part in (in_brackets or in_line).split(","):
            name, _, alias = part.partition("#")[0].strip().partition(" as ")
            imported[alias or name] = f"{module}.{name}"
    return SourceFile(text, imported, _FUNCTION.search(text) is not None)


@cache
def _list_modules() -> dict[str, Path]:
    """Return the file of each module of archgen and of the tests."""
    folders = (ROOT / "archgen", *(folder for folder in (ROOT / "tests").iterdir() if folder.name != "judges"))
    files = [file for folder in folders for file in ([folder] if folder.suffix == ".py" else folder.rglob("*.py"))]
    return {".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): file for file in files}


def _resolve_name(name: str) -> str | None:
    """Return the module of archgen or of the tests in which `package.name` is defined."""
    modules = _list_modules()
    if name in modules:
        return name
    module, _, own_name = name.rpartition(".")
    if module not in modules:
        return None
    # A package hands on what it imports: the module behind it counts.
    behind = _read_source(modules[module]).imported.get(own_name)
    return (_resolve_name(behind) or module) if behind and behind != name else module


@cache
def _find_imports(module: str) -> frozenset[str]:
    """Return the modules that a module imports, those that it uses through a package (`git.find_repository`) too."""
    source = _read_source(_list_modules()[module])
    names = {*source.imported.values()}
    names |= {
        f"{source.imported[name]}.{part}" for name, part in _ATTRIBUTE.findall(source.text) if name in source.imported
    }
    return frozenset(found for name in names if (found := _resolve_name(name)))


@cache
def _list_next(module: str) -> frozenset[str]:
    """Return the modules that a module leads to: by imports, by fixtures, by a process, by the name of a verb."""
    from archgen.cli import VERBS, verb_module

    found = set(_find_imports(module))
    if module == "archgen.cli":
        found |= {verb_module(verb) for verb in VERBS}
    if module == "tests.running":
        found.add("archgen.__main__")
    if _is_test(module):
        found |= {name for name in _list_modules() if name.endswith("conftest") and module.startswith(name[:-8])}
    return frozenset(found)


def _is_test(module: str) -> bool:
    return module.startswith("tests.") and module.rpartition(".")[2].startswith("test_")


def _find_reachable(module: str) -> set[str]:
    reached, pending = {module}, [module]
    while pending:
        new = _list_next(pending.pop()) - reached
        reached |= new
        pending += new
    return reached


def _list_logic() -> Iterator[str]:
    """Yield the modules of archgen that hold a function."""
    for module, path in _list_modules().items():
        if module.startswith("archgen") and _read_source(path).has_functions:
            yield module


@cache
def _list_tested() -> frozenset[str]:
    """Return the modules that a test of the same room imports; those at the top of archgen, that any test imports."""
    tested = set[str]()
    for test in filter(_is_test, _list_modules()):
        room = f"archgen.{test.split('.')[1]}."
        tested |= {name for name in _find_imports(test) if name.count(".") <= 1 or name.startswith(room)}
    return frozenset(tested)


def test_every_module_with_logic_has_a_test_or_one_that_covers_it() -> None:
    untested = sorted(set(_list_logic()) - _list_tested() - set(COVERED_MODULES))
    assert untested == [], f"write a test in the folder that mirrors theirs, or add them to {TABLE.name}"


def test_nothing_is_listed_that_is_tested_twice_or_gone() -> None:
    assert len(set(COVERED_MODULES)) == len(COVERED_MODULES)
    assert sorted(set(COVERED_MODULES) - set(_list_logic())) == [], f"take them out of {TABLE.name}: no such modules"
    assert sorted(set(COVERED_MODULES) & _list_tested()) == [], f"take them out of {TABLE.name}: their rooms test them"


@pytest.mark.parametrize("test", COVERED_BY)
def test_imports_lead_from_the_test_to_what_it_covers(test: str) -> None:
    name = ".".join(Path(test).with_suffix("").parts)
    assert name in _list_modules(), f"there is no {test}"
    assert sorted(set(COVERED_BY[test]) - _find_reachable(name)) == []


_ROWS_AT_ONCE = 12
"""Files of tests that share a process: to start it, and to import all of archgen under measurement, takes seconds."""
Shares = dict[str, dict[str, float]]
"""By file of tests and module: which share of the lines in the module's functions the tests executed."""


def _executed_shares(modules_by_test: Mapping[str, list[str]], folder: Path) -> Shares:
    """Run files of tests in one process, each until it has executed enough, and return what each executed."""
    folder.mkdir(exist_ok=True)
    files = {test: [str(_list_modules()[each]) for each in modules] for test, modules in modules_by_test.items()}
    all_files = "\n    ".join(dict.fromkeys(file for row in files.values() for file in row))
    settings = folder / "coveragerc"
    settings.write_text(
        f"[run]\nparallel = true\ndata_file = {folder / 'data'}\ndisable_warnings = no-data-collected\n"
        f"core = ctrace\ncontext = ${{{CONTEXT_VARIABLE}-}}\ninclude =\n    {all_files}"
    )
    (folder / WANTED_FILE).write_text(json.dumps(files), encoding="utf-8")
    # Coverage begins by this variable in every process: many tests run verbs as users do.
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COVERAGE_PROCESS_START": str(settings)}
    plugins = ("-p", "no:cacheprovider", "-p", "tests.enough_executed")
    command = [sys.executable, "-m", "pytest", "-q", "-x", *plugins, *files]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, check=False, text=True)  # noqa: S603
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    measured = coverage.Coverage(config_file=str(settings))
    measured.combine([str(folder)])
    data = measured.get_data()
    shares: Shares = {}
    for test, modules in modules_by_test.items():
        choose_context(data, test if len(modules_by_test) > 1 else None)
        executed = {module: data.lines(file) or () for module, file in zip(modules, files[test], strict=True)}
        choose_context(data, None)
        shares[test] = {
            module: executed_share(measured, str(_list_modules()[module]), lines) for module, lines in executed.items()
        }
    return shares


def _measure_together(test: str, request: pytest.FixtureRequest, folder: Path) -> dict[str, float]:
    """Return what a row of the table executed, measured with its neighbours; nothing where that run failed."""
    items = (item for item in request.session.items if getattr(item, "function", None) is request.function)
    selected = [str(item.callspec.params["test"]) for item in items if isinstance(item, pytest.Function)]
    first = selected.index(test) // _ROWS_AT_ONCE * _ROWS_AT_ONCE
    rows = {each: COVERED_BY[each] for each in selected[first : first + _ROWS_AT_ONCE]}

    def measure(place: Path) -> None:
        place.mkdir()
        shares: Shares = {}
        # One test that fails would leave the others of these rows without an answer: then each runs by itself.
        with suppress(AssertionError):
            shares = _executed_shares(rows, place / "measured")
        (place / "shares.json").write_text(json.dumps(shares), encoding="utf-8")

    place = made_once(folder / f"covered-{first}", measure)
    answer: Shares = json.loads((place / "shares.json").read_text(encoding="utf-8"))
    return answer.get(test, {})


def _find_too_small(shares: Mapping[str, float]) -> dict[str, float]:
    return {module: round(share, 2) for module, share in shares.items() if share < LEAST_EXECUTED_SHARE}


@pytest.mark.slow
@pytest.mark.parametrize("test", COVERED_BY)
def test_the_test_executes_what_it_covers(
    test: str, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, worker_id: str
) -> None:
    base = tmp_path_factory.getbasetemp()
    shares = _measure_together(test, request, base if worker_id == "master" else base.parent)
    if not shares or _find_too_small(shares):
        # Among others it may find things done already that it does by itself: what it executes alone decides.
        shares = _executed_shares({test: COVERED_BY[test]}, tmp_path_factory.mktemp("alone"))[test]
    assert _find_too_small(shares) == {}


@pytest.mark.slow
def test_what_a_test_does_not_execute_is_noticed(tmp_path: Path) -> None:
    rows = {
        "tests/test_frozen.py": ["archgen.frozen", "archgen.forge.comment_post"],
        "tests/test_float_sums.py": ["archgen.frozen"],
    }
    shares = _executed_shares(rows, tmp_path / "measured")
    assert shares["tests/test_frozen.py"]["archgen.frozen"] > LEAST_EXECUTED_SHARE
    assert shares["tests/test_frozen.py"]["archgen.forge.comment_post"] == 0
    # What one file executes counts for no other.
    assert shares["tests/test_float_sums.py"]["archgen.frozen"] < LEAST_EXECUTED_SHARE
