"""What could not be read is neither added nor removed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.compare.elements import by_key, element, pair, some


@pytest.mark.parametrize(
    ("before", "after", "lost", "key", "unread"),
    [
        ("group g", "", ("", "g"), "group g", True),  # missing in the second version, where `g` could not be read
        ("group g", "", ("g", ""), "group g", False),  # what the first version lost explains nothing
        ("", "group g", ("g", ""), "group g", True),
        ("", "group g", ("", "g"), "group g", False),
        ("group g", "", ("", ""), "group g", False),
        ("group g", "", ("", "h"), "group g", False),
        ("output g.a.x", "", ("", "a"), "output g.a.x", True),
        ("output g.a.x", "", ("", "g.a"), "output g.a.x", False),
        ("type Colour", "", ("", "Colour"), "type Colour", True),
    ],
)
def test_elements(before: str, after: str, lost: tuple[str, str], key: str, unread: bool) -> None:  # noqa: FBT001
    versions = pair(some(*filter(None, [before])), some(*filter(None, [after])), lost=lost)
    kind, name = key.split(" ")
    assert versions.may_be_unread((kind, name)) is unread


def test_the_last_word_of_a_name_with_blanks_counts() -> None:
    assert pair({}, {}, lost=("", "image")).may_be_unread(("type", "Colour image"))
    assert not pair({}, {}, lost=("", "Colour")).may_be_unread(("type", "Colour image"))


@pytest.mark.parametrize(
    ("key", "before", "after", "lost", "unread"),
    [
        ("component g.a", None, "x", ("a", ""), True),
        ("component g.a", None, "x", ("", "a"), False),
        ("component g.a", "x", None, ("", "a"), True),
        ("component g.a", "x", None, ("a", ""), False),
        ("component g.a", "x", "y", ("a", "a"), False),
        ("component g.a", "x", None, ("", "b"), False),
        ("component g.a", "x.b", None, ("", "b"), True),  # what it refers to is what could not be read
        ("component g.a", None, "x.b", ("b", ""), True),
        ("component g.a", 3, None, ("", "b"), False),
        ("component g.a", 3, None, ("", "a"), True),
        ("project robot", "x", None, ("", "b"), True),
        ("group g", None, "x", ("b", ""), True),
        ("project robot", "x", None, ("b", ""), False),
        ("component g.a", ["x", "b.c"], ["x"], ("", "c"), True),
        ("component g.a", ["x", "b.c"], ["x"], ("c", ""), False),
        ("component g.a", ["x"], ["x", "b"], ("b", ""), True),
        ("component g.a", ["x"], ["x", "b"], ("", "b"), False),
        ("component g.a", ["b"], ["c"], ("c", "b"), True),
        ("component g.a", ["b"], ["c"], ("", "b"), False),
        ("component g.a", None, ["b"], ("b", ""), True),
        ("component g.a", ["b"], None, ("", "b"), True),
        ("component g.a", ["a", "b"], ["b", "a"], ("a", "a"), False),  # another order
        ("component g.a", ["b"], None, ("", ""), False),
    ],
)
def test_values(key: str, before: object, after: object, lost: tuple[str, str], unread: bool) -> None:  # noqa: FBT001
    kind, name = key.split(" ")
    assert pair({}, {}, lost=lost).value_may_be_unread((kind, name), before, after) is unread


def test_elements_by_value() -> None:
    after = by_key(
        element("output g.b.x", type="T"), element("output g.a.x", type="T"), element("output g.a.y", type="U"),
        element("input g.a.x", type="T"),
    )  # fmt: skip
    assert pair({}, after).find_elements_with("output", "type", "T") == ["g.a.x", "g.b.x"]


def test_added_and_removed() -> None:
    versions = pair(some("host a", "host b"), some("host b", "host c"))
    assert [versions.is_removed("host", name) for name in "abc"] == [True, False, False]
    assert [versions.is_added("host", name) for name in "abc"] == [False, False, True]


@pytest.mark.parametrize(
    ("value_key", "before", "after", "lost", "unread"),
    [
        ("cores", 4, None, ("", "cores"), True),
        ("cores", 4, None, ("cores", ""), False),
        ("cores", None, 4, ("cores", ""), True),
        ("cores", 4, 8, ("", "cores"), False),
        ("timing.wcet", "1 ms", None, ("", "wcet"), True),
        ("timing.rate", "1 Hz", None, ("", "period"), True),
        ("timing.jitter", "1 ms", None, ("", "period"), False),
    ],
)
def test_a_key_that_was_taken_out_is_not_read(
    value_key: str, before: object, after: object, lost: tuple[str, str], unread: bool  # noqa: FBT001
) -> None:  # fmt: skip
    assert pair({}, {}, lost=lost).value_may_be_unread(("host", "pc"), before, after, value_key) is unread


def test_a_key_is_gone_from_a_file_that_was_read_well() -> None:
    host = replace(element("host pc"), file="good.yaml")
    versions = replace(
        pair(by_key(host), by_key(host), lost=("", "cores")), sound_files=(frozenset(), frozenset({"good.yaml"}))
    )
    assert not versions.value_may_be_unread(("host", "pc"), 4, None, "cores")
