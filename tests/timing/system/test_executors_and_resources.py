"""Processes, callback groups, orders, resources and stored inputs, as they are read off an architecture."""

from __future__ import annotations

import pytest

from archgen.timing.system.system_builder import build_system
from archgen.timing.system.timing_system import (
    Activity,
    Executor,
    ResourceUse,
    SharedResource,
    StoringCallback,
    TimingSystem,
)
from tests.timing.random_systems import architecture

MS = 10**6
TEXT = """
groups:
  g:
    components:
      eye: {outputs: {image: std_msgs/msg/String, cloud: std_msgs/msg/Bool, ask: std_srvs/srv/Trigger}}
      mind: {inputs: {image: {from: eye.image, freshness: 20 ms}, cloud: eye.cloud, ask: eye.ask, light: {external: Sun, medium: physical}}, outputs: {told: std_msgs/msg/Empty}}
      fast: {inputs: {told: mind.told}}
      slow: {inputs: {told: mind.told}}
      idle: {inputs: {told: mind.told}}
      planned: {inputs: {told: mind.told}}
nodes:
  eye: {implements: eye, container: box, timing: {rate: 100 Hz, wcet: {max: 4 ms, p50: 1 ms, p99: 3 ms, measured: true}, uses: {gpu: {max: 6 ms, min: 2 ms}, tpu: 1 ms}, cores: [3, 1, 3]}}
  mind: {implements: mind, host: pc, timing: {TIMING}}
  hands: {implements: [fast, slow, idle], host: arm, threads: 3, scheduling: ros2_executor, callback_groups: {quick: [fast], lazy: [g.slow]}}
  free: {implements: [], container: crate, reentrant: true}
hosts: {pc: {cores: 4, scheduling: edf}, arm: {scheduling: {0: fifo, 2: round_robin}}}
containers: {box: {host: pc, threads: 2, scheduling: non_preemptive}, crate: {title: Crate}}
resources: {gpu: {host: pc, scheduling: fixed_priority}, tpu: {}}
"""


def built(timing: str = "") -> TimingSystem:
    return build_system(architecture(TEXT.replace("TIMING", timing), is_fair=True))[0]


def mind(timing: str) -> tuple[Activity, int]:
    """Return the activity `mind`, and how many ticks a millisecond has."""
    system = built(timing)
    return system.activities["mind"], int(MS / system.tick)


def test_a_process_is_a_container_or_a_node_outside_of_one() -> None:
    assert list(built().executors.values()) == [
        Executor("container box", 2, "pc", "non_preemptive", suspends=True, usual_order="ros2_executor"),
        Executor("container crate", 1, None, None, usual_order="ros2_executor"),
        Executor("node mind", 1, "pc", None, usual_order="ros2_executor"),
        Executor("node hands", 3, "arm", "ros2_executor", usual_order="ros2_executor"),
        Executor("node planned", 1, None, None, usual_order="ros2_executor"),
    ]
    assert {name: activity.executor for name, activity in built().activities.items()} == {
        "eye": "container box",
        "mind": "node mind",
        "hands.fast": "node hands",
        "hands.slow": "node hands",
        "hands.idle": "node hands",
        "free": "container crate",
        "planned": "node planned",
    }


def test_a_container_without_a_host_is_where_its_nodes_are() -> None:
    text = TEXT.replace("TIMING", "").replace("free: {implements: [], ", "free: {implements: [], host: arm, ")
    assert build_system(architecture(text))[0].executors["container crate"].host == "arm"


def test_activities_of_a_node_exclude_one_another_unless_it_says_otherwise() -> None:
    assert {name: activity.callback_group for name, activity in built().activities.items()} == {
        "eye": "eye",
        "mind": "mind",
        "hands.fast": "hands.quick",
        "hands.slow": "hands.lazy",
        "hands.idle": "hands",
        "free": None,
        "planned": "planned",
    }


def test_orders_and_resources_are_those_that_are_written() -> None:
    system = built()
    assert system.host_orders == {"pc": "edf"}
    assert system.core_orders == {("arm", 0): "fifo", ("arm", 2): "round_robin"}
    assert system.resources == {
        "gpu": SharedResource("gpu", "pc", "fixed_priority"),
        "tpu": SharedResource("tpu", None, "fifo", is_order_assumed=True),
    }


def test_execution_times_uses_and_cores_are_in_ticks() -> None:
    system = built()
    eye, ms = system.activities["eye"], int(MS / system.tick)
    assert (eye.wcet, eye.percentiles, eye.wcet_measured) == (4 * ms, {"p50": ms, "p99": 3 * ms}, True)
    assert eye.uses == {"gpu": ResourceUse(6 * ms, 2 * ms), "tpu": ResourceUse(1 * ms, 0)}
    assert (eye.cores, eye.core) == ((1, 3), None)


@pytest.mark.parametrize(
    ("timing", "storing"),
    [
        ("behaviour: event", {}),
        ("rate: 10 Hz", {"image": (0, 0), "cloud": (0, 0)}),
        ("behaviour: on_demand, inputs: {cloud: {wcet: 3 ms}}", {"image": (0, 0), "cloud": (3, 0)}),
        ("behaviour: event, trigger: [image], inputs: {cloud: {wcet: 3 ms, bcet: 1 ms}}", {"cloud": (3, 1)}),
        ("behaviour: event, trigger: [light]", {"image": (0, 0), "cloud": (0, 0)}),
        ("behaviour: event, trigger: {match: [image, cloud], within: 5 ms}", {}),
    ],
)
def test_what_fires_nobody_and_carries_messages_is_stored(timing: str, storing: dict[str, tuple[int, int]]) -> None:
    activity, ms = mind(timing)
    assert activity.storing == {
        f"g.mind.{name}": StoringCallback(wcet * ms, bcet * ms) for name, (wcet, bcet) in storing.items()
    }


def test_matched_inputs_fire_within_a_window() -> None:
    activity, ms = mind("behaviour: event, trigger: {match: [image, cloud], within: 0.5 ms}")
    assert (activity.mode, activity.triggers) == ("match", ("g.mind.image", "g.mind.cloud"))
    assert activity.within == ms / 2
    assert mind("behaviour: event, trigger: {match: [image, cloud], within: 0 ms}")[0].within == 0
    assert mind("behaviour: event, trigger: {all: [image, cloud]}")[0].within is None


def test_what_is_dropped_is_kept_unless_it_is_forgotten() -> None:
    assert [mind(f"every: 2{word}")[0].keeps_dropped for word in ("", ", dropped: kept", ", dropped: forgotten")] == [
        True,
        True,
        False,
    ]


def test_a_deadline_and_freshness_are_in_ticks() -> None:
    activity, ms = mind("deadline: 7 ms")
    assert (activity.deadline, activity.freshness) == (7 * ms, {"g.mind.image": 20 * ms})
    assert mind("rate: 10 Hz")[0].deadline is None
