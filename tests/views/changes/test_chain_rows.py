"""Rows of the table of chains: what made a bound another."""

from __future__ import annotations

import pytest

from archgen.compare import ChainChange, Change
from archgen.views.changes.figure_lines import make_chain_row


@pytest.mark.parametrize(
    ("kind", "element", "key", "reason"),
    [
        ("component", "a.b", "timing.rate", "`a.b` (rate)"),
        ("component", "a.b", None, "`a.b` (changed)"),
        ("chain", "see", "through", "where it leads now"),
        ("chain", "halt", "through", "`halt` (through)"),
    ],
)
def test_a_chain_is_no_reason_for_itself(kind: str, element: str, key: str | None, reason: str) -> None:
    change = Change("changed", kind, element, key=key)
    assert make_chain_row(ChainChange("see", None, None, (change,))).reason == reason
