"""Merging component types, composed components, parameters, frames and fields: two partners inside of one thing."""

from __future__ import annotations

import pytest

from archgen.merge.file_merge import merge_contents
from archgen.merge.slice_merge import SliceVersions, merge_slices

TYPES = """\
component_types:
  arm:
    inputs: {goal: Goal}
    outputs: {state: {type: State, to: log.state}}
    parameters:
      gain: 0.5
      mode: {choices: [slow, fast], value: slow}
    operations: {stop: Ok}
    components:
      elbow: {is: motor, inputs: {target: self.goal}}
    frames:
      base: {}
  motor: {outputs: {state: State}}
types:
  Goal: {fields: {x: float64, y: float64}, constants: {MAX: {type: int8, value: 1}}}
groups:
  body:
    components:
      left: {is: arm, inputs: {goal: planner.goal}}
      whole:
        components:
          inner: {outputs: {x: X}}
"""


@pytest.mark.parametrize(
    ("old", "ours", "theirs", "merged"),
    [
        (
            "groups:",
            "  a: {title: A}\ngroups:",
            "  b: {title: B}\ngroups:",
            "  a: {title: A}\n  b: {title: B}\ngroups:",
        ),
        ("{goal: Goal}", "{goal: Goal, a: A}", "{goal: Goal, b: B}", "{goal: Goal, a: A, b: B}"),
        ("to: log.state", "to: [log.state, a.s]", "to: [log.state, b.s]", "to: [log.state, a.s, b.s]"),
        ("gain: 0.5", "gain: {value: 0.5, unit: m}", "gain: 0.6", "gain: {value: 0.6, unit: m}"),
        ("gain: 0.5", "gain: 0.5\n      a: 1", "gain: 0.5\n      b: 2", "gain: 0.5\n      a: 1\n      b: 2"),
        ("[slow, fast]", "[slow, fast, a]", "[slow, fast, b]", "[slow, fast, a, b]"),
        ("{stop: Ok}", "{stop: Ok, a: A}", "{stop: Ok, b: B}", "{stop: Ok, a: A, b: B}"),
        (
            "    frames:",
            "      a: {is: motor}\n    frames:",
            "      b: {is: motor}\n    frames:",
            "      a: {is: motor}\n      b: {is: motor}\n    frames:",
        ),
        (
            "{is: motor, inputs: {target: self.goal}}",
            "{is: motor, inputs: {target: self.goal}, timing: {wcet: 1 ms}}",
            "{is: motor, inputs: {target: self.goal}, parameters: {k: 1}}",
            "{is: motor, inputs: {target: self.goal}, timing: {wcet: 1 ms}, parameters: {k: 1}}",
        ),
        (
            "      base: {}\n",
            "      base: {}\n      a: base\n",
            "      base: {}\n      b: {parent: base}\n",
            "      base: {}\n      a: base\n      b: {parent: base}\n",
        ),
        (
            "{x: float64, y: float64}",
            "{x: {type: float64, unit: m}, y: float64}",
            "{x: float64, y: {type: float64, comment: North}}",
            "{x: {type: float64, unit: m}, y: {type: float64, comment: North}}",
        ),
        ("value: 1}}", "value: 1}, A: B}", "value: 1}, C: D}", "value: 1}, A: B, C: D}"),
        (
            "          inner: {outputs: {x: X}}\n",
            "          inner: {outputs: {x: X}}\n          a: {outputs: {x: X}}\n",
            "          inner: {outputs: {x: X}}\n          b: {outputs: {x: X}}\n",
            "          inner: {outputs: {x: X}}\n          a: {outputs: {x: X}}\n          b: {outputs: {x: X}}\n",
        ),
    ],
)
def test_what_two_add_inside_of_one_thing_merges(old: str, ours: str, theirs: str, merged: str) -> None:
    assert old in TYPES
    texts = [TYPES.replace(old, new, 1) for new in (old, ours, theirs)]
    assert merge_slices(SliceVersions(*texts)) == TYPES.replace(old, merged, 1)


@pytest.mark.parametrize(
    ("old", "ours", "theirs", "problem"),
    [
        ("gain: 0.5", "gain: 0.6", "gain: 0.7", "both sides changed `component_types.arm.parameters.gain`"),
        ("left: {is: arm", "left: {is: a", "left: {is: b", "both sides changed `groups.body.components.left.is`"),
        ("base: {}", "base: a", "base: b", "both sides changed `component_types.arm.frames.base`"),
        (
            "y: float64}",
            "y: float64, a: int8}",
            "y: float64, b: int8}",
            "both sides added to `types.Goal.fields` at one place, where order is that of the message",
        ),
    ],
)
def test_what_two_change_in_their_own_ways_is_named(old: str, ours: str, theirs: str, problem: str) -> None:
    assert old in TYPES
    base, *sides = (TYPES.replace(old, new, 1).encode() for new in (old, ours, theirs))
    assert merge_contents(base, sides[0], sides[1]).problem == problem


def test_a_list_of_choices_below_a_node_is_data() -> None:
    text = b"nodes: {n: {parameters: {choices: [a]}}}\n"
    merged = merge_contents(text, text.replace(b"[a]", b"[a, b]"), text.replace(b"[a]", b"[a, c]"))
    assert merged.problem == "both sides changed `nodes.n.parameters.choices`"


def test_a_parameter_called_choices_is_data_and_the_choices_of_a_parameter_are_none() -> None:
    text = b"component_types: {arm: {components: {a: {parameters: {choices: [a], mode: {choices: [a]}}}}}}\n"
    ours, theirs = (text.replace(b"mode: {choices: [a]", b"mode: {choices: [a, %b]" % each) for each in (b"b", b"c"))
    assert merge_contents(text, ours, theirs).content == text.replace(
        b"mode: {choices: [a]", b"mode: {choices: [a, b, c]"
    )
    ours, theirs = (text.replace(b"choices: [a], mode", b"choices: [a, %b], mode" % each) for each in (b"b", b"c"))
    assert merge_contents(text, ours, theirs).problem == (
        "both sides changed `component_types.arm.components.a.parameters.choices`"
    )
