"""The words below a summary are those that stand in it; all lines fit the terminal."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import resources
from tests.cli.conftest import Run
from tests.emit.terminal.test_chain_gaps import HEAVY, ROBOT

_HOT = HEAVY.replace("8 ms", "12 ms")
_DARK = "groups: {g: {components: {a: {}}}}\nnodes: {a: {implements: a}}\n"


def _legend(run: Run, folder: Path, text: str) -> tuple[list[str], list[str]]:
    """Return the lines of the summary above its words, and the words."""
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    lines = run("timing", folder / "robot.yaml").out.splitlines()
    place = lines.index("Words")
    end = lines.index("", place)
    return lines[:place], [line[2:].partition("  ")[0] for line in lines[place + 1 : end]]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAVY, "not proven|~|>=|(inferred)|no bound found|undecided|periodic|event|gap|response|(host)"),
        (_HOT, "MISSED|~|(inferred)|unbounded|overload|periodic|event|gap|response|(host)"),
        (ROBOT, "open|~|>=|(inferred)|schedulable|undecided|periodic|event|gap|response|(host)|(cores)"),
        (_DARK, "unknown|gap|response|(unknown)"),
    ],
)
def test_the_legend_names_the_words_of_the_summary_and_only_those(
    run: Run, tmp_path: Path, text: str, words: str
) -> None:
    lines, legend = _legend(run, tmp_path, text)
    assert "|".join(legend) == words
    cells = {cell.strip().removesuffix(" (inferred)") for line in lines for cell in line.split("  ")}
    known = {"met", "MISSED", "not proven", "open", "schedulable", "overload", "undecided", "periodic", "event"}
    assert cells & known == set(legend) & known


def test_what_nobody_wrote_of_jitter_is_said_once(run: Run, tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(HEAVY.replace("rate: 30 Hz", "rate: 30 Hz, jitter: 0 ms"), encoding="utf-8")
    said = run("timing", tmp_path / "robot.yaml").out
    assert said.count("no jitter is written for 2 of 3 periodic elements: taken as none") == 1


@pytest.mark.parametrize("width", [60, 100])
@pytest.mark.parametrize(
    "question",
    [
        (),
        ("--chain", "obstacle_to_stop"),
        ("--why", "fall_to_call"),
        ("--why", "object_store"),
        ("--sensitivity", "missed_dose_to_mark"),
        ("--from", "scanner_rear", "--to", "base_driver", "--worst", "3"),
        ("--set", "scanner_rear.timing.wcet=3ms"),
    ],
)
def test_no_line_is_wider_than_the_terminal(
    run: Run, monkeypatch: pytest.MonkeyPatch, width: int, question: tuple[str, ...]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    out = run("timing", resources.resource_path("example_ramcip"), *question).out
    assert max(map(len, out.splitlines())) <= width
