"""Verbs that write or print one thing: report, packed file, completion."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from archgen.cli import completion_command, pack_command, report_command


def _call(command: object, *words: str | Path) -> tuple[int, str]:
    done = CliRunner().invoke(command, [str(word) for word in words])  # type: ignore[arg-type]
    return done.exit_code, done.output


@pytest.mark.parametrize(
    ("shell", "mark"), [("bash", "complete -o"), ("zsh", "#compdef archgen"), ("fish", "complete --no-files")]
)
def test_completion_is_set_up_for_each_shell(shell: str, mark: str) -> None:
    status, printed = _call(completion_command.command, shell)
    assert status == 0
    assert mark in printed
    assert "_ARCHGEN_COMPLETE" in printed


def test_completion_for_another_shell_is_wrong_usage() -> None:
    assert _call(completion_command.command, "csh")[0] == 2


def test_the_report_is_a_word_file_of_what_was_selected(first: Path, tmp_path: Path) -> None:
    status, printed = _call(
        report_command.command, first, "-o", tmp_path / "a.docx", "--no-history", "--revision", "1a2b3c4"
    )
    assert (status, printed.splitlines()[-1]) == (0, f"wrote {tmp_path}/a.docx")
    with zipfile.ZipFile(tmp_path / "a.docx") as document:
        assert "1a2b3c4" in "".join(
            document.read(name).decode() for name in document.namelist() if name.endswith(".xml")
        )


def test_a_packed_project_is_one_file_and_the_resolved_one_is_data(first: Path, tmp_path: Path) -> None:
    assert _call(pack_command.command, first, "-o", tmp_path / "packed.yaml")[0] == 0
    assert yaml.safe_load((tmp_path / "packed.yaml").read_text())["archgen"] == 1
    assert _call(pack_command.command, first, "--resolved", "-o", tmp_path / "resolved.yaml")[0] == 0
    assert json.dumps(yaml.safe_load((tmp_path / "resolved.yaml").read_text())).count("edges") >= 1
    status, printed = _call(pack_command.command, first, "--select", "camera")
    assert status == 2
    assert "--select goes with --resolved" in printed
