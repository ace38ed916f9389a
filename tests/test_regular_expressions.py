"""No regular expression of the package takes more than linear time: a text that is twice as long takes twice the time."""

import json
import re
import time
from collections.abc import Iterator
from typing import Any

import pytest

from tests.property_sizes import try_some
from tests.regular_expressions import (
    ENDINGS,
    ROOT,
    Expression,
    list_attacks,
    list_expressions,
    list_made_expressions,
)

LENGTH = 4000
SECONDS_OF_LINEAR = 0.02
"""A linear expression takes a tenth of a millisecond for so many characters, a quadratic one 40 and more."""
SCHEMA = "of the schema, which is tried below"
SIZES = (16, 24, 32, 48, 64, 96, 128, 250, 1000)
"""So near one another that one that doubles with each character is found out before it takes a day."""
PARTS = 40

MADE = {
    "archgen/compare/losses/parted_ends.py:_find_mentions": "a name between bounds of words",
    "archgen/derivation/parameter_names.py:_list_bindings": "of the shipped library's files, no input",
    "archgen/emit/term_mentions.py:_compile_terms": "names between bounds of words",
    "archgen/emit/workspace/cpp_fields.py:_find_answers": "a name behind a word, and another one at most 300 characters behind it",
    "archgen/emit/workspace/cpp_fields.py:find_field": "names of messages and of what is declared with them, taken for good",
    "archgen/emit/workspace/own_code.py:_find_changed_messages": "a name, and another one at most 1,000 characters behind it",
    "archgen/emit/workspace/own_code.py:_find_lost_parameters": "names between bounds of words",
    "archgen/emit/workspace/own_code.py:_holds_phrase": "a name between bounds of words",
    "archgen/emit/workspace/run_record.py:_rename_packages": "a name behind a slash, and one sign",
    "archgen/emit/workspace/run_record.py:take_over_runs": "a name at the beginning, and one sign",
    "archgen/link/report_chapters.py:_locate_picture": "a path behind one sign",
    "archgen/plugins/ros/workspace/node_components.py:_leave_out_filed": "names of parameters, with what stands for one in them",
    "archgen/plugins/ros/workspace/node_components.py:_note_other_topics": "the same",
    "archgen/plugins/tables/table_files.py:_add_rows": "one set of characters, taken for good",
    "archgen/project/source_reading.py:_looks_like_slice": "known words at the beginning of a line",
    "archgen/schema/key_wording.py:diagnose_wrong_key": SCHEMA,
    "archgen/schema/schema_wording.py:split_ids": SCHEMA,
    "archgen/schema/schema_wording.py:_describe_wrong_value": SCHEMA,
    "archgen/schema/schema_wording.py:_find_list_help": SCHEMA,
    "archgen/schema/schema_wording.py:_find_value_help": SCHEMA,
    "archgen/schema/schema_wording.py:_suggest_message": SCHEMA,
    "archgen/syntax/file_patterns.py:_character_class": "one set of characters",
    "archgen/syntax/file_patterns.py:_compile_path": "tests/syntax/test_file_patterns.py tries what is slow elsewhere",
    "archgen/syntax/interface_literals.py:_explain_bad_string": "a quote",
}
"""Functions that make expressions of what they are given, each with why no text makes it slow."""


def find_slow_text(expression: Expression, length: int = LENGTH) -> str | None:
    """Find a text on which an expression takes longer than linear ones do: what repeats, with what stands before and after."""
    for beginning, pump in list_attacks(expression.pattern):
        for ending in ENDINGS:
            for method in [name for name in expression.methods if name != "compile"] or ["fullmatch"]:
                for size in (*SIZES, length):
                    text = beginning + pump * max(1, size // len(pump)) + ending
                    if not is_quick(expression.pattern, method, text):
                        return f"{method} of {beginning!r} + {pump!r} * {size // len(pump)} + {ending!r}"
    return None


def is_quick(pattern: re.Pattern[Any], method: str, text: str) -> bool:
    # Once more, since the first time may be the one in which other things happened.
    return any(time_of(pattern, method, text) < SECONDS_OF_LINEAR for _ in range(3))


def time_of(pattern: re.Pattern[Any], method: str, text: str) -> float:
    given: Any = text.encode() if isinstance(pattern.pattern, bytes) else text
    start = time.process_time()
    if method in ("sub", "subn"):
        getattr(pattern, method)(given[:0], given)
    elif method == "finditer":
        for _ in pattern.finditer(given):
            pass
    else:
        getattr(pattern, method)(given)
    return time.process_time() - start


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_expressions_are_linear(part: int) -> None:
    slow = {expression.place: find_slow_text(expression) for expression in list_expressions()[part::PARTS]}
    assert not {place: text for place, text in slow.items() if text}


def list_patterns(part: object) -> Iterator[str]:
    if isinstance(part, dict):
        if isinstance(part.get("pattern"), str):
            yield part["pattern"]
        if isinstance(part.get("patternProperties"), dict):
            yield from part["patternProperties"]
    for inner in part.values() if isinstance(part, dict) else part if isinstance(part, list) else ():
        yield from list_patterns(inner)


@pytest.mark.slow
def test_expressions_of_the_schemas_are_linear() -> None:
    schemas = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((ROOT / "schemas").glob("*.json"))]
    patterns = set(list_patterns(schemas))
    assert len(patterns) > 10
    expressions = [Expression(pattern, re.compile(pattern), ("search",)) for pattern in sorted(patterns)]
    slow = {expression.place: find_slow_text(expression) for expression in expressions}
    assert not {place: text for place, text in slow.items() if text}


def test_the_package_is_walked() -> None:
    places = {expression.place for expression in list_expressions()}
    assert len(places) > 400
    assert "archgen/syntax/yaml_comments.py:_CONFLICT_MARKER" in places  # a name
    assert any(
        place.startswith("archgen/plugins/tables/cell_values.py:") and place[-1].isdigit() for place in places
    )  # a call


def test_what_functions_make_is_known() -> None:
    assert list_made_expressions() == sorted(MADE)


@pytest.mark.parametrize(
    ("pattern", "method"),
    try_some(
        [
            (r"([^\r\n]*?)?[ \t]*\r?$", "match"),
            (r"(?:\s|#[^\r\n]*)*,", "match"),
            (r"\S+(?:, *\S+)*;", "match"),
            (r"(a|aa)+$", "match"),
            (r"\s+$", "search"),
            (r"[0-9]+,", "findall"),
            (r"\[[^\]]*\]", "sub"),
        ],
        2,
    ),
)
def test_slow_ones_are_found(pattern: str, method: str) -> None:
    expression = Expression("here", re.compile(pattern), (method,))
    # Most show at the first length, in a fortieth of the time; a quick machine needs a longer one.
    assert any(find_slow_text(expression, length) for length in (LENGTH, 2 * LENGTH, 5 * LENGTH))


@pytest.mark.parametrize(
    ("pattern", "method"),
    [
        (r"(?:(?<!\s)\s++)?+,", "search"),
        (r"a++b", "match"),
        (r"(?<![0-9])[0-9]++,", "findall"),
        (r"(?>a|aa)+$", "match"),
    ],
)
def test_quick_ones_are_not(pattern: str, method: str) -> None:
    assert find_slow_text(Expression("here", re.compile(pattern), (method,))) is None
