"""A proposed configuration as a patch: git applies it, comments stay, and the files then take what was printed."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.edit.configuration_patch import plan_patch
from archgen.edit.element_edit import EditRefusedError
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.proposals import TriedConfiguration, find_proposal
from tests.property_sizes import try_some
from tests.repositories import git
from tests.timing.search.trials import start_trials

ROBOT = Path(__file__).parents[1] / "timing" / "search" / "nav_robot.yaml"
SPREAD = {
    "archgen.yaml": "project: {id: p, title: P}\nsources: ['*.yaml']\nhosts: {p: {cores: 1}, q: {cores: 1}}\n"
    "links: {lan: {connects: [p, q], latency: 0 ms}}\ncontainers: {box: {host: p, threads: 1}}\n"
    "types: {Data: {message: std_msgs/msg/String}}\nchains: {c: {through: [a, b], deadline: 120 ms}}\n",
    "groups.yaml": "groups:\n  g:\n    components:\n      a: {outputs: {out: Data}}\n"
    "      b: {inputs: {a: a.out}, outputs: {done: {type: Data, external: World}}, timing: {wcet: 3 ms}} # quick\n"
    "      slow: {outputs: {done: {type: Data, external: World}}}\n",
    "nodes.yaml": "nodes:\n  a: {implements: g.a, host: q, timing: {period: 100 ms, wcet: 1 ms}}\n"
    "  b: {implements: g.b, container: box} # first\n"
    "  slow: {implements: g.slow, container: box, timing: {period: 200 ms, wcet: 60 ms}}\n",
}


def _write(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).write_bytes(text.encode())
    return folder


def _propose(path: Path) -> tuple[pipeline.CheckedProject, TriedConfiguration]:
    checked_project = pipeline.check_project(path)
    architecture = checked_project.architecture
    chains = bound_all_chains(analyse_architecture(architecture), architecture)
    return checked_project, find_proposal(start_trials(architecture, 60), chains).best


def _apply(folder: Path, patch: str) -> None:
    git(folder, "init", "-q", ".")
    git(folder, "apply", "-", stdin=patch.encode())


def _bound(path: Path) -> dict[str, object]:
    architecture = pipeline.check_project(path).architecture
    chains = bound_all_chains(analyse_architecture(architecture), architecture)
    return {name: chain.bound.value for name, chain in chains.items()}


@pytest.mark.parametrize("ending", try_some(["\r\n", "\n"]))
def test_git_applies_the_patch_of_the_newcomers_robot(tmp_path: Path, ending: str) -> None:
    robot = tmp_path / "robot.yaml"
    before = ROBOT.read_text(encoding="utf-8").rstrip("\n").replace("\n", ending)
    robot.write_bytes(before.encode())
    checked_project, best = _propose(robot)
    edits = plan_patch(checked_project, best)
    _apply(tmp_path, "".join(line for edit in edits for line in edit.unified_diff()))
    after = robot.read_bytes().decode()
    assert after.encode() == edits[0].new_content
    assert [line for line in before.split("\n") if "#" in line] == [line for line in after.split("\n") if "#" in line]
    assert "timing: {trigger: [scan], wcet: 40 ms, bcet: 10 ms, priority: 11, every: 2}" in after
    assert _bound(robot) == best.bounds
    assert not _propose(robot)[1].changes


def test_each_value_goes_where_the_node_stands(tmp_path: Path) -> None:
    checked_project, best = _propose(_write(tmp_path, SPREAD))
    assert not best.late
    edits = plan_patch(checked_project, best)
    assert {edit.file for edit in edits} <= {"nodes.yaml", "groups.yaml"}
    _apply(tmp_path, "".join(line for edit in edits for line in edit.unified_diff()))
    assert "# quick" in (tmp_path / "groups.yaml").read_text(encoding="utf-8")
    assert "# first" in (tmp_path / "nodes.yaml").read_text(encoding="utf-8")
    assert _bound(tmp_path) == best.bounds
    assert not _propose(tmp_path)[1].changes


def test_what_cannot_be_written_in_place_is_refused(tmp_path: Path) -> None:
    text = SPREAD["nodes.yaml"].replace("b, container: box", "b, container: &box box")
    text = text.replace("slow, container: box", "slow, container: *box")
    checked_project, best = _propose(_write(tmp_path, {**SPREAD, "nodes.yaml": text}))
    with pytest.raises(EditRefusedError) as refused:
        plan_patch(checked_project, best)
    assert refused.value.message.startswith("`container` is not written as a plain value on one line")


def test_what_would_not_take_what_was_printed_is_refused(tmp_path: Path) -> None:
    checked_project, best = _propose(_write(tmp_path, SPREAD))
    wrong = TriedConfiguration(best.words, best.changes, {"c": None}, (), best.lateness)
    with pytest.raises(EditRefusedError) as refused:
        plan_patch(checked_project, wrong)
    assert refused.value.message.startswith("what is written decides otherwise: `c` would take 1")
