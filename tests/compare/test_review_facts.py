"""For whom people stand: their own partner, not another one; and where nobody can say."""

from __future__ import annotations

import pytest

from archgen.compare.review_facts import ReviewFacts, name_author
from archgen.model.architecture import Partner

PARTNERS = {
    name: Partner(name, name, reviewers=reviewers)
    for name, reviewers in {
        "people": ("@Paula", "paula@p.example"),
        "others": ("@quinn",),
        "team": ("@o/team",),
        "mixed": ("@o/team", "@mia"),
        "mails": ("mara@m.example",),
        "nobody": (),
    }.items()
}


@pytest.mark.parametrize(
    ("login", "mail", "expected"),
    [
        ("paula", "", "people"),
        ("PAULA", "", "people"),
        ("", "Paula@p.example", "people"),
        ("", "12345+paula@users.noreply.github.com", "people"),
        ("", "7-quinn@users.noreply.gitlab.com", "others"),
        ("mia", "", "mixed"),
        ("", "mara@m.example", "mails"),
        ("stranger", "", ""),
    ],
)
def test_a_person_stands_for_one_partner(login: str, mail: str, expected: str) -> None:
    people = (name_author(login, mail),)
    facts = ReviewFacts(people) if login else ReviewFacts(authors=people)
    assert [name for name in PARTNERS if facts.stands_for(name, PARTNERS)] == [name for name in (expected,) if name]


@pytest.mark.parametrize(
    ("facts", "unknown"),
    [
        # A forge knows accounts: who has none of those named is somebody else.
        (ReviewFacts((name_author("stranger"),)), ["team", "mixed", "mails", "nobody"]),
        (ReviewFacts((name_author("paula"),)), []),
        # What address is whose nobody knows.
        (ReviewFacts(authors=(name_author(mail="who@x.example"),)), list(PARTNERS)),
        (ReviewFacts(authors=(name_author(mail="paula@p.example"),)), []),
        (ReviewFacts(), list(PARTNERS)),
        # Somebody else opened the request.
        (ReviewFacts((name_author("quinn"), name_author("paula"))), ["others"]),
        (ReviewFacts((name_author("paula"), name_author("quinn"))), ["people"]),
        (ReviewFacts(authors=(name_author(mail="paula@p.example"), name_author(mail="mara@m.example"))), ["people", "mails"]),
    ],
)  # fmt: skip
def test_what_nobody_can_say(facts: ReviewFacts, unknown: list[str]) -> None:
    assert [name for name in PARTNERS if facts.stands_for(name, PARTNERS) is None] == unknown
