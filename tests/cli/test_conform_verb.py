"""`archgen conform`: what it prints, in all formats, and its status."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.conformance.rovers import ROVER, check_rover, print_graph


@pytest.fixture
def graph(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return the graph of the robot as designed; the project is in `rover`."""
    monkeypatch.chdir(tmp_path)
    return print_graph(check_rover(tmp_path / "rover").architecture)


def test_a_difference_is_shown_with_both_places_the_remedy_and_the_owner(run: Run, graph: str) -> None:
    planted = graph.replace(
        "    /image: sensor_msgs/msg/Image\n  Service", "    /image: sensor_msgs/msg/CompressedImage\n  Service"
    )
    planted = planted.replace(
        "sensor_msgs/msg/Image\nEndpoint type: PUB", "sensor_msgs/msg/CompressedImage\nEndpoint type: PUB"
    )
    Path("graph.txt").write_text(planted, encoding="utf-8")
    done = run("conform", "rover", "--against", "graph.txt")
    line = planted.splitlines().index("    /image: sensor_msgs/msg/CompressedImage") + 1
    assert done.status == 1
    assert done.out == (
        "graph.txt (graph): 5 of 5 nodes, 12 of 12 endpoints seen; 0 of its names unknown; 2 parameters compared\n"
        "error[other-type]: `/image`, which `/camera` publishes, has the type `sensor_msgs/msg/CompressedImage` on the robot, and "
        "`sensor_msgs/msg/Image` in the design\n"
        "  --> archgen.yaml:31:82\n"
        "   31 |   camera: {implements: sensing.camera, host: base, status: existing, publishes: {image: /image}}\n"
        "      |                                                                                  ^^^^^\n"
        f"  --> ../graph.txt:{line}:1\n"
        f"   {line} |     /image: sensor_msgs/msg/CompressedImage\n"
        "      | ------------------------------------------- seen here\n"
        "   = help: write `sensor_msgs/msg/CompressedImage` as the type, or change the program; it belongs to North\n\n1 error\n"
    )


def test_programs_read_the_findings_of_a_check(run: Run, graph: str) -> None:
    Path("graph.txt").write_text(graph.replace("rate: 12.5", "rate: 10.0"), encoding="utf-8")
    done = run("conform", "rover", "--against", "graph.txt", "--format", "json")
    assert (done.status, json.loads(done.out)["diagnostics"][0]["rule"]) == (0, "other-parameter")
    assert done.err.startswith("graph.txt (graph): 5 of 5 nodes")
    for form, words in {
        "github": "::warning file=rover/archgen.yaml",
        "sarif": '"ruleId": "other-parameter"',
        "junit": 'failures="0"',
    }.items():
        assert words in run("conform", "rover", "--against", "graph.txt", "--format", form).out
    strict = run("conform", "rover", "--against", "graph.txt", "--format", "junit", "--strict")
    assert (strict.status, 'failures="1"' in strict.out) == (1, True)


def test_comments_settings_baselines_and_options_choose_what_is_shown(run: Run, graph: str) -> None:
    Path("graph.txt").write_text(graph.replace("rate: 12.5", "rate: 10.0"), encoding="utf-8")
    project = Path("rover/archgen.yaml")
    against = ("conform", "rover", "--against", "graph.txt", "--strict")
    assert run(*against, "--only", "other-type").status == 0
    project.write_text(
        ROVER.replace("{rate: 12.5}", "{rate: 12.5}  # archgen: ignore[other-parameter] it is tuned"), encoding="utf-8"
    )
    assert run(*against).status == 0
    assert "unused-ignore" not in run("check", "rover").out
    project.write_text(ROVER + "rules: {other-parameter: 'off'}\n", encoding="utf-8")
    assert run(*against).status == 0
    project.write_text(ROVER, encoding="utf-8")
    message = "the parameter `rate` of `/front/lidar` is `10.0` on the robot, and `12.5` in the design"
    entry = f"  - rule: other-parameter\n    element: lidar\n    message: {json.dumps(message)}\n"
    Path("known.yaml").write_text(f"archgen_baseline: 1\nfindings:\n{entry}", encoding="utf-8")
    known = run(*against, "--baseline", "known.yaml")
    assert (known.status, known.err) == (0, "not shown: 1 warning that known.yaml knows\n")


@pytest.mark.usefixtures("graph")
def test_wrong_usage_says_what_to_do(run: Run) -> None:
    Path("empty.txt").write_text("nothing\n", encoding="utf-8")
    Path("binary").write_bytes(b"\0\1\2")
    Path("folder").mkdir()
    for words, sentence in {
        ("--against", "empty.txt"): "there is no node in it; give what `archgen conform --recorder` records",
        ("--against", "nowhere"): "there is no nowhere",
        (
            "--against",
            "binary",
        ): "it is nothing that says how a robot is; give one of these: a folder with packages of ROS",
        ("--against", "folder"): "it is nothing that says how a robot is",
        ("--against", "empty.txt", "--host", "bas"): "did you mean `base`?",
        ("--against", "empty.txt", "--only", "other-typ"): "did you mean `other-type`?",
        (): "against what? Name a workspace",
    }.items():
        done = run("conform", "rover", *words)
        assert done.status == 2
        assert sentence in done.err


def test_a_project_with_errors_is_no_conforming_one(run: Run, graph: str) -> None:
    Path("graph.txt").write_text(graph, encoding="utf-8")
    Path("rover/archgen.yaml").write_text(ROVER.replace("lidar.scan", "lidar.scna"), encoding="utf-8")
    done = run("conform", "rover", "--against", "graph.txt")
    assert done.status == 1
    assert "scna" in done.err


def test_what_the_robot_tells_is_written_or_shown_as_a_patch(run: Run, graph: str) -> None:
    """A difference is followed only where its rule is named."""
    Path("graph.txt").write_text(graph.replace("rate: 12.5", "rate: 10.0"), encoding="utf-8")
    against = ("conform", "rover", "--against", "graph.txt", "--adopt")
    assert run(*against).err.startswith("adopted: 0\n")
    patch = run(*against, "--only", "other-parameter", "--dry-run")
    assert (patch.status, patch.err) == (0, "adopted: 1\n")
    assert patch.out.startswith("--- a/archgen.yaml\n+++ b/archgen.yaml\n")
    assert "\n+    parameters: {rate: 10.0}\n" in patch.out
    done = run(*against, "--only", "other-parameter")
    assert done.status == 0
    assert done.out.startswith("wrote rover/archgen.yaml (as on the robot)\n")
    assert done.out.endswith("no differences\n")
    assert Path("rover/archgen.yaml").read_text(encoding="utf-8") == ROVER.replace("rate: 12.5", "rate: 10.0")
    for wrong, words in {("--format", "json"): "no --format", ("--variant", "x"): "no --variant"}.items():
        assert words in run(*against, *wrong).err
    assert "give both" in run("conform", "rover", "--against", "graph.txt", "--dry-run").err
