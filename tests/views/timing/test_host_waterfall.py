"""Where the time of a host goes, and what is left of all deadlines."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.shapes import Inlines, Table
from archgen.views.timing.host_waterfall import make_host_waterfall, make_slack_waterfall
from archgen.views.timing.timing_lookup import analyse_with_chains

ROBOT = """\
partners: {{p: {{title: Partner P}}, q: {{title: Partner Q}}}}
hosts: {{pc: {{title: Base, cores: 2}}}}
groups:
  g:
    components:
      eye: {{owner: p, outputs: {{o: std_msgs/msg/Bool}}}}
      brain: {{owner: q, inputs: {{i: eye.o}}, outputs: {{o: std_msgs/msg/Bool}}}}
nodes:
  eye: {{implements: eye, host: pc, timing: {{period: 100 ms, wcet: 20 ms, bcet: 5 ms}}}}
  brain: {{implements: brain, host: pc, timing: {{period: 100 ms{wcet}, bcet: 1 ms}}}}
chains:
  late: {{title: Late, through: [eye, brain], deadline: 50 ms}}
  calm: {{title: Calm, through: [eye, brain], deadline: 10 s}}
  free: {{title: Free, through: [eye, brain]}}
"""


def look_up(folder: Path, wcet: str = ", wcet: 60 ms") -> Lookup:
    file = folder / "robot.yaml"
    file.write_text(ROBOT.format(wcet=wcet), encoding="utf-8")
    checked = check_project(file)
    assert not checked.structural_errors, checked.structural_errors
    return make_lookup(checked.architecture, checked.findings, timing_lookup=analyse_with_chains(checked.architecture))


def read(cell: Inlines) -> str:
    return "".join(run.text for run in cell)


def test_the_largest_node_comes_first_and_the_next_begins_where_it_ends(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert lookup.timing is not None
    waterfall = make_host_waterfall(lookup, lookup.timing, "pc")
    assert waterfall is not None
    assert [(step.title.text, read(step.note), step.words) for step in waterfall.steps] == [
        ("brain", "Partner Q", "30 %"),
        ("eye", "Partner P", "10 %"),
    ]
    spans = [(piece.start, piece.end) for step in waterfall.steps for piece in step.pieces]
    assert spans == [pytest.approx((0, 0.75)), pytest.approx((0.75, 1))]
    assert [(figure.title, figure.value) for figure in waterfall.figures] == [
        ("Load", "40 %"),
        ("Left until all cores are busy", "60 %"),
        ("Cores", "2"),
    ]
    (table,) = waterfall.cards[0].blocks
    assert isinstance(table, Table)
    assert [read(row[0]) + read(row[3]) for row in table.rows] == ["Partner Q30 %", "Partner P10 %"]


def test_a_load_that_nobody_knows_is_hatched_and_what_is_left_is_at_most_the_rest(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, wcet="")
    assert lookup.timing is not None
    waterfall = make_host_waterfall(lookup, lookup.timing, "pc")
    assert waterfall is not None
    assert waterfall.total[-1].kind == "unknown"
    assert waterfall.steps[-1].pieces[-1].kind == "unknown"
    assert waterfall.figures[1].value == "<= 90 %"


def test_a_host_of_which_only_foreign_load_is_known_has_no_waterfall(tmp_path: Path) -> None:
    fair = "cores: 2, scheduling: {fair: {slice: 3 ms, tick: 1 ms, lead: 5, other_load: 10 %}}"
    file = tmp_path / "robot.yaml"
    file.write_text(
        f"groups: {{g: {{components: {{eye: Eye}}}}}}\nhosts: {{pc: {{{fair}}}}}\nnodes: {{eye: {{host: pc, timing: {{rate: 5 Hz}}}}}}\n"
    )
    architecture = check_project(file).architecture
    lookup = make_lookup(architecture, timing_lookup=analyse_with_chains(architecture))
    assert lookup.timing is not None
    assert lookup.timing.analysis.hosts["pc"].utilisation.value
    assert make_host_waterfall(lookup, lookup.timing, "pc") is None


def test_chains_stand_on_one_scale_the_worst_first_and_without_a_deadline_nowhere(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert lookup.timing is not None
    waterfall = make_slack_waterfall(lookup, lookup.timing)
    assert waterfall is not None
    assert [step.title.text for step in waterfall.steps] == ["Late", "Calm"]
    # Twice the deadline is where the scale ends.
    assert waterfall.limits == (None, 0.5)
    late, calm = waterfall.steps
    assert late.pieces[-1].end == pytest.approx(1)
    assert late.pieces[-1].is_cut
    assert calm.pieces[-1].end < 0.1
    assert waterfall.remark == "What takes more than 200 % of its deadline is drawn short."


def test_a_chain_without_a_bound_is_not_left_out(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, wcet=", wcet: 1 s")
    assert lookup.timing is not None
    waterfall = make_slack_waterfall(lookup, lookup.timing)
    assert waterfall is not None
    assert [(step.title.text, step.words) for step in waterfall.steps] == [
        ("Late", "no bound: the host is overloaded; deadline 50 ms"),
        ("Calm", "no bound: the host is overloaded; deadline 10 s"),
    ]
    assert all(step.pieces[-1].kind == "unknown" for step in waterfall.steps if step.title.text == "Calm")
