"""What is missed, not proven and open reads and looks different, and hosts are named once each."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.diagnostics.diagnostic import Diagnostic
from archgen.emit.graphviz.chart_layout import STRETCH_FORMS
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.shapes import Bullets, Inlines, Paragraph
from archgen.views.timing import chain_charts, element_timing, load_charts, timing_tables, timing_verdicts
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.property_sizes import try_some

_FIVE = """\
groups:
  g:
    components:
      a: {outputs: {o: std_msgs/msg/Empty}}
      b: {inputs: {i: a.o}, outputs: {o: std_msgs/msg/Empty}}
      c: {inputs: {i: b.o}}
nodes:
  a: {implements: a, host: pc, timing: {period: 100 ms, COSTS}}
  b: {implements: b, host: pc, timing: {COSTS}}
  c: {implements: c, host: pc, timing: {COSTS}}
hosts: {pc: {title: Computer, CORES, scheduling: round_robin}}
chains: {c: {through: [g.a, g.b, g.c], deadline: LIMIT}}
"""


def _view(folder: Path, costs: str, cores: str, limit: str) -> tuple[Lookup, tuple[Diagnostic, ...]]:
    file = folder / "robot.yaml"
    file.write_text(_FIVE.replace("COSTS", costs).replace("CORES", cores).replace("LIMIT", limit), encoding="utf-8")
    checked = pipeline.check_project(file)
    return make_lookup(checked.architecture, timing_lookup=analyse_with_chains(checked.architecture)), checked.findings


@pytest.mark.parametrize(
    ("figures", "verdict", "kind"),
    try_some(
        [
            (
                ("wcet: 1 ms, bcet: 1 ms", "cores: 1", "200 ms"),
                "Met: at the latest after 103 ms, 97 ms before the deadline of 200 ms.",
                "met",
            ),
            (
                ("wcet: 1 ms, bcet: 1 ms", "cores: 1", "100 ms"),
                "Missed. In a simulated run it took 103 ms, 3 ms longer than its deadline of 100 ms allows; it never takes more than 103 ms.",
                "missed",
            ),
            (
                ("wcet: 1 ms, bcet: 1 ms", "cores: 1", "2 ms"),
                "Missed. It takes at least 3 ms, 1 ms longer than its deadline of 2 ms allows.",
                "missed",
            ),
            (
                ("wcet: 40 ms, bcet: 40 ms", "cores: 1", "1 s"),
                "Missed. It may take any time, whatever its deadline: more is to be done on pc than can be.",
                None,
            ),
            (
                ("wcet: 20 ms, bcet: 20 ms, jitter: 1 us", "cores: 1", "1 s"),
                "Not proven. Nothing says whether it meets its deadline of 1000 ms: no bound was found on pc at a load of 60 % (in any order).",
                "unproven",
            ),
            (
                ("wcet: 1 ms, bcet: 1 ms", "tags: []", "200 ms"),
                "Open: >= 103 ms; no bound: cores of pc not written.",
                "open",
            ),
        ],
        3,
    ),
)
def test_a_verdict_is_in_words_and_in_a_colour_of_its_own(
    tmp_path: Path, figures: tuple[str, str, str], verdict: str, kind: str | None
) -> None:
    view, _ = _view(tmp_path, *figures)
    assert view.timing is not None
    (result,) = view.timing.chains
    assert chain_charts.describe_chain_verdict(result, view.timing) == verdict
    bound_bar = chain_charts.make_chain_chart(view, view.timing, result).bars[-2]
    assert [segment.kind for segment in bound_bar.segments if segment.length is not None] == ([kind] if kind else [])
    assert len({STRETCH_FORMS[form][1] for form in ("met", "missed", "unproven", "open")}) == 4


def _text(value: Inlines) -> str:
    return "".join(part.text for part in value)


def test_where_no_bound_was_found_each_host_is_one_line(tmp_path: Path) -> None:
    view, _ = _view(tmp_path, "wcet: 20 ms, bcet: 20 ms, jitter: 1 us", "cores: 1", "1 s")
    assert view.timing is not None
    lead, bullets = timing_verdicts.list_unfound_bounds(view, view.timing)
    assert isinstance(lead, Paragraph)
    assert isinstance(bullets, Bullets)
    assert [_text(item) for item in bullets.items] == ["Computer at a load of 60 %: a, b, c"]


def test_without_a_number_of_cores_there_is_no_share_and_no_chart(tmp_path: Path) -> None:
    view, findings = _view(tmp_path, "wcet: 90 ms, bcet: 90 ms", "tags: []", "1 s")
    assert view.timing is not None
    table = timing_tables.make_load_table(view, view.timing)
    assert table is not None
    assert [_text(cell) for cell in table.rows[0][:3]] == ["Computer", "not written", "unknown"]
    assert list(load_charts.make_load_charts(view, view.timing)) == []
    assert element_timing.make_load_blocks(view, "pc") == ()
    assert not [finding for finding in findings if finding.rule in {"overloaded-host", "late-chain"}]
