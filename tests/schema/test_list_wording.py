"""Text that stands where a list is asked."""

from __future__ import annotations

import pytest

from archgen.schema.schema_wording import describe_list, split_ids, suggest_list
from tests.schema.findings import find_mistakes


@pytest.mark.parametrize(
    ("text", "place", "help_line"),
    [
        ("groups: {g: {components: {c: {requirements: 'R-1, R-4'}}}}", "1:45", "write `[R-1, R-4]`"),
        ("groups: {g: {components: {c: {requirements: R-1; R-4 and R-5}}}}", "1:45", "write `[R-1, R-4, R-5]`"),
        ("groups: {g: {components: {c: {requirements: R-1 R-4}}}}", "1:45", "write `[R-1, R-4]`"),
        ("groups: {g: {components: {c: {requirements: Works at night}}}}", "1:45", "write `[Works at night]`"),
        ("groups: {g: {tags: 'safety, arm'}}", "1:20", "write `[safety, arm]`"),
        ("nodes: {n: {implements: 'a.b, c'}}", "1:25", "write `[a.b, c]`"),
        (
            "nodes: {n: {implements: ['a.b, c']}}",
            "1:26",
            "write each as an entry of its own, with a comma between them",
        ),
        ("chains: {c: a -> b -> c}", "1:13", "write `[a, b, c]`"),
        ("chains: {c: {through: a b}}", "1:23", "write `[a, b]`"),
        ("nodes: {n: {timing: {trigger: scan}}}", "1:31", "write `[scan]`"),
        ("ros: {shared_topics: '/a, /b'}", "1:22", "write `[/a, /b]`"),
        ("nodes: {n: {owner: 'sssa, certh'}}", "1:20", "write `[sssa, certh]`"),
    ],
)
def test_ids_in_one_text_become_a_list(text: str, place: str, help_line: str) -> None:
    (mistake,) = find_mistakes(text)
    assert mistake.startswith(f"{place} ")
    assert mistake.endswith(f"| {help_line}")


def test_a_sentence_is_one_entry_and_long_text_is_no_list() -> None:
    sentences: dict[str, object] = {}
    assert split_ids("Works at night, in rain too", sentences) == []
    assert split_ids("quiet, fast", sentences) == ["quiet", "fast"]
    assert split_ids("R-1, " * 1000, sentences) == []
    assert suggest_list("Fast: very", sentences) == '["Fast: very"]'


@pytest.mark.parametrize(
    ("text", "form"),
    [
        ("1-9", "`[1, 9]`"),
        ("0 .. 30.5", "`[0, 30.5]`"),
        ("5 to -5", "`[-5, 5]`"),
        ("-5-5", "`[-5, 5]`"),
        ("5", "`[0, 5]`, or `[5, .inf]` for no upper end"),
        ("-5", "`[-5, 0]`, or `[-5, .inf]` for no upper end"),
        ("0 kg to 5 kg", "`[0, 10]`, or `[0, .inf]` for no upper end"),
    ],
)
def test_a_range_has_its_least_value_first(text: str, form: str) -> None:
    assert describe_list(text, {"title": "Range"}) == f"write its least and its greatest value: {form}"
