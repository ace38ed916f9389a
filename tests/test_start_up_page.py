"""The page on start-up: its example is a project in which nothing is wrong."""

from __future__ import annotations

import json
import re
from pathlib import Path

from archgen.analyses import RULES
from archgen.bringup.start_plan import make_start_plan
from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import check_project
from tests.running import ROOT, archgen_here

PAGE = (ROOT / "docs" / "start_up.md").read_text(encoding="utf-8")


def test_nothing_is_wrong_with_the_example(tmp_path: Path) -> None:
    (example,) = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    file = tmp_path / "archgen.yaml"
    file.write_text(f"archgen: 1\nproject: {{id: robot, title: Robot}}\n{example}", encoding="utf-8")
    checked = check_project(file)
    assert [f"{d.span} {d.rule}: {d.message}" for d in checked.findings if d.effective_severity > Severity.NOTE] == []
    plan = make_start_plan(checked.architecture)
    assert [step.id for step in plan.steps] == ["stage", "map_server", "manager", "clear_cache", "amcl", "rviz"]
    assert plan.dropped == ()


def test_every_key_and_every_rule_of_the_page_is_one() -> None:
    schema = json.loads((ROOT / "schemas" / "archgen.schema.json").read_text(encoding="utf-8"))["$defs"]
    keys = [key for row in re.findall(r"^\| (`.*?) \|", PAGE, re.MULTILINE) for key in re.findall(r"`(\w+)`", row)]
    assert set(keys) == set(schema["start"]["properties"])
    signs = PAGE.partition("All that `ready` holds must be true: ")[2].partition("\n\n")[0]
    assert {key for key in schema["start_ready"]["properties"] if f"`{key}`" not in signs} == set()
    rules = re.findall(r"\(rules/([\w-]+)\.md\)", PAGE)
    assert set(rules) == {rule.name for rule in RULES if rule.name in rules}
    assert len(rules) == 8


def test_the_example_gives_what_the_page_says_of_its_start(tmp_path: Path) -> None:
    (example,) = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    file = tmp_path / "archgen.yaml"
    file.write_text(f"archgen: 1\nproject: {{id: robot, title: Robot}}\n{example}", encoding="utf-8")
    archgen_here("generate", "start", "-o", "robot", "--option", "folder=/srv/robot", cwd=tmp_path)
    for name in re.findall(r"robot/(start[\w./]*)|`(settings\.sh|start/hosts/|start/systemd/|start/compose/)", PAGE):
        assert (tmp_path / "robot" / "".join(name).rstrip("/")).exists(), name
    unit = (tmp_path / "robot" / "start" / "systemd" / "sim_pc" / "robot-stage.service").read_text(encoding="utf-8")
    assert '"/srv/robot/start/lib/run.sh"' in unit
