"""A pytest plugin: tells coverage which test runs, and writes down how long each one took (seconds of the processor).

Coverage's own `dynamic_context = test_function` knows neither parameters nor fixtures: what a fixture executes would
belong to no test.
"""

from __future__ import annotations

import json
import os
import time
from collections.abc import Generator
from pathlib import Path
from typing import Any

import coverage
import pytest

_seconds_by_test: dict[str, float] = {}
_failed_tests: set[str] = set()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, Any, Any]:
    """Record what a test executes under its id, set-up included."""
    start = time.process_time()
    _switch_context(item.nodeid)
    try:
        return (yield)
    finally:
        _switch_context("")
        _seconds_by_test[item.nodeid] = time.process_time() - start


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: pytest.FixtureDef[Any]) -> Generator[None, Any, Any]:
    """Record what a fixture of several tests executes under no test: the first one that asks for it is not the only one."""
    if fixturedef.scope == "function":
        return (yield)
    _switch_context("")
    try:
        return (yield)
    finally:
        _switch_context(_current_test())


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Note a test that fails without any mutant."""
    if report.failed:
        _failed_tests.add(report.nodeid)


def pytest_sessionfinish() -> None:
    """Write the seconds of all tests that pass to the file that TEST_SECONDS names."""
    seconds = {test: count for test, count in _seconds_by_test.items() if test not in _failed_tests}
    Path(os.environ["TEST_SECONDS"]).write_text(json.dumps(seconds), encoding="utf-8")


def _current_test() -> str:
    """Return the id of the running test, as pytest publishes it."""
    return os.environ.get("PYTEST_CURRENT_TEST", "").rpartition(" ")[0]


def _switch_context(context: str) -> None:
    measurement = coverage.Coverage.current()
    if measurement is not None:
        measurement.switch_context(context)
