"""What the user decides when starting a project, as it is typed."""

from __future__ import annotations

import re

import pytest

from archgen.start import start_answers
from archgen.start.start_answers import GroupAnswer, PartnerAnswer

CERTH = PartnerAnswer("certh", "CERTH-ITI", "@certh/robotics")


@pytest.mark.parametrize(
    ("text", "partner"),
    [
        ("certh=CERTH-ITI @certh/robotics", CERTH),
        ("certh", PartnerAnswer("certh", "Certh")),
        ("CERTH ITI", PartnerAnswer("certh_iti", "CERTH ITI")),
        ("certh a@b.org", PartnerAnswer("certh", "Certh", "a@b.org")),
        ("@certh", PartnerAnswer("certh", "@certh")),
        ("robo corp = RoboCorp", PartnerAnswer("robo_corp", "RoboCorp")),
        ("Certh=CERTH", PartnerAnswer("certh", "CERTH")),
        ("Müller GmbH", PartnerAnswer("mueller_gmbh", "Müller GmbH")),
    ],
)
def test_a_partner_is_an_id_a_title_and_a_handle_and_any_may_be_missing(text: str, partner: PartnerAnswer) -> None:
    assert start_answers.parse_partner(text) == partner


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "a partner has a name"),
        ("=Title", "a partner has a name"),
        ("certh @a/", "'@a/' is no handle: write @user, @organisation/team or an e-mail address"),
    ],
)
def test_what_is_no_partner_says_what_to_write(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=f"^{re.escape(said)}$"):
        start_answers.parse_partner(text)


@pytest.mark.parametrize(
    ("text", "group"),
    [
        ("perception=certh", GroupAnswer("perception", "Perception", "certh")),
        ("Motion planning", GroupAnswer("motion_planning", "Motion planning")),
        ("perception", GroupAnswer("perception", "Perception")),
    ],
)
def test_a_group_may_have_an_owner(text: str, group: GroupAnswer) -> None:
    assert start_answers.parse_group(text, [CERTH]) == group


def test_a_group_belongs_to_a_partner_who_is_named() -> None:
    with pytest.raises(ValueError, match=r"'sssa' is no partner's id \(certh\)"):
        start_answers.parse_group("perception=sssa", [CERTH])
    with pytest.raises(ValueError, match=r"\(none is named with --partner\)"):
        start_answers.parse_group("perception=sssa", [])


def test_two_of_a_kind_need_two_ids() -> None:
    start_answers.require_distinct([CERTH, PartnerAnswer("sssa", "CERTH-ITI")], "partner")
    with pytest.raises(ValueError, match="two partners have the id 'certh'"):
        start_answers.require_distinct([CERTH, PartnerAnswer("certh", "Other")], "partner")


def test_partners_of_a_table_do_not_replace_those_that_were_typed() -> None:
    given = start_answers.collect_answers("robot")
    both = start_answers.add_partners(given, {"certh": "First"})
    assert start_answers.add_partners(both, {"certh": "Second", "sssa": "S"}).partners == (
        PartnerAnswer("certh", "First"),
        PartnerAnswer("sssa", "S"),
    )


def test_a_folder_and_words_that_are_no_utf_8_become_texts_that_can_be_written() -> None:
    """As Python names them: a byte that is no UTF-8 is a lone surrogate."""
    answers = start_answers.collect_answers("\udcff", title="r\udcfe", partners=["lab=Lab\udcff"])
    assert (answers.title, answers.partners[0].title) == ("r?", "Lab?")
    assert start_answers.collect_answers("my \udcff").title == "my ?"
