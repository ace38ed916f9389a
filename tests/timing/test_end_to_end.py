"""From YAML to chains: published task sets and the hot path of the Autoware-shaped reference system."""

from __future__ import annotations

from pathlib import Path

import pytest

import archgen
from archgen.emit.data import timing_json
from archgen.timing.chains import duerr_bounds

S1 = {"a": (10, 1), "b": (20, 2)}
S2 = {"imu": (5, 1), "ctrl": (10, 2), "loc": (20, 4), "plan": (100, 20)}


def _project(folder: Path, text: str) -> archgen.api.Project:
    (folder / "archgen.yaml").write_text(f"archgen: 1\n{text}", encoding="utf-8")
    project = archgen.load(folder)
    assert project.ok, [d.message for d in project.findings]
    return project


def _tasks(tasks: dict[str, tuple[int, int]], chain: str) -> str:
    components, nodes = [], []
    for at, (name, (period, wcet)) in enumerate(tasks.items()):
        others = ", ".join(f"from_{other}: {other}.out" for other in tasks if other != name)
        # As published: what has been written is there to be read, and no callback has to store it.
        stored = ", ".join(f"from_{other}: {{stored: at_once}}" for other in tasks if other != name)
        timing = f"{{period: {period} ms, wcet: {wcet} ms, bcet: {wcet} ms, priority: {90 - at}, inputs: {{{stored}}}}}"
        components.append(f"      {name}: {{inputs: {{{others}}}, outputs: {{out: std_msgs/msg/String}}}}")
        nodes.append(f"  {name}_node: {{implements: {name}, host: pc, timing: {timing}}}")
    through = ", ".join(f"{name}_node" for name in chain.split())
    head = f"hosts: {{pc: {{cores: 1}}}}\nchains: {{c: {{through: [{through}]}}}}\ngroups:\n  g:\n    components:\n"
    return head + "\n".join(components) + "\nnodes:\n" + "\n".join(nodes) + "\n"


@pytest.mark.parametrize(
    ("tasks", "chain", "responses", "expected"),
    [
        (S1, "a b", [1, 3], (34, 33, 13)),
        (S1, "b a", [3, 1], (34, 34, 24)),
        (S2, "imu ctrl", [1, 3], (19, 18, 8)),
        (S2, "imu loc plan ctrl", [1, 8, 55, 3], (202, 193, 183)),
        (S2, "plan ctrl imu", [55, 3, 1], (174, 174, 169)),
    ],
)
def test_published_task_sets(
    tmp_path: Path, tasks: dict[str, tuple[int, int]], chain: str, responses: list[int], expected: tuple[int, int, int]
) -> None:
    project = _project(tmp_path, _tasks(tasks, chain))
    result = project.chains()["c"]
    assert [term.response.value for term in result.terms] == [response * 10**6 for response in responses]
    assert result.bound.complete
    published = duerr_bounds.bound_periodic_chain(project.timing(), result.through) or ()
    assert [value // 10**6 for value in (result.bound.value or 0, *published)] == list(expected)


def test_published_bounds_are_not_shown_where_a_callback_has_to_store_what_is_read(tmp_path: Path) -> None:
    """While `a` works for 1 ms, a message to `b` waits, and `b` may be activated meanwhile: it reads the older one."""
    text = _tasks(S1, "a b").replace("{stored: at_once}", "{}")
    project = _project(tmp_path, text)
    result = project.chains()["c"]
    assert (result.bound.value, result.bound.complete) == (35 * 10**6, True)
    assert duerr_bounds.bound_periodic_chain(project.timing(), result.through) is None


HOT_PATH = """
groups:
  lidar:
    components:
      front: {outputs: {points: sensor_msgs/msg/PointCloud2}, timing: {period: 100 ms, wcet: 0 ms, bcet: 0 ms}}
      rear: {outputs: {points: sensor_msgs/msg/PointCloud2}, timing: {period: 100 ms, wcet: 0 ms, bcet: 0 ms}}
      turn_front: {inputs: {raw: front.points}, outputs: {points: sensor_msgs/msg/PointCloud2}, timing: &ten {wcet: 10 ms, bcet: 10 ms}}
      turn_rear: {inputs: {raw: rear.points}, outputs: {points: sensor_msgs/msg/PointCloud2}, timing: *ten}
      fusion:
        inputs: {front: turn_front.points, rear: turn_rear.points}
        outputs: {points: sensor_msgs/msg/PointCloud2}
        timing: {trigger: all, wcet: 10 ms, bcet: 10 ms}
      ground: {inputs: {points: fusion.points}, outputs: {points: sensor_msgs/msg/PointCloud2}, timing: *ten}
      clusters: {inputs: {points: ground.points}, outputs: {objects: vision_msgs/msg/Detection3DArray}, timing: *ten}
      collisions: {inputs: {objects: clusters.objects}, timing: *ten}
chains:
  hot_path: {through: [lidar.front, lidar.collisions]}
"""


def test_the_hot_path_of_the_reference_system(tmp_path: Path) -> None:
    result = _project(tmp_path, HOT_PATH).chains()["hot_path"]
    assert result.bound.value == 250 * 10**6
    assert result.best.value == 50 * 10**6
    assert result.through == ("front", "turn_front", "fusion", "ground", "clusters", "collisions")


CONDITIONAL = """
groups:
  g:
    components:
      eye: {outputs: {frames: std_msgs/msg/String}, timing: {period: 100 ms, wcet: 10 ms, bcet: 10 ms}}
      watch:
        inputs: {frames: eye.frames}
        outputs: {alarm: std_msgs/msg/String}
        timing: {wcet: 20 ms, outputs: {alarm: {conditional: true%s}}}
      bell: {inputs: {alarm: watch.alarm}, timing: {wcet: 1 ms}}
chains:
  ring: {through: [eye, watch.alarm, bell], deadline: 200 ms}
"""


def test_what_is_sent_on_a_condition_is_sent_for_the_stimulus(tmp_path: Path) -> None:
    result = _project(tmp_path, CONDITIONAL % "").chains()["ring"]
    assert result.bound.value == 131 * 10**6
    assert result.verdict == "met"
    said = "watch publishes /g/watch/alarm for this very input"
    assert said in result.bound.assumptions
    plain = timing_json.chain_to_json(result)
    assert all(said in plain[figure]["assumptions"] for figure in ("bound", "reduced_reaction"))
    assert said in plain["terms"][-1]["sampling"]["assumptions"]


def test_a_promised_gap_needs_no_such_assumption(tmp_path: Path) -> None:
    result = _project(tmp_path, CONDITIONAL % ", max_gap: 2 s").chains()["ring"]
    assert result.bound.value == 2131 * 10**6
    assert result.verdict == "missed"
    assert result.deadline
    assert result.deadline.value is not None
    assert result.late_run
    assert result.deadline.value < result.late_run.longest <= result.bound.value


SERVICE = """
groups:
  g:
    components:
      boss:
        inputs: {help: helper.help}
        timing: {period: 100 ms, wcet: 5 ms}
      helper: {outputs: {help: std_srvs/srv/Trigger}, timing: {wcet: 30 ms}}
chains:
  ask: {through: [boss, helper]}
  answer: {through: [boss, helper, boss]}
"""


def test_a_call_triggers_its_server_and_the_answer_waits_to_be_taken(tmp_path: Path) -> None:
    chains = _project(tmp_path, SERVICE).chains()
    assert chains["ask"].bound.value == (100 + 5 + 0 + 30) * 10**6
    assert chains["answer"].bound.value == (100 + 5 + 0 + 30 + 100 + 5) * 10**6


SEVERAL = """
groups:
  g:
    components:
      eye: {outputs: {frames: std_msgs/msg/String}, timing: {period: 100 ms, wcet: 10 ms}}
      mind: {inputs: {frames: eye.frames}, outputs: {plan: std_msgs/msg/String}}
      arm: {inputs: {plan: mind.plan}, timing: {period: 10 ms, wcet: 1 ms}}
nodes:
  first:
    implements: mind
    subscribes: {frames: {}}
    publishes: {}
    internal: {publishes: {middle: {topic: middle, message: std_msgs/msg/String}}}
    timing: {wcet: 7 ms}
  second:
    implements: mind
    subscribes: {}
    publishes: {plan: {}}
    internal: {subscribes: {middle: {topic: middle, message: std_msgs/msg/String}}}
    timing: {wcet: 9 ms}
chains:
  c: {through: [eye, mind, arm]}
"""


def test_a_component_of_several_nodes_stands_for_the_worst_way_through_them(tmp_path: Path) -> None:
    result = _project(tmp_path, SEVERAL).chains()["c"]
    assert result.through == ("eye", "first", "second", "arm")
    assert result.bound.value == (100 + 10 + 7 + 9 + 10 + 1) * 10**6
