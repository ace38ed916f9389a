"""Names of elements as identifiers: none is empty, a keyword, or begins with a digit, whatever it is made of."""

from __future__ import annotations

import builtins
import keyword
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from archgen.model.code_names import (
    CPP_KEYWORDS,
    JAVA_KEYWORDS,
    MAX_NAME_LENGTH,
    PYTHON_KEYWORDS,
    list_name_words,
    make_camel_name,
    make_identifier_in,
    make_lower_camel_name,
    make_ros_name,
    make_snake_name,
)

NAMES = (
    st.text()
    | st.sampled_from(sorted(PYTHON_KEYWORDS | CPP_KEYWORDS | JAVA_KEYWORDS))
    | st.from_regex(r"[a-z0-9_]{1,200}")
)
LONGEST = MAX_NAME_LENGTH + 2


@given(NAMES)
def test_identifiers(name: str) -> None:
    for language, keywords in (("python", PYTHON_KEYWORDS), ("cpp", CPP_KEYWORDS), ("java", JAVA_KEYWORDS)):
        identifier = make_identifier_in(language, name)
        assert re.fullmatch(r"[A-Za-z](?:_?[A-Za-z0-9])*_?", identifier), identifier
        assert identifier not in keywords
        assert len(identifier) <= LONGEST
    assert make_identifier_in("python", name).isidentifier()
    assert not keyword.iskeyword(make_identifier_in("python", name))


@given(NAMES)
def test_names_of_ros(name: str) -> None:
    ros_name = make_ros_name(name)
    # What rosidl demands of fields and packages.
    assert re.fullmatch(r"[a-z](?:_?[a-z0-9])*", ros_name), ros_name
    assert not keyword.iskeyword(ros_name)
    assert len(ros_name) <= LONGEST


@given(NAMES)
def test_snake_and_camel(name: str) -> None:
    assert re.fullmatch(r"[a-z](?:_?[a-z0-9])*", make_snake_name(name))
    assert re.fullmatch(r"[A-Z][A-Za-z0-9]*", make_camel_name(name))
    assert re.fullmatch(r"[a-z][A-Za-z0-9]*", make_lower_camel_name(name))
    assert make_lower_camel_name(name)[1:] == make_camel_name(name)[1:]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("left_arm", ["left", "arm"]),
        ("LeftArm2", ["Left", "Arm2"]),
        ("RGBDCamera", ["RGBD", "Camera"]),
        ("RGBD camera", ["RGBD", "camera"]),
        ("Größe", ["Groesse"]),
        ("a.b-c<D>", ["a", "b", "c", "D"]),
        ("日本", []),
        ("3d", ["3d"]),
    ],
)
def test_words(name: str, words: list[str]) -> None:
    assert list_name_words(name) == words


def test_an_id_in_snake_case_stays(  # ids of elements are in it already
) -> None:
    for name in ("left_arm", "a_1", "x2y"):
        assert make_snake_name(name) == name


def test_names_without_a_letter_differ() -> None:
    assert make_snake_name("日本") != make_snake_name("中国")
    assert make_camel_name("日本") != make_camel_name("中国")


def test_all_keywords_of_this_python_are_known() -> None:
    assert set(keyword.kwlist) <= PYTHON_KEYWORDS
    assert not PYTHON_KEYWORDS & set(dir(builtins)) - set(keyword.kwlist) - {"print", "exec"}
