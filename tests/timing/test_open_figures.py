"""What is not known, on its way through loops, promises and links of which only half is written."""

from __future__ import annotations

from pathlib import Path

import archgen
from archgen.emit.data import timing_json
from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.figures.timing_values import UNBOUNDED_VALUE, TimingValue, add_values, smallest_value
from tests.timing.made import missing, ms

_LOOP = """
groups: {g: {components: {
  a: {outputs: {o: A}, timing: {rate: 30 Hz, wcet: 1 ms, priority: 1}},
  b: {inputs: {i: c.o, j: c.u}, outputs: {o: A}, timing: {behaviour: event, wcet: 1 ms, priority: 2}},
  c: {outputs: {o: A, u: A}, timing: {period: 60 ms, wcet: 1 ms, priority: 1}},
  d: {inputs: {i: a.o, j: [c.u, a.o]}, outputs: {o: A}, timing: {trigger: all, wcet: 1 ms, priority: 2}}}}}
nodes: {na: {implements: a, host: p}, nb: {implements: b, host: p}, nc: {implements: c, host: q}, nd: {implements: d, host: q}}
types: {A: std_msgs/msg/Header}
hosts: {p: {cores: 1}, q: {cores: 1}}
"""
_PROMISE = """
groups: {g: {components: {
  a: {outputs: {o: A}, timing: {period: 2 s, wcet: 1 ms, bcet: 1 ms, outputs: {o: {conditional: true, max_gap: 1 s}}}},
  b: {inputs: {i: a.o}, outputs: {o: A}, timing: {behaviour: event, wcet: 1 ms}}}}}
types: {A: std_msgs/msg/Header}
"""
_HALF = """
groups: {g: {components: {
  a: {outputs: {o: A}, timing: {period: 10 ms, wcet: 1 ms, bcet: 1 ms}},
  b: {inputs: {i: a.o}, outputs: {o: A}, timing: {behaviour: event, every: 2, wcet: 1 ms, bcet: 1 ms}}}}}
nodes: {na: {implements: a, host: p}, nb: {implements: b, host: q}}
types: {A: std_msgs/msg/Header}
hosts: {p: {cores: 1}, q: {cores: 1}}
links: {lan: {connects: [p, q], latency: {worst: 3 ms}}}
chains: {c: {through: [a, b]}}
"""


def _of(folder: Path, text: str) -> tuple[Analysis, dict[str, object]]:
    (folder / "archgen.yaml").write_text(f"archgen: 1\nproject: {{id: p, title: P}}\n{text}", encoding="utf-8")
    project = archgen.load(folder)
    analysis = project.timing()
    return analysis, timing_json.timing_to_json(analysis, bound_all_chains(analysis, project.architecture))


def test_what_is_missing_is_named_however_far_round_a_loop(tmp_path: Path) -> None:
    """Both hosts wait for a link that nobody wrote, each through the other: that is missing, and nothing diverges."""
    analysis, _ = _of(tmp_path, _LOOP)
    worst = analysis.responses["na"].worst
    assert not analysis.diverged
    assert not worst.complete
    assert worst.missing


def test_a_promise_below_the_period_is_not_believed(tmp_path: Path) -> None:
    """What works every 2 s cannot publish each second."""
    _, found = _of(tmp_path, _PROMISE)
    assert found["elements"]["b"]["gap"]["value"] == 2000.0  # type: ignore[index]


def test_a_best_latency_that_nobody_wrote_counts_as_none(tmp_path: Path) -> None:
    """F = 10 + 1 + 3 + one more gap of (10 + 3) + 1."""
    _, found = _of(tmp_path, _HALF)
    bound = found["chains"]["c"]["bound"]  # type: ignore[index]
    assert (bound["value"], bound["complete"]) == (28.0, True)


def test_the_smallest_of_what_is_half_known_is_no_more_than_each() -> None:
    """A bound from below of one says nothing while another is unknown; what grows beyond any bound is no smallest."""
    partial = TimingValue(ms(100).value, complete=False, missing=("x",), side="at least")
    assert smallest_value((partial, missing("y"))).value is None
    assert smallest_value((partial, UNBOUNDED_VALUE)) == partial
    assert smallest_value((partial, ms(200))) == ms(200)


def test_what_is_unbounded_stays_so_beside_what_is_missing() -> None:
    """It is above any sum, and what is missing stays named."""
    both = TimingValue(None, complete=False, missing=("x",), assumptions=("unbounded",))
    assert add_values((ms(1), both)) == both


def test_the_json_says_on_which_side_a_figure_holds() -> None:
    """Only where something is missing."""
    partial = TimingValue(ms(1).value, complete=False, missing=("x",), side="at least")
    upper = TimingValue(ms(1).value, complete=False, missing=("x",), side="at most")
    assert timing_json.duration_to_json(partial)["side"] == "at least"
    assert timing_json.duration_to_json(upper)["side"] == "at most"
    assert "side" not in timing_json.duration_to_json(ms(1))
    assert "side" not in timing_json.duration_to_json(missing("x"))


def test_a_chain_with_a_wrong_name_is_open_and_not_late(tmp_path: Path) -> None:
    """The rule and the table say the same of it."""
    wrong = _HALF.replace("through: [a, b]", "through: [a, b, zz], deadline: 1 ms")
    _, found = _of(tmp_path, wrong)
    assert found["chains"]["c"]["verdict"] == "open"  # type: ignore[index]
    assert not [one for one in archgen.load(tmp_path).findings if one.rule == "late-chain"]
