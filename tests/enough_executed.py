"""A pytest plugin: leaves out the tests that remain as soon as those before them executed enough of each measured file.

tests/test_modules_are_tested.py asks whether a file's tests execute two fifths of a module. The first tests mostly do, and the
others, which may open browsers or build sites, run in `make test` anyway.
"""

from __future__ import annotations

import ast
import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path

import pytest
from coverage import Coverage, CoverageData
from coverage.exceptions import DataError

LEAST_EXECUTED_SHARE = 0.4
"""The share of the lines in a module's functions that its test must execute."""
WANTED_FILE = "wanted.json"
"""Beside coverage's data: the measured files by the file of tests that is to execute them."""
CONTEXT_VARIABLE = "ARCHGEN_RUNNING_TEST"
"""By this variable a process that a test starts knows for which file of tests it runs."""


def executed_share(measured: Coverage, file: str, executed: Iterable[int]) -> float:
    """Return which share of the lines in a file's functions is among the executed lines."""
    # What stands outside of functions is executed by the import alone.
    inner = _function_lines(measured, file)
    return len(inner & set(executed)) / len(inner)


@cache
def _function_lines(measured: Coverage, file: str) -> frozenset[int]:
    tree = ast.parse(Path(file).read_text(encoding="utf-8"))
    statements = measured.analysis2(file)[1]
    return frozenset(
        {line for start, end in _function_bodies(tree) for line in range(start, end + 1)}.intersection(statements)
    )


def _function_bodies(tree: ast.Module) -> Iterator[tuple[int, int]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.body[0].lineno, node.end_lineno or 0


class LeaveTheRestOut:
    """Watches which lines this process and those that it started have executed so far, for each file of tests.

    What is executed counts for the file whose tests run just then: coverage calls that a context.
    """

    def __init__(self, measured: Coverage, measured_files: Mapping[str, Sequence[str]]) -> None:
        self._measured = measured
        self._lines_by_test = {
            test: {file: set[int]() for file in files} for test, files in sorted(measured_files.items())
        }
        self._read_already: set[Path] = set()
        self._running_test = ""

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
        """Say that a test has been run, if enough was executed before it."""
        test = item.nodeid.partition("::")[0]
        if test != self._running_test:
            self._running_test = os.environ[CONTEXT_VARIABLE] = test
            self._measured.switch_context(test)
        if not self._is_enough():
            return None
        # The last test that ran expected one of its own file next: the file's fixtures end here.
        item.session._setupstate.teardown_exact(nextitem)  # noqa: SLF001 - pytest has no public way
        return True

    def _is_enough(self) -> bool:
        data = self._measured.get_data()
        self._take_lines(data)
        own_file = Path(data.data_filename())
        for file in set(own_file.parent.glob("data.*")) - self._read_already - {own_file}:
            other = CoverageData(basename=str(file))
            try:
                other.read()
            except DataError:  # its process is writing it just now
                continue
            self._take_lines(other)
            other.close(force=True)
            self._read_already.add(file)
        return all(
            executed_share(self._measured, file, lines) >= LEAST_EXECUTED_SHARE
            for file, lines in self._lines_by_test[self._running_test].items()
        )

    def _take_lines(self, data: CoverageData) -> None:
        choose_context(data, self._running_test if len(self._lines_by_test) > 1 else None)
        for file, lines in self._lines_by_test[self._running_test].items():
            lines.update(data.lines(file) or ())
        choose_context(data, None)


def choose_context(data: CoverageData, test: str | None) -> None:
    """Ask only for what was executed while a file's tests ran; None is all, also what its import executed."""
    data.set_query_contexts([f"^{re.escape(test)}$"] if test else None)


def pytest_configure(config: pytest.Config) -> None:
    """Watch, where this process is measured."""
    measured = Coverage.current()
    assert measured is not None, "coverage begins by the variable COVERAGE_PROCESS_START"
    wanted = Path(str(measured.get_option("run:data_file"))).with_name(WANTED_FILE)
    config.pluginmanager.register(LeaveTheRestOut(measured, json.loads(wanted.read_text(encoding="utf-8"))))
