"""The matcher alone: plain data and a pattern in, bindings out."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
import yaml

from archgen.passes.patterns.matching import (
    BudgetExceededError,
    IndexToken,
    MatchBudget,
    list_tokens,
    match_text,
    match_view,
)
from archgen.passes.patterns.pattern_shapes import (
    ComponentBody,
    PortReference,
    TextPattern,
    ViewValue,
    parse_text_pattern,
)
from archgen.passes.patterns.rule_reading import RuleReader
from archgen.syntax.yaml_parser import parse_yaml


class PlainView:
    """A view of plain data."""

    def __init__(self, components: dict[str, dict[str, ViewValue]], types: dict[str, dict[str, ViewValue]]) -> None:
        """Take what there is."""
        self._sections = {"components": components, "types": types}

    def list_elements(self, section: str) -> Sequence[str]:
        """Return all paths or names."""
        return tuple(self._sections[section])

    def get_element(self, section: str, name: str) -> dict[str, ViewValue] | None:
        """Return a component or type."""
        return self._sections[section].get(name)

    def find_having(self, token: IndexToken) -> Sequence[str]:
        """Return those that a token finds."""
        return [path for path, body in self._sections["components"].items() if token in set(list_tokens(body))]

    def count_having(self, token: IndexToken) -> int:
        """Return how many a token finds."""
        return len(self.find_having(token))

    def is_a(self, name: str, type_name: str) -> bool:
        """Plain data are made from nothing."""
        return name == type_name


ROBOT = PlainView(
    yaml.safe_load(
        """
g: {kind: group, id: g, autoconnect: ports}
g.camera: {kind: component, id: camera, in: g, outputs: {image: {type: Image}, state: {type: "Envelope<State>"}}, tags: [a, b]}
g.viewer: {kind: component, id: viewer, in: g, inputs: {image: {type: Image, from: [g.camera.image]}}}
g.recorder: {kind: component, id: recorder, in: g, inputs: {image: {type: Image}, log: {type: "Pair<Image, Envelope<State>>"}}, tags: []}
"""
    ),
    {"Image": {"message": "sensor_msgs/msg/Image"}, "Envelope": {"generic": ["T"]}},
)


def found(pattern: str, budget: int = 10_000, **bound: ViewValue) -> list[dict[str, ViewValue]]:
    """Match a pattern against the robot."""
    document, problems = parse_yaml("rule.yaml", "{find: " + pattern + ", drop: {components: {x: }}}")
    assert document is not None, problems
    reader = RuleReader()
    rule = reader.read_rule(document.root)
    assert rule is not None, reader.diagnostics
    return [dict(each) for each in match_view(rule.find, ROBOT, bound, MatchBudget(budget), rule.distinct)]


@pytest.mark.parametrize(
    ("pattern", "bindings"),
    [
        ("{components: {$c: {autoconnect: ports}}}", [{"c": "g"}]),
        (
            "{components: {$c: {in: $g, inputs: {$p: {from: [$s.$q]}}}}}",
            [{"c": "g.viewer", "g": "g", "p": "image", "s": "g.camera", "q": "image"}],
        ),
        ("{components: {$c: {tags: [$t]}}}", [{"c": "g.camera", "t": "a"}, {"c": "g.camera", "t": "b"}]),
        ("{components: {$c: {tags: [b, a]}}}", [{"c": "g.camera"}]),
        ("{components: {$c: {tags: [a, a]}}}", []),
        ("{components: {$c: {tags: []}}}", [{"c": "g.recorder"}]),
        ("{components: {$c: {tags: $all, id: camera}}}", [{"c": "g.camera", "all": ["a", "b"]}]),
        (
            "{components: {$c: {outputs: {$p: {type: {Envelope: $t}}}}}}",
            [{"c": "g.camera", "p": "state", "t": "State"}],
        ),
        (
            "{components: {$c: {inputs: {$p: {type: {Pair: [$a, {Envelope: $b}]}}}}}}",
            [{"c": "g.recorder", "p": "log", "a": "Image", "b": "State"}],
        ),
        ("{components: {$c: {inputs: {$p: {type: {$generic: $a}}}}}}", []),
        (
            "{components: {$c: {id: camera, outputs: {state: {type: {$generic: $a}}}}}}",
            [{"c": "g.camera", "generic": "Envelope", "a": "State"}],
        ),
        ("{components: {g.camera: {outputs: {$p: }}}}", [{"p": "image"}, {"p": "state"}]),
        ("{components: {$c: {id: '${start}corder'}}}", [{"c": "g.recorder", "start": "re"}]),
        ("{types: {$t: {generic: [$n]}}}", [{"t": "Envelope", "n": "T"}]),
        (
            "{components: {$c: {inputs: {image: {type: $t}}, tags: $tags}}, types: {$t: {message: $m}}}",
            [{"c": "g.recorder", "t": "Image", "tags": [], "m": "sensor_msgs/msg/Image"}],
        ),
        ("{components: {$c: {nothing: }}}".replace("nothing", "timing"), []),
    ],
)
def test_a_pattern_binds_what_it_finds(pattern: str, bindings: list[dict[str, ViewValue]]) -> None:
    assert found(pattern) == bindings


def test_different_variables_bind_different_components() -> None:
    pattern = "{components: {$a: {in: g, inputs: {image: }}, $b: {in: g, inputs: {image: }}}}"
    assert [(each["a"], each["b"]) for each in found(pattern)] == [
        ("g.viewer", "g.recorder"),
        ("g.recorder", "g.viewer"),
    ]
    assert found("{components: {$a: {in: g, inputs: {image: }}, $_: {in: g, inputs: {image: }}}}", a="g.viewer")[0] == {
        "a": "g.viewer"
    }


def test_a_variable_is_bound_by_its_first_place_and_agrees_in_all_others() -> None:
    pattern = "{components: {$s: {outputs: {$p: {type: $t}}}, $r: {inputs: {$p: {type: $t}}}}}"
    assert {(each["s"], each["r"], each["t"]) for each in found(pattern)} == {
        ("g.camera", "g.viewer", "Image"),
        ("g.camera", "g.recorder", "Image"),
    }
    assert found(pattern, t="Sound") == []


def test_matching_ends_when_its_steps_are_used_up() -> None:
    with pytest.raises(BudgetExceededError):
        found("{components: {$a: {in: g}, $b: {in: g}, $c: {in: g}}}", budget=20)
    assert len(found("{components: {$a: {in: g}, $b: {in: g}, $c: {in: g}}}")) == 6


@pytest.mark.parametrize(
    ("pattern", "text", "bound"),
    [
        ("$a.$b", "g.c.port", {"a": "g.c", "b": "port"}),
        ("$a.$b.$c", "g.c.d.port", {"a": "g.c", "b": "d", "c": "port"}),
        ("self.$x", "self.pose", {"x": "pose"}),
        ("self.$x", "drive.pose", None),
        ("$a.$b", "port", None),
        ("${a}_state", "arm_state", {"a": "arm"}),
        ("${a}_state", "_state", None),
        ("${a}_state", "arm_status", None),
        ("a${b}c${d}e", "aXcYcZe", {"b": "X", "d": "YcZ"}),
        ("${a}_$b", "x_y_z", {"a": "x", "b": "y_z"}),
        ("$$a", "$a", {}),
        ("${a}_$a", "x_x", {"a": "x"}),
        ("${a}_$a", "x_y", None),
        ("$_.state", "g.c.state", {}),
    ],
)
def test_texts_are_taken_apart_in_one_way(pattern: str, text: str, bound: dict[str, str] | None) -> None:
    parsed = parse_text_pattern(pattern, pattern, None)
    if isinstance(parsed, TextPattern):
        assert match_text(parsed, text, {}) == bound
    else:
        assert (str(getattr(parsed, "text", "")) == text) == (bound is not None)


def test_a_whole_component_is_no_port_of_what_is_around_it() -> None:
    parsed = parse_text_pattern("$a.$b", "$a.$b", None)
    assert isinstance(parsed, TextPattern)
    assert match_text(parsed, PortReference("g.camera", None), {}) is None
    assert match_text(parsed, PortReference("g.camera", "image"), {}) == {"a": "g.camera", "b": "image"}


def test_a_component_keeps_where_it_is_read_from() -> None:
    body = ComponentBody({"id": "camera"})
    body.path = "g.camera"
    assert body == {"id": "camera"}
