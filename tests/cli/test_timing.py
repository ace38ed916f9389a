"""`archgen timing`: the summary, one chain, why, ways, what if, sensitivity, measured; as text and as JSON."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest

from archgen import resources
from tests.cli.conftest import Run

PROJECT = """\
archgen: 1
project: {id: p, title: P}
groups:
  drive:
    components:
      scanner:
        outputs: {scan: sensor_msgs/msg/LaserScan}
        timing: {period: 50 ms, wcet: 5 ms}
      planner:
        inputs: {scan: scanner.scan}
        outputs: {path: nav_msgs/msg/Path}
        timing: {wcet: 20 ms}
      base:
        inputs: {path: planner.path}
        timing:
          period: 20 ms
          wcet: 2 ms
nodes:
  scan: {implements: scanner}
  plan: {implements: planner}
  drive: {implements: base}
chains:
  avoid: {through: [scan, plan, drive], deadline: 90 ms}
  ends: {through: [scan, drive]}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "p"
    folder.mkdir()
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return folder


def _json(run: Run, *words: object) -> Any:  # noqa: ANN401 - plain data
    ran = run("timing", "--format", "json", *words)
    data = json.loads(ran.out)
    schema = json.loads(resources.resource_path("schemas", "timing.schema.json").read_text(encoding="utf-8"))
    assert list(jsonschema_rs.Draft202012Validator(schema).iter_errors(data)) == []
    return data


def test_a_chain_in_json(run: Run, project: Path) -> None:
    data = _json(run, project)
    chain = data["chains"]["avoid"]
    assert chain["through"] == ["scan", "plan", "drive"]
    assert chain["bound"]["value"] == 50 + 5 + 0 + 20 + 20 + 2
    assert (chain["deadline"], chain["slack"], chain["verdict"]) == (90, -7, "missed")
    assert chain["witness"]["longest"] > 90
    assert chain["remedy"] == {"set": [], "bound": None, "tried": {}, "cut": False}
    assert chain["floor"] == 97
    assert [term["sampling"]["value"] for term in chain["terms"]] == [50, 0, 20]
    assert data["chains"]["ends"]["bound"] == chain["bound"]
    assert (data["elements"]["plan"]["behaviour"], data["elements"]["plan"]["rate"]["value"]) == ("event", 20)


def test_the_summary_names_the_chain_that_is_late(run: Run, project: Path) -> None:
    ran = run("timing", project)
    assert ran.status == 0
    assert "  avoid  97 ms  deadline 90 ms  MISSED  7 ms above it  seen in `archgen simulate --chain avoid" in ran.out
    assert (
        "In a simulated run it took 92 ms, 2 ms longer than its deadline of 90 ms allows; it never takes more than 97 ms."
        in (" ".join(ran.out.split()))
    )
    assert "nothing shows that it ever does" not in " ".join(ran.out.split())
    assert (
        "  avoid  with nobody in its way it takes 97 ms: nothing but other rates, triggers or execution times can prove it "
        "(`archgen timing --budget avoid`)\n"
    ) in ran.out
    assert "  ends   97 ms  no deadline" in ran.out


def test_the_run_that_shows_the_chain_late_can_be_seen_again(run: Run, project: Path) -> None:
    command, longest = re.findall(r"seen in `archgen (simulate [^`]+)`: ([0-9.]+) ms", run("timing", project).out)[0]
    verb, *options = command.split()
    shown = run(verb, project, *options).out
    (row,) = (line.split() for line in shown.splitlines() if line.startswith("  avoid reaction"))
    assert float(row[5]) == float(longest)
    assert run("timing", project, "--chain", "avoid").out.count(f"`archgen {command}`: {longest} ms") == 1


ROBOT = Path(__file__).parents[1] / "timing" / "search" / "nav_robot.yaml"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    return Path(shutil.copy(ROBOT, tmp_path / "robot.yaml"))


@pytest.mark.slow
def test_a_robot_that_is_late_is_proven_in_three_commands(run: Run, robot: Path) -> None:
    shown = run("timing", robot).out
    assert (
        "scan_and_stop  with nobody in its way it takes 424.8 ms: nothing but other rates, triggers or execution"
        in shown
    )
    assert "costmap fired by one message in 2 of its input scan (`archgen timing --propose`)" in shown
    proposed = run("timing", robot, "--propose")
    assert "  All 3 chains are proven.\n" in proposed.out
    assert "--- a/robot.yaml\n+++ b/robot.yaml\n@@ " in proposed.out
    assert robot.read_bytes() == ROBOT.read_bytes()
    assert run("timing", robot, "--propose", "--apply").out.endswith("robot.yaml (as proposed)\n")
    assert "MISSED" not in run("timing", robot).out
    assert "not proven" not in run("timing", robot).out
    again = run("timing", robot, "--propose", "--apply")
    assert again.out == "Each chain with a deadline is met.\n"


@pytest.mark.slow
def test_a_proposal_in_json(run: Run, robot: Path) -> None:
    found = _json(run, robot, "--propose")["propose"]
    best = found["tried"][found["best"]]
    assert (found["floors"], best["late"], best["lateness"]) == ({"scan_and_stop": 424.8}, [], 0)
    assert best["bounds"]["scan_and_stop"] == 338.85
    assert found["tried"][found["kept_triggers"]]["late"] == ["scan_and_stop"]
    assert found["patch"].startswith("--- a/robot.yaml\n")
    options = [word for change in best["set"] for word in ("--set", change)]
    assert re.search(r"scan_and_stop +1800\.85 ms -> 338\.85 ms", run("timing", robot, *options).out)
    kept = _json(run, robot, "--propose", "settings")["propose"]
    assert not any("trigger" in change for tried in kept["tried"] for change in tried["set"])


@pytest.mark.slow
def test_what_has_no_place_is_to_be_written_by_hand(run: Run, robot: Path) -> None:
    text = robot.read_text(encoding="utf-8").replace(
        "    container: navbox\n    timing: {rate: 5", "    container: &box navbox\n    timing: {rate: 5"
    )
    robot.write_text(text.replace("    container: navbox\n", "    container: *box\n"), encoding="utf-8")
    ran = run("timing", robot, "--propose", "--apply")
    assert ran.status == 2
    assert "no patch: `container` is not written as a plain value on one line" in ran.err
    assert "to be written by hand: --set planner.container=none --set" in ran.err
    assert _json(run, robot, "--propose")["propose"]["refused"].startswith("`container` is not written")


def test_the_budget_of_a_chain(run: Run, project: Path) -> None:
    ran = run("timing", project, "--budget", "avoid")
    assert ran.out.startswith("avoid: 97 ms, deadline 90 ms, MISSED, 7 ms above it\n")
    assert "must shrink by the factor" in ran.out or "All together, each times 0." in ran.out
    assert _json(run, project, "--budget", "avoid")["slack"] == -7
    refused = run("timing", project, "--budget", "ends")
    assert refused.status == 2
    assert "`ends` has no budget: it has no deadline; write `deadline` at `chains: ends`" in refused.err


def test_check_warns_of_the_late_chain(run: Run, project: Path) -> None:
    ran = run("check", project)
    assert (
        "warning[late-chain]: the chain `avoid` misses its deadline of 90 ms: it took 92 ms in a simulated run "
        "(`archgen simulate --chain avoid --seed 0 --seconds 2`)" in ran.out
    )


def test_a_chain_term_by_term(run: Run, project: Path) -> None:
    ran = run("timing", project, "--chain", "avoid")
    lines = [" ".join(line.split()) for line in ran.out.splitlines()]
    assert lines[0] == "avoid: scan > plan > drive"
    assert "scan - 50 ms 5 ms samples the world every 50 ms at the latest (archgen.yaml:8:26)" in lines
    assert any(
        line.startswith("drive - 20 ms 2 ms reads /drive/planner/path every 20 ms at the latest") for line in lines
    )
    assert any(
        line.startswith("reduced reaction time (from the first sample on) 47 ms hold it against a stop")
        for line in lines
    )


def test_how_much_the_end_of_a_chain_may_jitter_is_what_lies_between_best_and_worst(run: Run) -> None:
    out = run("timing", resources.resource_path("example_ramcip"), "--chain", "slip_to_grip").out
    figures = [line.split() for line in out.splitlines()]
    assert ["best", "case", "550", "us"] in [line[:4] for line in figures]
    assert ["best", "to", "worst", "8.15", "ms"] in [line[:5] for line in figures]
    assert any("8.7" in line and "largest" in line for line in figures)


def test_why_goes_back_to_the_sources(run: Run, project: Path) -> None:
    ran = run("timing", project, "--why", "plan")
    assert "plan: event (inferred), rate 20 Hz, largest gap 55 ms" in ran.out
    assert "  scan: periodic, rate 20 Hz, largest gap 50 ms" in ran.out
    assert "archgen.yaml:8" in ran.out
    steps = _json(run, project, "--why", "avoid")["steps"]
    assert steps[0]["text"].startswith("avoid: 97 ms")


def test_ways_between_two_elements(run: Run, project: Path) -> None:
    data = _json(run, project, "--from", "scanner", "--to", "base", "--worst", "3")
    assert (data["count"], [way["bound"]["value"] for way in data["worst"]]) == (1, [97])
    ran = run("timing", project, "--from", "scanner", "--to", "base")
    assert ran.out.startswith("drive.scanner to drive.base: 1 way\n  worst 1: 97 ms   scan > plan > drive\n")


def test_what_if_shows_the_effect_and_touches_nothing(run: Run, project: Path) -> None:
    ran = run("timing", project, "--set", "plan.timing.wcet=10ms", "--set", "scanner.timing.rate=40Hz")
    assert "  avoid  97 ms -> 62 ms  (-35 ms)  missed -> met" in ran.out
    assert (project / "archgen.yaml").read_text(encoding="utf-8") == PROJECT
    data = _json(run, project, "--set", "plan.timing.wcet=10ms")
    assert [data[key]["chains"]["avoid"]["bound"]["value"] for key in ("present", "changed")] == [97, 87]


def test_sensitivity_ranks_what_decides(run: Run, project: Path) -> None:
    data = _json(run, project, "--sensitivity", "avoid")
    assert [(gain["figure"], gain["gain"]) for gain in data["gains"]] == [
        ("scan.timing.period", 5),
        ("drive.timing.period", 2),
        ("plan.timing.wcet", 2),
        ("scan.timing.wcet", 0.5),
        ("drive.timing.wcet", 0.2),
    ]
    (project / "archgen.yaml").write_text(PROJECT.replace("timing: {wcet: 20 ms}", ""), encoding="utf-8")
    ran = run("timing", project, "--sensitivity", "avoid")
    assert "execution time of plan" in ran.out


def test_what_is_missing_is_said(run: Run, project: Path) -> None:
    text = PROJECT.replace(", wcet: 5 ms", "").replace("{wcet: 20 ms}", "{}").replace("          wcet: 2 ms\n", "")
    (project / "archgen.yaml").write_text(text, encoding="utf-8")
    out = run("timing", project).out
    assert "  avoid  >= 50 ms  deadline 90 ms  open" in out or "  avoid  >= 70 ms  deadline 90 ms  open" in out
    assert "(periods only) no bound: execution time of scan, plan, drive unknown" in out


def test_measured_names_outliers(run: Run, project: Path, tmp_path: Path) -> None:
    file = tmp_path / "run.csv"
    file.write_text("id,rate,wcet\nscan,20 Hz,9 ms\nplan,,\n", encoding="utf-8")
    ran = run("timing", project, "--measured", file)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.endswith("2 figures measured, 1 outlier:\n  scan: wcet takes longer than the design says\n")
    assert [row["verdict"] for row in _json(run, project, "--measured", file)["measured"]] == ["as designed", "outlier"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--from", "scan"), "--from and --to belong together"),
        (("--propose", "--chain", "avoid"), "are questions of their own: ask one at a time"),
        (
            ("--propose", "--set", "plan.timing.wcet=1ms"),
            "--propose is about what the files say, and goes with no --set",
        ),
        (("--apply",), "--apply writes what it proposes"),
        (("--chain", "avoidd"), "there is no chain `avoidd`; did you mean `avoid`?"),
        (("--why", "plam"), "nothing is called `plam`; did you mean `plan`?"),
        (("--set", "plan.timing.wcet=10"), "`wcet` takes a duration"),
        (("--chain", "avoid", "--why", "plan"), "ask one at a time"),
        (("--from", "scan", "--to", "nobody"), "nothing is called `nobody`"),
    ],
)
def test_wrong_usage_is_said(run: Run, project: Path, words: tuple[str, ...], said: str) -> None:
    ran = run("timing", project, *words)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err


BROKEN_CHAIN = """archgen: 1
project: {id: x}
groups: {g: {components: {a: {outputs: {o: T}}, b: {}}}}
chains: {see: {through: [a, b]}}
"""


@pytest.mark.parametrize("question", [("--chain", "see"), ("--sensitivity", "see"), ("--why", "see"), ()])
def test_a_chain_that_is_not_connected_says_where(run: Run, tmp_path: Path, question: tuple[str, ...]) -> None:
    (tmp_path / "archgen.yaml").write_text(BROKEN_CHAIN, encoding="utf-8")
    ran = run("timing", tmp_path, *question)
    assert (ran.status, ran.err) == (0, "")
    assert "no way leads from `g.a` to `g.b`" in ran.out
