"""Ends that met and meet no more: who loses what, by which change, in which words."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import broken

ROBOT = """\
partners: {a: A, b: B}
ros: {distro: jazzy}
hosts: {pc: {cores: 2}, far: {cores: 2, environment: {ROS_DOMAIN_ID: "7"}}}
types: {T: std_msgs/msg/Bool, S: std_srvs/srv/Trigger}
groups:
  eyes: {owner: a, components: {eye: {outputs: {x: T, ask: {type: S}}}}}
  legs: {owner: b, components: {leg: {inputs: {x: eye.x, ask: eye.ask}}}}
nodes:
  eye: {implements: eye, package: p, executable: e, status: existing, host: pc, kind: lifecycle, publishes: {x: /x}, serves: {ask: /ask}, internal: {publishes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}}
  keeper: {package: nav2_lifecycle_manager, executable: lifecycle_manager, status: existing, host: pc, parameters: {node_names: [eye], autostart: true}}
  leg: {implements: leg, package: p, executable: l, status: existing, host: pc, subscribes: {x: /x}, calls: {ask: /ask}, internal: {subscribes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}}
"""
AT_EYE = "executable: e,"
NAMES = "`/ask`, `/tf` and `/x`"
FAR = f"runs what is on {NAMES} in the domain 7, where `leg` of B runs in the usual domain: nothing arrives any more"
STILL = "no longer has `eye` run (`{}`), and with it " + NAMES + "; `leg` of B needs it"
NOBODY = STILL.format("nobody activates it")
SIMULATED = f"runs what is on {NAMES} by simulated time, where `leg` of B runs by the time of the system"
ENVIRONMENT = "executable: e, start: {environment: {ROS_DOMAIN_ID: '%s'}},"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (AT_EYE, ENVIRONMENT % 7, [f"eye/start.environment.ROS_DOMAIN_ID b: {FAR}"]),
        (AT_EYE, ENVIRONMENT % 0, []),
        (
            "eye, package: p, executable: e, status: existing, host: pc",
            "eye, package: p, executable: e, status: existing, host: far",
            [f"eye/host b: {FAR}"],
        ),
        (
            AT_EYE,
            ENVIRONMENT % "$(arg domain)",
            [f"eye/start.environment.ROS_DOMAIN_ID b: {FAR.replace('the domain 7', 'a domain that nobody knows')}"],
        ),
        (AT_EYE, "executable: e, parameters: {use_sim_time: true},", [f"eye/parameters.use_sim_time b: {SIMULATED}"]),
        (
            AT_EYE,
            "executable: e, arguments: [--ros-args, -p, 'use_sim_time:=true'],",
            [f"eye/arguments b: {SIMULATED}"],
        ),
        (
            "distro: jazzy",
            "distro: jazzy, parameters: {use_sim_time: true}",
            [
                (
                    "robot/parameters.use_sim_time b: runs `eye` by simulated time, which nobody gives, and with it "
                    f"{NAMES}; `leg` of B needs it"
                )
            ],
        ),
        (
            AT_EYE,
            "executable: e, start: {state: unconfigured},",
            [f"eye/start.state b: {STILL.format('state: unconfigured')}"],
        ),
        ("[eye], autostart", "[leg], autostart", [f"keeper/parameters.node_names b: {NOBODY}"]),
        ("autostart: true", "autostart: false", [f"keeper/parameters.autostart b: {NOBODY}"]),
        # What the reader does himself.
        ("executable: l,", "executable: l, start: {environment: {ROS_DOMAIN_ID: '7'}},", []),
        ("executable: l,", "executable: l, parameters: {use_sim_time: true},", []),
        ("executable: l,", "executable: l, kind: lifecycle, start: {state: unconfigured},", []),
        # Both.
        ("executable:", "start: {environment: {ROS_DOMAIN_ID: '7'}}, executable:", []),
    ],
)
def test_who_meets_nobody_any_more(compared: Compared, old: str, new: str, said: list[str]) -> None:
    assert broken(compared, ROBOT, [(old, new)]) == said


def test_ends_that_never_met_are_parted_by_nothing(compared: Compared) -> None:
    apart = ROBOT.replace("executable: l,", "executable: l, start: {environment: {ROS_DOMAIN_ID: '3'}},")
    assert broken(compared, apart, [(AT_EYE, ENVIRONMENT % 7)]) == []


def test_a_clock_that_somebody_gives_parts_nobody(compared: Compared) -> None:
    clock = "nodes:\n  sim: {package: s, executable: s, status: existing, host: pc, internal: {publishes: {clock: {topic: /clock, message: rosgraph_msgs/msg/Clock}}}}\n"
    assert broken(compared, ROBOT, [("jazzy", "jazzy, parameters: {use_sim_time: true}"), ("nodes:\n", clock)]) == []
