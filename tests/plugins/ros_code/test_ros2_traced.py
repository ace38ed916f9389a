"""Generated nodes are run as they are started, and traced: no order and no number of threads is seen that the analysis excludes."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.timing_system import TimingSystem
from archgen.views.generation.generation_context import GenerationContext
from tests.ros_environment import NEWEST_PYTHON, make_ros_python, ros_environment
from tests.running import archgen_here
from tests.timing.random_systems import architecture

SECONDS = 6
TRACER = Path(__file__).with_name("traced_node.py")
SEEDS = range(50) if os.environ.get("ARCHGEN_DRAW_ANEW") else range(3)
"""As many projects as `make properties` draws take minutes."""


class Job(NamedTuple):
    """A callback that ran: of which activity, on which thread, from when to when (s), and how much of it it computed."""

    activity: str
    callback: str
    thread: int
    begin: float
    end: float
    computed: float
    data: str


@pytest.mark.ros
@pytest.mark.hypothesis
@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_is_seen_that_the_analysis_excludes(seed: int, tmp_path: Path) -> None:
    if sys.version_info[:2] > NEWEST_PYTHON or sys.platform != "linux":
        pytest.skip(f"there is no ROS 2 for {sys.platform} and Python {sys.version.split()[0]}")
    (tmp_path / "archgen.yaml").write_text(json.dumps(_random_project(seed)))
    project = check_project(tmp_path).architecture
    system, _ = build_system(project)
    archgen_here("generate", "ros2_python", "-o", tmp_path / "w", "--keep-going", cwd=tmp_path)
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    descriptions = [
        _describe_program(system, program, tmp_path, dice)
        for program in make_view(GenerationContext(project)).data["programs"]
    ]
    environment = ros_environment(seed, tmp_path) | {"PYTHONPATH": str(tmp_path / "w" / "src" / "rt_g")}
    processes = [
        subprocess.Popen(  # noqa: S603 - a program of this test
            [str(make_ros_python()), str(TRACER), json.dumps(description)],
            env=environment,
            stderr=subprocess.PIPE,
        )
        for description, _ in descriptions
    ]
    errors = [process.communicate(timeout=120)[1].decode() for process in processes]
    assert [process.returncode for process in processes] == [0] * len(processes), errors
    rows_of = {str(each["file"]): json.loads(Path(str(each["file"])).read_text()) for each, _ in descriptions}
    sent_at = {f"{file} {at}": row[3] for file, rows in rows_of.items() for at, row in enumerate(rows)}
    for description, activities in descriptions:
        jobs = [Job(activities[name], name, *rest) for name, *rest in rows_of[str(description["file"])]]
        assert jobs, (description, errors)
        assert find_excluded(system, jobs) == []
        assert find_extra_turns(system, jobs, sent_at) == []


def find_extra_turns(system: TimingSystem, jobs: Sequence[Job], sent_at: Mapping[str, float]) -> list[str]:
    """Say which callback of one thread had more turns while a message waited than there were rounds: the one under way, and
    one for each message of the same subscription that was worked on until then.

    Messages that have been sent for 0.1 s have arrived: this computer does other things, too.
    """
    if system.executors[system.activities[jobs[0].activity].executor].threads != 1:
        return []
    begins: dict[str, list[float]] = {}
    for job in jobs:
        begins.setdefault(job.callback, []).append(job.begin)
    return [
        f"{other}, {turns} of {rounds} rounds, before {job}"
        for job in jobs
        if job.data
        for rounds in [1 + sum(sent_at[job.data] + 0.1 < begin <= job.begin for begin in begins[job.callback])]
        for other, others in begins.items()
        if (turns := sum(sent_at[job.data] + 0.1 < begin < job.begin for begin in others)) > rounds
    ]


def find_excluded(system: TimingSystem, jobs: Sequence[Job]) -> list[str]:
    """Say what was seen in a process that the analysis excludes."""
    executor = system.executors[system.activities[jobs[0].activity].executor]
    wrong = (
        [f"{len({job.thread for job in jobs})} threads"]
        if len({job.thread for job in jobs}) > (executor.threads or 99)
        else []
    )
    ordered = sorted(jobs, key=lambda job: job.begin)
    cluster: list[Job] = []
    for job in ordered:
        running = [each for each in cluster if each.end > job.begin]
        if len(running) + 1 > (executor.threads or 99):
            wrong.append(f"{len(running) + 1} at once: {job}")
        group = system.activities[job.activity].callback_group
        wrong += [
            f"{job} beside {each}"
            for each in running
            if group is not None and system.activities[each.activity].callback_group == group
        ]
        if running:
            cluster.append(job)
        else:
            cluster = [job]
        wall = max(each.end for each in cluster) - cluster[0].begin
        computed = sum(each.computed for each in cluster)
        if executor.is_serial and computed > wall + 0.002:
            wrong.append(f"{computed} s computed in {wall} s: {cluster}")
    return wrong


def test_what_is_excluded_is_found() -> None:
    text = {
        "nodes": {
            "n": {
                "implements": ["a", "b"],
                "language": "python",
                "threads": 2,
                "callback_groups": {"x": ["a"], "y": ["b"]},
            }
        }
    }
    components = {name: {"outputs": {"out": "std_msgs/msg/String"}} for name in "ab"}
    system, _ = build_system(architecture(json.dumps({"groups": {"g": {"components": components}}, **text})))
    beside = [Job("n.a", "a", 1, 0, 2, 1, ""), Job("n.b", "b", 2, 1, 3, 1, "")]
    assert find_excluded(system, beside) == []
    assert len(find_excluded(system, [job._replace(computed=2) for job in beside])) == 1  # 4 s of computing in 3 s
    assert len(find_excluded(system, [beside[0], beside[1]._replace(activity="n.a")])) == 1  # one group
    third = [*beside, Job("n.b", "b", 3, 1.5, 3, 0, "")]
    assert len(find_excluded(system, third)) == 3  # three threads, three at once, one group


def _random_project(seed: int) -> dict[str, object]:
    """Make nodes of one to three components in Python, of one to three threads, that read one another."""
    dice = random.Random(1000 + seed)  # noqa: S311 - a test's dice
    components: dict[str, dict[str, object]] = {}
    nodes: dict[str, dict[str, object]] = {}
    for at in range(dice.randint(2, 3)):
        members = [f"c{at}{name}" for name in "abc"[: dice.randint(1, 3)]]
        for name in members:
            timing: dict[str, object] = {"wcet": "10 ms"}
            sources = [
                f"{other}.out" for other in dice.sample(list(components), min(len(components), dice.randint(0, 2)))
            ]
            if not sources or dice.random() < 0.5:
                timing["period"] = f"{dice.choice((60, 80, 100, 150))} ms"
            inputs = {"i": sources} if sources else {}
            components[name] = {
                "functionality": "Works.",
                "inputs": inputs,
                "outputs": {"out": "std_msgs/msg/String"},
                "timing": timing,
            }
        node: dict[str, object] = {"implements": members, "language": "python", "threads": dice.choice((1, 2, 3))}
        if len(members) > 1 and dice.random() < 0.6:
            node["callback_groups"] = {f"g{name}": [name] for name in members}
        elif dice.random() < 0.4:
            node["reentrant"] = True
        nodes[f"n{at}"] = node
    return {
        "archgen": 1,
        "project": {"id": "rt", "title": "Robot"},
        "ros": {"distro": "jazzy"},
        "groups": {"g": {"components": components}},
        "nodes": nodes,
    }


def _describe_program(
    system: TimingSystem, program: Mapping[str, object], folder: Path, dice: random.Random
) -> tuple[dict[str, object], dict[str, str]]:
    """Say what the callbacks of a program do, and to which activity each belongs."""
    node: Mapping[str, str] = program["nodes"][0]  # type: ignore[index]
    activity_of = {each.component: each for each in system.activities.values() if each.node == node["id"]}
    callbacks: dict[str, tuple[float, list[str]]] = {}
    activities: dict[str, str] = {}

    def add_callback(name: str, component: str, *, sends: bool) -> None:
        sent = [
            each["key"]
            for each in program["publishers"]  # type: ignore[attr-defined]
            if sends and str(each["port"]).rpartition(".")[0] == component
        ]
        callbacks[name] = (dice.choice((0.001, 0.003, 0.008)), sent)
        activities[name] = activity_of[component].id

    for timer in program["timers"]:  # type: ignore[attr-defined]
        add_callback(f"on_timer{'_' if timer['key'] else ''}{timer['key']}", timer["component"], sends=True)
    for each in program["subscriptions"]:  # type: ignore[attr-defined]
        component = str(each["port"]).rpartition(".")[0]
        fires = each["port"] in activity_of[component].triggers
        add_callback(f"receive_{each['key']}", component, sends=fires)
    return {
        "module": f"{program['package']}.{program['module']}_node",
        "class": program["class_name"],
        "seconds": SECONDS,
        "file": str(folder / f"{node['id']}.json"),
        "callbacks": callbacks,
    }, activities
