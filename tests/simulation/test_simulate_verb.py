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
    schema = json.loads(resources.path("schemas", "simulation.schema.json").read_text(encoding="utf-8"))
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
