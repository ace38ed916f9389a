"""Figures 6 and 14 to 16 as rules beside the passes `envelope` and `monitor`: where they agree, and where the passes are finer.

On robots at random, all of whose ports carry messages of programs to be written, they agree:
- `envelope`: exactly the same ports are wrapped, and the connections stay;
- `monitor`: the same wholes get one monitor each, which reads exactly the same parts, and gives on how the whole is.
What the passes leave plain or call otherwise stands in the tests behind.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.passes.patterns.pattern_registry import find_known_passes
from archgen.pipeline import CheckedProject, check_project, transform_project
from tests.passes.patterns.random_robots import make_robot
from tests.passes.random_projects import RandomProject


def _run(checked: CheckedProject, name: str) -> CheckedProject:
    made = transform_project(checked, (name,), find_known_passes(checked.loaded_project).passes)
    assert made.transformed is not None
    assert [each.message for each in made.transformed.findings if each.rule == "wrong-pass"] == []
    return made


def _write(text: str, folder: Path) -> CheckedProject:
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return check_project(folder)


@pytest.fixture(
    params=[
        pytest.param(f"{maker} {seed}", marks=pytest.mark.slow if seed > 2 else ())
        for maker in ("robot", "project")
        for seed in range(8)
    ]
)
def drawn(request: pytest.FixtureRequest, tmp_path: Path) -> CheckedProject:
    """Return a project that is drawn by either of the makers."""
    maker, _, seed = request.param.partition(" ")
    if maker == "robot":
        return check_project(make_robot(int(seed), tmp_path))
    return _write(RandomProject(int(seed)).text, tmp_path)


def _list_types(checked: CheckedProject) -> dict[str, str | None]:
    return {
        output.id: output.type
        for component in checked.architecture.components.values()
        for output in component.outputs.values()
    }


def test_envelope_wraps_the_same_ports(drawn: CheckedProject) -> None:
    by_pass, by_rules = _run(drawn, "envelope"), _run(drawn, "rules.envelope")
    assert _list_types(by_rules) == _list_types(by_pass)
    assert by_rules.architecture.edges == by_pass.architecture.edges
    if _list_types(drawn):
        assert _list_fields(by_rules) == _list_fields(by_pass) == [("sender", "string"), ("payload", "T")]


def _list_fields(checked: CheckedProject) -> list[tuple[str, str]]:
    return [(each.name, str(each.type)) for each in checked.architecture.types["Envelope"].fields or ()]


def _list_watched(checked: CheckedProject, tag: str) -> dict[str, set[str]]:
    """Return what each whole's monitor reads, by the whole."""
    architecture = checked.architecture
    monitors = [each for each in architecture.components.values() if tag in each.tags]
    wholes = [each.id.rpartition(".")[0] for each in monitors]
    assert len(set(wholes)) == len(wholes)
    # A whole says how it is by the monitor in it, whatever that is called.
    said_by = {each.id: whole for each, whole in zip(monitors, wholes, strict=True)}
    return {
        each.id.rpartition(".")[0]: {
            said_by.get(edge.output.rpartition(".")[0], edge.output.rpartition(".")[0])
            for edge in architecture.edges
            if edge.input.rpartition(".")[0] == each.id
        }
        for each in monitors
    }


def test_monitor_watches_the_same_parts(drawn: CheckedProject) -> None:
    by_pass, by_rules = _run(drawn, "monitor"), _run(drawn, "rules.monitor")
    assert _list_watched(by_rules, "monitor") == _list_watched(by_pass, "state_monitor")
    was = {(each.output, each.input) for each in drawn.architecture.edges}
    for made in (by_pass, by_rules):
        assert was <= {(each.output, each.input) for each in made.architecture.edges}


PARTS = """\
archgen: 1
groups:
  g:
    components:
      camera: {outputs: {image: {type: Image}}, status: existing, node: {package: p, executable: e}}
      view: {inputs: {image: {from: camera.image}}, outputs: {found: {type: Pose}, state: {type: Mode}}}
      radio: {inputs: {orders: {type: Order, external: The operator}, found: {from: view.found}}, outputs: {ack: {type: Order}}}
      monitor: {inputs: {ack: {from: radio.ack}}, functionality: Is called so.}
types:
  Image: sensor_msgs/msg/Image
  Pose: geometry_msgs/msg/Pose
  Order: std_msgs/msg/String
  Mode: std_msgs/msg/String
"""


def test_only_the_pass_leaves_plain_what_programs_of_others_send_and_hear(tmp_path: Path) -> None:
    checked = _write(PARTS, tmp_path)
    plain = {
        name: {port for port, kind in _list_types(_run(checked, name)).items() if kind and "Envelope" not in kind}
        for name in ("envelope", "rules.envelope")
    }
    assert plain == {"envelope": {"g.camera.image"}, "rules.envelope": set()}
    inputs = {
        name: _run(checked, name).architecture.components["g.radio"].inputs["orders"].type
        for name in ("envelope", "rules.envelope")
    }
    assert inputs == {"envelope": "Order", "rules.envelope": "Envelope<Order>"}


def test_only_the_pass_leaves_existing_programs_as_they_are_and_takes_the_state_that_is_there(tmp_path: Path) -> None:
    checked = _write(PARTS, tmp_path)
    by_pass, by_rules = _run(checked, "monitor").architecture, _run(checked, "rules.monitor").architecture
    assert _list_watched(_run(checked, "monitor"), "state_monitor") == {"g": {"g.view", "g.radio", "g.monitor"}}
    assert _list_watched(_run(checked, "rules.monitor"), "monitor") == {
        "g": {"g.camera", "g.view", "g.radio", "g.monitor"}
    }
    assert list(by_pass.components["g.camera"].outputs) == ["image"]
    assert list(by_pass.components["g.view"].outputs) == ["found", "state"]
    assert list(by_rules.components["g.view"].outputs) == ["found", "state", "view_state"]
    # A data type for each component, of a message that ROS has; the paper has one for all.
    assert {each for each in by_pass.types if "state" in each.lower()} == {"Radio state", "Monitor state"}
    assert {each for each in by_rules.types if "state" in each.lower()} == {"State"}
