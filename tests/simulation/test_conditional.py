"""Chains that do not send each input on: what is seen is held against bounds under the bounds' own assumption."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from archgen.cli import main
from archgen.simulation.chain_series import ChainTrace, measure_chain

PROJECT = """
groups:
  g:
    components:
      eye: {outputs: {seen: {type: Seen}}, timing: {period: 10 ms, wcet: 1 ms}}
      watch:
        inputs: {seen: eye.seen}
        outputs: {alarm: {type: Seen}}
        timing: {wcet: 2 ms, outputs: {alarm: {conditional: true%s}}}
      hand: {inputs: {alarm: watch.alarm}, outputs: {moved: {medium: physical}}, timing: {wcet: 3 ms}}
types: {Seen: {message: std_msgs/msg/Empty}}
chains: {reach: {through: [eye, watch, hand], deadline: 20 ms}}
"""
TRACE = ChainTrace(
    samplings=[0, 10, 20, 30],
    source_logs=[[0, 1, 2, 3], [0, 3]],  # of what `watch` had from the second and third input, it said nothing
    job_ends=[6, 36],
    forwarded_jobs=[None, frozenset({0, 3})],
    samples_world=True,
)


def told(tmp_path: Path, more: str, *words: str) -> str:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT % more, encoding="utf-8")
    found = CliRunner().invoke(main, ["simulate", str(file), "--seconds", "5", "--seeds", "3", *words])
    assert found.exit_code == 0, found.output
    return found.stdout


def test_over_all_inputs_a_reaction_waits_for_the_next_that_is_sent_on() -> None:
    assert measure_chain(TRACE).reactions == ((26, 36), (16, 26), (6, 16))
    assert measure_chain(TRACE).ages == ((6, 36),)


def test_of_what_is_sent_on_at_once_only_its_own_way_counts() -> None:
    passing = measure_chain(TRACE, forwarded_only=True)
    assert passing.reactions == ((6, 16),)
    assert (passing.ages, passing.reduced_reaction, passing.input_count) == ((), 6, 1)


def test_json_has_both(tmp_path: Path) -> None:
    chain = json.loads(told(tmp_path, "", "--format", "json"))["chains"]["reach"]
    assert chain["bound"] == 16
    assert chain["reaction"]["max"] > 16
    assert chain["conditional"]["reaction"]["max"] <= 16
    assert 0 < chain["conditional"]["inputs"] < chain["inputs"]
    assert chain["conditional"]["because"] == ["watch does not always publish /g/watch/alarm"]
    assert chain["assumptions"][1:] == ["watch publishes /g/watch/alarm for this very input"]


def test_text_shows_no_figure_above_its_bound_without_a_word(tmp_path: Path) -> None:
    text = told(tmp_path, "")
    rows = [line.split() for line in text.splitlines() if line.startswith("  reach ")]
    assert [row[-2] for row in rows] == ["16.000*", "16.000*"]
    assert all(float(row[5]) <= 16 for row in rows)
    assert "Over all inputs" in text
    assert "watch does not always publish /g/watch/alarm" in text


def test_a_promised_gap_makes_a_bound_for_all_inputs(tmp_path: Path) -> None:
    chain = json.loads(told(tmp_path, ", max_gap: 50 ms", "--format", "json"))["chains"]["reach"]
    assert chain["conditional"] is None
    assert 16 < chain["reaction"]["max"] <= chain["bound"]


@pytest.mark.parametrize(
    ("more", "said"), [("", []), (", max_gap: 5 ms", ["watch promises g.watch.alarm every 5 ms at least"])]
)
def test_a_promise_that_cannot_be_kept_is_named(tmp_path: Path, more: str, said: list[str]) -> None:
    found = json.loads(told(tmp_path, more, "--format", "json"))["assumptions"]["contradictions"]
    assert [one.split(",")[0] for one in found] == said


@pytest.mark.parametrize(("bandwidth", "is_said"), [("80 Mbit/s", False), ("7 Mbit/s", True)])
def test_a_latency_that_a_link_cannot_keep_is_named(tmp_path: Path, bandwidth: str, is_said: bool) -> None:  # noqa: FBT001
    nodes = "nodes: {eye: {implements: eye, host: p}, watch: {implements: watch, host: q}, hand: {implements: hand, host: q}}"
    hosts = f"hosts: {{p: {{}}, q: {{}}}}\nlinks: {{lan: {{connects: [p, q], bandwidth: {bandwidth}, latency: 1 ms}}}}"
    file = tmp_path / "robot.yaml"
    text = (PROJECT % "").replace("std_msgs/msg/Empty}", "std_msgs/msg/String, size: 10 kB}")
    file.write_text(f"{text}\n{nodes}\n{hosts}\n", encoding="utf-8")
    found = CliRunner().invoke(main, ["simulate", str(file), "--seconds", "5", "--seeds", "1", "--format", "json"])
    assert found.exit_code == 0, found.output
    sentences = json.loads(found.stdout)["assumptions"]["contradictions"]
    assert any(one.startswith("lan has a latency of 1 ms") for one in sentences) is is_said
