"""The paper's figures as rules: they make what the passes of the same names make, on the examples and on random robots."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from archgen.checking.checked_packing import pack_checked_project
from archgen.passes.pass_shape import STATES
from archgen.passes.patterns.pattern_registry import find_known_passes, list_shipped_passes
from archgen.pipeline import CheckedProject, check_project, transform_project
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import judge_shipped
from tests.passes.patterns.random_robots import make_robot
from tests.property_sizes import list_seeds, try_some
from tests.running import ROOT

TWINS = (
    "normalise_connections",
    "connect_components",
    "connect_ports",
    "connect_types",
    "resolve_instances",
    "remove_generics",
)
EXAMPLES = ("arm", "bringup", "cleaning_robot", "drone", "first_robot")


def _pack(checked: CheckedProject, name: str = "") -> object:
    """Give a packed project; of what connects, without the word that it follows from, which rules leave."""
    packed = pack_checked_project(checked)
    data = yaml.safe_load(write_yaml(packed.data, packed.comments))
    data.pop("variants", None)
    return _drop_key(data, "autoconnect") if name in {"connect_ports", "connect_types"} else data


def _drop_key(data: object, left_out: str) -> object:
    if isinstance(data, dict):
        return {key: _drop_key(value, left_out) for key, value in data.items() if key != left_out}
    return [_drop_key(item, left_out) for item in data] if isinstance(data, list) else data


def _compare(checked: CheckedProject, name: str) -> None:
    """Run a pass and its rules on a project; both make the same."""
    known = find_known_passes(checked.loaded_project).passes
    by_pass = transform_project(checked, (name,), known)
    by_rules = transform_project(checked, (f"rules.{name}",), known)
    assert by_rules.transformed is not None
    assert [each for each in by_rules.transformed.findings if each.rule == "wrong-pass"] == []
    assert sorted(map(str, by_rules.architecture.edges)) == sorted(map(str, by_pass.architecture.edges))
    said, wanted = ([(each.rule, each.message) for each in made.findings] for made in (by_rules, by_pass))
    assert sorted(said) == sorted(wanted)
    # What could be joined in several ways the pass leaves as it is, with all that stands beside it.
    if not any(rule == "ambiguous-connection" for rule, _ in said):
        assert _pack(by_rules, name) == _pack(by_pass, name)


def test_every_shipped_pass_of_rules_is_right() -> None:
    for shipped in list_shipped_passes(tuple(STATES)):
        assert shipped.diagnostics == (), shipped.name
        assert shipped.text.startswith("# Figure"), shipped.name


@pytest.mark.parametrize("name", TWINS)
@pytest.mark.parametrize("example", try_some(EXAMPLES))
def test_rules_make_what_the_pass_of_their_name_makes(example: str, name: str) -> None:
    _compare(judge_shipped(ROOT / "examples" / example), name)


@pytest.mark.parametrize("seed", list_seeds(12))
def test_rules_and_passes_agree_on_random_robots(seed: int, tmp_path: Path) -> None:
    checked = check_project(make_robot(seed, tmp_path))
    assert [each for each in checked.findings if str(each.severity) == "error"] == []
    for name in ("connect_ports", "connect_types", "resolve_instances", "remove_generics"):
        _compare(checked, name)


ROBOT = (ROOT / "examples" / "cleaning_robot" / "archgen.yaml").read_text(encoding="utf-8")
"""It has a group on top (`cleaning`), a type on top (`arm`), and local components (`planner`, `watch`)."""


def _with_library(folder: Path) -> CheckedProject:
    """Give the cleaning robot with its types in a library."""
    data = yaml.safe_load(ROBOT)
    data["rules"] = {"missing-detail": "off"}
    types = data.pop("component_types")
    (folder / "parts").mkdir()
    used = {name: types[name] for name in ("lidar", "gps", "pose_fusion", "filter", "motor")}
    (folder / "parts" / "parts.yaml").write_text(yaml.safe_dump({"component_types": used}, sort_keys=False))
    data["component_types"] = {"arm": types["arm"]}
    data["libraries"] = {"parts": "parts"}
    listed = data["groups"]["cleaning"]["components"]["localization"]["components"]
    data["groups"]["cleaning"]["components"]["localization"]["components"] = {name: {"is": name} for name in listed}
    text = yaml.safe_dump(data, sort_keys=False)
    for name in used:
        text = text.replace(f"is: {name}", f"is: parts.{name}")
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    checked = check_project(folder)
    assert [each.message for each in checked.findings if str(each.severity) == "error"] == []
    return checked


@pytest.fixture(params=["written in the project", "in a library"])
def robot(request: pytest.FixtureRequest, tmp_path: Path) -> CheckedProject:
    """Return the cleaning robot."""
    return (
        judge_shipped(ROOT / "examples" / "cleaning_robot")
        if request.param.startswith("written")
        else _with_library(tmp_path)
    )


def _transform(checked: CheckedProject, *names: str) -> CheckedProject:
    known = find_known_passes(checked.loaded_project).passes
    made = transform_project(checked, names, known)
    assert made.transformed is not None
    assert [each.message for each in made.transformed.findings if each.rule == "wrong-pass"] == []
    assert [each.message for each in made.findings if str(each.severity) == "error"] == []
    again = transform_project(made, names[-1:], known)
    assert _pack(again) == _pack(made)
    return made


@pytest.mark.parametrize("name", try_some(TWINS, 2))
def test_rules_and_passes_agree_where_types_stand_in_a_library(name: str, tmp_path: Path) -> None:
    _compare(_with_library(tmp_path), name)


def test_figure_6_each_message_carries_its_sender(robot: CheckedProject) -> None:
    made = _transform(robot, "rules.envelope")
    assert made.architecture.edges == robot.architecture.edges
    types = {
        output.type for component in made.architecture.components.values() for output in component.outputs.values()
    }
    assert {each for each in types if each and not each.startswith("Envelope<")} == {"Torque"}


def test_figures_6_and_7_leave_no_generic_type(robot: CheckedProject) -> None:
    made = _transform(robot, "rules.envelope", "rules.remove_generics")
    text = str(_pack(made))
    assert "Envelope of Laser pose" in text
    assert "filter_of_pose" in text
    assert "<" not in text
    assert len(made.architecture.edges) == len(robot.architecture.edges)


def test_figures_14_to_16_watch_every_component(robot: CheckedProject) -> None:
    made = _transform(robot, "rules.monitor")
    packed = _pack(made)
    assert isinstance(packed, dict)
    monitor = packed["groups"]["cleaning"]["components"]["cleaning_monitor"]
    parts = set(packed["groups"]["cleaning"]["components"]) - {"cleaning_monitor"}
    assert set(monitor["inputs"]) == {f"{name}_state" for name in parts}
    arm = packed["component_types"]["arm"]
    assert set(arm["components"]["arm_monitor"]["inputs"]) == {
        f"{name}_state" for name in ("planner", "shoulder", "elbow", "watch")
    }
    assert arm["outputs"]["arm_state"] == {"type": "State", "from": ["arm_monitor.state"]}
    monitors = [key for key in made.architecture.components if key.endswith("_monitor")]
    assert len(monitors) == 4


def test_figures_4_and_8_connect_in_groups_types_and_components(robot: CheckedProject) -> None:
    made = _transform(robot, "rules.connect_ports", "rules.connect_types")
    assert sorted(map(str, made.architecture.edges)) == sorted(map(str, robot.architecture.edges))
    packed = str(_pack(made))
    assert packed.count("'from': ['self.") == str(_pack(robot)).count("'from': ['self.") + 2
    assert "'from': ['lidar.p']" in packed
