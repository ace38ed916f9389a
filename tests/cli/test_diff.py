"""`archgen diff`: what it compares, how it is written, how it ends."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import resources
from tests.cli.conftest import Run
from tests.repositories import commit, repository
from tests.repositories import git as git_run
from tests.running import RAMCIP, contents

ROBOT = """\
archgen: 1
project: {id: robot}
partners: {certh: CERTH, sssa: SSSA}
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
  display:
    owner: sssa
    components:
      screen: {title: Screen, inputs: {image: camera.image}}
nodes:
  camera: {implements: camera, timing: {rate: 10 Hz, wcet: 2 ms}, host: pc}
  screen: {implements: screen, timing: {behaviour: event, wcet: 5 ms}, host: pc}
hosts: {pc: {cores: 1}}
chains: {see: {through: [camera, screen], deadline: 300 ms}}
"""
SLOWER = ROBOT.replace("rate: 10 Hz", "rate: 5 Hz")
CUT = (
    ROBOT.replace("      screen: {title: Screen, inputs: {image: camera.image}}\n", "      lamp: Lamp\n")
    .replace("  screen: {implements: screen, timing: {behaviour: event, wcet: 5 ms}, host: pc}\n", "")
    .replace("[camera, screen]", "[camera]")
)


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a repository in which the working tree of a branch differs from where it left `main`."""
    root = repository(tmp_path / "robot", {"archgen.yaml": ROBOT})
    git_run(root, "checkout", "-q", "-b", "slow")
    commit(root, {"archgen.yaml": SLOWER})
    monkeypatch.chdir(root)
    return root


def test_a_branch_against_where_it_left_the_main_line(run: Run, robot: Path) -> None:
    ran = run("diff")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out == (
        "sensing: Sensing (CERTH)\n"
        "  ~ `sensing.camera`: rate `10 Hz` → `5 Hz`\n"
        "\n"
        "Between partners\n"
        "  ~ `sensing.camera.image` from CERTH to SSSA: rate 10 Hz → 5 Hz; largest gap 107 ms → 207 ms\n"
        "\n"
        "Latency of chains\n"
        "  see: 107 ms → 207 ms (+100 ms), deadline 300 ms: met\n"
        "\n"
        "1 change (1 changed); concerns CERTH, SSSA; no change breaks another partner\n"
    )
    assert run("diff", "main", "-C", robot).out == ran.out
    assert run("diff", "main..slow").out == ran.out
    assert run("diff", "HEAD").out == "no changes\n"


def test_exit_codes(run: Run, robot: Path) -> None:
    assert run("diff", "--exit-code").status == 1
    assert run("diff", "HEAD", "--exit-code").status == 0
    (robot / "archgen.yaml").write_text(f"# only a comment\n{SLOWER}", encoding="utf-8")
    assert run("diff", "HEAD", "--exit-code").status == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["mian"], "there is no revision `mian`: did you mean `main`?"),
        (["./nothing"], "nothing does not exist"),
        (["main", "main", "-C", "/nowhere"], "/nowhere does not exist"),
        (["--select", "nobody"], "nothing is called `nobody`; `archgen list` gives the names of all elements"),
    ],
)
def test_wrong_usage(run: Run, robot: Path, words: list[str], said: str) -> None:
    assert robot
    ran = run("diff", *words)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err


def test_outside_of_a_repository(run: Run, first: Path) -> None:
    ran = run("diff", "-C", first)
    assert ran.status == 2
    assert "is not in a git repository: run `git init` first, or name two folders or files to compare" in ran.err
    assert run("diff", first, first).out == "no changes\n"


def test_consequences_and_cured_findings(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(CUT, encoding="utf-8")
    out = run("diff", "main").out
    assert (
        "- component `display.screen` is removed with 1 input; `sensing.camera.image` is no longer read by anybody\n"
        in out
    )
    assert "  warning[unread-output]: nobody reads `image` of `sensing.camera` (archgen.yaml:8:26)\n" in out
    assert "Latency of chains\n  see: 107 ms → 102 ms (-5 ms), deadline 300 ms: met\n" in out
    assert out.rstrip().endswith("; concerns CERTH, SSSA; no change breaks another partner")


def test_json_follows_its_schema(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(
        CUT.replace("cores: 1", "cores: 2").replace("sensing:", "perception:"), encoding="utf-8"
    )
    data = json.loads(run("diff", "main", "--format", "json").out)
    _valid(data)
    (group,) = [change for change in data["changes"] if change["kind"] == "renamed"]
    assert (group["sort"], group["element"], group["was"], group["breaks"]) == (
        "group",
        "perception",
        "sensing",
        ["sssa"],  # the topic is called after the group, and its reader is taken away
    )
    assert [each["verdicts"] for each in data["chains"]] == [["met", "met"]]
    assert [(c["id"], c["before"]["value"], c["after"]["value"], c["deadline"]) for c in data["chains"]] == [
        ("see", 107.0, 102.0, 300.0)
    ]
    assert data["owners"] == ["certh", "sssa"]
    assert {"unmapped-component", "unread-output"} <= {d["rule"] for d in data["findings"]["new"]}


@pytest.mark.slow
def test_json_of_the_case_study(run: Run, tmp_path: Path) -> None:
    files = {name: data for name, data in contents(RAMCIP).items() if "archgen-out" not in name}
    root = repository(tmp_path / "ramcip", dict(files))
    for file in root.rglob("*.yaml"):
        text = (
            file.read_text(encoding="utf-8")
            .replace("appliance_monitor", "stove_watch")
            .replace("sensor_data", "default")
        )
        file.write_text(text.replace("R-10", "R-99"), encoding="utf-8")
    data = json.loads(run("diff", "-C", root, "--format", "json").out)
    _valid(data)
    assert {change["kind"] for change in data["changes"]} == {"changed", "renamed"}
    assert data["broken"] == {"before": [], "after": []}


def _valid(data: object) -> None:
    schema = json.loads(resources.resource_path("schemas", "diff.schema.json").read_text(encoding="utf-8"))
    jsonschema_rs.meta.validate(schema)
    assert [error.message for error in jsonschema_rs.validator_for(schema).iter_errors(data)] == []


def test_a_side_that_does_not_load_is_told_and_the_rest_compared(run: Run, robot: Path) -> None:
    rest, groups = ROBOT.replace("groups:", "@groups:").split("@")
    groups, nodes = groups.split("nodes:")
    files = {"archgen.yaml": rest + "hosts: {pc: {cores: 1}}\n", "groups.yaml": groups, "nodes.yaml": f"nodes:{nodes}"}
    files["nodes.yaml"] = files["nodes.yaml"].replace("hosts: {pc: {cores: 1}}\n", "")
    commit(robot, dict(files))
    assert run("diff", "main").out.startswith("sensing") is False
    (robot / "groups.yaml").write_text(groups.replace("components:", "components: [", 1), encoding="utf-8")
    (robot / "archgen.yaml").write_text(files["archgen.yaml"].replace("cores: 1", "cores: 2"), encoding="utf-8")
    out = run("diff", "HEAD").out
    assert out.startswith(
        "the working tree is not sound (1 error). What cannot be read there is left out of the comparison:\n\nerror["
    )
    assert "Hosts\n  ~ host `pc`: cores 1 → 2\n" in out
    assert "is removed" not in out
    data = json.loads(run("diff", "HEAD", "--format", "json").out)
    assert [d["rule"] for d in data["broken"]["after"]][:1] == ["syntax-error"]
    assert data["broken"]["before"] == []


def test_select_keeps_what_touches_it_on_either_side(run: Run, robot: Path) -> None:
    (robot / "archgen.yaml").write_text(CUT.replace("rate: 10 Hz", "rate: 5 Hz"), encoding="utf-8")
    screen = run("diff", "main", "--select", "display.screen").out
    assert "component `display.screen` is removed" in screen
    assert "rate" not in screen
    assert "lamp" not in screen
    camera = run("diff", "main", "--select", "owner:certh").out
    assert "rate `10 Hz` → `5 Hz`" in camera
    assert "lamp" not in camera


def test_names_from_strangers_move_no_terminal(run: Run, robot: Path) -> None:
    evil = ROBOT.replace("{title: Screen,", r'{title: "\e[2J::error::x\u202e",').replace("R", "R")
    (robot / "archgen.yaml").write_text(evil, encoding="utf-8")
    for form in ("text", "json"):
        out = run("diff", "main", "--format", form).out
        assert "\x1b" not in out
        assert "\u202e" not in out
        assert not any(line.lstrip().startswith("::") for line in out.splitlines())


@pytest.mark.parametrize(
    ("form", "start"),
    [
        ("text", "sensing: Sensing (CERTH)\n  ~ `sensing.camera`: rate"),
        ("json", '{\n  "version": 1,'),
        ("markdown", "### 1 change of the architecture: concerns CERTH and SSSA\n\n`where this branch left main ("),
        ("html", "<!DOCTYPE html>\n"),
        ("svg", '<?xml version="1.0" encoding="UTF-8"?>\n<svg class="archgen"'),
    ],
)
def test_every_format_goes_to_the_terminal_or_into_a_file(run: Run, robot: Path, form: str, start: str) -> None:
    ran = run("diff", "--format", form)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith(start)
    assert run("diff", "--format", form, "-o", "made/changes").out == "wrote made/changes\n"
    assert (robot / "made" / "changes").read_text(encoding="utf-8") == ran.out
    assert [path.name for path in (robot / "made").iterdir()] == ["changes"]


def test_no_picture_is_said_and_nothing_is_written(run: Run, robot: Path) -> None:
    ran = run("diff", "HEAD", "--format", "svg", "-o", "picture.svg")
    assert ran.status == 2
    assert "nothing changed that a picture could show" in ran.err
    assert not (robot / "picture.svg").exists()


def test_the_comment_names_the_command_that_shows_everything(run: Run, robot: Path) -> None:
    many = "".join(f"      part{at}: {{title: {'w' * 90}, inputs: {{image: camera.image}}}}\n" for at in range(700))
    text = SLOWER.replace("      screen: {", f"{many}      screen: {{")
    (robot / "archgen.yaml").write_text(text, encoding="utf-8")
    ran = run("diff", "main", "--format", "markdown")
    assert len(ran.out) <= 65_336
    assert " more: `archgen diff main`" in ran.out


def test_a_tree_of_git_is_a_version(run: Run, tmp_path: Path) -> None:
    """As `git merge-tree --write-tree main other` makes one."""
    project = "archgen: 1\nproject: {id: robot}\ngroups: {g: {components: {a: {outputs: {o: T}}}}}\n"
    folder = repository(tmp_path / "robot", {"archgen.yaml": project})
    git_run(folder, "checkout", "-q", "-b", "other")
    commit(folder, {"archgen.yaml": project.replace("o: T", "o: T, p: T")})
    tree = git_run(folder, "merge-tree", "--write-tree", "main", "other")
    ran = run("diff", "main", tree, "-C", folder)
    assert "output `g.a.p` is added" in ran.out
    assert run("diff", "main", f"main...{tree[:8]}", "-C", folder).status == 2
    blob = git_run(folder, "rev-parse", "main:archgen.yaml")
    assert "there is no revision" in run("diff", "main", blob, "-C", folder).err


def test_groups_and_partners_stand_in_the_order_in_which_people_count(run: Run, tmp_path: Path) -> None:
    groups = "".join(
        f"  g{at}: {{owner: p{at}, components: {{c: {{outputs: {{o: T}}, timing: {{rate: 5 Hz}}}}}}}}\n"
        for at in (10, 2, 1)
    )
    partners = ", ".join(f"p{at}: {{title: P {at}}}" for at in (1, 2, 10))
    text = f"project: {{title: Row}}\npartners: {{{partners}}}\ntypes: {{T: std_msgs/msg/Bool}}\ngroups:\n{groups}"
    row = tmp_path / "row"
    repository(row, {"archgen.yaml": text})
    (row / "archgen.yaml").write_text(text.replace("5 Hz", "4 Hz"), encoding="utf-8")
    told = run("diff", "HEAD", "-C", row, "--format", "markdown").out
    assert re.findall(r"g\d+(?=\.c)", told)[:3] == ["g1", "g2", "g10"]
    assert told.index("P 2") < told.index("P 10")
