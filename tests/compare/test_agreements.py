"""Which entries of `review.accepted` excuse a break, and which speak of it and excuse nothing."""

from __future__ import annotations

import pytest

from archgen.compare.agreements import judge_agreements, names_change
from archgen.compare.comparison import Change, PartnerBreak
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics.source_span import Span
from archgen.model.review_settings import AcceptedChange

TYPE = Change("changed", "output", "g.a.x", key="type")
MATCHED = MatchedIds(old_ids={"partner": {"new": "old"}})


def read_entries(text: str) -> list[AcceptedChange]:
    """Read `PARTNER ELEMENT KEY REASON, ...`; `-` is no key, or no partner."""
    entries = []
    for words in (entry.split(" ") for entry in filter(None, text.split(", "))):
        partner, element, key, reason = ("" if word == "-" else word for word in words)
        file = f"review/{partner}.yaml" if partner else "archgen.yaml"
        entries.append(AcceptedChange(element, reason, key or None, Span.of_file(file)))
    return entries


@pytest.mark.parametrize(
    ("entry", "change", "expected"),
    [
        ("p g.a.x type ok", TYPE, True),
        ("p g.a.x - ok", TYPE, True),
        ("p g.a.x title ok", TYPE, False),
        ("p g.a.y type ok", TYPE, False),
        ("p g.a.x removed ok", Change("removed", "output", "g.a.x"), True),
        ("p g.a.x type ok", Change("removed", "output", "g.a.x"), False),
    ],
)
def test_an_entry_names_the_key_or_what_happened_or_nothing(entry: str, change: Change, expected: bool) -> None:  # noqa: FBT001
    (accepted,) = read_entries(entry)
    assert names_change(accepted, change) is expected


@pytest.mark.parametrize(
    ("entries", "partners", "agreements", "claims"),
    [
        (("", "p g.a.x type fine"), "p q", ["fine", None], []),
        (("", "p g.a.x type fine, q g.a.x type good"), "p q", ["fine", "good"], []),
        # Without a key, without a file of the partner's own, or from before: it excuses nothing.
        (("", "p g.a.x - fine"), "p", [None], ["fine"]),
        (("", "- g.a.x type fine"), "p", [None], ["fine"]),
        (("p g.a.x type fine", "p g.a.x type fine"), "p", [None], ["fine"]),
        (("p g.a.x type fine", "p g.a.x type fine, p g.a.x type anew"), "p", ["anew"], ["fine"]),
        (("", "p g.a.x - fine, p g.a.x type anew"), "p", ["anew"], ["fine"]),
        # Of another change, or of a partner whom it does not break.
        (("", "p g.a.y type fine"), "p", [None], []),
        (("", "q g.a.x type fine"), "p", [None], ["fine"]),
        # A partner who has another id now: its file is called as before.
        (("", "old g.a.x type fine"), "new", ["fine"], []),
        (("", "new g.a.x type fine"), "new", [None], ["fine"]),
    ],
)
def test_a_partner_agrees_in_its_own_file_to_this_change_alone(
    entries: tuple[str, str], partners: str, agreements: list[str | None], claims: list[str]
) -> None:
    breaks = [PartnerBreak(partner, "loses it") for partner in partners.split()]
    judged = judge_agreements(TYPE, breaks, (read_entries(entries[0]), read_entries(entries[1])), MATCHED)
    assert [each.agreement for each in judged.breaks] == agreements
    assert [claim.reason for claim in judged.claims] == claims
