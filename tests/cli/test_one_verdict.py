"""One verdict in all outputs: generated robots, each output of which is read as people read it, held against one another."""

from __future__ import annotations

import io
import json
import random
import re
import zipfile
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import lxml.html
import pytest
from lxml import etree

from tests.cli.conftest import Run
from tests.property_sizes import DRAWS_ANEW, try_some
from tests.timing.random_robots import random_robot_text

_UNITS = {"ns": Fraction(1), "us": Fraction(10**3), "µs": Fraction(10**3), "ms": Fraction(10**6), "s": Fraction(10**9)}
_TIME = re.compile(r"(>=|≥|at least)?\s*~?([0-9.]+)\s?(ns|us|µs|ms|s)\b")
_WORD = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"


class Stated(NamedTuple):
    """What an output says of a chain: the verdict, and how long it takes at most as it is written there (None: no figure)."""

    verdict: str
    latest: str | None


def draw_robot(seed: int) -> tuple[str, str]:
    """Return a robot of two partners with deadlines, and an earlier version in which nothing was to be in time."""
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    text = random_robot_text(seed)
    number = iter(range(1000))
    text = re.sub(r"(?m)^(      n\d+: \{)", lambda head: f"{head[1]}owner: {'pq'[next(number) % 2]}, ", text)
    earlier = re.sub(r"(through: \[[^\]]*\])\}", r"\1, deadline: 100000 s}", text)
    later = re.sub(
        r"(through: \[[^\]]*\])\}",
        lambda chain: f"{chain[1]}, deadline: {dice.choice((5, 20, 60, 150, 400, 2000))} ms}}",
        text,
    )
    head = "partners: {p: P, q: Q}\n"
    return head + later, head + earlier


def read_json(text: str) -> dict[str, dict[str, object]]:
    chains: dict[str, dict[str, object]] = json.loads(text)["chains"]
    return chains


def read_terminal(text: str) -> Iterator[tuple[str, Stated]]:
    for line in text.split("Chains:")[1].split("\n\n", maxsplit=1)[0].splitlines()[1:]:
        name, latest, _, verdict = re.split(r"  +", line.strip())[:4]
        yield name, Stated(verdict.lower(), latest)


def read_check(text: str) -> dict[str, str]:
    late = dict.fromkeys(re.findall(r"the chain `(c\d)` misses its deadline", text), "missed")
    return late | dict.fromkeys(re.findall(r"nothing proves that the chain `(c\d)` meets", text), "not proven")


def read_rows(tables: Iterator[list[list[str]]], name: str, latest: str, verdict: str) -> Iterator[tuple[str, Stated]]:
    """Yield the chains of the tables that have these columns; a title of a column may end with a unit."""
    for header, *rows in tables:
        titles = [title.partition(",")[0] for title in header]
        if {name, latest, verdict} <= set(titles):
            unit = header[titles.index(latest)].partition(", ")[2]
            for row in rows:
                if len(row) < len(header) or not row[titles.index(verdict)]:
                    continue  # a row of another table on the same sheet
                figure = row[titles.index(latest)]
                whole = f"{figure} {unit}" if unit and re.search("[0-9]", figure) else figure
                yield row[titles.index(name)].lower(), Stated(row[titles.index(verdict)], whole)


def list_html_tables(text: str) -> Iterator[list[list[str]]]:
    for table in lxml.html.fromstring(text).iter("table"):
        yield [[_read_text(cell) for cell in row if cell.tag in {"td", "th"}] for row in table.iter("tr")]


def _read_text(element: Any) -> str:  # noqa: ANN401 - an element of lxml
    return " ".join("".join(element.itertext()).split())


def list_word_tables(data: bytes) -> Iterator[list[list[str]]]:
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        document = etree.fromstring(package.read("word/document.xml"))
    for table in document.iter(f"{_WORD}tbl"):
        yield [[_read_text(cell) for cell in row.iter(f"{_WORD}tc")] for row in table.iter(f"{_WORD}tr")]


def list_sheet_tables(path: Path) -> Iterator[list[list[str]]]:
    openpyxl = pytest.importorskip("openpyxl")
    for sheet in openpyxl.load_workbook(path):
        rows = [["" if cell is None else str(cell) for cell in row] for row in sheet.iter_rows(values_only=True)]
        yield from (rows[start:] for start, row in enumerate(rows) if "Verdict" in row)


def list_markdown_tables(text: str) -> Iterator[list[list[str]]]:
    for block in re.findall(r"(?m)(?:^\|.*\n)+", text):
        rows = [
            [re.sub(r"[*`\\]|&#8203;|\[|\]\([^)]*\)", "", cell).strip() for cell in line.strip("|").split("|")]
            for line in block.splitlines()
        ]
        yield [rows[0], *rows[2:]]


def check_statements(source: str, statements: dict[str, Stated], chains: dict[str, dict[str, object]]) -> None:
    """Hold what an output says against the JSON: the same verdict, and a figure that is on the safe side of the exact one."""
    for name, stated in statements.items():
        chain = chains[name]
        assert stated.verdict == chain["verdict"], (source, name)
        bound = chain["bound"]
        assert isinstance(bound, dict)
        found = _TIME.search(stated.latest or "")
        assert (found is None) == (bound["value"] is None), (source, name, stated)
        if found is None:
            continue
        exact, shown = Fraction(bound["value"]) * 10**6, Fraction(found[2]) * _UNITS[found[3]]
        is_partial = not bound["complete"] and bound.get("side") == "at least"
        assert bool(found[1]) == is_partial, (source, name, stated, bound)
        margin = exact / 90 + 1
        if source == "terminal":
            assert abs(shown - exact) <= margin
        else:
            assert (-1 <= exact - shown <= margin) if is_partial else (-1 <= shown - exact <= margin), (
                source,
                name,
                stated,
                bound,
            )


def read_quick(run: Run, folder: Path, seed: int, *, agrees: bool = True) -> dict[str, dict[str, object]]:
    """Hold the outputs that need no picture and no search against one another; return the chains of the JSON."""
    later, earlier = draw_robot(seed)
    robot, before = folder / "after" / "robot.yaml", folder / "before" / "robot.yaml"
    for path, text in ((robot, later), (before, earlier)):
        path.parent.mkdir(parents=True)
        path.write_text(text, encoding="utf-8")
    chains = read_json(run("timing", robot, "--format", "json").out)
    told = read_check(run("check", robot).out)
    assert told == {
        name: chain["verdict"] for name, chain in chains.items() if chain["verdict"] in {"missed", "not proven"}
    }
    comment = run("diff", before, robot, "--format", "markdown").out
    rows = read_rows(list_markdown_tables(comment), "chain", "after", "verdict")
    statements = {name: each._replace(verdict=each.verdict.partition(" (was")[0]) for name, each in rows}
    assert statements
    check_statements("comment", statements, chains)
    check_lists(run, robot, chains)
    if not agrees:
        return chains
    agreement = run("interfaces", robot, "--between", "p", "q").out
    agreed = read_rows(
        list_markdown_tables(agreement), "Chain that passes through it", "Expected at the latest", "Verdict"
    )
    check_statements("agreement", dict(agreed), chains)
    return chains


def check_lists(run: Run, robot: Path, chains: dict[str, dict[str, object]]) -> None:
    """Hold what `todo` and `list` say against the JSON: verdicts, how many are met, what is to be done for which chain."""
    listed = {
        each["id"]: each for each in json.loads(run("list", "--of", "chains", "-C", robot, "--format", "json").out)
    }
    assert set(listed) == set(chains)
    for partner in ("p", "q"):
        text = run("todo", "--partner", partner, robot).out
        reliance = json.loads(run("impact", "--partner", partner, robot, "--format", "json").out)["chains"]
        titles = {listed[each["id"]]["title"]: each["id"] for each in reliance}
        table = text.partition("Deadlines through them")[2].partition("\n\n")[0].splitlines()[2:]
        rows = {re.split("  +", line.strip())[0]: line.rpartition("  ")[2] for line in table if "  " in line.strip()}
        assert {titles[title]: verdict for title, verdict in rows.items()} == {
            each["id"]: chains[each["id"]]["verdict"] for each in reliance
        }
        met_count = sum(chains[each["id"]]["verdict"] == "met" for each in reliance)
        if reliance:
            assert f" {met_count} of {len(reliance)} through them are met" in text
        tasks = json.loads(run("todo", "--partner", partner, robot, "--format", "json").out)["tasks"]
        for task in tasks:
            if named := re.match(r"(?:Bring|Show that) `(c\d)`.*?(?:: (missed|not proven|open)|$)", task["text"]):
                verdict = chains[named[1]]["verdict"]
                assert verdict != "met", task
                assert named[2] in {None, verdict}, task
            # What is late is a finding, too.
            if late := re.match(r"the chain `(c\d)` misses", task["text"]):
                assert chains[late[1]]["verdict"] == "missed"
            if late := re.match(r"nothing proves that the chain `(c\d)`", task["text"]):
                assert chains[late[1]]["verdict"] == "not proven"


@pytest.mark.slow
@pytest.mark.parametrize("seed", try_some([24, 17, 51]))
def test_what_is_read_and_written_quickly_says_the_same(run: Run, tmp_path: Path, seed: int) -> None:
    assert read_quick(run, tmp_path, seed)


@pytest.mark.slow
def test_all_outputs_say_the_same(run: Run, tmp_path: Path) -> None:
    chains = read_quick(run, tmp_path, 34)
    robot = tmp_path / "after" / "robot.yaml"
    check_statements("terminal", dict(read_terminal(run("timing", robot).out)), chains)
    assert run("site", robot, "-o", tmp_path / "site").status == 0
    assert run("report", robot, "-o", tmp_path / "report.docx").status == 0
    assert run("report", robot, "-o", tmp_path / "report.xlsx").status == 0
    page = (tmp_path / "site" / "chains.html").read_text(encoding="utf-8")
    columns = ("Chain", "At the latest", "Verdict")
    for source, tables in (
        ("site", list_html_tables(page)),
        ("report", list_word_tables((tmp_path / "report.docx").read_bytes())),
        ("workbook", list_sheet_tables(tmp_path / "report.xlsx")),
    ):
        statements = dict(read_rows(tables, *columns))
        assert set(statements) == set(chains), source
        check_statements(source, statements, chains)
    for name, chain in chains.items():
        text = _read_text(
            lxml.html.fromstring((tmp_path / "site" / "chains" / f"{name}.html").read_text(encoding="utf-8"))
        )
        assert f"{chain['verdict']}" in text
        assert "diverged" not in text
        assert f"{chain['verdict']}" in run("show", name, "-C", robot).out.lower()
    for partner in ("p", "q"):
        reliance = json.loads(run("impact", "--partner", partner, robot, "--format", "json").out)
        assert all(each["verdict"] == chains[each["id"]]["verdict"] for each in reliance["chains"])


@pytest.mark.slow
@pytest.mark.hypothesis
def test_random_robots_say_the_same(run: Run, tmp_path: Path) -> None:
    # The shares of deadlines, which an agreement has too, take longer than all else.
    found = [
        read_quick(run, tmp_path / str(seed), seed, agrees=seed % 10 == 0) for seed in range(40 if DRAWS_ANEW else 10)
    ]
    assert {str(chain["verdict"]) for chains in found for chain in chains.values()} >= {"met", "missed", "not proven"}
