"""The plan of a start-up: what waits for what, in which order, and which waits are given up."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.bringup.plan_shapes import StartPlan
from archgen.bringup.start_plan import make_start_plan
from archgen.model.architecture import Architecture

Derived = Callable[[str], Architecture]


def waits_of(plan: StartPlan) -> dict[str, list[str]]:
    """Give what each step waits for with the reasons."""
    return {step.id: [f"{wait.awaited} ({wait.reason})" for wait in step.waits] for step in plan.steps}


def dropped(plan: StartPlan) -> list[str]:
    """Give the waits that were given up, with their circles."""
    return [
        f"{each.wait.waiting} waits for {each.wait.awaited} ({each.wait.reason}): {' '.join(each.circle) or 'phases'}"
        for each in plan.dropped
    ]


STACK = """
groups:
  g:
    components:
      laser: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      localiser: {inputs: {scan: laser.scan, twist: {from: control.twist, optional: true}}, outputs: {pose: geometry_msgs/msg/PoseStamped}}
      planner: {inputs: {pose: localiser.pose, map: maps.get}, outputs: {path: nav_msgs/msg/Path}}
      control: {inputs: {path: planner.path, pose: localiser.pose}, outputs: {twist: geometry_msgs/msg/TwistStamped}, timing: {rate: 10 Hz}}
      maps: {outputs: {get: nav_msgs/srv/GetMap}}
nodes:
  control: {implements: control, package: p, executable: c}
  planner: {implements: planner, container: box, package: p, plugin: "p::Planner"}
  localiser: {implements: localiser, package: p, executable: l, namespace: /n, parameter_files: [l.yaml]}
  laser: {implements: laser, kind: lifecycle, package: p, executable: s, start: {state: active, ready: {topic: /g/laser/scan, within: 5 s}}}
  maps: {implements: maps, kind: lifecycle, package: p, executable: m, start: {by: manager}}
  manager: {package: nav2_lifecycle_manager, executable: lifecycle_manager, start: {phase: core}}
  stage: {kind: program, command: [stage, "my world"], start: {phase: simulators, user: root, ready: {port: 80}}}
  upload: {kind: program, command: [ip, link], start: {phase: network, once: true}}
containers: {box: {threads: 4}}
"""


def test_sources_before_readers_servers_before_clients_containers_before_nodes(derived: Derived) -> None:
    plan = make_start_plan(derived(STACK))
    assert waits_of(plan) == {
        "upload": [],
        "stage": [],
        "manager": [],
        "box": [],
        "laser": [],
        "localiser": ["laser (data)"],
        "maps": [],
        "planner": ["box (container)", "maps (service)", "localiser (data)", "manager (managed)"],
        "control": ["localiser (sampled)", "planner (sampled)"],
    }
    assert dropped(plan) == [
        "manager waits for maps (manages): phases",
        "localiser waits for control (optional): localiser control",
    ]
    assert plan.circles == ()


def test_steps_say_all_that_starts_them(derived: Derived) -> None:
    plan = make_start_plan(derived(STACK))
    assert {step.id: (step.kind, step.phase, " ".join(step.command)) for step in plan.steps} == {
        "upload": ("program", "network", "ip link"),
        "stage": ("program", "simulators", "stage my world"),
        "manager": (
            "node",
            "core",
            "ros2 run nav2_lifecycle_manager lifecycle_manager --ros-args -r __node:=manager",
        ),
        "box": (
            "container",
            "components",
            "ros2 run rclcpp_components component_container_mt --ros-args -r __node:=box -p thread_num:=4",
        ),
        "laser": ("node", "components", "ros2 run p s --ros-args -r __node:=laser -r scan:=/g/laser/scan"),
        "localiser": (
            "node",
            "components",
            (
                "ros2 run p l --ros-args -r __node:=localiser -r __ns:=/n -r pose:=/g/localiser/pose -r scan:=/g/laser/scan"
                " -r twist:=/g/control/twist --params-file l.yaml"
            ),
        ),
        "maps": ("node", "components", "ros2 run p m --ros-args -r __node:=maps -r get:=/g/maps/get"),
        "planner": (
            "composable",
            "components",
            (
                "ros2 component load /box p p::Planner --node-name planner -r path:=/g/planner/path -r pose:=/g/localiser/pose"
                " -r map:=/g/maps/get -e use_intra_process_comms:=true"
            ),
        ),
        "control": (
            "node",
            "components",
            (
                "ros2 run p c --ros-args -r __node:=control -r twist:=/g/control/twist -r path:=/g/planner/path"
                " -r pose:=/g/localiser/pose"
            ),
        ),
    }
    steps = {step.id: step for step in plan.steps}
    assert [words[-1] for words in steps["laser"].transitions] == ["configure", "activate"]
    assert (steps["maps"].transitions, steps["maps"].manager, steps["maps"].state) == ((), ("manager",), "active")
    assert steps["stage"].needs_rights == ("to run as the user root", "to open the port 80")
    assert (steps["upload"].needs_rights, steps["upload"].once) == (("to change the system with ip",), True)


def test_steps_say_what_a_generator_of_scripts_needs(derived: Derived) -> None:
    plan = make_start_plan(derived(STACK + "hosts: {pc: PC}\n"))
    steps = {step.id: step for step in plan.steps}
    assert [(phase, [step.id for step in each]) for phase, each in plan.phases][:3] == [
        ("network", ["upload"]),
        ("simulators", ["stage"]),
        ("core", ["manager"]),
    ]
    assert plan.hosts == (None,)
    assert {step.id: step.log_file for step in plan.steps} == {name: f"{name}.log" for name in steps}
    shown = {
        step.id: ([(signal.kind, signal.target) for signal in step.signals], step.seconds_at_most)
        for step in plan.steps
        if step.signals
    }
    assert shown == {
        "upload": ([("end", "")], None),
        "stage": ([("port", "80")], "60"),
        "laser": ([("topic", "/g/laser/scan")], "5"),
    }
    assert [(each.awaited, each.until, len(each.waits)) for each in steps["planner"].awaited] == [
        ("box", "ready", 1),
        ("maps", "ready", 1),
        ("localiser", "ready", 1),
        ("manager", "ready", 1),
    ]
    assert steps["stage"].ros is None
    assert steps["localiser"].ros is not None
    assert (steps["localiser"].ros.full_name, steps["localiser"].ros.package) == ("/n/localiser", "p")


@pytest.mark.parametrize(
    ("ready", "signals", "seconds"),
    [
        ("wait: 1500 ms", [("time", "1.5")], "62"),
        ("port: 1, file: /a, log: up, within: 0.25 s", [("port", "1"), ("file", "/a"), ("log", "up")], "0.25"),
        ("service: get, within: 2 min", [("service", "/get")], "120"),
    ],
)
def test_how_long_one_waits_at_most(derived: Derived, ready: str, signals: list[tuple[str, str]], seconds: str) -> None:
    (step,) = make_start_plan(
        derived(f"nodes: {{a: {{kind: program, command: [a], start: {{ready: {{{ready}}}}}}}}}")
    ).steps
    assert ([(each.kind, each.target) for each in step.signals], step.seconds_at_most) == (signals, seconds)


def test_what_is_awaited_is_up_started_or_at_its_end(derived: Derived) -> None:
    plan = make_start_plan(
        derived("""
nodes:
  clock: {kind: program, command: [c], start: {once: true, ready: {within: 9 s}}}
  maps: {kind: lifecycle, package: p, executable: m, start: {by: manager, after: clock}}
  manager: {package: q, executable: m}
  last: {package: q, executable: l, start: manager}
""")
    )
    assert {step.id: [(each.awaited, each.until) for each in step.awaited] for step in plan.steps} == {
        "clock": [],
        "maps": [("clock", "ended")],
        "manager": [("maps", "started")],
        "last": [("manager", "ready")],
    }
    assert plan.steps[0].seconds_at_most == "9"


def test_ros_1_has_commands_of_its_own(derived: Derived) -> None:
    plan = make_start_plan(
        derived("""
groups: {g: {components: {a: A, b: B, c: C, d: D, e: E}}}
ros: {distro: noetic}
nodes:
  a: {implements: a, kind: nodelet, plugin: p/A, container: box}
  b: {implements: b, package: p, executable: b, namespace: n}
  c: {implements: c, kind: nodelet, plugin: p/C}
  d: {implements: d, container: own, status: existing}
  e: {implements: e, status: planned}
containers: {box: {namespace: m}, own: {package: q, executable: q}}
""")
    )
    assert {step.id: " ".join(step.command) for step in plan.steps} == {
        "box": "rosrun nodelet nodelet manager __name:=box __ns:=/m",
        "a": "rosrun nodelet nodelet load p/A /m/box __name:=a",
        "b": "rosrun p b __name:=b __ns:=/n",
        "c": "rosrun nodelet nodelet standalone p/C __name:=c",
        "own": "rosrun q q __name:=own",
        "d": "",
        # What generators make of it.
        "e": "rosrun robot_g e __name:=e",
    }


def test_a_container_starts_with_the_earliest_of_its_nodes(derived: Derived) -> None:
    plan = make_start_plan(
        derived("""
groups: {g: {components: {a: A, b: B}}}
nodes:
  a: {implements: a, container: b, start: {phase: core}}
  b: {implements: b, container: b}
containers: {b: , idle: }
""")
    )
    assert [(step.id, step.phase) for step in plan.steps] == [
        ("container b", "core"),
        ("a", "core"),
        ("b", "components"),
        ("idle", "components"),
    ]


def ring(*needs: str) -> str:
    """Give components in a circle; each reads the one before it, with what is added there."""
    count = len(needs)
    components = (
        f"n{at}: {{inputs: {{i: {{from: n{(at - 1) % count}.o{', optional: true' if need == 'optional' else ''}}}}}, "
        f"outputs: {{o: std_{'srvs/srv/Trigger' if needs[(at + 1) % count] == 'service' else 'msgs/msg/Bool'}}}"
        f"{', timing: {rate: 1 Hz}' if need == 'sampled' else ''}}}"
        for at, need in enumerate(needs)
    )
    return f"groups: {{g: {{components: {{{', '.join(components)}}}}}}}\nnodes: {{{', '.join(f'n{at}: n{at}' for at in range(count))}}}\n"


@pytest.mark.parametrize(
    ("needs", "given_up"),
    [
        (("data", "optional", "sampled"), "n1 waits for n0 (optional): n1 n2 n0"),
        (("data", "sampled", "service"), "n1 waits for n0 (sampled): n1 n2 n0"),
        (("service", "data", "service"), "n1 waits for n0 (data): n1 n2 n0"),
        (("data", "data", "data"), "n0 waits for n2 (data): n0 n1 n2"),
    ],
)
def test_a_circle_is_cut_where_least_is_needed(derived: Derived, needs: tuple[str, ...], given_up: str) -> None:
    plan = make_start_plan(derived(ring(*needs)))
    assert dropped(plan) == [given_up]
    assert len(plan.steps) == 3


def test_after_and_phases_never_give_way(derived: Derived) -> None:
    text = ring("service", "service").replace("n0: n0", "n0: {implements: n0, start: {after: n1}}")
    assert dropped(make_start_plan(derived(text))) == ["n1 waits for n0 (service): n1 n0"]
    text = ring("service", "data").replace("n0: n0", "n0: {implements: n0, start: {phase: core}}")
    assert dropped(make_start_plan(derived(text))) == ["n0 waits for n1 (service): phases"]


def test_who_waits_for_a_component_waits_for_all_of_its_nodes(derived: Derived) -> None:
    plan = make_start_plan(
        derived("""
groups: {g: {components: {arm: {components: {left: L, right: R}}, b: B, c: C}}}
nodes:
  b: {implements: b, start: arm}
  left: left
  right: right
  second: {implements: right, start: right}
  c: {implements: c, start: [second, b]}
""")
    )
    assert waits_of(plan) == {
        "left": [],
        "right": [],
        "second": ["right (after)"],
        "b": ["left (after)", "right (after)", "second (after)"],
        "c": ["b (after)", "second (after)"],
    }


def test_what_describes_a_start_up(derived: Derived) -> None:
    assert derived(STACK).describes_start()
    assert not derived(ring("data", "data")).describes_start()
    assert derived("nodes: {a: {kind: program, command: [a]}}").describes_start()
    assert derived(
        "groups: {g: {components: {a: A}}}\nnodes: {a: {implements: a, start: {phase: core}}}"
    ).describes_start()


def test_of_many_components_with_loops_none_is_lost(derived: Derived) -> None:
    count = 300
    components = ", ".join(
        f"c{at}: {{inputs: {{i: c{(at * 7 + 1) % count}.o, j: {{from: c{max(at - 3, 0)}.o, optional: true}}}}, outputs: {{o: std_msgs/msg/Bool}}}}"
        for at in range(count)
    )
    architecture = derived(f"groups: {{g: {{components: {{{components}}}}}}}")
    plan = make_start_plan(architecture)
    assert len(plan.steps) == count
    assert plan == make_start_plan(architecture)


@pytest.mark.parametrize(
    ("distro", "expected"),
    [
        (
            "jazzy",
            {
                "a": "ros2 run p a --fast a b --ros-args -r __node:=a -r out:=/g/a/o -r /tf:=tf",
                "b": "ros2 component load /box p p::B --node-name b -r in:=/g/a/o -e use_intra_process_comms:=true",
            },
        ),
        (
            "noetic",
            {
                "a": "rosrun p a --fast a b __name:=a out:=/g/a/o /tf:=tf",
                "b": "rosrun nodelet nodelet load p::B /box __name:=b in:=/g/a/o",
            },
        ),
    ],
)
def test_programs_get_their_arguments_and_new_names(derived: Derived, distro: str, expected: dict[str, str]) -> None:
    text = """
ros: {distro: %s}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Empty}}, b: {inputs: {o: a.o}}}}}
nodes:
  a: {implements: a, package: p, executable: a, arguments: [--fast, a b], remaps: {/tf: tf}, publishes: {o: {own_name: out}}}
  b: {implements: b, kind: [composable, nodelet], package: p, plugin: "p::B", container: box, subscribes: {o: {own_name: in}}}
containers: {box: }
"""
    plan = make_start_plan(derived(text % distro))
    assert {step.id: " ".join(step.command) for step in plan.steps if step.id != "box"} == expected


def test_new_names_reach_all_parts_of_an_action(derived: Derived) -> None:
    text = """
groups: {g: {components: {a: {outputs: {o: A}}}}}
types: {A: nav2_msgs/action/Spin}
nodes: {a: {implements: a, package: p, executable: a, serves: {o: {name: /turn, own_name: spin}}}}
"""
    (step,) = make_start_plan(derived(text)).steps
    assert step.ros is not None
    assert list(step.ros.remaps.items())[:2] == [
        ("spin/_action/send_goal", "/turn/_action/send_goal"),
        ("spin/_action/cancel_goal", "/turn/_action/cancel_goal"),
    ]


def test_sources_in_another_order_change_no_plan(derived: Callable[[str], Architecture]) -> None:
    """Generated scripts say for whom a step waits: what moves in a list changes none of them."""
    text = """
        groups: {g: {components: {left: {outputs: {o: T}}, right: {outputs: {o: T}}, guard: {inputs: {arms: [left.o, right.o]}}}}}
        types: {T: std_msgs/msg/Bool}
        """
    plans = [make_start_plan(derived(each)) for each in (text, text.replace("[left.o, right.o]", "[right.o, left.o]"))]
    assert [each.awaited for each in plans[0].steps[-1].awaited] == ["left", "right"]
    assert plans[0].steps == plans[1].steps
