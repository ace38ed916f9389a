"""The questions of `archgen init`, answered line by line; tests/cli/test_init_questions.py asks them in a terminal."""

from __future__ import annotations

from dataclasses import replace

import click
import pytest
from click.testing import CliRunner

from archgen.cli.init_command import ask_questions
from archgen.start import start_answers
from archgen.start.start_answers import GroupAnswer, PartnerAnswer, StartAnswers

DEFAULTS = replace(start_answers.collect_answers("robot"), title="Robot", distro="jazzy")
ALL = frozenset({"title", "distro", "partner", "group", "ci"})


def _ask(lines: str, answered: frozenset[str] = frozenset()) -> tuple[StartAnswers, str]:
    """Answer with these lines; return the answers and what was printed."""
    given: list[StartAnswers] = []

    @click.command
    def ask() -> None:
        given.append(ask_questions(DEFAULTS, answered, ("jazzy", "humble")))

    done = CliRunner().invoke(ask, input=lines)
    assert done.exit_code == 0, done.output
    return given[0], done.output


def _lines(*answers: str) -> str:
    return "".join(f"{answer}\n" for answer in answers)


def test_enter_takes_every_default() -> None:
    assert _ask(_lines("", "", "", "", ""))[0] == DEFAULTS


def test_what_a_flag_has_answered_is_not_asked() -> None:
    answers, printed = _ask("", ALL)
    assert answers == DEFAULTS
    assert printed.count("\n") == 2


def test_each_group_gets_an_owner_where_there_are_partners() -> None:
    answers, _ = _ask(_lines("p = Lab P @p", "q", "", "sensing, Motion planning", "", "q"), ALL - {"partner", "group"})
    assert answers.partners == (PartnerAnswer("p", "Lab P", "@p"), PartnerAnswer("q", "Q"))
    assert answers.groups == (
        GroupAnswer("sensing", "Sensing", "p"),
        GroupAnswer("motion_planning", "Motion planning", "q"),
    )


@pytest.mark.parametrize("lines", [("p", "p", "q", ""), ("P=x", "p", "q", "")])
def test_a_wrong_answer_is_said_and_asked_for_again(lines: tuple[str, ...]) -> None:
    answers, printed = _ask(_lines(*lines), ALL - {"partner"})
    assert [partner.id for partner in answers.partners] == ["p", "q"]
    assert "Error: " in printed
