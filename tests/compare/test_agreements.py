"""Which entries of `review.accepted` excuse a break, and which speak of it and excuse nothing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare.agreements import AgreementJudge, hash_change, names_change
from archgen.compare.comparison import Change, PartnerBreak
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts, name_author
from archgen.compare.version_pair import ConnectionMap, VersionPair
from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Partner
from archgen.model.project_settings import AcceptedChange, ReviewSettings
from archgen.project.project_loading import load_from_files
from archgen.syntax.project_files import OverlaidFiles

TYPE = Change("changed", "output", "g.a.x", key="type")
EMPTY = pipeline.judge_project(
    load_from_files(OverlaidFiles(Path(), {"archgen.yaml": b"archgen: 1"}), "archgen.yaml")
).architecture
NO_ENDS = ConnectionMap({}, {})
VERSIONS = VersionPair(NO_ENDS, NO_ENDS, {}, {})
PARTNERS = {
    "p": Partner("p", "P", reviewers=("@Paula", "paula@p.example")),
    "q": Partner("q", "Q", reviewers=("@quinn",)),
    "old": Partner("old", "Old"),
}
MATCHED = MatchedIds(old_ids={"partner": {"new": "old"}})


def read_entries(text: str) -> list[AcceptedChange]:
    """Read `PARTNER ELEMENT KEY REASON, ...`; `-` is no key, or no partner."""
    entries = []
    for words in (entry.split(" ") for entry in filter(None, text.split(", "))):
        partner, element, key, reason = ("" if word == "-" else word for word in words)
        file = f"review/{partner}.yaml" if partner else "archgen.yaml"
        entries.append(AcceptedChange(element, reason, key or None, Span.of_file(file)))
    return entries


def judge_between(
    old: list[AcceptedChange], new: list[AcceptedChange], facts: ReviewFacts | None = None
) -> AgreementJudge:
    """Make the judge of two versions that accept something; each has the partners p, q and old."""
    before, after = (
        replace(EMPTY, review=ReviewSettings(accepted=tuple(entries)), partners=PARTNERS) for entries in (old, new)
    )
    return AgreementJudge(before, after, MATCHED, VERSIONS, facts or ReviewFacts())


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
    judged = judge_between(read_entries(entries[0]), read_entries(entries[1])).judge(TYPE, breaks)
    assert [each.agreement for each in judged.breaks] == agreements
    assert [claim.reason for claim in judged.claims] == claims


HASH = hash_change(TYPE, VERSIONS)
OTHER = replace(TYPE, after="Other")
ENTRY = AcceptedChange("g.a.x", "fine", "type", Span.of_file("review/p.yaml"))


@pytest.mark.parametrize(
    ("entry", "facts", "flaw"),
    [
        (replace(ENTRY, was=HASH), ReviewFacts(), None),
        (replace(ENTRY, was="000000"), ReviewFacts(), "other change"),
        # Without a hash: what had changed when it was written, if anybody knows.
        (ENTRY, ReviewFacts(), None),
        (ENTRY, ReviewFacts(agreed_hashes=lambda _: {("g.a.x", "type"): hash_change(TYPE, VERSIONS)}), None),
        (ENTRY, ReviewFacts(agreed_hashes=lambda _: {("g.a.x", "type"): hash_change(OTHER, VERSIONS)}), "other change"),
        (ENTRY, ReviewFacts(agreed_hashes=lambda _: {}), "other change"),
        # Written by somebody else.
        (ENTRY, ReviewFacts((name_author("paula"),)), None),
        (ENTRY, ReviewFacts((name_author("quinn"),)), "other author"),
        (ENTRY, ReviewFacts((name_author("quinn"), name_author("paula"))), None),
        (ENTRY, ReviewFacts((name_author("quinn"),), agreement_authors={"review/p.yaml": (name_author(mail="1+Paula@users.noreply.github.com"),)}), None),
        (ENTRY, ReviewFacts((name_author("quinn"),), agreement_authors={"review/p.yaml": (name_author(mail="paula@p.example"),)}, trusts_mails=False), "other author"),
        (ENTRY, ReviewFacts(agreement_authors={"review/p.yaml": (name_author(mail="quinn@users.noreply.github.com"),)}), "other author"),
        (ENTRY, ReviewFacts(agreement_authors={"review/p.yaml": (name_author(mail="who@x.example"),)}), None),
    ],
)  # fmt: skip
def test_an_entry_holds_for_this_change_and_from_the_partner_itself(
    entry: AcceptedChange, facts: ReviewFacts, flaw: str | None
) -> None:
    judge = judge_between([], [entry], facts)
    judged = judge.judge(TYPE, [PartnerBreak("p", "loses it")])
    assert judge.find_flaw(entry, judged) == flaw
    assert judged.breaks[0].agreement == (None if flaw else "fine")
