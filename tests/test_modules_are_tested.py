"""Every module with logic is imported by a test of its room, or tests/covered_by.yaml names the test that covers it.

What the table says is proved by running: slow tests run each test that it names, and look whether the module's functions were
executed. Before that, cheaply: the test exists, and imports lead from it to the module.
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
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
from tests.module_graph import find_imports, find_reachable, is_test, list_modules, read_source
from tests.property_sizes import try_some
from tests.running import ROOT, made_once

TABLE = ROOT / "tests" / "covered_by.yaml"
COVERED_BY: dict[str, list[str]] = yaml.safe_load(TABLE.read_text(encoding="utf-8"))
"""Modules by the test that covers them."""
COVERED_MODULES = [module for modules in COVERED_BY.values() for module in modules]


def _list_logic() -> Iterator[str]:
    """Yield the modules of archgen that hold a function."""
    for module, path in list_modules().items():
        if module.startswith("archgen") and read_source(path).has_functions:
            yield module


@cache
def _list_tested() -> frozenset[str]:
    """Return the modules that a test of the same room imports; those at the top of archgen, that any test imports."""
    tested = set[str]()
    for test in filter(is_test, list_modules()):
        room = f"archgen.{test.split('.')[1]}."
        tested |= {name for name in find_imports(test) if name.count(".") <= 1 or name.startswith(room)}
    return frozenset(tested)


def test_every_module_with_logic_has_a_test_or_one_that_covers_it(
    request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    if request.config.getoption("--update-covered"):
        _update_table(tmp_path)
        pytest.fail(f"{TABLE.name} is written anew: run the tests again")
    untested = sorted(set(_list_logic()) - _list_tested() - set(COVERED_MODULES))
    assert untested == [], (
        f"write a test in the folder that mirrors theirs, or `pytest {Path(__file__).name} --update-covered`"
    )


def test_nothing_is_listed_thatis_tested_twice_or_gone() -> None:
    assert len(set(COVERED_MODULES)) == len(COVERED_MODULES)
    assert sorted(set(COVERED_MODULES) - set(_list_logic())) == [], "no such modules: `--update-covered` takes them out"
    assert sorted(set(COVERED_MODULES) & _list_tested()) == [], (
        "their rooms test them: `--update-covered` takes them out"
    )


@pytest.mark.parametrize("test", COVERED_BY)
def test_imports_lead_from_the_test_to_what_it_covers(test: str) -> None:
    name = ".".join(Path(test).with_suffix("").parts)
    assert name in list_modules(), f"there is no {test}"
    assert sorted(set(COVERED_BY[test]) - find_reachable(name)) == []


_SHARE = 4
"""`make test-all` runs one row of so many, `make properties` the others: to run them all is to run a third of `make test` again."""
_ROWS_AT_ONCE = 12
"""Files of tests that share a process: to start it, and to import all of archgen under measurement, takes seconds."""
Shares = dict[str, dict[str, float]]
"""By file of tests and module: which share of the lines in the module's functions the tests executed."""


def _executed_shares(modules_by_test: Mapping[str, list[str]], folder: Path) -> Shares:
    """Run files of tests in one process, each until it has executed enough, and return what each executed."""
    folder.mkdir(exist_ok=True)
    files = {test: [str(list_modules()[each]) for each in modules] for test, modules in modules_by_test.items()}
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
            module: executed_share(measured, str(list_modules()[module]), lines) for module, lines in executed.items()
        }
    return shares


_MAX_CANDIDATES = 12
"""Tests that are tried for a module that no row covers, those first that lead to the fewest modules."""


def _update_table(folder: Path) -> None:
    """Write the table anew: without what is gone or tested by its room, with a test for what has none that executes it."""
    rows = {test: set(modules) & set(_list_logic()) - _list_tested() for test, modules in COVERED_BY.items()}
    covered = {module for modules in rows.values() for module in modules}
    for number, module in enumerate(sorted(set(_list_logic()) - _list_tested() - covered)):
        reaching = [
            (len(reached), test)
            for test in filter(is_test, list_modules())
            if module in (reached := find_reachable(test))
        ]
        for _, test in sorted(reaching)[:_MAX_CANDIDATES]:
            file = list_modules()[test].relative_to(ROOT).as_posix()
            if not _find_too_small(_executed_shares({file: [module]}, folder / f"{number}-{test}")[file]):
                rows.setdefault(file, set()).add(module)
                break
    TABLE.write_text(_write_rows(TABLE.read_text(encoding="utf-8"), rows), encoding="utf-8", newline="\n")


def _write_rows(table: str, rows: Mapping[str, Collection[str]]) -> str:
    """Return a table with other rows below the comment at its top."""
    head = itertools.takewhile(lambda line: line.startswith("#"), table.splitlines())
    lines = [
        line
        for test in sorted(rows)
        if rows[test]
        for line in (f"{test}:", *(f"- {each}" for each in sorted(rows[test])))
    ]
    return "\n".join((*head, *lines)) + "\n"


def test_the_table_is_as_it_would_be_written_anew() -> None:
    table = TABLE.read_text(encoding="utf-8")
    assert _write_rows(table, COVERED_BY) == table
    assert table.startswith("# ")


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


def _begin_with_each(step: int) -> list[str]:
    """Return the rows with every so manieth first: of each room some."""
    rows = list(COVERED_BY)
    return [row for first in range(step) for row in rows[first::step]]


@pytest.mark.parametrize("test", try_some(_begin_with_each(_SHARE), 0, len(COVERED_BY) // _SHARE))
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
        "tests/test_frozen.py": ["archgen.frozen", "archgen.forge.pull_request"],
        "tests/test_float_sums.py": ["archgen.frozen"],
    }
    shares = _executed_shares(rows, tmp_path / "measured")
    assert shares["tests/test_frozen.py"]["archgen.frozen"] > LEAST_EXECUTED_SHARE
    assert shares["tests/test_frozen.py"]["archgen.forge.pull_request"] == 0
    # What one file executes counts for no other.
    assert shares["tests/test_float_sums.py"]["archgen.frozen"] < LEAST_EXECUTED_SHARE
