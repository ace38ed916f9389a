"""The order of lines says nothing of a robot: elements that move, and comments, change no byte of what is generated."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.property_sizes import try_some
from tests.running import archgen_here

ROBOT = """\
archgen: 1
project: {id: farm, title: Farm}
ros: {distro: DISTRO}
groups:
  arms:
    components:
      left: {is: arm, inputs: {goal: planner.goal}, parameters: {reach: 1.5}}
      right: {is: arm, inputs: {goal: planner.goal}, parameters: {reach: 2.5}}
      lidar_front: {outputs: {seen: Words}}
      camera_front: {outputs: {seen: Words}}
      lidar_rear: {outputs: {seen: Words}}
      camera_rear: {outputs: {seen: Words}}
      fuse_front: {is: fuse, inputs: {seen: [lidar_front.seen, camera_front.seen]}}
      fuse_rear: {is: fuse, inputs: {seen: [camera_rear.seen, lidar_rear.seen]}}
      planner: {inputs: {reset: safety.guard.reset}, outputs: {goal: State}, timing: {rate: 5 Hz}}
  safety:
    components:
      guard:
        inputs: {arms: [arms.left.state, arms.right.state], words: [arms.lidar_rear.seen, arms.lidar_front.seen]}
        outputs: {stop: State, reset: std_srvs/srv/Trigger}
        parameters: {zeal: 3, lowest: {value: 0.2, range: [0, 1]}, mode: {value: slow, choices: [slow, fast]}}
        timing: {rate: 20 Hz}
      logger: {inputs: {stop: guard.stop}, parameters: {file: log.txt}}
component_types:
  arm: {inputs: {goal: State}, outputs: {state: State}, parameters: {reach: {unit: m}, gain: 2}}
  fuse: {inputs: {seen: Words}, outputs: {out: Words}}
nodes:
  watch: {implements: [safety.logger, safety.guard], LANGUAGE}
types:
  Words: {fields: {text: string}}
  State: {fields: {positions: "float64[]"}}
"""
BACKENDS = {
    "jazzy": ("ros2_python", "ros_interfaces"),
    "noetic": ("ros1_python", "ros_interfaces"),
    "cpp": ("ros2_cpp",),
}
ORDERLESS_LISTS = frozenset({"implements", "arms", "seen", "words"})


def shuffle(value: Any, draw: random.Random, key: str = "") -> Any:  # noqa: ANN401 - any YAML
    """Return YAML with everything in another order that says nothing by its order. Fields of a message do."""
    if isinstance(value, dict) and key != "fields":
        keys = sorted(value, key=lambda each: (each != "archgen", draw.random()))
        return {each: shuffle(value[each], draw, each) for each in keys}
    if isinstance(value, list) and key in ORDERLESS_LISTS:
        return draw.sample(value, len(value))
    return value


def generate(project: dict[str, Any], backends: tuple[str, ...], folder: Path, comment: str = "") -> dict[str, bytes]:
    """Return what backends write for a project, by path."""
    folder.mkdir()
    text = comment + yaml.safe_dump(project, sort_keys=False)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    for passed in backends:
        archgen_here("generate", passed, "-o", folder / "ws", cwd=folder)
    written = (path for path in (folder / "ws").rglob("*") if path.is_file())
    return {path.relative_to(folder / "ws").as_posix(): path.read_bytes() for path in written}


@pytest.mark.parametrize("kind", try_some([*BACKENDS, "envelope"], 2))
def test_moved_lines_and_comments_change_no_generated_byte(kind: str, tmp_path: Path) -> None:
    distro = kind if kind in {"jazzy", "noetic"} else "jazzy"
    text = ROBOT.replace("DISTRO", distro).replace("LANGUAGE", f"language: {'cpp' if kind == 'cpp' else 'python'}")
    project = yaml.safe_load(text)
    if kind == "envelope":
        (tmp_path / "plain").mkdir()
        (tmp_path / "plain" / "archgen.yaml").write_text(text, encoding="utf-8")
        archgen_here("transform", "envelope", "-o", tmp_path / "e.yaml", cwd=tmp_path / "plain")
        project = yaml.safe_load((tmp_path / "e.yaml").read_bytes())
    backends = BACKENDS.get(kind, BACKENDS["jazzy"])
    first = generate(project, backends, tmp_path / "first")
    assert any(b"receive_arms_left" in data or b"senders.arms_left" in data for data in first.values())
    assert any(b"receive_seen_lidar" in data for data in first.values()) or kind == "cpp"
    for seed in range(4):
        moved = shuffle(project, random.Random(seed))  # noqa: S311 - a draw, no secret
        assert moved != project or list(moved) != list(project)
        assert generate(moved, backends, tmp_path / f"moved-{seed}", "# Said of it.\n\n") == first, seed
