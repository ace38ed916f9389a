"""Accepted differences are no findings; they are found where they are gone, misspelt, or accepted for too long."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.conformance.accepted_differences import apply_acceptances
from archgen.model.project_settings import AcceptedDifference
from archgen.pipeline import check_project
from tests.cli.conftest import Run, run
from tests.conformance.rovers import ROVER, check_rover, compare_with_graph, print_graph, show_findings
from tests.repositories import git, repository

__all__ = ["run"]

ACCEPTED = """\
conform:
  ignore: [/relay]
  accepted:
    motion.base.odom: {rule: other-type, reason: the new driver comes in spring, until: v2}
    lidar: {rule: [other-parameter, other-typ], reason: tuned by hand}
"""


def plant(graph: str) -> str:
    graph = graph.replace(
        "Topic type: nav_msgs/msg/Odometry\nEndpoint type: PUB", "Topic type: nav_msgs/msg/Path\nEndpoint type: PUB"
    )
    return f"{graph}$ ros2 node info /relay\n/relay\n  Subscribers:\n    /scan: sensor_msgs/msg/LaserScan\n"


def test_what_is_accepted_is_counted_and_what_is_stale_is_found(tmp_path: Path) -> None:
    checked_project = check_rover(tmp_path, ROVER + ACCEPTED)
    report = compare_with_graph(checked_project, plant(print_graph(checked_project.architecture)))
    line = ROVER.count("\n") + 5
    assert report.accepted_count == 1
    assert show_findings(report.reported.findings) == [
        f"warning stale-acceptance archgen.yaml:{line} `lidar` has no `other-parameter` any more: nothing is left to accept",
        f"warning stale-acceptance archgen.yaml:{line} no rule `other-typ` compares a robot with the design: nothing is accepted",
    ]
    assert report.reported.findings[1].help == "did you mean `other-type`?; it belongs to North"


def test_a_tag_that_is_there_ends_what_is_accepted(tmp_path: Path) -> None:
    root = repository(tmp_path / "r", {"archgen.yaml": ROVER + ACCEPTED})
    graph = plant(print_graph(check_project(root).architecture))
    git(root, "tag", "v2")
    findings = compare_with_graph(check_project(root), graph).reported.findings
    assert "the difference at `motion.base.odom` was accepted until `v2`, which is there by now" in {
        e.message for e in findings
    }


def test_an_element_that_nobody_saw_may_still_differ() -> None:
    accepted = [AcceptedDifference("arm", ("not-running",), "in repair")]
    assert apply_acceptances([], accepted, lambda _: False, lambda _: False) == ([], 0)
    assert [each.rule for each in apply_acceptances([], accepted, lambda _: True, lambda _: False)[0]] == [
        "stale-acceptance"
    ]


def test_an_acceptance_without_reason_or_rule_is_refused_by_the_check(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        f"{ROVER}conform: {{accepted: {{lidar: {{rule: not-running}}, arm: {{reason: x}}}}}}\n", encoding="utf-8"
    )
    found = [each.message for each in check_project(tmp_path).findings if each.rule == "missing-key"]
    assert found == ["`lidar` lacks `reason`", "`arm` lacks `rule`"]


def test_the_project_names_what_it_is_held_against(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what lies in its repository: a project of others must not have files of the machine shown in findings."""
    monkeypatch.chdir(tmp_path)
    graph = print_graph(check_rover(tmp_path / "r/rover", f"{ROVER}conform: {{against: ../graph.txt}}\n").architecture)
    (tmp_path / "r/graph.txt").write_text(plant(graph), encoding="utf-8")
    outside = run("conform", "r/rover")
    assert (outside.status, "which is not in the repository: give it with --against" in outside.err) == (2, True)
    (tmp_path / "r/.git").mkdir()
    done = run("conform", "r/rover", "--only", "other-type")
    assert done.status == 1
    assert done.out.startswith("r/graph.txt (graph): 5 of 5 nodes")
    assert "against what?" in run("conform", check_rover(tmp_path / "plain").root).err
