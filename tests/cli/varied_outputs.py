"""What the outputs of a project say, read as people read them, and held against one another."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import lxml.html
import pytest
from lxml import etree

_WORD = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
_FACTORS: dict[str, int | Fraction] = {
    "ns": 1,
    "us": 10**3,
    "µs": 10**3,
    "ms": 10**6,
    "s": 10**9,
    "Hz": 1,
    "kHz": 1000,
    "%": Fraction(1, 100),
}
_FIGURE = re.compile(r"(>=|≥|at least|<=|≤)?\s*~?([0-9.]+)\s?(ns|us|µs|ms|s|Hz|kHz|%)(?![\w/])")
Rows = list[list[str]]


def read_words(element: Any) -> str:  # noqa: ANN401 - an element of lxml
    """Return the words of an element, chips and bars as what they say to a screen reader."""
    said = [element.text or ""]
    for child in element:
        said += ["\n" if child.tag == "br" else "", read_words(child), child.tail or ""]
    return "".join(said)


def list_html_tables(text: str) -> Iterator[Rows]:
    """Yield the tables of a page."""
    for table in lxml.html.fromstring(text).iter("table"):
        yield [[_fold(read_words(cell)) for cell in row if cell.tag in {"td", "th"}] for row in table.iter("tr")]


def list_word_tables(data: bytes) -> Iterator[Rows]:
    """Yield the tables of a Word document."""
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        document = etree.fromstring(package.read("word/document.xml"))
    for table in document.iter(f"{_WORD}tbl"):
        yield [[_read_paragraphs(cell) for cell in row.iter(f"{_WORD}tc")] for row in table.iter(f"{_WORD}tr")]


def _read_paragraphs(cell: Any) -> str:  # noqa: ANN401 - as above
    breaks = {f"{_WORD}p", f"{_WORD}br"}
    return _fold("".join(" " if each.tag in breaks else each.text or "" for each in cell.iter()))


def list_sheet_tables(path: Path) -> Iterator[Rows]:
    """Yield the sheets of a workbook; where a sheet holds several tables the columns of all stand in its first row."""
    openpyxl = pytest.importorskip("openpyxl")
    for sheet in openpyxl.load_workbook(path):
        yield [["" if cell is None else _fold(str(cell)) for cell in row] for row in sheet.iter_rows(values_only=True)]


def list_slide_tables(path: Path) -> Iterator[Rows]:
    """Yield the tables of slides."""
    pptx = pytest.importorskip("pptx")
    for slide in pptx.Presentation(str(path)).slides:
        for shape in slide.shapes:
            if shape.has_table:
                yield [[_fold(cell.text) for cell in row.cells] for row in shape.table.rows]


def list_markdown_tables(text: str) -> Iterator[Rows]:
    """Yield the tables of a comment."""
    for block in re.findall(r"(?m)(?:^\|.*\n)+", text):
        rows = [
            [re.sub(r"[*`\\]|&#8203;|\[|\]\([^)]*\)", "", cell).strip() for cell in line.strip("|").split(" | ")]
            for line in block.splitlines()
        ]
        yield [rows[0], *rows[2:]]


def _fold(text: str) -> str:
    return " ".join(text.split())


def list_records(tables: Iterator[Rows], *titles: str) -> Iterator[dict[str, str]]:
    """Yield the rows of the tables that have columns of such titles, by title; figures with the unit that their column's title has."""
    for header, *rows in (table for table in tables if table):
        names = [title.partition(",")[0] for title in header]
        if set(titles) <= set(names):
            for row in rows:
                if len(row) == len(header):
                    yield {
                        name: re.sub("([0-9.]+)", rf"\1 {title.partition(', ')[2]}", cell, count=1)
                        if ", " in title
                        else cell
                        for name, title, cell in zip(names, header, row, strict=True)
                    }


def read_figure(text: str) -> tuple[str, Fraction] | None:
    """Return the sign of the first figure of a text, and what it says in ns, Hz or as a share."""
    found = _FIGURE.search(text)
    if not found:
        return None
    sign = {">=": ">", "≥": ">", "at least": ">", "<=": "<", "≤": "<"}.get(found[1] or "", "")
    return sign, Fraction(found[2]) * Fraction(_FACTORS[found[3]])


class Agreement:
    """Collects what contradicts what."""

    def __init__(self, timing: dict[str, Any]) -> None:
        self.timing = timing
        self.faults: list[str] = []

    def expect(self, source: str, what: str, said: object, known: object) -> None:
        """Hold what an output says against what is known."""
        if said != known:
            self.faults.append(f"{source}: {what}: said {said!r}, known {known!r}")

    def hold_time(self, source: str, text: str, value: dict[str, Any], factor: int = 10**6, digits: int = 90) -> None:
        """Hold a written figure against an exact one (ms, or Hz with another factor): its sign, and its safe side."""
        read = read_figure(text)
        if value["value"] is None or (not value["value"] and not value["complete"]):
            if read is not None:
                self.faults.append(f"{source}: said {text!r}, known {value}")
            return
        if read is None:
            self.faults.append(f"{source}: said {text!r}, known {value}")
            return
        exact = Fraction(value["value"]) * factor
        sign, said = read
        is_least = value.get("side") == "at least" or (not value["complete"] and value.get("side") != "at most")
        if (sign == ">") != is_least or abs(said - exact) > exact / digits + Fraction(1, 10**4):
            self.faults.append(f"{source}: said {text!r}, known {value}")
        elif factor == 10**6 and (
            said > exact * Fraction(1000001, 1000000) + 1 if is_least else said < exact * Fraction(999999, 1000000) - 1
        ):
            self.faults.append(f"{source}: unsafe side: said {text!r}, known {value}")

    def hold_chains(
        self, source: str, records: Iterator[dict[str, str]], names: dict[str, str], *, is_whole: bool = False
    ) -> None:
        """Hold rows of chains against the analysis: figure, deadline, verdict."""
        seen = set()
        for record in records:
            title = record.get("Chain") or record.get("Chain that passes through it") or record.get("chain") or ""
            if title not in names:
                continue
            chain = self.timing["chains"][names[title]]
            seen.add(names[title])
            where = f"{source} {names[title]}"
            verdict = (record.get("Verdict") or record.get("verdict") or "").partition(" (was")[0]
            self.hold_verdict(where, verdict, chain)
            for column in ("At the latest", "Expected at the latest", "after"):
                if column in record:
                    self.hold_time(f"{where} {column}", record[column], chain["bound"])
            if "At the earliest" in record and read_figure(record["At the earliest"]):
                best = chain["best"]
                said = read_figure(record["At the earliest"])
                if (
                    best["value"] is None
                    or said is None
                    or said[1] > Fraction(best["value"]) * 10**6 * Fraction(1000001, 1000000) + 1
                ):
                    self.faults.append(f"{where}: earliest {record['At the earliest']!r}, known {best}")
            if "Deadline" in record:
                deadline = chain["deadline"]
                if (read := read_figure(record["Deadline"])) or deadline:
                    self.expect(where, "deadline", read and read[1], deadline and Fraction(str(deadline)) * 10**6)
        if is_whole:
            self.expect(source, "chains", seen, set(self.timing["chains"]))

    def hold_verdict(self, where: str, said: str, chain: dict[str, Any]) -> None:
        """Hold a written verdict against the analysis; a chain without a deadline has none."""
        known = chain["verdict"] if chain["deadline"] else ""
        shown = next(
            (word for word in ("met", "missed", "not proven", "open", "no deadline") if said.lower().startswith(word)),
            said,
        )
        if not chain["deadline"] and shown in {"", "no deadline", "without a deadline"}:
            return
        if shown != known and not (shown.startswith("seen +") and known == "missed"):
            self.faults.append(f"{where}: verdict {said!r}, known {known!r}")
