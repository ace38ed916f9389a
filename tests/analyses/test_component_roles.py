"""Tests of roles: what each of them asks of a component's ports."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.analyses.component_roles import role_mismatch

Found = Callable[..., list[str]]

_AROUND = """
    type Data std_msgs/msg/String
    type Call std_srvs/srv/Trigger
    out z.other.data type=Data
    out z.other.call type=Call
    in z.other.back from=a
"""
_SAYS = "6: `a.c` says that its role is"


@pytest.mark.parametrize(
    ("role", "ports", "fault"),
    [
        # A stub is not checked; one port is enough to be.
        ("source", [], None),
        ("filter", ["out a.c.x type=Data"], "`filter`, but it takes no data from another component"),
        # source: an output, no input from inside.
        ("source", ["out a.c.x"], None),
        ("source", ["out a.c.x physical external"], None),
        ("source", ["in a.c.i external"], "`source`, but it has no output"),
        ("source", ["out a.c.x", "in a.c.i external"], None),
        ("source", ["out a.c.x", "in a.c.i from=z.other.data"], "`source`, but it takes data from another component"),
        ("source", ["out a.c.x", "in a.c.i from=z.other"], "`source`, but it takes data from another component"),
        ("source", ["out a.c.x type=Data", "in a.c.i from=a.c.x"], None),
        # A call that it makes does not count as data from others; neither does what could not be resolved.
        ("source", ["out a.c.x", "in a.c.i from=z.other.call"], None),
        ("source", ["out a.c.x", "in a.c.i from=?"], None),
        # filter: an input from inside and an output that is not physical.
        ("filter", ["out a.c.x type=Data", "in a.c.i from=z.other.data"], None),
        ("filter", ["out a.c.x type=Call", "in a.c.i from=z.other.data"], None),
        ("filter", ["out a.c.x type=Data", "in a.c.i from=?"], None),
        ("filter", ["out a.c.x type=Data", "in a.c.i"], None),
        (
            "filter",
            ["out a.c.x type=Data", "in a.c.i external"],
            "`filter`, but it takes no data from another component",
        ),
        (
            "filter",
            ["out a.c.x type=Data", "in a.c.i from=z.other.call"],
            "`filter`, but it takes no data from another component",
        ),
        (
            "filter",
            ["out a.c.x physical", "in a.c.i from=z.other.data"],
            "`filter`, but it has no output that is not physical",
        ),
        # sink: fed from inside, and a physical or external output or no message output at all.
        ("sink", ["in a.c.i from=z.other.data"], None),
        ("sink", ["in a.c.i from=z.other.data", "out a.c.x physical external"], None),
        ("sink", ["in a.c.i from=z.other.data", "out a.c.x type=Data external"], None),
        ("sink", ["in a.c.i from=z.other.data", "out a.c.x type=Call"], None),
        ("sink", ["in a.c.i from=z.other.data", "out a.c.x type=Data", "out a.c.y physical"], None),
        ("sink", ["out a.c.x type=Call", "out a.c.y physical"], None),
        (
            "sink",
            ["in a.c.i from=z.other.data", "out a.c.x type=Data"],
            "`sink`, but all that it sends stays inside the architecture",
        ),
        ("sink", ["in a.c.i external"], "`sink`, but no other component feeds it"),
        # reactive: serves a service or action.
        ("reactive", ["out a.c.x type=Call"], None),
        ("reactive", ["out a.c.x type='Not mapped'"], None),
        ("reactive", ["out a.c.x type=Data"], "`reactive`, but it serves no service and no action"),
        ("reactive", ["in a.c.i from=z.other.data"], "`reactive`, but it serves no service and no action"),
    ],
)
def test_a_role_is_held_against_the_ports(found: Found, role: str, ports: list[str], fault: str | None) -> None:
    text = "\n".join([_AROUND.rstrip(), f"component a.c role={role}", *ports])
    assert found(role_mismatch, text) == ([f"{_SAYS} {fault}"] if fault else [])


def test_a_component_without_role_is_not_checked(found: Found) -> None:
    assert found(role_mismatch, "in a.c.i external") == []


def test_the_help_names_the_roles_that_fit(sketch: Callable[..., object]) -> None:
    text = "component a.c role=sink\nout a.c.x physical external"
    (diagnostic,) = role_mismatch(sketch(text))  # type: ignore[arg-type]
    assert diagnostic.help == "its ports fit the role `source`"
