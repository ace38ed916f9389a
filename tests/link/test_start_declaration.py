"""What is written below `start`, and the words of commands: as read, as inherited, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture
from archgen.model.node import Node, StartUp

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]

ROBOT = """
groups: {g: {components: {a: A, b: B}}}
nodes:
  na:
    implements: a
    start:
      phase: core
      after: [b, stage]
      ready: {port: 80, file: /f, topic: t, service: s, log: up, wait: 1 s, within: 2 s}
      respawn: true
      respawn_delay: 500 ms
      environment: {LEVEL: 1, DISPLAY: ":0"}
      directory: /d
      user: robot
      once: true
      state: inactive
      by: stage
  b: {implements: b, start: stage}
  stage: {kind: program, command: [stage, 1.10, "a b"]}
"""


def test_everything_is_read(linked: Linked) -> None:
    architecture, found = linked(ROBOT)
    assert found == ()
    start = architecture.nodes["na"].start or StartUp()
    assert [(target.kind, target.id) for target in start.after] == [("component", "g.b"), ("node", "stage")]
    ready = start.ready
    assert (ready.port, ready.file, ready.topic, ready.service, ready.log) == (80, "/f", "t", "s", "up")
    assert (str(ready.wait), str(ready.within), str(start.respawn_delay)) == ("1 s", "2 s", "500 ms")
    assert (start.phase, start.respawn, start.once, start.state) == ("core", True, True, "inactive")
    assert (start.directory, start.user, dict(start.environment)) == ("/d", "robot", {"LEVEL": "1", "DISPLAY": ":0"})
    assert start.by is not None
    assert (start.by.id, start.wanted_state, start.places["phase"].line) == ("stage", "inactive", 7)
    assert architecture.nodes["stage"].command == ("stage", "1.10", "a b")
    assert architecture.nodes["stage"].start is None
    assert [target.id for target in (architecture.nodes["b"].start or StartUp()).after] == ["stage"]


@pytest.mark.parametrize(
    ("start", "rule", "help_line"),
    [
        ("{after: stagee}", "unknown-reference", "did you mean `stage`?"),
        ("{by: stagee}", "unknown-reference", "did you mean `stage`?"),
        ("{after: []}", "wrong-value", "name one or more, or leave `after` out"),
    ],
)
def test_what_is_named_must_be_there(linked: Linked, start: str, rule: str, help_line: str) -> None:
    _, (finding,) = linked(ROBOT.replace("start: stage", f"start: {start}"))
    assert (finding.rule, finding.help, finding.element) == (rule, help_line, "b")


def check(folder: Path, text: str) -> pipeline.CheckedProject:
    file = folder / "robot.yaml"
    file.write_text(f"archgen: 1\nproject: {{id: robot, title: Robot}}\n{text}", encoding="utf-8")
    return pipeline.check_project(file)


@pytest.mark.parametrize(
    ("node", "message", "help_line"),
    [
        (
            "command: stage worlds/home.world",
            "`command` cannot be `stage worlds/home.world`",
            "write its words as a list: `[stage, worlds/home.world]`",
        ),
        (
            "command: stage 'my world' $HOME && x",
            "`command` cannot be `stage 'my world' $HOME && x`",
            'write its words as a list: `[stage, my world, "$HOME", "&&", x]`; no shell reads it',
        ),
        ("command: {a: b}", "`command` is a mapping, but must be text or a list", None),
        ("start: {phase: componets}", "`phase` cannot be `componets`", "did you mean `components`?"),
        ("start: {phase: boot}", "`phase` cannot be `boot`", "it is one of `network`, `simulators`, `core`, `components`"),
        ("start: {state: activ}", "`state` cannot be `activ`", "did you mean `active`?"),
        ("start: {ready: {port: 70000}}", "`port` cannot be `70000`", "it is at most 65535"),
        ("start: {ready: soon}", "`ready` cannot be `soon`", None),
        ("start: {user: the robot}", "`user` cannot be `the robot`", "a user is a name of the system without blanks, such as `robot`"),
        ("start: {befor: a}", "a start-up has no key `befor`", None),
    ],
)  # fmt: skip
def test_what_cannot_be_meant_is_said_where_it_stands(
    tmp_path: Path, node: str, message: str, help_line: str | None
) -> None:
    checked = check(tmp_path, f"groups: {{g: {{components: {{a: A}}}}}}\nnodes:\n  n: {{implements: a, {node}}}\n")
    (finding,) = [finding for finding in checked.findings if finding.severity == "error"]
    assert finding.message.startswith(message)
    assert finding.span is not None
    assert finding.span.line == 5
    assert help_line is None or finding.help == help_line


NESTED = """\
component_types:
  sensor:
    node: {package: p, executable: e, start: {phase: core, ready: {topic: up}, environment: {A: a, B: b}, user: robot}}
  stage_type: {node: {command: [stage, "$(self.world)"], start: {phase: simulators}}, parameters: {world: home.world}}
groups:
  g:
    components:
      base: {title: B, node: {package: p, executable: base, start: {phase: network}}}
      arm:
        title: Arm
        node: {start: {phase: core, after: base, once: true, ready: 2 s, user: arm}}
        components:
          first: {is: sensor, node: {start: {environment: {A: c}, ready: {port: 81}}}}
          second: {title: S, node: {package: p, executable: s, start: {after: first, once: false}}}
      simulator: {is: stage_type, parameters: {world: street.world}}
      other: {is: stage_type, node: {package: q, executable: q}}
      copy: {same_as: sensor, node: {start: {after: simulator}}}
"""


def test_instances_and_what_is_inside_inherit(tmp_path: Path) -> None:
    checked = check(tmp_path, NESTED)
    assert [str(finding) for finding in checked.findings if finding.severity == "error"] == []

    def start_of(name: str) -> StartUp:
        return checked.architecture.nodes[name].start or StartUp()

    def command_of(name: str) -> Node:
        return checked.architecture.nodes[name]

    first, second = start_of("first"), start_of("second")
    assert (first.phase, first.user, dict(first.environment)) == ("core", "robot", {"A": "c", "B": "b"})
    assert (first.ready.topic, first.ready.port, first.ready.wait, first.once) == ("up", 81, None, False)
    assert [target.id for target in first.after] == ["g.base"]
    assert (second.phase, second.user) == ("core", "arm")
    assert [target.id for target in second.after] == ["g.arm.first"]
    assert command_of("simulator").command == ("stage", "street.world")
    assert (command_of("other").command, command_of("other").package) == ((), "q")
    assert [target.id for target in start_of("copy").after] == ["g.simulator"]
    assert start_of("copy").phase == "core"


def test_names_in_types_mean_what_stands_beside_them(tmp_path: Path) -> None:
    text = """\
component_types:
  arm:
    components:
      motor: {title: M, node: {package: p, executable: m, start: base}}
      watch: {title: W, node: {package: p, executable: w, start: {after: motor}}}
groups:
  g:
    components:
      left: {is: arm}
      right: {is: arm}
      base: {title: B, node: {package: p, executable: b}}
"""
    checked = check(tmp_path, text)
    assert [str(finding) for finding in checked.findings if finding.severity == "error"] == []
    starts = {name: node.start for name, node in checked.architecture.nodes.items() if node.start}
    assert {name: [each.id for each in start.after] for name, start in starts.items()} == {
        "left_motor": ["g.base"],
        "left_watch": ["g.left.motor"],
        "right_motor": ["g.base"],
        "right_watch": ["g.right.motor"],
    }
