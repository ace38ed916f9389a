"""What became of promises, and figures that hardly moved, as lines of all outputs of a comparison."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema_rs
import pytest

from archgen import pipeline, resources
from archgen.compare import Comparison
from archgen.compare.compare_versions import compare_versions
from archgen.compare.figure_noise import FigureNoise
from archgen.emit.data.comparison_json import comparison_record
from archgen.products.compared_versions import make_comparison_input
from archgen.views.changes.comparison_document import ReadingErrors, describe_comparison
from archgen.views.changes.figure_lines import write_limit_lines, write_noise_line

PROJECT = """\
project: {id: p, title: P}
partners: {a: A, b: B, c: C}
types: {Rows: std_msgs/msg/Int32}
hosts: {pc: {cores: 1, scheduling: fixed_priority}}
groups:
  sense: {owner: a, components: {eye: {outputs: {rows: {type: Rows, promise: {max_gap: 130 ms}}}}}}
  act: {owner: b, components: {base: {inputs: {rows: eye.rows}}}}
  logging: {owner: c, components: {log: Log}}
nodes:
  eye: {implements: eye, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  base: {implements: base, host: pc, timing: {behaviour: event, wcet: 5 ms}}
  log: {implements: log, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
chains: {see: {through: [eye, base], deadline: 200 ms}}
"""
LOG = "log, host: pc, timing: {rate: 10 Hz, wcet: 5 ms"


def compare(folder: Path, *texts: str) -> Comparison:
    """Compare two one-file projects."""
    sides = []
    for number, text in enumerate(texts):
        file = folder / str(number) / "archgen.yaml"
        file.parent.mkdir()
        file.write_text(text, encoding="utf-8")
        sides.append(make_comparison_input(pipeline.check_project(file)))
    return compare_versions(*sides)


@pytest.mark.parametrize(
    ("noise", "time", "told"),
    [
        ("", "6 ms", ["2 figures moved by less than 2 % and changed no verdict; the most: largest gap of `sense.eye.rows`, by 0.9 %"]),
        ("review: {noise: 0.01 %}\n", "6 ms", []),
        ("review: {noise: 60 %}\n", "15 ms", ["4 figures moved by less than 60 % and changed no verdict; the most: age on arrival of `sense.eye.rows`, by 40 %"]),
    ],
)  # fmt: skip
def test_figures_that_hardly_moved_are_one_line(tmp_path: Path, noise: str, time: str, told: list[str]) -> None:
    before = noise + PROJECT
    comparison = compare(tmp_path, before, before.replace(LOG, LOG.replace("5 ms", time)))
    lines = [line.text for line in write_noise_line(FigureNoise(comparison))]
    assert lines == told
    document = describe_comparison(comparison, "a", "b")
    assert [line.text for line in document.boundary_lines if "moved by less" in line.text] == told
    assert bool(document.chain_rows) is not bool(told)
    record = json.loads(json.dumps(comparison_record(comparison, ReadingErrors())))
    schema = json.loads(resources.resource_path("schemas", "diff.schema.json").read_text(encoding="utf-8"))
    assert [error.message for error in jsonschema_rs.validator_for(schema).iter_errors(record)] == []
    assert bool(record["noise"]["count"]) is bool(told)


def test_what_moved_by_a_thousandth_is_no_change(tmp_path: Path) -> None:
    comparison = compare(tmp_path, PROJECT, PROJECT.replace(LOG, LOG.replace("5 ms", "5.1 ms")))
    assert (comparison.boundaries, comparison.chains) == ((), ())


def test_a_figure_that_breaks_something_is_no_noise(tmp_path: Path) -> None:
    before = PROJECT.replace(LOG, LOG.replace("5 ms", "19.9 ms"))
    comparison = compare(tmp_path, before, before.replace("19.9 ms", "20.2 ms"))
    (line,) = describe_comparison(comparison, "a", "b").boundary_lines[:1]
    assert line.text.startswith("`sense.eye.rows` from A to B: largest gap ")
    assert [change.element_id for change in comparison.changes if change.breaks] == ["logging.log"]


def test_readers_of_whom_the_same_holds_stand_in_one_line(tmp_path: Path) -> None:
    promised = PROJECT.replace("max_gap: 130 ms", "max_age: 10 ms").replace(
        LOG, LOG.replace("rate: 10 Hz", "behaviour: event")
    )
    promised = promised.replace("log: Log", "log: {inputs: {rows: eye.rows}}")
    lost = promised.replace("eye, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}", "eye, host: pc, timing: {rate: 10 Hz}")
    comparison = compare(tmp_path, promised, lost)
    (line,) = [line.text for line in write_limit_lines(comparison)]
    assert line == (
        "the promise of `sense.eye.rows` of no greater age than 10 ms was broken, and nobody knows it any more, where "
        "`act.base.rows` and `logging.log.rows` read it (15 ms → not known without figures of `eye`)"
    )


def test_what_is_kept_again_is_told(tmp_path: Path) -> None:
    broken = PROJECT.replace(LOG, LOG.replace("5 ms", "60 ms"))
    comparison = compare(tmp_path, broken, PROJECT)
    told = ["the promise of `sense.eye.rows` of gaps of at most 130 ms is kept again (170 ms → 115 ms)"]
    assert [line.text for line in write_limit_lines(comparison)] == told
    assert describe_comparison(comparison, "a", "b").boundary_lines[0].text == told[0]
    (limit,) = comparison_record(comparison, ReadingErrors())["limits"]
    assert (limit["element"], limit["key"], limit["was"], limit["is"]) == (
        "sense.eye.rows",
        "max_gap",
        "broken",
        "kept",
    )
