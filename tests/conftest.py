"""Fixtures of several rooms: a short text as an architecture, the case study with all its outputs, and a browser."""

from __future__ import annotations

import gc
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from _pytest.mark import deselect_by_keyword

from archgen import cache
from archgen.derivation import derive_low_level
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.emit import text
from archgen.emit.graphviz import worker_pool
from archgen.link.slice_merging import merge_documents
from archgen.model.architecture import Architecture
from archgen.model.message_types import ConceptualType
from archgen.schema import normalise_document, validate_document
from archgen.syntax import yaml_parser
from tests import property_sizes
from tests.bounded_waits import bound_waits
from tests.linking import link_table
from tests.outside_tools import LATER_MARKS, TOOL_MARKS, ToolHiding, describe_left_out, list_tool_marks
from tests.running import RAMCIP, REVISION, archgen, made_once

if TYPE_CHECKING:
    from playwright.sync_api import Browser

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]
SHIPPED = {
    "Laser scan": ConceptualType("Laser scan", "sensor_msgs/msg/LaserScan"),
    "Pose": ConceptualType("Pose", "geometry_msgs/msg/Pose"),
}


def _link(text: str) -> tuple[Architecture, tuple[Diagnostic, ...]]:
    document, found = yaml_parser.parse_yaml("a.yaml", text)
    assert document is not None, found
    assert (validate_document(document), normalise_document(document)) == ((), ())
    table, _ = merge_documents([document])
    return link_table(table, "robot", SHIPPED)


@pytest.fixture
def linked() -> Linked:
    """Read, merge and link a text; the types `Laser scan` and `Pose` are shipped."""
    return _link


@pytest.fixture
def told() -> Callable[[str], list[str]]:
    """Give the findings of linking: `line:column rule: message (labelled places) | help`."""

    def tell(text: str) -> list[str]:
        return [_line(diagnostic) for diagnostic in _link(text)[1]]

    return tell


def _line(diagnostic: Diagnostic) -> str:
    places = ", ".join(f"{label.span.line}:{label.span.column} {label.text}" for label in diagnostic.labels)
    where = f"{diagnostic.span.line}:{diagnostic.span.column}"
    labels = f" ({places})" if places else ""
    return f"{where} {diagnostic.rule}: {diagnostic.message}{labels} | {diagnostic.help}"


@pytest.fixture(scope="session")
def derived() -> Callable[[str], Architecture]:
    """Read, link without a finding, and derive the low level."""

    def derive(text: str) -> Architecture:
        architecture, found = _link(text)
        assert [_line(diagnostic) for diagnostic in found] == []
        return derive_low_level(architecture)

    return derive


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-covered", action="store_true", help="Write tests/covered_by.yaml anew, by what runs.")
    parser.addoption("--update-golden", action="store_true", help="Renew what stands in tests/golden.")


def pytest_configure(config: pytest.Config) -> None:
    # Images of containers often tell Python to keep no bytecode: each of the hundreds of processes started here would compile
    # archgen anew, for more than half of its time. `-B` is another matter: who writes it means this run.
    if "-B" not in sys.orig_argv:
        sys.dont_write_bytecode = False
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    if not hasattr(config, "workerinput"):  # xdist's workers inherit it
        # One cache for all tests of a run, beside those that try it out: a picture of the case study is drawn once, and neither
        # does a test find what an earlier run left in a developer's own cache, nor leave anything there.
        cache_folder = tempfile.mkdtemp(prefix="archgen-tests-cache-")
        os.environ["XDG_CACHE_HOME"] = cache_folder
        config.add_cleanup(lambda: shutil.rmtree(cache_folder, ignore_errors=True))
    property_sizes.choose_profile(config)
    # Who hands tests to workers waits for these as long as they take.
    if hasattr(config, "workerinput") or not config.getoption("numprocesses", None):
        bound_waits()
        # Of what is collected nothing is garbage: to look for it would be a fifth of the time.
        gc.disable()
    # A test that changes something in this process and runs a verb again wants to see what that does.
    cache.KEPT_VERBS = ()
    config.stash[_HIDING] = ToolHiding(Path(os.environ["XDG_CACHE_HOME"]) / "bare-commands")
    # It reads where the cache is.
    from tests import forked_templates, kept_workers

    kept_workers.keep_workers(config)
    forked_templates.fork_templates(config)


_LONGEST = frozenset(
    {
        "test_slopes",
        "test_interpreters",
        "test_fuzz_run",
        "test_wheel",
        "test_faults",
        "test_random_branches",
        "test_merged_workspaces",
        "test_ros1_running",
    }
)
"""Modules with tests that take a minute and more."""
_LEFT_OUT = Counter[str]()
_HIDING = pytest.StashKey[ToolHiding]()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the tests that ask programs from outside, before pytest selects by marks."""
    found: dict[tuple[object, ...], frozenset[str]] = {}
    for item in items:
        if isinstance(item, pytest.Function):
            # One answer for all samples of a test.
            key = (item.function, *item.fixturenames)
            if key not in found:
                fixtures = item._fixtureinfo.name2fixturedefs  # noqa: SLF001 - pytest has no public way
                functions = [each.func for name in item.fixturenames for each in fixtures.get(name, ())]
                found[key] = list_tool_marks([item.function, *functions])
            for mark in found[key]:
                item.add_marker(mark)
    # First: one of them left for the end would keep one worker, with nothing to do for the others.
    items.sort(key=lambda item: item.path.stem not in _LONGEST)
    # What `-k` does not name is left to nobody: gone before pytest selects by marks, and counts what these leave out.
    deselect_by_keyword(items, config)
    _LEFT_OUT.clear()


def pytest_deselected(items: Sequence[pytest.Item]) -> None:
    # Who asks for some marks leaves others out, but not to `make test-all`.
    if items and "not slow" in items[0].config.getoption("markexpr"):
        marks = [[mark for mark in LATER_MARKS if item.get_closest_marker(mark)] for item in items]
        _LEFT_OUT.update(mark for each in marks for mark in each)
        _LEFT_OUT["all"] += sum(map(bool, marks))


def pytest_runtest_setup(item: pytest.Item) -> None:
    item.config.stash[_HIDING].hide_tools(hides=not any(map(item.get_closest_marker, TOOL_MARKS)))


def pytest_sessionfinish(session: pytest.Session) -> None:
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["left_out"] = dict(_LEFT_OUT)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    # Each worker has left out the same.
    _LEFT_OUT.update(Counter(getattr(node, "workeroutput", {}).get("left_out", {})) - _LEFT_OUT)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    are_named = bool(config.getoption("keyword")) or config.args != config.getini("testpaths")
    for line in describe_left_out(_LEFT_OUT, are_named=are_named):
        terminalreporter.write_line(line)


def pytest_collection_finish() -> None:
    # Fourteen thousand tests stay until the end: nothing is found by looking through them for garbage again and again.
    gc.freeze()
    # What a test leaves is small beside that; searched for as often as Python likes it would be a thirtieth of all time.
    gc.set_threshold(100_000, 20, 20)
    gc.enable()


_TEMPORARY_FOLDERS = Counter[str]()
"""How many folders there are of each name."""


@pytest.fixture
def tmp_path(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a folder as pytest's own fixture does, which looks for its number among those of all tests: a millisecond and more."""
    name = re.sub(r"\W", "_", request.node.name)[:30]
    while True:
        folder = tmp_path_factory.getbasetemp() / f"{name}{_TEMPORARY_FOLDERS[name]}"
        _TEMPORARY_FOLDERS[name] += 1
        with suppress(FileExistsError):
            folder.mkdir(0o700)
            return folder


@pytest.fixture(scope="session")
def ramcip(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """Build the case study with every output, once for all workers; give the folder."""
    base = tmp_path_factory.getbasetemp()
    place = base if worker_id == "master" else base.parent

    def make(folder: Path) -> None:
        archgen("build", RAMCIP, "--backend", "wiki", "--revision", REVISION, "--no-history", "-o", folder, cwd=place)

    return made_once(place / "ramcip", make)


@pytest.fixture
def fresh_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw and render in processes that start and end with each build, as users have them."""
    from tests.kept_workers import KeptWorker

    monkeypatch.setattr(text, "subprocess", subprocess)
    monkeypatch.setattr(worker_pool, "DrawingWorker", KeptWorker.__base__)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Start Chromium for the tests of one module: while it runs, no test of this process can have an event loop."""
    # Few tests need it, and importing it takes longer than most of them.
    from playwright.sync_api import expect, sync_playwright

    from tests.browser_pages import launch_chromium

    with sync_playwright() as playwright:
        # Many others may run at the same time, which makes everything late and nothing wrong.
        expect.set_options(timeout=120_000)
        started = launch_chromium(playwright)
        yield started
        started.close()
