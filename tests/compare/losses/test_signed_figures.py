"""What follows from figures is judged alike by an agreement and by a comparison.

Where a version is as signed and the next one is not, the comparison of the two breaks somebody: else the gate would let pass
what the contract refuses.
"""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare.compare_versions import compare_versions
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.separated_causes import VersionsWithout
from archgen.compare.match_elements import match_elements
from archgen.products.compared_versions import make_comparison_input
from archgen.timing.run_analysis import analyse_for_chains
from archgen.views.agreement.partner_agreement import make_agreement
from archgen.views.agreement.signed_terms import list_departures
from tests.agreeing import view
from tests.property_sizes import list_seeds

PROJECT = """\
project: {{id: p, title: P}}
partners: {{a: A, b: B, c: C}}
types: {{Rows: std_msgs/msg/Int32}}
review: {{breaking: {{wire: error, promise: error}}}}
hosts: {{pc: {{cores: {cores}}}, far: {{cores: 1}}}}
links: {{lan: {{connects: [pc, far], bandwidth: 100 Mbit/s, latency: {{best: 0.1 ms, worst: {latency}}}}}}}
groups:
  sense:
    owner: a
    components:
      eye: {{outputs: {{rows: {{type: Rows, promise: {{{promise}}}}}}}}}
      filter: {{inputs: {{rows: eye.rows}}, outputs: {{clean: {{type: Rows, promise: {{{clean}}}}}}}}}
  act:
    owner: b
    components:
      base: {{inputs: {{rows: {{from: eye.rows, freshness: {freshness}}}}}}}
      arm: {{inputs: {{clean: filter.clean}}}}
  logging: {{owner: c, components: {{log: Log{more}}}}}
nodes:
  eye: {{implements: eye, host: pc, {qos}timing: {{rate: {rate}, wcet: {eye}{priority}}}}}
  filter: {{implements: filter, host: pc, timing: {{behaviour: {behaviour}, wcet: {filter}}}}}
  base: {{implements: base, host: {host}, timing: {{rate: 20 Hz, wcet: 2 ms}}}}
  arm: {{implements: arm, host: pc, timing: {{behaviour: event, wcet: 2 ms}}}}
  log: {{implements: log, host: pc, timing: {{rate: 10 Hz{log}}}}}
{nodes}"""
FIGURES: dict[str, list[str]] = {
    "cores": ["1", "2"],
    "latency": ["1 ms", "30 ms"],
    "promise": [
        "max_gap: 130 ms",
        "max_gap: 115 ms, max_age: 140 ms",
        "rate: 10 Hz",
        "rate: 10 Hz, max_gap: 140 ms, max_age: 160 ms",
    ],
    "clean": ["max_gap: 150 ms", "max_gap: 125 ms", "max_age: 30 ms"],
    "freshness": ["150 ms", "120 ms", "200 ms"],
    "more": ["", ", stub: Stub"],
    "qos": ["", "publishes: {rows: {qos: {deadline: 130 ms}}}, "],
    "rate": ["10 Hz", "9.9 Hz", "12 Hz", "8 Hz"],
    "eye": ["1 ms", "5 ms", "20 ms"],
    "priority": ["", ", priority: 2"],
    "behaviour": ["event", "periodic, rate: 10 Hz"],
    "filter": ["1 ms", "10 ms"],
    "host": ["pc", "far"],
    "log": [", wcet: 1 ms", ", wcet: 5 ms", ", wcet: 25 ms", ", wcet: 60 ms", ", wcet: 120 ms", ""],
    "nodes": ["", "  stub: {implements: stub, host: pc, timing: {rate: 10 Hz, wcet: 40 ms}}\n"],
}
_LIMITS = ("promise", "clean", "freshness", "qos")


def _write(figures: dict[str, str]) -> str:
    nodes = figures["nodes"] if figures["more"] else ""
    return PROJECT.format(**{**figures, "nodes": nodes})


def _choose(random_source: random.Random) -> dict[str, str]:
    return {name: random_source.choice(values) for name, values in FIGURES.items()}


def _change(figures: dict[str, str], random_source: random.Random, count: int) -> dict[str, str]:
    """Change some figures; limits stay, for another one is no longer what was signed, and so does what is the reader's own:
    nobody breaks himself.
    """
    names = random_source.sample([name for name in FIGURES if name not in (*_LIMITS, "host")], count)
    return {**figures, **{name: random_source.choice(FIGURES[name]) for name in names}}


def _check(folder: Path, text: str) -> pipeline.CheckedProject:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return pipeline.check_project(folder / "archgen.yaml")


def _is_signed(signed: pipeline.CheckedProject, later: pipeline.CheckedProject) -> bool:
    changes = make_agreement(view(later), "a", "b", earlier_revision=("signed", view(signed))).changes
    assert changes is not None
    # More than was promised is not as signed either, and breaks nobody.
    return not any(
        "weaker: " in line or "Contradiction" in line or "Open promise" in line for line in list_departures(changes)
    )


@pytest.mark.parametrize("seed", list_seeds(8))
def test_what_is_no_longer_as_signed_breaks_somebody(seed: int, tmp_path: Path) -> None:
    random_source = random.Random(seed)  # noqa: S311 - a test's dice
    left = number = 0
    while left < 3:
        number += 1
        figures = _choose(random_source)
        later_figures = _change(figures, random_source, 2)
        texts = [_write(figures), _write(later_figures), _write(_change(later_figures, random_source, 3))]
        signed, base, head = (_check(tmp_path / f"{number}-{i}", text) for i, text in enumerate(texts))
        if _is_signed(signed, base) and not _is_signed(signed, head):
            left += 1
            comparison = compare_versions(make_comparison_input(base), make_comparison_input(head))
            assert comparison.is_refused, f"--- base\n{texts[1]}\n--- head\n{texts[2]}"


@pytest.mark.parametrize("seed", range(16))
def test_without_all_changes_figures_are_as_they_were(seed: int, tmp_path: Path) -> None:
    random_source = random.Random(seed)  # noqa: S311 - a test's dice
    figures = _choose(random_source)
    before = make_comparison_input(_check(tmp_path / "0", _write(figures)))
    after = make_comparison_input(_check(tmp_path / "1", _write(_change(figures, random_source, 4))))
    comparison = compare_versions(before, after)
    matched_ids = match_elements(before.architecture, after.architecture)
    context = ChangeContext(
        before.architecture, after.architecture, matched_ids, comparison.versions, comparison.changes
    )
    found = VersionsWithout(context).analyse(frozenset(range(len(comparison.changes))))
    assert found is not None, [(change.kind, change.element_kind, change.key) for change in comparison.changes]
    _, analysis = found
    expected = analyse_for_chains(before.architecture)
    assert analysis.paces == expected.paces
    assert analysis.responses == expected.responses
    assert analysis.outputs == expected.outputs
