"""The numbers that tables sort by: each figure of the case study has one, in the base unit of its column."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest

from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.views.pages import site_pages
from archgen.views.shapes import Inlines, Page, Section, Table
from tests.judged_projects import judge_ramcip

ROOT = Path(__file__).resolve().parents[2]
FIGURE = re.compile(
    r"(?:[<>]= |at most )?([0-9.]+)[ \u00a0](ns|us|ms|s|min|h|Hz|kHz|[kMG]?B|[kMG]?B/s|[kMG]?bit/s|%)( \(computed\))?"
)
UNITS = {"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9, "min": 60 * 10**9, "h": 3600 * 10**9, "Hz": 1, "kHz": 1000}
UNITS |= {"B": 1, "kB": 10**3, "MB": 10**6, "GB": 10**9, "B/s": 1, "kB/s": 10**3, "MB/s": 10**6, "GB/s": 10**9}
UNITS |= {"bit/s": 1, "kbit/s": 10**3, "Mbit/s": 10**6, "Gbit/s": 10**9}


@pytest.fixture(scope="module")
def pages() -> tuple[Page, ...]:
    views = project_views.make_views(judge_ramcip(), OutputOptions(revision="test"))
    return tuple(site_pages.make_pages(views.lookup, views.edition))


def _list_tables(section: Section) -> Iterator[Table]:
    yield from (block for block in section.blocks if isinstance(block, Table))
    for inner in section.sections:
        yield from _list_tables(inner)


def _read(cell: Inlines) -> str:
    return "".join(run.text for run in cell)


def test_each_figure_of_the_site_has_the_number_that_it_shows(pages: tuple[Page, ...]) -> None:
    wrong, count = [], 0
    for table in (table for page in pages for table in _list_tables(page.section)):
        for cell in (cell for row in table.rows for cell in row):
            figure = FIGURE.fullmatch(_read(cell))
            if figure is None:
                continue
            count += 1
            factor = Fraction(1, 100) if figure[2] == "%" else Fraction(UNITS[figure[2]])
            shown, number = Fraction(figure[1]) * factor, next((run.sort_number for run in cell if run.sort_number), "")
            # What is shown is rounded to three digits, what it is sorted by is exact.
            if not number or abs(Fraction(number) - shown) > abs(shown) / 100:
                wrong.append((table.anchor, _read(cell), number))
    assert wrong == []
    assert count > 400, count


@pytest.mark.parametrize(
    ("anchor", "column", "first", "last"),
    [
        ("table:chains", 4, "20 ms", "60 s"),
        ("table:periods", 0, "up to 10 ms", "on demand"),
        ("table:links", 3, "60 us to 20 ms", "60 us to 20 ms"),
        ("table:types", 2, "5 B (computed)", ""),
    ],
)
def test_columns_sort_by_quantity_and_what_has_none_comes_last(
    pages: tuple[Page, ...], anchor: str, column: int, first: str, last: str
) -> None:
    table = next(table for page in pages for table in _list_tables(page.section) if table.anchor == anchor)
    numbers = [
        (Fraction(run.sort_number), _read(row[column]))
        for row in table.rows
        for run in row[column]
        if run.sort_number is not None
    ]
    unknown = [_read(row[column]) for row in table.rows if not any(run.sort_number for run in row[column])]
    ordered = [text for _, text in sorted(numbers)] + unknown
    assert (ordered[0], ordered[-1]) == (first, last)
