"""What the processes that archgen starts may see of a job's environment, in which its secrets are."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from archgen import resources
from archgen.history import history_counting
from tests import repositories
from tests.cli.conftest import Run

PROJECT = """\
archgen: 1
project: {id: x}
groups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.o}}}}}
"""
ALLOWED_VARIABLES = {
    *("PYTHONPATH", "PYTHONHOME", "LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "DYLD_FALLBACK_LIBRARY_PATH", "SYSTEMROOT"),
    *("PATH", "HOME", "USERPROFILE", "XDG_CONFIG_HOME", "FONTCONFIG_FILE", "TZ"),
}


@pytest.fixture
def environments(monkeypatch: pytest.MonkeyPatch) -> Mapping[str, dict[str, str]]:
    """Give the environment of each process of Python that is started, by what it is for."""
    started: dict[str, dict[str, str]] = {}
    start_process = subprocess.Popen.__init__

    def record_process(process: Any, command: Sequence[str], *words: Any, **options: Any) -> None:  # noqa: ANN401
        if command[0] != "git":
            kind = next(
                name
                for name in ("drawing_worker", "template_worker", "history.history_counting")
                if name in str(command)
            )
            # None means that the process gets everything.
            started[kind] = dict(os.environ if options.get("env") is None else options["env"])
        start_process(process, command, *words, **options)

    monkeypatch.setattr(subprocess.Popen, "__init__", record_process)
    return started


@pytest.mark.usefixtures("fresh_workers")
def test_workers_see_what_they_need_and_nothing_else(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, environments: Mapping[str, dict[str, str]]
) -> None:
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": PROJECT})
    for number in range(3):
        repositories.commit(folder, {"archgen.yaml": PROJECT + f"# {number}\n"})
    monkeypatch.setenv("SECRET_THING", "hunter2")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(history_counting, "_COMMITS_PER_PROCESS", 1)
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    assert run("build", folder, "--only", "diagrams,wiki").status == 0
    assert run("stats", folder, "--history").status == 0
    assert sorted(environments) == ["drawing_worker", "history.history_counting", "template_worker"]
    for variables in environments.values():
        assert variables.keys() <= ALLOWED_VARIABLES
    assert not {"PATH", "HOME"} & environments["template_worker"].keys()
    assert "HOME" not in environments["drawing_worker"]


def test_a_worker_is_given_nothing_that_is_not_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET_THING", "hunter2")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/lib")
    assert resources.worker_environment()["LD_LIBRARY_PATH"] == "/lib"
    assert "SECRET_THING" not in resources.worker_environment("PATH")
