"""Judging many versions of one project: what is the same is found once, and a place that moved is told as it is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.products import compared_versions
from archgen.timing import run_analysis as module
from archgen.timing.analysis import Analysis, Reason
from archgen.timing.system.timing_system import TimingSystem
from tests.running import ROOT

PROJECT = """\
archgen: 1
groups:
  g:
    components:
      a: {outputs: {x: std_msgs/msg/Empty}}
      b: {inputs: {x: a.x}}
nodes:
  a: {implements: a, timing: {rate: 10 Hz, wcet: 60 ms}, host: pc}
  b: {implements: b, timing: {rate: 10 Hz, wcet: 60 ms}, host: pc}
hosts: {pc: {cores: 1}}
"""


Judged = Callable[[str], list[tuple[str, int]]]


@pytest.fixture
def found(tmp_path: Path) -> Judged:
    """Give what is said of each version of one project, with one cache for all of them."""
    version_cache = pipeline.VersionCache()

    def judge(text: str) -> list[tuple[str, int]]:
        (tmp_path / "archgen.yaml").write_text(text)
        findings = pipeline.check_project(tmp_path, version_cache).findings
        return [(d.rule, d.span.line) for d in findings if d.rule == "overloaded-host"]

    return judge


def test_the_same_system_is_analysed_once(found: Judged, monkeypatch: pytest.MonkeyPatch) -> None:
    first = found(PROJECT)
    assert first
    with monkeypatch.context() as patched:
        patched.setattr(module, "analyse_system", lambda *_, **__: pytest.fail("it is known already"))
        assert found(PROJECT) == first
        assert found(PROJECT + "# a comment\n") == first


def test_what_moved_or_changed_is_analysed_again(found: Judged) -> None:
    first = found(PROJECT)
    assert found(f"# a comment\n{PROJECT}") == [(rule, line + 1) for rule, line in first]
    assert found(PROJECT.replace("60 ms", "40 ms")) == []
    assert found(PROJECT.replace("cores: 1", "cores: 2")) == []


def test_nothing_is_remembered_without_a_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    runs = []
    analyse = module.analyse_system

    def count(system: TimingSystem, notes: tuple[Reason, ...], *, judging: bool) -> Analysis:
        runs.append(system)
        return analyse(system, notes, judging=judging)

    monkeypatch.setattr(module, "analyse_system", count)
    for _ in range(2):
        pipeline.check_project(tmp_path)
    assert len(runs) == 2


def test_a_comparison_takes_the_analyses_of_the_checks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    versions = []
    for name, text in (("old", PROJECT), ("new", PROJECT.replace("60 ms", "61 ms"))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "archgen.yaml").write_text(text + "chains: {c: {through: [a, b]}}\n")
        versions.append(compared_versions.read_version(str(tmp_path / name)))
    monkeypatch.setattr(module, "analyse_system", lambda *_, **__: pytest.fail("it is known already"))
    assert compared_versions.compare_named_versions(*versions).changes


@pytest.mark.parametrize(
    "name",
    [
        "example_ramcip",
        *sorted(each.parent.relative_to(ROOT).as_posix() for each in ROOT.glob("examples/**/archgen.yaml")),
    ],
)
def test_what_was_judged_is_completed_to_what_is_analysed_at_once(name: str) -> None:
    architecture = pipeline.check_project(ROOT / name).architecture
    judged_analysis = module.analyse_architecture(architecture, judging=True)
    assert module.complete_analysis(judged_analysis) == module.analyse_architecture(architecture)
