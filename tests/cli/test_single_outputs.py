"""Verbs that write or print one thing: report, packed file, completion."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import click
import pytest
import yaml
from click.testing import CliRunner

from archgen.cli import completion_command, diff_command, owners_command, pack_command, report_command


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


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("-o", "r.doc"), "the ending of `r.doc` names no format: end it in .docx, .pdf or .xlsx, or give --format"),
        (("-o", "-"), "cannot write to standard output: name a file or a folder"),
    ],
)
def test_the_ending_of_a_report_says_its_format(first: Path, words: tuple[str, ...], said: str) -> None:
    status, printed = _call(report_command.command, first, *words)
    assert status == 2
    assert said in " ".join(printed.split())


def test_a_report_is_a_workbook_where_its_ending_says_so(first: Path, tmp_path: Path) -> None:
    assert _call(report_command.command, first, "--no-history", "-o", tmp_path / "r.XLSX")[0] == 0
    with zipfile.ZipFile(tmp_path / "r.XLSX") as workbook:
        assert "xl/workbook.xml" in workbook.namelist()


def test_a_packed_project_goes_to_standard_output_for_a_dash(
    first: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert _call(pack_command.command, first, "-o", "packed.yaml")[0] == 0
    done = CliRunner().invoke(pack_command.command, [str(first), "-o", "-"])
    assert (done.exit_code, done.stdout_bytes) == (0, (tmp_path / "packed.yaml").read_bytes())
    done = CliRunner().invoke(pack_command.command, [str(first), "--resolved", "-o", "-"])
    assert "edges" in yaml.safe_load(done.stdout_bytes)
    assert [each.name for each in tmp_path.glob("-*")] == []
    status, printed = _call(pack_command.command, first, "-o", "x.json")
    assert (status, "what is packed is YAML: end `x.json` in .yaml" in printed) == (2, True)


@pytest.mark.parametrize("command", [diff_command.command, owners_command.command])
def test_a_dash_is_standard_output_also_where_that_is_the_default(
    command: click.Command, first: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    words = [str(first)] * 2 if command.name == "diff" else [str(first)]
    done = CliRunner().invoke(command, [*words, "-o", "-"])
    assert (done.exit_code, "wrote" in done.stdout) == (0, False)
    assert not list(tmp_path.glob("-*"))
