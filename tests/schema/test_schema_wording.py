"""What is wrong with a value or a key, in our own words, with what to write instead."""

from __future__ import annotations

import pytest

from archgen.schema import schema_wording, validate_document
from archgen.syntax import yaml_parser


def _findings(text: str) -> list[str]:
    document, _ = yaml_parser.parse_yaml("f", text)
    assert document is not None
    return [f"{d.span.line}:{d.span.column} {d.rule}: {d.message} | {d.help}" for d in validate_document(document)]


def _timing(text: str) -> list[str]:
    """Check the timing of a component; places begin on line 3."""
    return _findings(f"groups: {{g: {{components: {{c: {{timing: {{\n\n{text}\n}}}}}}}}}}")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("grups: {}", "1:1 unknown-key: no section is called `grups` | did you mean `groups`?"),
        ("nodes: {n: {name: N, id: x}}", "1:22 unknown-key: a ROS node has no key `id` | the key above is the id; write the name for people as `title`"),
        ("groups: {g: {titel: G}}", "1:14 unknown-key: a functional group has no key `titel` | did you mean `title`?"),
        ("groups: {g: {'title:G': }}", "1:14 unknown-key: a functional group has no key `title:G` | write a blank after the colon: `title: G`"),
        ("groups: []", "1:1 wrong-type: `groups` is a list, but must be a mapping | write `{}` for none"),
        ("groups: [a]", "1:1 wrong-type: `groups` is a list, but must be a mapping | `groups` is keyed by id: write `{a: {}}` instead of a list"),
        ("archgen: 2", "1:10 wrong-value: this archgen reads version 1 of the language, not `2` | write `1`"),
        ("groups: {g: {components: {c: {role: filtre}}}}", None),
        ("nodes: {n: {timing: {prio: 20}}}", "1:22 unknown-key: a timing has no key `prio` | did you mean `priority`?"),
        ("hosts: {pc: {scheduling: fixed_prio}}", "1:26 wrong-value: `scheduling` cannot be `fixed_prio` | did you mean `fixed_priority`?"),
        ("nodes: {n: {timing: {cores: 0-3}}}", "1:29 wrong-type: `cores` is `0-3`, but must be a list | write `[0, 1, 2, 3]`"),
        ("nodes: {n: {timing: {cores: 0-99}}}", "1:29 wrong-type: `cores` is `0-99`, but must be a list | write `[0-99]`"),
        ("nodes: {n: {timing: {trigger: match}}}", "1:31 wrong-value: `trigger` cannot be `match` | a trigger is `any`, `all`, a list of inputs, `{all: [inputs]}`, or `{match: [inputs], within: 30 ms}`"),
        ("nodes: {n: {timing: {trigger: scan}}}", "1:31 wrong-value: `trigger` cannot be `scan` | write `[scan]`"),
        ("groups: {g: {components: {c: {inputs: {i: {freshness: {max: 1 s}}}}}}}", "1:44 wrong-type: `freshness` is a mapping, but must be text | a duration is a number and one of the units `ns us ms s min h`, such as `80 ms`"),
        ("groups: {g: {components: {c: {inputs: {i: a.o, freshness: 20 ms}}}}}", "1:59 wrong-value: `freshness` cannot be `20 ms` | a key of an input stands below that input: `INPUT: {from: ..., freshness: ...}`"),
        ("groups: {g: {components: {c: {outputs: {o: {freshness: 20 ms}}}}}}", "1:45 unknown-key: an output has no key `freshness` | write it at the input that reads it: `inputs: {INPUT: {from: ..., freshness: ...}}`"),
        ("groups: {g: {title: {a: b}}}", "1:14 wrong-type: `title` is a mapping, but must be text | text with braces must be quoted"),
    ],
)  # fmt: skip
def test_keys_and_types(text: str, said: str | None) -> None:
    found = _findings(text)
    assert len(found) == 1
    if said is not None:
        assert found == [said]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("period: 20", "`20` has no unit | write `20 s` or `20 ms`, whichever is meant"),
        ("period: -20 ms", "`period` cannot be negative"),
        ("period: 20 msec", "`period` has no unit `msec` | write `20 ms`; case counts"),
        ("period: 20 MS", "`period` has no unit `MS` | write `20 ms`; case counts"),
        ("period: 50 Hz", "`period` has no unit `Hz` | write `rate: 50 Hz`"),
        ("rate: 20 ms", "`rate` has no unit `ms` | write `period: 20 ms`"),
        ("rate: 30 fps", "`rate` has no unit `fps` | write `30 Hz`; case counts"),
        ("period: '0,5 ms'", "`period` cannot be `0,5 ms` | write `0.5 ms`"),
        ("period: 1234567890123456789 ms", "`period` has too many digits | at most 18 are read"),
        ("period: soon", "`period` cannot be `soon` | a duration is"),
    ],
)
def test_quantities_say_which_unit_was_meant(text: str, said: str) -> None:
    (found,) = _timing(text)
    message, _, advice = said.partition(" | ")
    assert found.startswith(f"3:{len(text.partition(':')[0]) + 3} wrong-value: {message}")
    assert advice in found


@pytest.mark.parametrize(
    ("key", "ids"),
    [
        ("ColourCamera", ("ColourCamera", "colour_camera")),
        ("Bad Id!", ("Bad-Id", "bad_id")),
        ("R 1", ("R-1", "r_1")),
        ("機", ("", "")),
    ],
)
def test_a_malformed_id_is_mended_as_a_requirement_and_as_any_other(key: str, ids: tuple[str, str]) -> None:
    assert schema_wording.suggest_ids(key) == ids


@pytest.mark.parametrize(
    ("path", "element"),
    [
        ((), None),
        (("groups",), None),
        (("groups", "g"), "g"),
        (("groups", "g", "components", "c", "inputs", "i"), "g.c"),
        (("nodes", "n", "publishes", 0), "n"),
        (("project", "title"), None),
    ],
)
def test_the_element_that_a_path_leads_into(path: tuple[str | int, ...], element: str | None) -> None:
    assert schema_wording.element_of_path(path) == element
