"""What holds for every generator that ships: any text of the model stays text, and the same input gives the same bytes."""

from __future__ import annotations

import ast
import configparser
import os
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml

from archgen.emit.backend_manifests import find_backends
from archgen.emit.file_tree import OutputError
from archgen.emit.workspace.disk_files import GeneratedFile, find_path_problems
from archgen.pipeline import CheckedProject, check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from tests import hostile
from tests.judged_projects import judge_shipped
from tests.outside_tools import run_judge
from tests.property_sizes import try_some
from tests.running import ROOT, contents

GENERATORS = [name for name, each in find_backends(ROOT / "docs")[0].items() if each.makes == "workspace"]


def _check_files(folder: Path) -> None:
    """Let a parser read each generated file whose language has one here."""
    for path, data in contents(folder).items():
        text = data.decode()
        assert str(folder) not in text
        if path.endswith(".py"):
            ast.parse(text, path)
        elif path.endswith((".xml", ".launch", ".xacro", ".cpf")):
            assert "<!DOCTYPE" not in text
            ET.fromstring(text)  # noqa: S314 - just made
        elif path.endswith((".yaml", ".yml")):
            list(yaml.safe_load_all(text))
        elif path.endswith((".service", ".target")):
            configparser.RawConfigParser(strict=False).read_string(text)
        elif path.endswith((".sh", ".bash")) or text.startswith(("#!/bin/sh", "#!/bin/bash", "#!/usr/bin/env bash")):
            shell = "bash" if "bash" in text.partition("\n")[0] or path.endswith(".bash") else "sh"
            run_judge(shell, "-n", stdin=text)


@pytest.fixture(scope="module", params=try_some(hostile.TEXTS))
def hostile_project(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> CheckedProject:
    folder = tmp_path_factory.mktemp("hostile")
    (folder / "archgen.yaml").write_text(hostile.written(hostile.project(hostile.TEXTS[request.param])), "utf-8")
    return check_project(folder)


@pytest.mark.parametrize("generator", GENERATORS)
def test_hostile_text_stays_text(generator: str, hostile_project: CheckedProject, tmp_path: Path) -> None:
    try:
        result = write_workspace(hostile_project, OutputOptions(), generator, tmp_path / "ws")
    except OutputError as refusal:
        # Names of packages and the like are paths: refused, with the place, before anything is written.
        assert "archgen.yaml:" in refusal.message  # noqa: PT017 - it may be refused
        assert list(tmp_path.iterdir()) == []
        return
    if result.plan is not None:
        assert result.plan.conflicts == ()
        _check_files(tmp_path / "ws")
        assert not list(find_path_problems(GeneratedFile(path, b"") for path in result.plan.writes))
    assert {path.name for path in tmp_path.iterdir()} <= {"ws"}


@pytest.fixture(scope="module", params=try_some(["examples/cleaning_robot", "example_ramcip"]))
def judged_twice(request: pytest.FixtureRequest) -> tuple[CheckedProject, CheckedProject]:
    """Judge a project twice, which takes longer than what a generator does with it."""
    return judge_shipped(ROOT / request.param), check_project(ROOT / request.param)


@pytest.mark.parametrize("generator", try_some(GENERATORS, 8))
def test_the_same_input_gives_the_same_bytes(
    generator: str, tmp_path: Path, judged_twice: tuple[CheckedProject, CheckedProject]
) -> None:
    project, other = judged_twice
    first = write_workspace(project, OutputOptions(), generator, tmp_path / "first")
    write_workspace(other, OutputOptions(), generator, tmp_path / "second")
    assert contents(tmp_path / "first") == contents(tmp_path / "second")
    if first.plan is None:
        return
    _check_files(tmp_path / "first")
    for path in (tmp_path / "first").rglob("*"):
        os.utime(path, ns=(1, 1))
    again = write_workspace(project, OutputOptions(), generator, tmp_path / "first")
    assert again.plan is not None
    assert {step.verb for step in again.plan.steps} <= {"same", "yours"}
    assert {path.stat().st_mtime_ns for path in (tmp_path / "first").rglob("*") if path.is_file()} <= {1}
