"""The priority and cores of a process: what timing takes all that it runs to have, and nothing where that differs."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.bringup.start_plan import make_start_plan
from archgen.model.architecture import Architecture
from archgen.model.process_scheduling import NO_SCHEDULING, read_scheduling

ROBOT = """
groups: {{g: {{components: {{a: {{outputs: {{x: std_msgs/msg/Empty}}}}, b: {{inputs: {{x: a.x}}}}}}}}}}
hosts: {{pc: {{cores: 4{host}}}}}
containers: {{box: {{host: pc}}}}
nodes:
  a: {{implements: a, {where}, timing: {{rate: 10 Hz, wcet: 1 ms{a}}}}}
  b: {{implements: b, {where}, timing: {{wcet: 1 ms{b}}}}}
"""


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        (("host: pc", "", ", priority: 20", ""), {"a": "chrt -f 20", "b": ""}),
        (("host: pc", "", ", priority: 99, core: 3", ", cores: [0, 2]"), {"a": "chrt -f 99 taskset -c 3", "b": "taskset -c 0,2"}),
        # Threads of one process: one priority and one set of cores, or none.
        (("container: box", "", ", priority: 20, core: 1", ", priority: 20, core: 1"), {"box": "chrt -f 20 taskset -c 1", "a": "", "b": ""}),
        (("container: box", "", ", priority: 20, core: 1", ", priority: 10, core: 1"), {"box": "taskset -c 1", "a": "", "b": ""}),
        (("container: box", "", ", priority: 20, core: 1", ""), {"box": "", "a": "", "b": ""}),
        # Orders that the kernel does not keep by priorities, on the host or on the core that counts.
        (("host: pc", ", scheduling: fixed_priority", ", priority: 5", ""), {"a": "chrt -f 5", "b": ""}),
        (("host: pc", ", scheduling: round_robin", ", priority: 5", ""), {"a": "", "b": ""}),
        (("host: pc", ", scheduling: {3: edf}", ", priority: 5, core: 3", ", priority: 5"), {"a": "taskset -c 3", "b": "chrt -f 5"}),
        # SCHED_FIFO has no such priorities.
        (("host: pc", "", ", priority: 0", ", priority: 100"), {"a": "", "b": ""}),
    ],
)  # fmt: skip
def test_a_process_has_what_all_that_it_runs_has(
    parts: tuple[str, str, str, str], words: dict[str, str], derived: Callable[[str], Architecture]
) -> None:
    plan = make_start_plan(derived(ROBOT.format(**dict(zip(("where", "host", "a", "b"), parts, strict=True)))))
    assert {step.id: " ".join(step.scheduling.words) for step in plan.steps} == {"box": "", **words}
    for step in plan.steps:
        rights = [f"to run with the real-time priority {step.scheduling.priority}"] if step.scheduling.priority else []
        assert list(step.needs_rights) == rights


def test_what_no_computer_runs_has_no_priority(derived: Callable[[str], Architecture]) -> None:
    text = (
        "groups: {g: {components: {a: A}}}\nnodes: {a: {implements: a, timing: {rate: 1 Hz, wcet: 1 ms, priority: 9}}}"
    )
    assert make_start_plan(derived(text)).steps[0].scheduling == NO_SCHEDULING


@pytest.mark.parametrize(
    ("words", "priority", "cores", "rest"),
    [
        ("chrt -f 40", 40, (), ""),
        ("taskset -c 2,5-7 chrt --fifo 40 gdb -ex run", 40, (2, 5, 6, 7), "gdb -ex run"),
        ("/opt/ws/lib/bot/run_scheduled chrt -f 40 taskset --cpu-list 3 --", 40, (3,), ""),
        ("chrt 40", None, (), "chrt 40"),
        ("chrt -f 0", None, (), "chrt -f 0"),
        ("chrt -f 123456789012345678901234567890", None, (), "chrt -f 123456789012345678901234567890"),
        ("taskset -c 0-99999", None, (), "taskset -c 0-99999"),
        ("taskset -c 1,x", None, (), "taskset -c 1,x"),
        ("taskset -c 5-2", None, (), "taskset -c 5-2"),
        ("chrt -f 00400", None, (), "chrt -f 00400"),
        ("nice -n 5 chrt -f 3", None, (), "nice -n 5 chrt -f 3"),
        ("", None, (), ""),
    ],
)
def test_what_stands_in_front_of_a_command_is_read(
    words: str, priority: int | None, cores: tuple[int, ...], rest: str
) -> None:
    scheduling, left = read_scheduling(words.split())
    assert (scheduling.priority, scheduling.cores, " ".join(left)) == (priority, cores, rest)
    assert read_scheduling(scheduling.words) == (scheduling, ())
