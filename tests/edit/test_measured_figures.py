"""Which measured times a slice gets, and how they are written: rounded to the safe side, never less than before."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from archgen import pipeline
from archgen.diagnostics.source_span import NO_SPAN
from archgen.edit.measured_slice import FigureSorter, collect_times, make_measured_slice
from archgen.model.quantity import Quantity
from archgen.timing.chains.measured_comparison import Observation
from tests.measured_project import PROJECT

OPEN = PROJECT.replace(", wcet: 5 ms", "")


def _observe(element: str, **figures: Fraction | int) -> Observation:
    return Observation(element, {key: Quantity(Fraction(value), "") for key, value in figures.items()}, NO_SPAN)


def _sort(folder: Path, data: dict[str, Any], *observations: Observation) -> FigureSorter:
    (folder / "archgen.yaml").write_text(OPEN, encoding="utf-8")
    sorter = FigureSorter(pipeline.check_project(folder), data)
    for times in collect_times(observations):
        list(sorter.add_times(times))
    return sorter


@pytest.mark.parametrize(
    ("ns", "longest", "shortest"),
    [
        (1, "1 us", "0 ms"),
        (999_999, "1 ms", "999 us"),
        (1_500_000, "1.5 ms", "1.5 ms"),
        (Fraction(4_000_000_001, 2), "2000.001 ms", "2000 ms"),
    ],
)
def test_the_longest_is_rounded_up_and_the_shortest_down(
    tmp_path: Path, ns: Fraction | int, longest: str, shortest: str
) -> None:
    data: dict[str, Any] = {}
    _sort(tmp_path, data, _observe("scan", wcet=ns, bcet=ns))
    assert data == {"nodes": {"scan": {"timing": {"wcet": {"max": longest, "measured": True}, "bcet": shortest}}}}


def test_several_observations_of_one_element_count_together(tmp_path: Path) -> None:
    data: dict[str, Any] = {}
    _sort(tmp_path, data, _observe("scan", wcet=5000, bcet=3000), _observe("scan", wcet=4000, bcet=2000))
    timing = data["nodes"]["scan"]["timing"]
    assert (timing["wcet"]["max"], timing["bcet"]) == ("5 us", "2 us")


def test_the_shortest_alone_is_adopted_alone(tmp_path: Path) -> None:
    data: dict[str, Any] = {}
    _sort(tmp_path, data, _observe("scan", bcet=3000))
    assert data == {"nodes": {"scan": {"timing": {"bcet": "3 us"}}}}


def test_a_part_of_two_nodes_of_several_components_has_no_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    twins = OPEN.replace("  maps:", "  maps2: {implements: [mapper, checker]}\n  maps:")
    monkeypatch.setitem(globals(), "OPEN", twins)
    data: dict[str, Any] = {}
    sorter = _sort(tmp_path, data, _observe("maps.checker", wcet=3000))
    assert data == {}
    assert [figure.element for figure in sorter.left_out] == ["maps.checker"]


def test_what_the_slice_holds_stays_unless_more_was_seen(tmp_path: Path) -> None:
    timing = {"wcet": "9 us", "bcet": "4 us", "priority": 5}
    data: dict[str, Any] = {"nodes": {"scan": {"timing": timing, "title": "Mine"}, "drive": {"title": "x"}}}
    _sort(tmp_path, data, _observe("scan", wcet=5000, bcet=5000))
    assert data == {
        "nodes": {
            "scan": {
                "timing": {"wcet": {"max": "9 us", "measured": True}, "bcet": "4 us", "priority": 5},
                "title": "Mine",
            },
            "drive": {"title": "x"},
        }
    }


def test_what_has_no_place_in_the_language_is_left_out(tmp_path: Path) -> None:
    data: dict[str, Any] = {}
    sorter = _sort(tmp_path, data, _observe("/odd", storing=5))
    assert data == {}
    assert [(figure.element, figure.why) for figure in sorter.left_out] == [
        (
            "/odd",
            "the language has no place for it: it is no input of a component, or several nodes share the component",
        )
    ]


def test_a_slice_that_would_be_an_error_says_so(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(OPEN, encoding="utf-8")
    (tmp_path / "measured.yaml").write_text("nodes: {scan: {timing: {wcet: 5 ms}, tiltle: x}}\n", encoding="utf-8")
    checked_project = pipeline.check_project(tmp_path)
    (tmp_path / "measured.yaml").write_text("nodes: {scan: {timing: {wcet: 5 ms}, tilttle: x}}\n", encoding="utf-8")
    measured_slice = make_measured_slice(checked_project, [_observe("scan", wcet=5000)], "measured.yaml")
    assert [error.message for error in measured_slice.errors] == ["a ROS node has no key `tilttle`"]


ARMS = """\
archgen: 1
component_types:
  motor: {inputs: {target: Goal}, outputs: {state: Goal}, timing: {rate: 10 Hz}, node: {package: arms, executable: motor}}
  slow_motor: {is: motor, timing: {wcet: 3 ms}}
  arm:
    inputs: {target: Goal}
    outputs: {state: {from: elbow.state}}
    components:
      elbow: {is: motor, inputs: {target: self.target}}
      hand: {is: slow_motor, inputs: {target: elbow.state}}
groups:
  body:
    components:
      left: {is: arm, inputs: {target: planner.goal}}
      right: {same_as: arm, inputs: {target: planner.goal}}
      planner: {inputs: {l: left.state, r: right.state}, outputs: {goal: Goal}}
types: {Goal: std_msgs/msg/String}
"""


def test_the_time_of_an_instance_s_leaf_is_written_below_its_group(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Below `nodes` it would make a node that implements nothing, in the type it would hold for all instances."""
    monkeypatch.setitem(globals(), "OPEN", ARMS)
    data: dict[str, Any] = {}
    _sort(tmp_path, data, _observe("left_elbow", wcet=5000))
    timing = {"wcet": {"max": "5 us", "measured": True}}
    assert data == {"groups": {"body": {"components": {"left.elbow": {"timing": timing}}}}}


def test_the_slice_changes_one_instance_and_can_be_written_again(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(f"{ARMS}sources: ['*.yaml']\n", encoding="utf-8")
    observations = [_observe("left_elbow", wcet=5000), _observe("right_elbow", wcet=4000)]
    measured_slice = make_measured_slice(pipeline.check_project(tmp_path), observations, "measured.yaml")
    assert measured_slice.errors == ()
    (tmp_path / "measured.yaml").write_text(measured_slice.text, encoding="utf-8")
    checked_project = pipeline.check_project(tmp_path)
    assert not checked_project.has_errors
    timings = {key: each.timing for key, each in checked_project.architecture.components.items() if each.timing}
    assert {key: str(timing.wcet) for key, timing in timings.items() if timing.wcet} == {
        "body.left.elbow": "5 us",
        "body.left.hand": "3 ms",
        "body.right.hand": "3 ms",
    }
    assert make_measured_slice(checked_project, observations, "measured.yaml").text == measured_slice.text


def test_what_a_type_has_written_is_proposed_for_the_instance(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(globals(), "OPEN", ARMS)
    sorter = _sort(tmp_path, {}, _observe("left_hand", wcet=5000))
    assert [(figure.why, figure.proposal) for figure in sorter.left_out] == [
        (
            "written already: 3 ms, in its type",
            "left.hand: {timing: {wcet: {max: 5 us, measured: true}}}, below `components` of `body`",
        )
    ]


def test_what_is_exactly_its_type_gets_no_time_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(globals(), "OPEN", ARMS)
    data: dict[str, Any] = {}
    sorter = _sort(tmp_path, data, _observe("right_elbow", wcet=5000))
    assert data == {}
    assert [figure.why for figure in sorter.left_out] == [
        "`body.right` is exactly its type (`same_as`): only the type can have it"
    ]
