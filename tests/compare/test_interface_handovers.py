"""Interfaces that another partner gives, or takes, than before."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import cast

import pytest

from archgen.compare.boundary_changes import join_handovers
from archgen.compare.comparison import BoundaryChange, BoundaryKind, FigureChange, FigureKey
from archgen.timing.figures.timing_values import TimingValue


def read_changes(text: str) -> Iterator[BoundaryChange]:
    """Read `removed x a>b rate=10, added x c>b rate=5`; of what is removed the figures are those before."""
    for entry in text.split(", "):
        kind, name, ends, *figures = entry.split(" ")
        giver, taker = ends.split(">")
        yield BoundaryChange(
            cast("BoundaryKind", kind),
            name,
            None,
            (giver,),
            (taker,),
            tuple(_read_figure(figure, kind) for figure in figures),
            frozenset({giver, taker}),
        )


def _read_figure(text: str, kind: str) -> FigureChange:
    name, value = text.split("=")
    figure = TimingValue(Fraction(value))
    return FigureChange(FigureKey(name), *((figure, None) if kind == "removed" else (None, figure)))


def write_change(change: BoundaryChange) -> str:
    """Write a change with who gave and took it before, its figures, and whom it concerns."""
    ends = [
        "".join(part) + (f"(was {''.join(old)})" if old else "")
        for part, old in ((change.givers, change.old_givers), (change.takers, change.old_takers))
    ]
    figures = [f" {each.key.name}={_show(each.before)}..{_show(each.after)}" for each in change.figures]
    return f"{change.kind} {change.interface_id} {'>'.join(ends)}{''.join(figures)} {''.join(sorted(change.concerned_partners))}"


def _show(figure: object) -> str:
    return str(figure.value) if isinstance(figure, TimingValue) else "-"


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        # Another giver: one change, with the figures that differ.
        ("removed x a>b rate=10 gap=1, added x c>b rate=5 gap=1", ["changed x c(was a)>b rate=10..5 abc"]),
        ("added x c>b rate=5, removed x a>b rate=10", ["changed x c(was a)>b rate=10..5 abc"]),
        ("removed x a>b rate=10, added x c>b rate=10 gap=2", ["changed x c(was a)>b gap=-..2 abc"]),
        # Another taker.
        ("removed x a>b rate=10, added x a>c rate=5", ["changed x a>c(was b) abc"]),
        ("added x a>c rate=5, removed x a>b", ["changed x a>c(was b) abc"]),
        # Nothing of this: another interface, or both ends, or no counterpart.
        ("removed x a>b rate=10, added y c>b rate=5", ["removed x a>b ab", "added y c>b rate=-..5 bc"]),
        ("removed x a>b rate=10, added x c>d rate=5", ["removed x a>b ab", "added x c>d rate=-..5 cd"]),
        ("removed x a>b rate=10", ["removed x a>b ab"]),
        ("added x a>b rate=10", ["added x a>b rate=-..10 ab"]),
        ("changed x a>b rate=10", ["changed x a>b rate=-..10 ab"]),
        # Two who took it are gone, or two who take it came: nobody knows who came for whom.
        (
            "removed x a>b, removed x a>c, added x a>d",
            ["removed x a>b ab", "removed x a>c ac", "added x a>d ad"],
        ),
        ("removed x a>b, added x a>c, added x a>d", ["removed x a>b ab", "added x a>c ac", "added x a>d ad"]),
        # What stays beside it stays as it is.
        ("removed x a>b, changed x a>d rate=1, added x a>c", ["changed x a>d rate=-..1 ad", "changed x a>c(was b) abc"]),
        ("removed x a>b, changed x d>b rate=1, added x c>b", ["changed x d>b rate=-..1 bd", "changed x c(was a)>b abc"]),
    ],
)  # fmt: skip
def test_what_another_partner_gives_or_takes_is_one_change(changes: str, expected: list[str]) -> None:
    assert [write_change(change) for change in join_handovers(read_changes(changes))] == expected
