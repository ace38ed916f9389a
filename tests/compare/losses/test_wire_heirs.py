"""Outputs that took over the wire of one that is gone."""

from __future__ import annotations

import pytest

from archgen.compare.losses.change_context import find_wire_heirs
from tests.compare.conftest import Compared

HEAD = "ros: {distro: jazzy}\ngroups: {g: {components: {"
READER = "reader: {inputs: {i: %s}}}}}\nnodes: {nr: reader, "


def robot(components: str, source: str, nodes: str) -> str:
    """Return a robot with some components, a reader of an output, and nodes."""
    return f"{HEAD}{components}, {READER % source}{nodes}}}\n"


EYE = robot("eye: {outputs: {x: T}}", "eye.x", "n: {implements: eye, publishes: {x: /t}}")
TWO = robot(
    "eye: {outputs: {x: T}}, ear: {outputs: {z: T}}",
    "eye.x",
    "n: {implements: eye, publishes: {x: /t}}, m: {implements: ear, publishes: {z: /t}}",
)
NEW = "lens: {functionality: Quite another thing, outputs: {out: T}}"


@pytest.mark.parametrize(
    ("before", "after", "heirs"),
    [
        (EYE, robot(NEW, "lens.out", "k: {implements: lens, publishes: {out: /t}}"), {"g.eye.x": "g.lens.out"}),
        # Another topic, another type, another world, another QoS: not the same wire.
        (EYE, robot(NEW, "lens.out", "k: {implements: lens, publishes: {out: /u}}"), {}),
        (EYE, robot(NEW.replace("T}", "U}"), "lens.out", "k: {implements: lens, publishes: {out: /t}}"), {}),
        (EYE, robot(NEW, "lens.out", "k: {implements: lens, publishes: {out: {topic: /t, qos: {depth: 3}}}}"), {}),
        # A plan does not take the place of a program, a program that of a plan.
        (EYE, robot(NEW, "lens.out", "k: {implements: lens, status: planned, publishes: {out: /t}}"), {}),
        (
            EYE.replace("eye, publishes", "eye, status: planned, publishes"),
            robot(NEW, "lens.out", "k: {implements: lens, publishes: {out: /t}}"),
            {"g.eye.x": "g.lens.out"},
        ),
        # Two that could be it; one that was there before; one that nobody read.
        (
            EYE,
            robot(
                f"{NEW}, more: {{outputs: {{o: T}}}}",
                "lens.out",
                "k: {implements: lens, publishes: {out: /t}}, q: {implements: more, publishes: {o: /t}}",
            ),
            {},
        ),
        (TWO, robot("ear: {outputs: {z: T}}", "ear.z", "m: {implements: ear, publishes: {z: /t}}"), {}),
        (
            TWO,
            robot(
                f"ear: {{outputs: {{z: T}}}}, {NEW}",
                "ear.z",
                "m: {implements: ear, publishes: {z: /t}}, k: {implements: lens, publishes: {out: /u}}",
            ),
            {},
        ),
        (EYE.replace("i: eye.x", ""), robot(NEW, "lens.out", "k: {implements: lens, publishes: {out: /t}}"), {}),
        # Without a node the name says it.
        (robot("eye: {outputs: {x: T}}", "eye.x", ""), robot(NEW.replace("out:", "x:"), "lens.x", ""), {"g.eye.x": "g.lens.x"}),
        (robot("eye: {outputs: {x: T}}", "eye.x", ""), robot(NEW, "lens.out", ""), {}),
    ],
)  # fmt: skip
def test_what_is_new_on_the_same_wire_is_the_heir(
    compared: Compared, before: str, after: str, heirs: dict[str, str]
) -> None:
    comparison = compared(before, after)
    architectures = comparison.before.architecture, comparison.after.architecture
    assert find_wire_heirs(comparison.versions, architectures, comparison.matched_ids) == heirs
