"""Own code that fitted is not read again until it, what is generated around it, or archgen changes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen.emit.workspace import workspace_plan
from archgen.emit.workspace.disk_files import DiskReader, GeneratedFile
from archgen.emit.workspace.own_code import judge_own_code
from archgen.emit.workspace.run_record import read_run_record
from archgen.emit.workspace.workspace_plan import KnownFits, UserChoices, digest_fit, plan_workspace
from archgen.emit.workspace.workspace_writing import carry_out, lock_workspace

OWN = GeneratedFile("own.py", b"class Own:\n    def a(self, m): pass\n", once=True, expected_words=("a=x.a:p/msg/A",))


def run(folder: Path, file: GeneratedFile = OWN) -> tuple[str, ...]:
    """Write a workspace as a run does, and return what is said of own code."""
    workspace = folder / "ws"
    workspace.mkdir(exist_ok=True)
    fits = KnownFits(folder / "cache", workspace, "code")
    choices = UserChoices(fits=fits)
    with lock_workspace(workspace):
        plan = plan_workspace(read_run_record(workspace, "code"), "robot", [file], DiskReader(workspace), choices)
        carry_out(plan, workspace)
    fits.keep()
    return tuple(finding.message for step in plan.steps for finding in step.findings)


def test_what_fitted_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[str] = []

    def judge(path: str, *words: object) -> object:
        read.append(path)
        return judge_own_code(path, *words)  # type: ignore[arg-type]

    monkeypatch.setattr(workspace_plan, "judge_own_code", judge)
    run(tmp_path)
    (tmp_path / "ws" / "own.py").write_text("class Own:\n    def a(self, m): self.x = 1\n")
    # The first run writes it, the second one remembers what its methods are, the third one that nothing changed.
    for _ in range(3):
        assert run(tmp_path) == ()
    read.clear()
    record = read_run_record(tmp_path / "ws", "code")
    assert run(tmp_path) == ()
    assert read == []
    assert read_run_record(tmp_path / "ws", "code") == record
    # What is generated around it changes, and what does not fit is told each time.
    for _ in range(2):
        assert run(tmp_path, replace(OWN, expected_words=("a=x.a:p/msg/A", "b=x.b"))) == (
            "`Own` lacks `b`, which is called for `x.b`",
        )
    assert run(tmp_path) == ()
    (tmp_path / "ws" / "own.py").write_text("class Own:\n    def c(self): pass\n")
    assert run(tmp_path) != ()


def test_a_digest_says_all_that_decides() -> None:
    digests = {
        digest_fit(OWN, "1", {}),
        digest_fit(OWN, "2", {}),
        digest_fit(OWN, "1", {"a": "x"}),
        digest_fit(OWN, "1", {}, {"a": "x"}),
        digest_fit(replace(OWN, offered_words=("b",)), "1", {}),
        digest_fit(replace(OWN, path="other.py"), "1", {}),
    }
    assert len(digests) == 6


def test_without_a_cache_nothing_is_known(tmp_path: Path) -> None:
    kept = KnownFits(tmp_path, tmp_path / "ws", "code")
    kept.add("a")
    kept.keep()
    assert KnownFits(tmp_path, tmp_path / "ws", "code").is_known("a")
    assert not KnownFits(tmp_path, tmp_path / "other", "code").is_known("a")
    nothing = KnownFits()
    nothing.add("a")
    nothing.keep()
    assert not KnownFits().is_known("a")
