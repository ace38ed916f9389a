"""Which changes come first: those that need an answer most."""

from __future__ import annotations

import pytest

from archgen.compare.breaking_changes import _rank_change as rank_change
from archgen.compare.comparison import Change, PartnerBreak
from archgen.diagnostics.diagnostic import Severity
from archgen.model.project_settings import BreakCategory, BreakPolicy

POLICY = BreakPolicy(wire=Severity.ERROR, promise=Severity.WARNING)
CHANGES: dict[str, tuple[tuple[BreakCategory, str | None], ...]] = {
    "breaks a wire": (("wire", None),),
    "breaks a promise": (("promise", None),),
    "breaks both": (("promise", None), ("wire", None)),
    "breaks a wire, agreed": (("wire", "Yes"),),
    "breaks a promise, agreed": (("promise", "Yes"),),
    "breaks nobody": (),
}


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("breaks a wire", "breaks a promise"),
        ("breaks a promise", "breaks a wire, agreed"),
        ("breaks both", "breaks a promise"),
        ("breaks a wire, agreed", "breaks a promise, agreed"),
        ("breaks a promise, agreed", "breaks nobody"),
    ],
)
def test_what_needs_an_answer_most_comes_first(first: str, second: str) -> None:
    ranks = [
        rank_change(
            Change(
                "removed",
                "output",
                "x",
                breaks=tuple(
                    PartnerBreak("p", "loses it", agreement, category) for category, agreement in CHANGES[name]
                ),
            ),
            POLICY,
        )
        for name in (first, second)
    ]
    assert ranks[0] < ranks[1]
