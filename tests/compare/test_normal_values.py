"""Values in normal form: what reads alike is equal, what differs in meaning is not."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.compare.normal_values import (
    BooleanValue,
    ElementTitle,
    is_unset,
    normalize_text,
    normalize_title,
    parameter_leaves,
    to_plain_data,
)
from archgen.model.quantity import Quantity


@pytest.mark.parametrize(
    ("written", "normal"),
    [
        (None, None),
        ("", None),
        ("  ", None),
        ("  one line ", "one line"),
        ("one\ntwo", "one\ntwo"),
        ("one  \r\ntwo\t\rthree\n\n", "one\ntwo\nthree"),
        ("one\rtwo ", "one\ntwo"),
        ("one  \ntwo", "one\ntwo"),
        ("ä ", "ä"),
        ("\n \n", None),
        ("é\u00a0", "é"),
        ("  indented\n    more", "indented\n    more"),
    ],
)
def test_texts(written: str | None, normal: str | None) -> None:
    assert normalize_text(written) == normal


def test_a_title_made_from_the_id_is_generated_even_if_written() -> None:
    assert normalize_title("front_camera", "Front Camera") == ElementTitle("Front Camera", generated=True)
    assert normalize_title("front_camera", "front_camera") == ElementTitle("front_camera", generated=True)
    assert normalize_title("front_camera", "Eye") == ElementTitle("Eye", generated=False)


def test_keys_without_a_value_are_dropped_but_not_those_that_are_false_or_zero() -> None:
    values: dict[str, object] = {"a": None, "b": (), "c": frozenset(), "d": 0, "e": False, "f": "", "g": ("x",)}
    assert [key for key, value in values.items() if not is_unset(value)] == ["d", "e", "f", "g"]


def test_parameters_become_their_leaves() -> None:
    parameter = {
        "on": True,
        "empty": {},
        "list": [1, [True]],
        "none": None,
        "no": [],
        "deep": {"x": 1.5},
        "m": [{"a": 1}],
    }
    assert dict(parameter_leaves("p", parameter)) == {
        "p.on": BooleanValue(is_true=True),
        "p.empty": "{}",
        "p.list": (1, (BooleanValue(is_true=True),)),
        "p.none": "null",
        "p.no": "[]",
        "p.deep.x": 1.5,
        "p.m": ((("a", 1),),),
    }
    assert dict(parameter_leaves("p", 1)) == {"p": 1}


def test_true_is_not_one() -> None:
    assert dict(parameter_leaves("p", {"on": True})) != dict(parameter_leaves("p", {"on": 1}))


@pytest.mark.parametrize(
    ("value", "plain"),
    [
        (Quantity(Fraction(1), "1 ms"), "1 ms"),
        (ElementTitle("T", generated=True), "T"),
        (Fraction(4, 2), 2),
        (Fraction(1, 2), 0.5),
        (frozenset({"b", "a"}), ["a", "b"]),
        (BooleanValue(is_true=False), False),
        ((Fraction(3), ("x",)), [3, ["x"]]),
        ("text", "text"),
        (None, None),
    ],
)
def test_plain_data(value: object, plain: object) -> None:
    found = to_plain_data(value)
    assert (found, type(found)) == (plain, type(plain))
