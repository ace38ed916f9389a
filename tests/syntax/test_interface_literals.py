"""Values of constants and defaults in interface definitions."""

from __future__ import annotations

import pytest

from archgen.syntax.interface_literals import (
    FieldType,
    explain_bad_default,
    explain_bad_literal,
    integer_limits,
    read_field_type,
)


@pytest.mark.parametrize(
    ("type_name", "text", "ros1", "reason"),
    [
        ("int8", "-128", False, None),
        ("int8", "128", False, "int8 holds -128 to 127"),
        ("uint8", "0xFF", False, None),
        ("uint8", "0xFF", True, "an integer is needed, in base ten"),
        ("uint8", "007", False, None),
        ("uint8", "-0b1", False, "uint8 holds 0 to 255"),
        ("uint8", "1.0", False, "an integer is needed"),
        ("int64", "9" * 41, False, "an integer is needed"),
        ("byte", "-1", True, None),
        ("byte", "-1", False, "byte holds 0 to 255"),
        ("char", "-1", True, "char holds 0 to 255"),
        ("bool", "true", False, None),
        ("bool", "true", True, "a bool is `True` or `False`"),
        ("bool", "2", True, None),
        ("bool", "2", False, "a bool is `true` or `false`"),
        ("float32", "1e-3", False, None),
        ("float32", "0,5", False, "a number is needed, with a point for the decimals"),
        ("string", 'a "b"', False, None),
        ("string", '"a "b""', False, 'a quote inside is written `\\"`'),
        ("string", "'a \"b\"'", False, None),
        ("string", '"a "b""', True, None),
    ],
)
def test_a_literal_is_a_value_of_its_type(type_name: str, text: str, ros1: bool, reason: str | None) -> None:  # noqa: FBT001
    assert explain_bad_literal(type_name, text, None, ros1=ros1) == reason


@pytest.mark.parametrize(
    ("text", "reason"), [("'abcd'", None), ("'abcde'", "5 characters for a string of at most 4"), ('"ab\\"c"', None)]
)
def test_quotes_do_not_count_for_the_length_of_a_string(text: str, reason: str | None) -> None:
    assert explain_bad_literal("string", text, 4, ros1=False) == reason


@pytest.mark.parametrize(
    ("type_name", "text", "reason"),
    [
        ("int8", "3", None),
        ("int8[]", "[1, 2]", None),
        ("int8[]", "[]", None),
        ("int8[]", "1, 2", "an array's value stands in brackets, as in `[1, 2]`"),
        ("int8[]", "[", "an array's value stands in brackets, as in `[1, 2]`"),
        ("int8[]", "[1, x]", "an integer is needed"),
        ("int8[2]", "[1]", "1 values for an array of exactly 2"),
        ("int8[<=2]", "[1]", None),
        ("int8[<=2]", "[1, 2, 3]", "3 values for an array of at most 2"),
        ("string[]", "[\"a, b\", 'c']", None),
        ("string[2]", "[\"a, b\", 'c']", None),
        ("string[]", '["a]', "the strings of an array are separated by commas, and quotes are closed"),
        ("string<=2[]", "[ab, abc]", "3 characters for a string of at most 2"),
    ],
)
def test_a_default_fits_its_field(type_name: str, text: str, reason: str | None) -> None:
    field = read_field_type(type_name, "own", ros1=False)
    assert isinstance(field, FieldType)
    assert explain_bad_default(field, text) == reason


def test_limits_of_integers() -> None:
    assert integer_limits("uint16", ros1=False) == (0, 65535)
    assert integer_limits("int64", ros1=True) == (-(2**63), 2**63 - 1)
