"""Which texts mean the same."""

from __future__ import annotations

import pytest

from archgen.compare.text_meaning import differs_in_meaning, differs_in_measures, quote_difference


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("Offsets in metres", "offsets in  metres."),
        ("m, positive to the left", "[m] Positive, to the left"),
        ("The frame is base_link", "the frame is `base_link`"),
        ("A right-handed frame", "a right handed frame"),
        ("in m;\nat most 3", "In m: at most 3"),
        ("", ". - !"),
        ("Stops! (See 1, and 2.)", "stops, see 1 and 2"),
        ("[0,  1) m", "[0,1) m"),
    ],
)
def test_how_a_text_is_written_changes_nothing(before: str, after: str) -> None:
    assert not differs_in_meaning(before, after)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("in m", "in mm"),
        ("mW", "MW"),
        ("range 1.0", "range 10"),
        ("range 1.5", "range 15"),
        ("+x to the front", "-x to the front"),
        ("from -1 to 1", "from 1 to 1"),
        ("x < y", "x > y"),
        ("50 %", "50"),
        ("m/s", "m*s"),
        ("in m", ""),
        ("frame base_link", "frame base link"),
        ("valid if != 0", "valid if = 0"),
        ("valid if != 0", "valid if == 0"),
        ("sent if !busy", "sent if busy"),
        ("in [0, 1)", "in (0, 1]"),
        ("in [0, inf)", "in [0, inf]"),
        ("in ]-1; \u03c0]", "in [-1; \u03c0]"),
        ("~5 cm", "5 cm"),
        ("a | b", "a & b"),
        ("x + 1", "x - 1"),
        ("Größe in µm", "Größe in nm"),
    ],
)
def test_units_signs_and_numbers_change_what_a_text_means(before: str, after: str) -> None:
    assert differs_in_meaning(before, after)
    assert differs_in_meaning(after, before)


@pytest.mark.parametrize(
    ("before", "after", "differs"),
    [
        ("Finds persons, in metres", "Looks for people, in metres", False),
        ("Finds persons, in metres", "Finds persons, in feet", True),
        ("Finds persons", "Finds persons in millimetres", True),
        ("Finds 20 persons", "Finds 5 persons", False),
        ("Finds persons up to 20 m", "Finds persons up to 5 m", True),
        ("Turns along +x", "Turns along -x", True),
        ("Finds a person", "Finds the person", False),
    ],
)
def test_only_measures_count_in_a_text_that_says_much_else(before: str, after: str, *, differs: bool) -> None:
    assert differs_in_measures(before, after) is differs


def test_a_difference_is_quoted_with_the_words_around_it() -> None:
    lead = "one two three four five"
    assert quote_difference(f"{lead} in m", f"{lead} in mm now") == ("… four five in m", "… four five in mm now")
    assert quote_difference("in m", "in m and s") == ("in m", "in m and s")
    long = " ".join(map(str, range(20)))
    assert quote_difference(f"a {long}", f"b {long}")[0] == "a 0 1 2 3 4 5 6 7 8 9 10 …"
    assert quote_difference("a\nb", "a\tc") == ("a b", "a c")
