"""What happens when in a run: the order, the clock, and what makes a component active, as docs/program_simulation.md says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.plugins.middlewares.simulation.simulated_workspaces import generate, run_python

COUNTING = """\
class {name}Behaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        arrived = [value for port in self.component.inputs for value in port.fresh()]
        for port in self.component.outputs:
            port.send(" ".join([self.component.id[2:], *arrived]))
"""
"""Sends who it is, and what arrived since it was active last."""


def run_project(
    folder: Path, components: str, scenario: str, until: str = "100ms", behaviour: str = COUNTING
) -> list[str]:
    """Return the trace, or what the run says of a mistake, with each component of the group `g` as the behaviour says."""
    (folder / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: lab}\nrules: {missing-detail: off}\ntypes: {T: }\ngroups: {g: {components: {\n"
        + components
        + "\n}}}\n",
        "utf-8",
    )
    generate(folder, folder / "ws", backends=("python_simulation",))
    for path in (folder / "ws" / "python" / "lab_simulation" / "g").glob("*_behaviour.py"):
        (name,) = re.findall(r"class (\w+)Behaviour", path.read_text("utf-8"))
        path.write_text(behaviour.replace("{name}", name), "utf-8")
    (folder / "scenario.txt").write_text(scenario, "utf-8")
    status, trace, errors = run_python(folder / "ws", "lab_simulation", str(folder / "scenario.txt"), "--until", until)
    assert (status == 0) == (errors == ""), errors
    return [line.replace("000000 ", " ") for line in trace.splitlines()] + [
        line.replace(f"{folder}/", "") for line in errors.splitlines()
    ]


def test_the_order_within_an_instant(tmp_path: Path) -> None:
    trace = run_project(
        tmp_path,
        """\
a: {functionality: F, inputs: {}, outputs: {o: T}, timing: {period: 50 ms}},
b: {functionality: F, inputs: {i: [c.o, a.o]}, outputs: {o: T}, timing: {period: 50 ms}},
c: {functionality: F, inputs: {i: [a.o, b.o]}, outputs: {o: T}, timing: {behaviour: event}}""",
        '0 < g.b.i "x"\n',
    )
    assert trace[:12] == [
        '0 < g.b.i "x"',
        # Both clocks, before anything that they send arrives.
        '0 > g.a.o "a"',
        '0 > g.b.o "b x"',
        '0 < g.b.i "a"',
        '0 < g.c.i "a"',
        '0 > g.c.o "c a"',
        '0 < g.c.i "b x"',
        '0 > g.c.o "c b x"',
        '0 < g.b.i "c a"',
        '0 < g.b.i "c b x"',
        '50 > g.a.o "a"',
        '50 > g.b.o "b a c a c b x"',
    ]
    assert not any(line.startswith("100 ") for line in trace)


ACTIVE: dict[str, list[str]] = {
    "{behaviour: event}": ["1 x1", "2 x2", "3 y3", "9 x9", "20 y20", "21 x21"],
    "{trigger: [x]}": ["1 x1", "2 x2", "9 x9 y3", "21 x21 y20"],
    "{trigger: {all: [x, y]}}": ["3 x1 x2 y3", "20 x9 y20"],
    # At 20 ms what arrived at 9 ms is too old, and is given up.
    "{trigger: {match: [x, y], within: 1 ms}}": ["3 x1 x2 y3", "21 x9 x21 y20"],
    "{trigger: [x], every: 2}": ["2 x1 x2", "21 x9 x21 y3 y20"],
    "{trigger: [x], every: 2, dropped: forgotten}": ["2 x2", "21 x21 y3 y20"],
    "{behaviour: event, throttle: 5 ms}": ["1 x1", "9 x2 x9 y3", "20 y20"],
    "{behaviour: once}": ["0"],
    "{behaviour: on_demand}": [],
    # At 20 ms the clock comes behind the scenario: what arrives then is read then.
    "{period: 10 ms}": ["0", "10 x1 x2 x9 y3", "20 y20", "30 x21"],
}
"""When a component is active whose `timing` this is, in ms, and what arrived since the last time."""


def test_what_makes_a_component_active(tmp_path: Path) -> None:
    ports = "inputs: {x: {type: T, external: e}, y: {type: T, external: e}}, outputs: {o: T}"
    components = [f"c{n}: {{functionality: F, {ports}, timing: {timing}}}" for n, timing in enumerate(ACTIVE)]
    values = ["21 x", "1 x", "2 x", "3 y", "9 x", "20 y"]
    scenario = [
        f'{time}ms < g.c{number}.{port} "{port}{time}"'
        for time, port in (each.split() for each in values)
        for number in range(len(ACTIVE))
    ]
    trace = run_project(tmp_path, ",\n".join(components), "\n".join(scenario), until="31ms")
    for number, (timing, expected) in enumerate(ACTIVE.items()):
        sent = [
            line.replace('"', "").split(f" > g.c{number}.o c{number}") for line in trace if f" > g.c{number}.o" in line
        ]
        assert ["".join(each) for each in sent] == expected, timing


@pytest.mark.slow
def test_messages_that_go_round_are_told(tmp_path: Path) -> None:
    trace = run_project(
        tmp_path,
        """\
a: {functionality: F, inputs: {i: b.o}, outputs: {o: T}, timing: {behaviour: event}},
b: {functionality: F, inputs: {i: a.o}, outputs: {o: T}, timing: {behaviour: event}}""",
        '1ms < g.a.i "x"\n',
        behaviour=COUNTING.replace('" ".join([self.component.id[2:], *arrived])', '"x"'),
    )
    assert trace[-1] == "at 1000000 ns messages go round without end"


def test_a_mistake_of_a_behaviour_has_time_and_place(tmp_path: Path) -> None:
    components = "a: {functionality: F, inputs: {}, outputs: {o: T}, timing: {period: 10 ms}}"
    trace = run_project(tmp_path, components, "", behaviour=COUNTING.replace("arrived = [", "arrived = 1 / 0, ["))
    assert trace == ["at 0 ns in g.a: ZeroDivisionError('division by zero')"]
    trace = run_project(tmp_path, components, "", behaviour=COUNTING.replace('" ".join', "len"))
    assert trace == ["what g.a.o sends is not a text"]


SLIPS = {
    "nothing": "a line is TIME < INPUT VALUE or TIME > OUTPUT VALUE",
    '1 < g.a.o "x"': "there is no input g.a.o",
    '1 > g.a.i "x"': "there is no output g.a.i",
    '1.5 < g.a.i "x"': "the time 1.5 is no whole number of nanoseconds",
    '10000000000s < g.a.i "x"': "the time 10000000000s is no whole number of nanoseconds",
    '1min < g.a.i "x"': 'a time is a number with ns, us, ms or s, not "1min"',
    "1 < g.a.i 7": "the value is not a text",
    '1 < g.a.i "x': "character 1 of the value: Unterminated string starting at",
    f"1 < g.a.i {'[' * 101}{']' * 101}": "the value is nested too deeply",
}


def test_a_slip_in_a_scenario_has_its_line(tmp_path: Path) -> None:
    components = "a: {functionality: F, inputs: {i: {type: T, external: e}}, outputs: {o: T}}"
    assert run_project(tmp_path, components, "") == []
    for line, words in SLIPS.items():
        (tmp_path / "scenario.txt").write_text(f"# x\n\n{line}\n", "utf-8")
        done = run_python(tmp_path / "ws", "lab_simulation", str(tmp_path / "scenario.txt"))
        assert done == (1, "", f"{tmp_path}/scenario.txt:3: {words}\n")
