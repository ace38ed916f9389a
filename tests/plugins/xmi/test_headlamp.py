"""The paper's case: the project that `archgen import xmi` makes of the model is the one that ships."""

from __future__ import annotations

import shutil
from pathlib import Path

from archgen.pipeline import check_project
from tests.running import ROOT, archgen_here

HEADLAMP = ROOT / "examples" / "headlamp"


def test_the_example_is_what_the_import_makes(tmp_path: Path) -> None:
    shutil.copy(HEADLAMP / "headlamp.xmi", tmp_path)
    result = archgen_here("import", "xmi", "headlamp.xmi", "-o", ".", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    made = {each.name: each.read_text(encoding="utf-8") for each in tmp_path.glob("*.yaml")}
    shipped = {each.name: each.read_text(encoding="utf-8") for each in HEADLAMP.glob("*.yaml")}
    assert made == shipped


def test_the_example_has_the_five_components_of_the_paper() -> None:
    checked = check_project(HEADLAMP)
    assert not checked.has_errors
    architecture = checked.architecture
    assert {each.component_type for each in architecture.components.values() if each.component_type} == {
        *("guppy_80", "four_point", "wrist_sensor", "impedance", "manipulator")
    }
    assert {(each.output, each.input) for each in architecture.edges} == {
        ("assembly.camera.image", "assembly.pos_sensor.image"),
        ("assembly.pos_sensor.position", "assembly.impedance_control.position"),
        ("assembly.force_sensor.force", "assembly.impedance_control.force"),
        ("assembly.impedance_control.velocity", "assembly.robot.velocity"),
        ("assembly.robot.pose", "assembly.impedance_control.pose"),
    }
    assert {each.id: each.host for each in architecture.nodes.values() if each.host} == {
        "camera": "vision_pc",
        "pos_sensor": "vision_pc",
        "force_sensor": "control_pc",
        "impedance_control": "control_pc",
        "robot": "control_pc",
    }
