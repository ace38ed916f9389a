"""docs/transformations.md: its commands run, its table names every pass, and what it shows of the cleaning robot is so."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from archgen.cli.transform_command import command
from archgen.passes import PASSES
from archgen.pipeline import check_project, transform_project
from tests.passes.same_meaning import pack

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "transformations.md").read_text(encoding="utf-8")
ROBOT = ROOT / "examples" / "cleaning_robot"


def test_its_commands_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (ROBOT / "archgen.yaml").read_text(encoding="utf-8")
    (tmp_path / "archgen.yaml").write_text(text + "\nvariants: {simulation: {}}\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    block = re.search(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    assert block is not None
    for line in block[1].splitlines():
        words = shlex.split(line, comments=True)
        assert words[:2] == ["archgen", "transform"]
        result = CliRunner().invoke(command, words[2:])
        assert result.exit_code == 0, (line, result.output)
    assert (tmp_path / "flat.yaml").exists()
    assert (tmp_path / "archgen-out" / "transformed.yaml").exists()


def test_its_table_names_every_pass_in_order() -> None:
    assert re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE) == list(PASSES)


def test_what_it_shows_of_the_cleaning_robot() -> None:
    checked = check_project(ROBOT)
    connected = yaml.safe_load(pack(transform_project(checked, ["connect_ports", "connect_types"])))
    components = connected["groups"]["cleaning"]["components"]
    assert components["controller"]["inputs"]["map"]["from"] == ["navigation.map"]
    assert components["localization"]["components"]["pose_fusion"]["inputs"]["lp"]["from"] == ["lidar.p"]
    assert components["localization"]["outputs"]["p"]["from"] == ["pose_fusion.p"]
    plain = yaml.safe_load(pack(transform_project(checked, ["envelope", "remove_generics"])))
    assert plain["groups"]["cleaning"]["components"]["smooth"]["is"] == "filter_of_pose"
    assert plain["types"]["Envelope of Pose"]["message"].endswith("/EnvelopePose")
    flat = pack(transform_project(checked, ["flatten"]))
    assert "      left_arm_shoulder:  # archgen: made[resolve_instances, flatten] from archgen.yaml:78:7\n" in flat
    topic = yaml.safe_load(flat)["groups"]["cleaning"]["components"]["lidar"]["node"]["publishes"]["p"]["topic"]
    assert topic == ["/cleaning/localization/lidar/p"]
    assert "  cleaning:  # archgen: from archgen.yaml:90:3\n" in flat
