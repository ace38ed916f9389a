"""`archgen simulate`: the same figures each time, as the schema describes them."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
from click.testing import CliRunner

from archgen import resources
from archgen.cli import main

PROJECT = """
groups:
  g:
    components:
      eye: {outputs: {seen: {type: Seen}}, timing: {period: 10 ms, wcet: 2 ms, bcet: 1 ms}}
      hand: {inputs: {seen: eye.seen}, outputs: {moved: {medium: physical}}, timing: {wcet: 3 ms}}
types: {Seen: {message: std_msgs/msg/Empty}}
chains: {reach: {through: [eye, hand], deadline: 20 ms}}
"""


def told(tmp_path: Path, *words: str) -> str:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT, encoding="utf-8")
    return CliRunner().invoke(main, ["simulate", str(file), "--seconds", "2", "--seeds", "3", *words]).stdout


def test_json_is_as_the_schema_says(tmp_path: Path) -> None:
    schema = json.loads(resources.resource_path("schemas", "simulation.schema.json").read_text(encoding="utf-8"))
    data = json.loads(told(tmp_path, "--format", "json"))
    jsonschema_rs.validator_for(schema).validate(data)
    chain = data["chains"]["reach"]
    assert chain["bound"] == 15
    assert 14 < chain["reaction"]["max"] <= 15


def test_the_same_seeds_give_the_same_text(tmp_path: Path) -> None:
    first = told(tmp_path)
    assert first == told(tmp_path)
    assert "What was seen is no bound" in first
    assert "reach reaction" in first


def test_an_unknown_chain_is_wrong_usage(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT, encoding="utf-8")
    found = CliRunner().invoke(main, ["simulate", str(file), "--chain", "raech"])
    assert (found.exit_code, "did you mean `reach`" in found.stderr) == (2, True)


def _run(tmp_path: Path, project: str, *words: str) -> tuple[int, str]:
    file = tmp_path / "robot.yaml"
    file.write_text(project, encoding="utf-8")
    found = CliRunner().invoke(main, ["simulate", str(file), *words])
    return found.exit_code, found.stdout + found.stderr


def test_json_says_what_was_taken_for_granted(tmp_path: Path) -> None:
    said = json.loads(told(tmp_path, "--format", "json"))["assumptions"]
    assert {one["figure"]: (one["taken"], one["of"]) for one in said["defaults"]} == {
        "bcet": ("0", ["hand"]),
        "jitter": ("none", ["eye"]),
        "host": ("a core of its own", ["eye", "hand"]),
    }
    assert "execution times from bcet to wcet" in said["random"]
    assert "lost packets" in said["not_simulated"]


def test_without_timing_it_says_what_is_missing(tmp_path: Path) -> None:
    status, said = _run(tmp_path, "groups: {g: {components: {a: {outputs: {o: {type: T}}}}}}\ntypes: {T: {}}\n")
    assert status == 0
    assert "Nothing ran: no element has a period or a rate" in said


def test_a_ring_without_end_is_refused(tmp_path: Path) -> None:
    ring = PROJECT.replace("eye: {outputs", "eye: {inputs: {x: {from: eye.seen}}, outputs").replace(
        "timing: {period: 10 ms, wcet: 2 ms", "timing: {behaviour: event, wcet: 2 ms"
    )
    status, said = _run(tmp_path, ring)
    assert status != 0
    assert "round for ever in eye > eye" in said


def test_wrong_figures_are_wrong_usage(tmp_path: Path) -> None:
    for words in (("--seconds", "0"), ("--seeds", "x"), ("--seeds", "-1")):
        status, said = _run(tmp_path, PROJECT, *words)
        assert status == 2
        assert words[0] in said


def test_a_chain_that_is_not_there_names_those_that_are(tmp_path: Path) -> None:
    assert "the chains are reach" in _run(tmp_path, PROJECT, "--chain", "walk")[1]
