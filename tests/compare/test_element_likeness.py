"""How alike two elements are, and which are taken for the same."""

from __future__ import annotations

import pytest

from archgen.compare.element_likeness import Feature, find_likely_pairs, letter_pairs, measure_likeness, word_set

NOTHING = Feature(5, frozenset())


def marks(text: str, weight: float = 3, *, generated: bool = False) -> Feature:
    return Feature(weight, frozenset(text.split()), generated)


def test_marks_are_pairs_of_letters_and_words() -> None:
    assert letter_pairs("Cam") == {"^c", "ca", "am", "m$"}
    assert letter_pairs("") == {"^$"}
    assert word_set("Sees the  Sea") == {"sees", "the", "sea"}
    assert word_set(None) == frozenset()


@pytest.mark.parametrize(
    ("one", "other", "likeness"),
    [
        ({"a": marks("x y")}, {"a": marks("x y")}, 3 / 4),  # the doubt weighs 1
        ({"a": marks("x y")}, {"a": marks("x z")}, 1 / 4),  # one mark of three is common
        ({"a": marks("x", 1)}, {"a": marks("x", 1)}, 1 / 2),
        ({"a": marks("x"), "b": NOTHING}, {"a": marks("x"), "b": NOTHING}, 3 / 4),
        ({"a": marks("x"), "b": NOTHING}, {"a": marks("x"), "b": marks("y", 5)}, 3 / 9),
        ({"a": marks("x"), "b": marks("y", 5)}, {"a": marks("x"), "b": NOTHING}, 3 / 9),
        ({"a": marks("x"), "b": marks("p", generated=True)}, {"a": marks("x"), "b": marks("q", generated=True)}, 3 / 4),
        ({"a": marks("x"), "b": marks("p")}, {"a": marks("x"), "b": marks("q", generated=True)}, 3 / 7),
        ({"a": marks("x"), "b": marks("p", generated=True)}, {"a": marks("x"), "b": marks("q")}, 3 / 7),
        ({}, {}, 0),
    ],
)
def test_likeness(one: dict[str, Feature], other: dict[str, Feature], likeness: float) -> None:
    assert measure_likeness(one, other) == pytest.approx(likeness)
    assert measure_likeness(other, one) == pytest.approx(likeness)


def table(text: str) -> dict[str, dict[str, Feature]]:
    """Read `id: marks; id: marks`."""
    return {name: {"f": marks(words)} for name, _, words in (entry.partition(": ") for entry in text.split("; "))}


@pytest.mark.parametrize(
    ("before", "after", "pairs"),
    [
        ("a: x y", "b: x y", [("a", "b", 0.75)]),
        ("a: x y", "b: x z", []),
        ("a: p q r s t", "b: p q r s", [("a", "b", 0.6)]),  # 3 * 4/5 / 4: just enough
        ("a: x y; b: x y z", "c: x y z", [("b", "c", 0.75)]),  # the surest first, each at most once
        ("a: x y", "b: x y; c: x y", [("a", "b", 0.75)]),  # a tie: the first by id
        ("c: x y; a: x y", "b: x y", [("a", "b", 0.75)]),
        ("b: x y", "c: x y; a: x y", [("b", "a", 0.75)]),
        ("b: x y; a: x y", "y: x y", [("a", "y", 0.75)]),
        ("y: x y; x: x y", "a: x y", [("x", "a", 0.75)]),
        ("a: x", "", []),
    ],
)
def test_pairs(before: str, after: str, pairs: list[tuple[str, str, float]]) -> None:
    sides = table(before), table(after) if after else {}
    assert list(find_likely_pairs(*sides)) == pairs
    assert sorted((new, old, sure) for old, new, sure in find_likely_pairs(*sides[::-1])) == sorted(pairs)


def test_confidence_is_cut_not_rounded() -> None:
    nearly = {"f": Feature(299, frozenset({"x"}))}
    assert list(find_likely_pairs({"a": nearly}, {"b": nearly})) == [("a", "b", 0.99)]


def test_among_many_only_those_with_a_rare_mark_are_compared() -> None:
    def many(prefix: str, count: int, common: str) -> dict[str, dict[str, Feature]]:
        return {f"{prefix}{n}": {"f": marks(f"{common} own{n}")} for n in range(count)}

    # 9 * 9 pairs are more than 64, and share the common mark: `own1` of both is found by its own mark.
    found = list(find_likely_pairs(many("a", 9, "x y z p q r"), many("b", 9, "x y z p q r")))
    assert {(old, new) for old, new, _ in found} == {(f"a{n}", f"b{n}") for n in range(9)}
    # Without a mark of their own they are not compared at all.
    same = {f"a{n}": {"f": marks("x y")} for n in range(9)}
    assert list(find_likely_pairs(same, {name.replace("a", "b"): each for name, each in same.items()})) == []
    # 8 * 8 are all compared, and a mark that 64 pairs share still counts among more of them.
    eight = dict(list(same.items())[:8])
    assert len(list(find_likely_pairs(eight, {name.replace("a", "b"): each for name, each in eight.items()}))) == 8
    five = dict(list(same.items())[:5])
    thirteen = {f"b{n}": {"f": marks("x y")} for n in range(13)}
    assert list(find_likely_pairs(five, thirteen)) == []
    more = {"c": {"f": marks("other")}}
    assert len(list(find_likely_pairs(eight | more, {f"b{n}": {"f": marks("x y")} for n in range(8)}))) == 8


@pytest.mark.parametrize(
    ("one", "other", "likeness"),
    [
        ("p q", "p q", 0.99),  # all that both hold
        ("p q r", "p q", 2 / 3),  # two of three
        ("p q", "p q r", 2 / 3),
        ("p q", "p r s", 5 * 1 / 4 / 6),  # one alone decides nothing
        ("p", "p", 5 / 6),
        ("p q", "r s", 0),
    ],
)
def test_a_decisive_feature_decides_where_both_hold_two_of_the_same(one: str, other: str, likeness: float) -> None:
    sides = [{"holds": Feature(5, frozenset(text.split()), decisive=True)} for text in (one, other)]
    assert measure_likeness(*sides) == pytest.approx(likeness)


@pytest.mark.parametrize(
    ("before", "after", "confidences"),
    [
        # The same in all but its name, and enough of it.
        ("a: n=a x=1 y=2", "b: n=b x=1 y=2", [("a", "b", 0.99)]),
        ("a: n=a x=1", "b: n=b x=1", []),
        ("a: n=a x=1 y=2 z=", "b: n=b x=1 y=2 z=", [("a", "b", 0.99)]),
        # What is said of neither weighs nothing; with a rival on either side nobody is certain.
        ("a: n=a x=1 y= z=", "b: n=b x=1 y= z=", []),
        ("a: n=a x=1 y=2", "b: n=b x=1 y=2; c: n=c x=1 y=2", [("a", "b", 0.6)]),
        ("a: n=a x=1 y=2; c: n=c x=1 y=2", "b: n=b x=1 y=2", [("a", "b", 0.6)]),
        ("a: n=a x=1 y=2 z=3", "b: n=b x=1 y=2 z=4", []),
    ],
)
def test_who_is_the_same_in_all_but_the_name_is_certain(
    before: str, after: str, confidences: list[tuple[str, str, float]]
) -> None:
    """Each feature weighs 3: two and the doubt of 1 and the name that differs are 6 / 10."""
    assert list(find_likely_pairs(_read_named(before), _read_named(after))) == confidences


def _read_named(text: str) -> dict[str, dict[str, Feature]]:
    elements = {}
    for name, _, words in (entry.partition(": ") for entry in text.split("; ")):
        pairs = (word.partition("=") for word in words.split())
        elements[name] = {{"n": "name"}.get(key, key): marks(value) for key, _, value in pairs}
    return elements
