"""All Python and Java that backends make, of random projects and with hostile texts, is written as its readers expect.

Packages of ROS are judged with all that ament_flake8 sets. The simulation is no package of ROS: there quotes, the order of
imports and names of modules are as in plain Python, and all else is judged alike.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from itertools import cycle
from pathlib import Path

import pytest
import yaml

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from tests.hostile import TEXTS
from tests.outside_tools import QUICK_START, find_tool, run_judge
from tests.passes.patterns.random_robots import make_robot
from tests.passes.random_projects import RandomProject
from tests.plugins.middlewares.simulation.random_robots import make_robot as make_simulated_robot
from tests.plugins.ros_code.test_ros2_python import AMENT_FLAKE8
from tests.property_sizes import DRAWS_ANEW

ROS_BACKENDS = {"ros2_python": "jazzy", "ros1_python": "noetic"}
NOT_OF_ROS = "A,I,Q"
"""What is judged in packages of ROS alone: names as of builtins, the order of imports, quotes."""
SEEDS = (20, 21) if DRAWS_ANEW else (20,)
ODD_PROJECTS = Path(__file__).parent / "odd_projects"
_TITLED = ("groups", "components", "component_types")


def _make_hostile(data: object, texts: Iterator[str]) -> object:
    """Return a project whose elements have hostile titles and functionalities."""
    if not isinstance(data, dict):
        return data
    made = {key: _make_hostile(value, texts) for key, value in data.items()}
    for section in _TITLED:
        elements = made.get(section)
        for element in elements.values() if isinstance(elements, dict) else ():
            if isinstance(element, dict):
                element["title"] = next(texts)
                if section != "groups":
                    element["functionality"] = next(texts)
    return made


@pytest.fixture(scope="module")
def workspaces(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Generate from projects that are drawn, half of them with hostile texts; return the folder of all workspaces."""
    folder = tmp_path_factory.mktemp("style")
    texts = cycle([each for each in TEXTS.values() if each.strip()])
    for seed in SEEDS:
        make_robot(seed, folder / f"robot{seed}" / "project")
        drawn = {f"drawn{seed}": RandomProject(seed).data, f"run{seed}": _read(make_simulated_robot(seed).text)}
        for name, data in drawn.items():
            for kind, made in (("plain", data), ("hostile", _make_hostile(data, texts))):
                project = folder / f"{kind}_{name}" / "project"
                project.mkdir(parents=True)
                (project / "archgen.yaml").write_text(yaml.safe_dump(made, allow_unicode=True), encoding="utf-8")
    for path in sorted(ODD_PROJECTS.glob("*.yaml")):
        (folder / f"hostile_{path.stem}" / "project").mkdir(parents=True)
        shutil.copyfile(path, folder / f"hostile_{path.stem}" / "project" / "archgen.yaml")
    for workspace in sorted(folder.iterdir()):
        _generate_all(workspace)
    return folder


def _read(text: str) -> object:
    # YAML 1.1 takes `off` for false.
    return yaml.load(text, yaml.BaseLoader)  # noqa: S506 - only texts


def _generate_all(workspace: Path) -> None:
    path = workspace / "project" / "archgen.yaml"
    data = yaml.safe_load(path.read_text(encoding="utf-8"))
    for backend, distro in {"python_simulation": "jazzy", "java": "jazzy", **ROS_BACKENDS}.items():
        data["ros"] = {"distro": distro}
        path.write_text(yaml.safe_dump(data, sort_keys=False, allow_unicode=True), encoding="utf-8")
        plan = write_workspace(check_project(path.parent), OutputOptions(), backend, workspace / backend).plan
        assert plan is not None, (workspace.name, backend)


def _judge(settings: tuple[str, ...], folders: list[Path]) -> str:
    assert folders
    assert all(any(each.rglob("*.py")) for each in folders)
    command = [sys.executable, "-m", "flake8", "--isolated", "--jobs=1", *settings, *map(str, folders)]
    return run_judge(*command, statuses=(0, 1)).stdout


@pytest.mark.slow
@pytest.mark.hypothesis
def test_packages_of_ros_are_written_as_ament_wants_it(workspaces: Path) -> None:
    made = [each for backend in ROS_BACKENDS for each in workspaces.glob(f"*/{backend}") if any(each.rglob("*.py"))]
    assert len(made) > 2 * len(SEEDS)
    assert _judge(AMENT_FLAKE8, made) == ""


@pytest.mark.slow
@pytest.mark.hypothesis
def test_simulations_are_written_as_python_is(workspaces: Path) -> None:
    ignored, *others = AMENT_FLAKE8
    found = _judge((f"{ignored},{NOT_OF_ROS}", *others), sorted(workspaces.glob("*/python_simulation")))
    assert found == ""


@pytest.mark.build
def test_simulations_compile_without_any_warning(workspaces: Path) -> None:
    for number, folder in enumerate(sorted(workspaces.glob("hostile_*/java/java"))):
        sources = [str(each) for each in folder.rglob("*.java")]
        assert len(sources) > 10
        options = ["-Xlint:all", "-Werror", "-encoding", "UTF-8", "--release", "17", "-d", f"{workspaces}/c{number}"]
        done = run_judge(find_tool("javac"), *(f"-J{each}" for each in QUICK_START), *options, *sources)
        assert done.stdout + done.stderr == "", folder
