"""No output contradicts another one: drawn projects over all that the language has, each output read as people read it.

`tests/cli/test_one_verdict.py` does the same for the verdicts of robots that are drawn for timing alone.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import lxml.html
import pytest

from tests.cli import varied_outputs
from tests.cli.conftest import Run
from tests.cli.varied_outputs import Agreement, Rows, list_records, read_figure, read_words
from tests.cli.varied_robots import draw_project
from tests.property_sizes import DRAWS_ANEW, try_some

_HOST_WORDS = {
    "schedulable": {"in time"},
    "overload": {"overload", "overloaded"},
    "undecided": {"not proven in time", "undecided", "not proven"},
    "unknown": {"unknown", ""},
}
_COUNTS = ("Chains proven in time", "Requirements served", "Hosts proven in time")


class Written(NamedTuple):
    """Where a project is, and what was written of it."""

    robot: Path
    before: Path
    out: Path

    def page(self, path: str) -> str:
        """Return a page of the site, empty where there is none."""
        file = self.out / "site" / path
        return file.read_text(encoding="utf-8") if file.exists() else ""

    def tables(self, name: str) -> Iterator[Rows]:
        """Yield the tables of a page, a document, the workbook or the slides."""
        path = self.out / name
        if name.endswith(".html"):
            yield from varied_outputs.list_html_tables(self.page(name)) if self.page(name) else ()
        elif name.endswith(".docx"):
            yield from varied_outputs.list_word_tables(path.read_bytes())
        elif name.endswith(".xlsx"):
            yield from varied_outputs.list_sheet_tables(path)
        else:
            yield from varied_outputs.list_slide_tables(path)


def write_outputs(run: Run, folder: Path, seed: int) -> Written:
    """Write a drawn project, the version before it, and what is made of it."""
    pytest.importorskip("xlsxwriter")
    texts = draw_project(seed)
    written = Written(folder / "after" / "robot.yaml", folder / "before" / "robot.yaml", folder / "out")
    for path, text in zip(written[:2], texts, strict=True):
        path.parent.mkdir(parents=True)
        path.write_text(text, encoding="utf-8")
    verbs: tuple[tuple[object, ...], ...] = (
        ("site", written.robot, "-o", written.out / "site"),
        ("report", written.robot, "-o", written.out / "deliverable.docx"),
        ("report", written.robot, "--document", "workbook", "-o", written.out / "workbook.xlsx"),
        ("slides", written.robot, "-o", written.out / "slides.pptx"),
    )
    for verb in verbs:
        done = run(*verb)
        assert done.status == 0, done.err
    return written


def list_contradictions(run: Run, written: Written) -> list[str]:
    """Return what contradicts what."""
    robot = written.robot
    timing = json.loads(run("timing", robot, "--format", "json").out)
    lists = {
        kind: json.loads(run("list", "--of", kind, "-C", robot, "--format", "json").out)
        for kind in ("chains", "components", "requirements", "partners")
    }
    held = Agreement(timing)
    hold_terminal(held, run, robot)
    hold_comment(held, run("diff", written.before, robot, "--format", "markdown").out)
    hold_chain_tables(held, written, {each["title"]: each["id"] for each in lists["chains"]})
    hold_counts(held, written, lists)
    hold_requirements(held, written, {each["id"]: each["state"] for each in lists["requirements"]})
    hold_figures(held, written)
    hold_partners(held, run, written, lists)
    return held.faults


def hold_terminal(held: Agreement, run: Run, robot: Path) -> None:
    """Hold what `timing` and `show` print against the analysis."""
    text = run("timing", robot).out
    for line in text.partition("Chains:")[2].partition("\n\n")[0].splitlines()[1:]:
        name, latest, _, *rest = re.split("  +", line.strip())
        if name in held.timing["chains"]:  # and no share of the reactions
            chain = held.timing["chains"][name]
            held.hold_verdict(f"terminal {name}", rest[0] if rest and chain["deadline"] else "", chain)
            held.expect(
                "terminal", f"{name} has a figure", read_figure(latest) is None, chain["bound"]["value"] is None
            )
    for line in text.partition("Hosts: load")[2].partition("\n\n")[0].splitlines()[1:]:
        verdict = held.timing["hosts"][line.split()[0]]["verdict"]
        held.expect("terminal", line, any(word and word in line for word in _HOST_WORDS[verdict]), known=True)
    for name, chain in held.timing["chains"].items():
        if chain["deadline"]:
            held.expect("show", name, chain["verdict"] in run("show", name, "-C", robot).out.lower(), known=True)


def hold_comment(held: Agreement, comment: str) -> None:
    """Hold a comment: no line stands there twice, and none tells of a change to the same."""
    names = {name: name for name in held.timing["chains"]}
    held.hold_chains("comment", list_records(varied_outputs.list_markdown_tables(comment), "chain", "verdict"), names)
    lines = [line for line in comment.splitlines() if line.startswith("- ")]
    held.faults += [f"comment: twice: {line}" for line in {*lines} if lines.count(line) > 1]
    for before, after in re.findall(r"([^;:,]+?) → ([^;:,\n]+)", re.sub(r"[`*\\]|&#8203;", "", comment)):
        held.expect("comment", f"{before} → {after}", before.strip() == after.strip(), known=False)


def hold_chain_tables(held: Agreement, written: Written, names: dict[str, str]) -> None:
    """Hold all tables of chains against the analysis, and that no word of the inside is on a page."""
    for name in ("chains.html", "workbook.xlsx", "deliverable.docx", "slides.pptx"):
        records = list_records(written.tables(name), "Chain", "Verdict")
        held.hold_chains(name, records, names, is_whole=bool(names) and name in {"chains.html", "workbook.xlsx"})
    for path in sorted((written.out / "site").rglob("*.html")):
        text, name = path.read_text(encoding="utf-8"), path.relative_to(written.out / "site").as_posix()
        if "Verdict" in text and name != "chains.html":
            held.hold_chains(name, list_records(varied_outputs.list_html_tables(text), "Chain", "Verdict"), names)
        inside = re.search(r"\bdiverged\b|Fraction\(|TimingValue|>None<|saturated link:", text)
        held.expect(name, "a word of the inside", inside and inside[0], None)


def hold_counts(held: Agreement, written: Written, lists: dict[str, Any]) -> None:
    """Hold the figures at a glance: on the start page, on the title page, in the summary and on a slide."""
    texts = {
        "home": " ".join(read_words(lxml.html.fromstring(written.page("index.html"))).split()),
        **{
            name: " ".join(cell for table in written.tables(name) for row in table for cell in row)
            for name in ("deliverable.docx", "slides.pptx")
        },
    }
    judged = [each for each in held.timing["chains"].values() if each["deadline"]]
    known = {
        "Chains proven in time": (sum(each["verdict"] == "met" for each in judged), len(judged)),
        "Requirements served": (
            sum(each["state"] != "uncovered" for each in lists["requirements"]),
            len(lists["requirements"]),
        ),
        "Hosts proven in time": (
            sum(each["verdict"] == "schedulable" for each in held.timing["hosts"].values()),
            len(held.timing["hosts"]),
        ),
    }
    for title in _COUNTS:
        for name, text in texts.items():
            found = re.search(rf"{title} (\d+) of (\d+)" if name == "home" else rf"(\d+) of (\d+) ?{title}", text)
            if found:
                held.expect(name, title, (int(found[1]), int(found[2])), known[title])
    points = {name: re.search(r"Open points ?(\d+)|(\d+) ?Open points:", text) for name, text in texts.items()}
    held.expect("open points", "in all", len({each and (each[1] or each[2]) for each in points.values()}), 1)


def hold_requirements(held: Agreement, written: Written, states: dict[str, str]) -> None:
    """Hold what is said of requirements: which nobody serves, and which are missed."""
    for name in ("requirements.html", "workbook.xlsx"):
        for record in list_records(written.tables(name), "Id", "Requirement", "Served by"):
            if record["Id"] in states:
                is_unserved = "no component yet" in record["Served by"]
                held.expect(name, record["Id"], is_unserved, states[record["Id"]] == "uncovered")
    for name, state in states.items():
        page = written.page(f"requirements/{name.lower()}.html")
        shown = re.findall(r"<dt>State</dt><dd>(.*?)</dd>", page)
        words = [read_words(lxml.html.fromstring(each)).strip() for each in shown]
        held.expect(f"page of {name}", "state", words, [state] if page and words else words)
    for record in list_records(written.tables("deliverable.docx"), "Id", "Requirement", "Proof"):
        if record["Id"] in states:
            proof, state = record["Proof"], states[record["Id"]]
            held.expect("proof", record["Id"], "nobody serves it" in proof, state == "uncovered")
            held.expect("proof", record["Id"], "missed" in proof, state == "missed")
            held.expect("proof", record["Id"], proof == "met", known=False)  # the verdict of what?


def hold_figures(held: Agreement, written: Written) -> None:
    """Hold rates, gaps, responses and loads against the analysis."""
    for name in ("timing/rates.html", "workbook.xlsx"):
        for record in list_records(written.tables(name), "Activity", "Rate", "Longest gap", "Response"):
            element = held.timing["elements"].get(record["Activity"])
            if element:
                held.hold_time(f"{name} {record}", record["Rate"], element["rate"], 1, 40)
                held.hold_time(f"{name} {record}", record["Longest gap"], element["gap"])
                held.hold_time(f"{name} {record}", record["Response"], element["response"])
    for record in list_records(written.tables("workbook.xlsx"), "Host", "Load of all cores", "Verdict"):
        host = held.timing["hosts"].get(record["Host"].lower())
        if host:
            held.expect("load", record["Host"], record["Verdict"].lower() in _HOST_WORDS[host["verdict"]], known=True)
            load = dict(host["utilisation"])
            if load["value"] is not None and host["cores"]:
                load["value"] /= host["cores"]
                held.hold_time(f"load {record['Host']}", record["Load of all cores"], load, 1, 20)


def hold_partners(held: Agreement, run: Run, written: Written, lists: dict[str, Any]) -> None:
    """Hold what partners have, give and owe: in all places the same, and the sums those of the matrix."""
    titles = {each["title"]: each["id"] for each in lists["partners"]}
    sums: dict[str, list[str]] = {}
    for name in ("index.html", "deliverable.docx", "slides.pptx", "workbook.xlsx"):
        for record in list_records(written.tables(name), "Partner", "Components"):
            if record["Partner"] in titles and record["Components"].isdigit():
                own = [
                    each
                    for each in lists["components"]
                    if titles[record["Partner"]] in (each["owner"] or "").split(", ")
                ]
                held.expect(name, f"components of {record['Partner']}", int(record["Components"]), len(own))
        for record in list_records(written.tables(name), "Partner", "Gives", "Takes", "Owes"):
            said = [record[title] for title in ("Gives", "Takes", "Owes")]
            held.expect(name, f"sums of {record['Partner']}", said, sums.setdefault(record["Partner"], said))
    hold_matrix(held, written, sums, {*titles})
    for name in titles.values():
        impact = json.loads(run("impact", "--partner", name, written.robot, "--format", "json").out)
        for chain in impact["chains"]:
            held.expect("impact", chain["id"], chain["verdict"], held.timing["chains"][chain["id"]]["verdict"])
        tasks = json.loads(run("todo", "--partner", name, written.robot, "--format", "json").out)["tasks"]
        listed = [*list_records(written.tables(f"todo/{name}.html"), "What", "Where")]
        held.expect(f"todo/{name}.html", "tasks", len(listed), len(tasks))


def hold_matrix(held: Agreement, written: Written, sums: dict[str, list[str]], titles: set[str]) -> None:
    """Hold how many interfaces there are between two partners: in all places as many, and the sums of their rows."""
    matrix: dict[tuple[str, str], int] = {}
    for name in ("deliverable.docx", "partners.html"):
        for header, *rows in (table for table in written.tables(name) if table and {*table[0][1:]} <= titles):
            for row in rows if header[0] in {"", "Gives"} and len(header) > 1 else ():
                for taker, cell in zip(header[1:], row[1:], strict=True):
                    count = int(re.sub(r"\D", "", cell) or 0)
                    held.expect(name, f"{row[0]} to {taker}", count, matrix.setdefault((row[0], taker), count))
    for title, (gives, *_) in sums.items():
        count = sum(each for (giver, _), each in matrix.items() if giver == title)
        held.expect("sums", f"{title} gives", int((re.match(r"\d+", gives) or ["0"])[0]), count)


@pytest.mark.parametrize("seed", try_some([6, 1103, 4, 5, 1042, 1004], 1, 2))
def test_no_output_contradicts_another(run: Run, tmp_path: Path, seed: int) -> None:
    assert list_contradictions(run, write_outputs(run, tmp_path, seed)) == []


@pytest.mark.slow
@pytest.mark.hypothesis
def test_drawn_projects_say_the_same_everywhere(run: Run, tmp_path: Path) -> None:
    for seed in range(2000, 2060 if DRAWS_ANEW else 2008):
        written = write_outputs(run, tmp_path / str(seed), seed)
        assert (seed, list_contradictions(run, written)) == (seed, [])
