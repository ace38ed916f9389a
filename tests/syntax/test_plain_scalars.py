"""Plain scalars by YAML 1.2's core schema."""

from __future__ import annotations

import math

import pytest

from archgen.syntax.yaml_tree import NON_TEXT_STARTS, resolve_scalar


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("no", "no"), ("on", "on"), ("Yes", "Yes"), ("off", "off"), ("1:30", "1:30"), ("2024-01-02", "2024-01-02"),
        ("true", True), ("False", False), ("~", None), ("null", None), ("nUll", "nUll"),
        ("12", 12), ("-3", -3), ("+3", 3), ("010", 10), ("0o17", 15), ("0x1F", 31), ("-0x1F", "-0x1F"), ("1_000", "1_000"),
        ("1e3", 1000.0), ("1.10", 1.1), (".5", 0.5), ("5.", 5.0), (".", "."), ("-", "-"), ("1e999", "1e999"),
        (".inf", math.inf), ("-.INF", -math.inf), ("9" * 30, int("9" * 30)), ("9" * 31, "9" * 31), ("٣", "٣"),
    ],
)  # fmt: skip
def test_value(text: str, value: object) -> None:
    found = resolve_scalar(text) if text[0] in NON_TEXT_STARTS else text
    assert (type(found), found) == (type(value), value)


def test_not_a_number() -> None:
    found = resolve_scalar(".nan")
    assert isinstance(found, float)
    assert math.isnan(found)
