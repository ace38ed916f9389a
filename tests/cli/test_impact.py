"""`archgen impact`, `archgen todo`, and what is wrong usage of them."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from archgen.cli import impact_command, todo_command
from tests.late_robot import ROBOT, check


@pytest.fixture
def late(tmp_path: Path) -> str:
    check(tmp_path / "late")
    return str(tmp_path / "late")


def run(*words: str) -> tuple[int, str]:
    verb = todo_command.command if words[:1] == ("todo",) else impact_command.command
    result = CliRunner().invoke(verb, [word for word in words if word != "todo"])
    return result.exit_code, result.output


def test_a_partner_is_shown_and_written(late: str, tmp_path: Path) -> None:
    status, text = run(late, "--partner", "north")
    assert status == 0
    assert "1. Eye · picture" in text
    file = tmp_path / "north.md"
    assert run(late, "--partner", "north", "--format", "markdown", "-o", str(file))[0] == 0
    assert file.read_text(encoding="utf-8").startswith("# If North is late")


def test_a_day_is_one_of_the_calendar(late: str) -> None:
    assert "The project writes no milestones." in run(late, "--partner", "north", "--until", "2027-03-01")[1]
    assert run(late, "--partner", "north", "--until", "2027-02-29")[0] == 2


def test_eighty_columns_are_enough(late: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    _, text = run(late, "--partner", "north")
    assert max(map(len, text.splitlines())) <= 80


def test_a_partner_or_component_that_is_not_there_is_wrong_usage(late: str, tmp_path: Path) -> None:
    assert run(late, "--partner", "nort")[0] == 2
    assert "did you mean `north`" in run(late, "--partner", "nort")[1]
    assert run(late)[0] == 2
    assert "nothing is called" in run(late, "--component", "moth")[1]
    check(tmp_path / "bare", "archgen: 1\ngroups: {}\n")
    assert "the project has no partners" in run(str(tmp_path / "bare"), "--partner", "x")[1]


def test_what_is_to_do_is_shown_with_what_others_changed_since(late: str, tmp_path: Path) -> None:
    check(tmp_path / "before", ROBOT.replace("period: 100 ms", "period: 50 ms"))
    status, text = run("todo", late, "--partner", "south", "--since", str(tmp_path / "before"))
    assert status == 0
    assert "What others changed\n- " in text
    assert "What others changed" not in run("todo", late, "--partner", "south")[1]
    assert run("todo", late)[0] == 2
    assert run("todo", late, "--partner", "south", "--since", "nowhere")[0] == 2
