"""Overrides of quality of service: which parameters are one, what they set, and what a program makes of them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.derivation.wire.qos_overrides import POLICIES, describe_values, read_policy
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint

Derived = Callable[[str], Architecture]

ROBOT = """\
groups: {g: {components: {a: {%soutputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a}}}}}
nodes:
  a: {implements: a, %spublishes: {o: /x}, parameters: {%s}}
  b: b
"""


def publisher(architecture: Architecture) -> Endpoint:
    return next(each for each in architecture.endpoints if each.use == "publishes")


@pytest.mark.parametrize(
    ("policy", "value", "fields"),
    [
        ("reliability", "best_effort", {"reliability": "best_effort"}),
        ("reliability", "system_default", {"reliability": "reliable"}),
        ("reliability", "best_available", {}),
        ("reliability", "BEST_EFFORT", None),
        ("durability", True, None),
        ("history", "$(var h)", {}),
        ("history", None, {}),
        ("depth", 0, {"depth": 0}),
        ("depth", -1, None),
        ("depth", True, None),
        ("depth", "5", None),
        ("depth", 10**30, None),
        ("deadline", 2**63 - 1, {"deadline": None}),
        ("lifespan", 0, {"lifespan": None}),
        ("avoid_ros_namespace_conventions", False, {}),
        ("avoid_ros_namespace_conventions", 1, None),
    ],
)
def test_values(policy: str, value: object, fields: dict[str, object] | None) -> None:
    assert read_policy(policy, value) == fields


def test_a_duration_is_in_nanoseconds() -> None:
    fields = read_policy("liveliness_lease_duration", 1_000_000)
    assert fields is not None
    assert (fields["lease_duration"].value, str(fields["lease_duration"])) == (1_000_000, "1000000 ns")


def test_each_policy_says_what_it_takes() -> None:
    assert [describe_values(policy) for policy in POLICIES][-3:] == [
        "a whole number of nanoseconds",
        "a whole number of nanoseconds",
        "`true` or `false`",
    ]


@pytest.mark.parametrize(
    ("component", "node", "parameters", "told"),
    [
        ("", "", "qos_overrides./x.publisher.depth: 3", ("obeyed", 3, None)),
        ("", "", "qos_overrides: {/x: {publisher: {depth: 3}}}", ("obeyed", 3, None)),
        ("", "", "qos_overrides: {/x: {publisher_left: {depth: 3}}}", ("ignored", 10, None)),
        ("", "", "qos_overrides: {x: {publisher: {depth: 3}}}", (None, 10, None)),
        ("", "", "qos_overrides: {/x: {subscription: {depth: 3}}}", (None, 10, None)),
        ("", "", "qos_overrides./x: 1", (None, 10, None)),
        ("", "", "qos_overrides: {/x: {publisher: {depth: -1}}}", ("obeyed", 10, None)),
        ("", "status: existing, ", "qos_overrides: {/x: {publisher: {depth: 3}}}", ("unknown", 3, 10)),
        ("", "command: [run], ", "qos_overrides: {/x: {publisher: {depth: 3}}}", ("unknown", 3, 10)),
        (
            "parameters: {qos_overrides./x.publisher.depth: 7}, ",
            "status: existing, ",
            "a: 1",
            ("obeyed", 7, None),
        ),
        (
            "parameters: {qos_overrides./x.publisher.history: keep_last}, ",
            "status: existing, ",
            "qos_overrides: {/x: {publisher: {durability: volatile}}}",
            ("obeyed", 10, None),
        ),
        (
            "parameters: {qos_overrides./x.publisher.history: {type: string}}, ",
            "status: existing, ",
            "qos_overrides: {/x: {publisher: {depth: 3}}}",
            ("ignored", 10, None),
        ),
    ],
)
def test_what_becomes_of_the_depth(
    derived: Derived, component: str, node: str, parameters: str, told: tuple[str | None, int, int | None]
) -> None:
    endpoint = publisher(derived(ROBOT % (component, node, parameters)))
    other_depth = endpoint.qos_if_ignored.depth if endpoint.qos_if_ignored else None
    assert (endpoint.qos_override, endpoint.qos.depth, other_depth) == told


def test_each_policy_says_where_it_comes_from(derived: Derived) -> None:
    parameters = 'qos_overrides: {/x: {publisher: {depth: 3, reliability: "$(var r)"}}}'
    endpoint = publisher(derived(ROBOT % ("", "", parameters)))
    told = [
        f"{name} {each.kind} {each.rule} {each.at.line}:{each.at.column}" for name, each in endpoint.evidence.items()
    ]
    assert told == [
        "qos.depth written qos_overrides./x.publisher.depth 3:95",
        "qos.reliability unknown qos_overrides./x.publisher.reliability 3:111",
    ]
    assert endpoint.qos.written


def test_arguments_override_until_a_launch_says_more(derived: Derived) -> None:
    words = 'arguments: ["--ros-args", -p, "qos_overrides./x.publisher.depth:=3", -p, "n:qos_overrides./x.publisher.depth:=4"], '
    assert publisher(derived(ROBOT % ("", words, "a: 1"))).qos.depth == 3
    assert publisher(derived(ROBOT % ("", words, "qos_overrides: {/x: {publisher: {depth: 5}}}"))).qos.depth == 5


def test_the_project_overrides_too_and_ros_1_has_no_overrides(derived: Derived) -> None:
    text = ROBOT % ("", "", "a: 1") + "ros: {%sparameters: {qos_overrides: {/x: {subscription: {depth: 4}}}}}"
    assert [each.qos.depth for each in derived(text % "").endpoints] == [10, 4]
    assert [each.qos.depth for each in derived(text % "distro: noetic, ").endpoints] == [10, 10]
