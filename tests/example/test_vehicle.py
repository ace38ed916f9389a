"""Two experiments over one library: local components, instances and references, as in the paper that they are from."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from archgen.analyses.size_counts import measure_size
from archgen.checking.checked_packing import pack_checked_project
from archgen.pipeline import CheckedProject, check_project
from archgen.syntax.yaml_writer import write_yaml
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.running import ROOT

FOLDER = ROOT / "examples" / "vehicle"
EXPERIMENTS = ("scenario", "two_lasers")


@pytest.fixture(scope="module")
def projects() -> dict[str, CheckedProject]:
    return {name: check_project(FOLDER / name) for name in EXPERIMENTS}


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_there_is_nothing_to_complain_about(projects: dict[str, CheckedProject], name: str) -> None:
    assert [str(finding) for finding in projects[name].findings] == []


@pytest.mark.parametrize(("name", "figures"), [("scenario", (8, 6, 13, 12)), ("two_lasers", (9, 6, 17, 9))])
def test_their_size(projects: dict[str, CheckedProject], name: str, figures: tuple[int, ...]) -> None:
    size = measure_size(projects[name].architecture)
    assert (size.components, size.component_types, size.connections, size.nodes) == figures


def test_the_scenario_has_the_eight_components_of_the_paper_in_its_three_ways(
    projects: dict[str, CheckedProject],
) -> None:
    components = projects["scenario"].architecture.components.values()
    assert {each.id.rpartition(".")[2] for each in components if each.component_type is None} == {
        "faithlocaliser3d",
        "imu",
    }
    assert {each.component_type for each in components if each.component_type and not each.is_reference} == {
        "orca.gridmap",
        "orca.car",
        "orca.orcaview2d",
    }
    assert {each.component_type for each in components if each.is_reference} == {
        "orca.dgclocalnav",
        "orca.highlevelplanner",
        "orca.laser2d",
    }


def test_a_reference_is_the_same_in_both_experiments(projects: dict[str, CheckedProject]) -> None:
    for component in ("perception.laser2d0", "driving.dgclocalnav", "driving.highlevelplanner"):
        first, second = (projects[name].architecture.components[component] for name in EXPERIMENTS)
        assert first.parameters
        assert (first.parameters, first.timing) == (second.parameters, second.timing)


@pytest.mark.parametrize(
    ("name", "component", "values"),
    [
        ("scenario", "driving.car", {"vehicle.control.max_forward_speed": 3.0, "vehicle.control.wheelbase": 2.6}),
        ("two_lasers", "driving.car", {"vehicle.control.max_forward_speed": 2.0, "vehicle.control.wheelbase": 2.6}),
        ("scenario", "perception.gridmap", {"map_file": "maps/parking_lot.pnm.gz", "size.x": 120.0}),
        ("two_lasers", "perception.laser2d0", {"offset.rotation.yaw": 0.0, "player_client.device": 0}),
        ("two_lasers", "perception.laser2d1", {"offset.rotation.yaw": 180.0, "player_client.device": 1}),
    ],
)
def test_an_instance_has_values_of_its_own(
    projects: dict[str, CheckedProject], name: str, component: str, values: dict[str, object]
) -> None:
    parameters = projects[name].architecture.components[component].parameters
    assert {key: parameters[key].value for key in values} == values


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_an_input_has_one_source_as_in_the_paper(projects: dict[str, CheckedProject], name: str) -> None:
    inputs = [edge.input for edge in projects[name].architecture.edges]
    assert len(inputs) == len(set(inputs))


@pytest.mark.parametrize(("name", "count"), [("scenario", 3), ("two_lasers", 4)])
def test_the_scanners_stand_on_the_vehicle(projects: dict[str, CheckedProject], name: str, count: int) -> None:
    frames = projects[name].architecture.frames
    assert len(frames) == count
    assert {each.parent for frame_id, each in frames.items() if frame_id.startswith("laser")} == {"base_link"}


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_deadline_is_met(projects: dict[str, CheckedProject], name: str) -> None:
    architecture = projects[name].architecture
    bounds = bound_all_chains(analyse_architecture(architecture), architecture)
    assert set(bounds) == {"go", "see_and_steer"}
    for chain_id, bound in bounds.items():
        deadline = architecture.chains[chain_id].deadline
        assert bound.bound.complete
        assert deadline is not None
        assert bound.bound.value is not None
        assert bound.bound.value < deadline.value


def test_the_experiments_speak_of_the_same_messages(projects: dict[str, CheckedProject]) -> None:
    first, second = ({e.message for e in projects[name].architecture.endpoints} for name in EXPERIMENTS)
    assert {message for message in first & second if message and message.startswith("orca_msgs/")} == {
        "orca_msgs/msg/RangeScan2d",
        "orca_msgs/msg/Odometry3d",
        "orca_msgs/msg/Localise3d",
        "orca_msgs/msg/OgMap",
        "orca_msgs/msg/VelocityControl2d",
        "orca_msgs/msg/Path2d",
        "orca_msgs/action/FollowPath2d",
    }


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_the_packed_file_needs_no_library(projects: dict[str, CheckedProject], name: str, tmp_path: Path) -> None:
    file = tmp_path / "packed.yaml"
    file.write_text(write_yaml(pack_checked_project(projects[name]).data), encoding="utf-8")
    packed = check_project(file)
    assert [str(finding) for finding in packed.findings] == []
    assert packed.architecture.components == projects[name].architecture.components
    assert packed.architecture.types == projects[name].architecture.types


def test_what_changes_in_the_library_changes_in_both_experiments(tmp_path: Path) -> None:
    # Without git a project reads nothing outside of its own folder: the library moves into each experiment.
    for name in EXPERIMENTS:
        shutil.copytree(FOLDER / name, tmp_path / name)
        shutil.copytree(FOLDER / "library", tmp_path / name / "library")
        replace_text(tmp_path / name / "archgen.yaml", "../library", "library")
        replace_text(
            tmp_path / name / "library" / "components.yaml",
            "max_acceleration: {value: 0.5",
            "max_acceleration: {value: 0.7",
        )
        checked = check_project(tmp_path / name)
        assert [str(finding) for finding in checked.findings] == []
        assert checked.architecture.components["driving.dgclocalnav"].parameters["max_acceleration"].value == 0.7


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("same_as: orca.dgclocalnav", "parameters: {max_turn_rate: 20.0}\n        same_as: orca.dgclocalnav", "changed-reference"),
        ("max_forward_speed: 3.0", "max_forward_speed: 20.0", "wrong-parameter"),
        ("map_file: maps/parking_lot.pnm.gz, ", "", "unset-parameter"),
    ],
)  # fmt: skip
def test_what_the_page_of_the_example_says_to_break_is_found(tmp_path: Path, old: str, new: str, rule: str) -> None:
    shutil.copytree(FOLDER / "scenario", tmp_path / "scenario")
    shutil.copytree(FOLDER / "library", tmp_path / "scenario" / "library")
    file = tmp_path / "scenario" / "archgen.yaml"
    replace_text(file, "../library", "library")
    replace_text(file, old, new)
    assert [finding.rule for finding in check_project(tmp_path / "scenario").findings] == [rule]


def replace_text(file: Path, old: str, new: str) -> None:
    """Replace a text that is in a file once."""
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")
