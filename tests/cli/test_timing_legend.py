"""The words below a summary are those that stand in it; all lines fit the terminal."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen import resources
from tests.cli.conftest import Run
from tests.property_sizes import try_some
from tests.timing.chains.test_missing_figures import HEAVY, ROBOT

_HOT = HEAVY.replace("8 ms", "12 ms")
_DARK = "groups: {g: {components: {a: {}}}}\nnodes: {a: {implements: a}}\n"


def _legend(run: Run, folder: Path, text: str) -> tuple[list[str], list[str]]:
    """Return the lines of the summary above its words, and the words."""
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    return _split_legend(run("timing", folder / "robot.yaml").out.splitlines())


def _split_legend(lines: list[str]) -> tuple[list[str], list[str]]:
    place = lines.index("Words")
    end = lines.index("", place)
    # The words of one kind share a line: `~  rounded; >=: at least so much`.
    rows = [line[2:].partition("  ") for line in lines[place + 1 : end]]
    assert len(rows) <= 10
    return lines[:place], [word for first, _, text in rows for word in (first, *re.findall(r"; ([^;:]+): ", text))]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            HEAVY,
            ("not proven|reaction time|data age|no bound found|~|>=|(inferred)|(host)|periodic|event"),
        ),
        (
            _HOT,
            ("MISSED|reaction time|data age|unbounded|~|(inferred)|(host)|periodic|event"),
        ),
        (
            ROBOT,
            ("open|reaction time|data age|unknown|~|>=|(inferred)|(host)|(cores)|periodic|event"),
        ),
        (_DARK, "unknown|(unknown)"),
    ],
)
def test_the_legend_names_the_words_of_the_summary_and_only_those(
    run: Run, tmp_path: Path, text: str, words: str
) -> None:
    lines, legend = _legend(run, tmp_path, text)
    assert "|".join(legend) == words
    cells = {cell.strip().removesuffix(" (inferred)") for line in lines for cell in line.split("  ")}
    known = {"met", "MISSED", "not proven", "open", "periodic", "event"}
    assert cells & known == set(legend) & known


PLAIN = set(
    """
    a actions activation activations adds an bound but after again age allows and another any are as at be before best by call callers can chains core cores
    deadline deadlines do done due earliest elements every execution feed figures for found from give granted has how if
    in is it its itself joins known largest late latency latest lets link links long longer longest loops many may measure
    meets missing more most need needs no nobody none not nothing of off often on one only or order own part parts
    periods pin priorities priority proven rate reads rest round runs samples say services share shorten shows so starts
    sure take taken takes than that the them there they this time to triggered until up wait was what whatever where
    whether which why work worked works world write written hosts hz ms us s any all overloaded sum triggers late
    between call calls end exactly begin beginnings began clocks each gap host jitter load next nothing overload proves response clock two says start since source these caller configurations
    lead slice tick threads times comes other way their prove trying tried would then set stored old messages used thread node nodes components component left waits together apart several
    """.split()  # noqa: SIM905 - a text of words is read more easily than a list of strings
)
"""Words that need no legend."""


@pytest.mark.parametrize("text", [HEAVY, _HOT, ROBOT, _DARK, None])
def test_each_word_of_a_summary_is_plain_or_in_its_legend(run: Run, tmp_path: Path, text: str | None) -> None:
    if text is None:
        lines, legend = _split_legend(run("timing", resources.resource_path("example_ramcip")).out.splitlines())
    else:
        lines, legend = _legend(run, tmp_path, text)
    # What has a dot, a slash or a digit, stands in backticks or opens a row is a name of the project.
    words = set[str]()
    for line in lines:
        shown = re.sub(r"`[^`]*`", "", line)
        words.update(word.lower() for word in re.findall(r"(?<![\w./])[A-Za-z][a-z]+(?![\w./])", shown))
    explained = {word for entry in legend for word in entry.strip("()").lower().split()}
    names = {
        "colour",
        "depth",
        "amcl",
        "auto",
        "cable",
        "conversation",
        "far",
        "octree",
        "pc",
        "respeaker",
        "slam",
        "transcriber",
    }
    assert words - PLAIN - explained - names == set()


@pytest.mark.parametrize("width", [20, 60, 100, 160])
def test_words_take_ten_lines_at_most(run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, width: int) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    lines = run("timing", tmp_path / "robot.yaml").out.splitlines()
    legend = lines[lines.index("Words") + 1 :]
    legend = legend[: legend.index("")]
    assert len(legend) <= 10
    assert any("docs/timing.md" in line for line in legend) == (width < 100)


def test_what_nobody_wrote_of_jitter_is_said_once(run: Run, tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(HEAVY.replace("rate: 30 Hz", "rate: 30 Hz, jitter: 0 ms"), encoding="utf-8")
    said = run("timing", tmp_path / "robot.yaml").out
    assert said.count("no jitter is written for 2 of 3 periodic elements: taken to start exactly by their clocks") == 1


@pytest.mark.parametrize("width", try_some([60, 100]))
@pytest.mark.parametrize(
    "question",
    [
        (),
        ("--chain", "obstacle_to_stop"),
        ("--why", "fall_to_call"),
        ("--why", "object_store"),
        pytest.param(("--sensitivity", "missed_dose_to_mark"), marks=pytest.mark.slow),
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
