"""What is said of changed figures: at each interface between partners, and of the loads of hosts and links."""

from __future__ import annotations

import itertools
import json

import jsonschema_rs
import pytest

from archgen import resources
from archgen.compare.comparison import BoundaryChange
from archgen.emit.data.comparison_json import comparison_record
from archgen.views.agreement.partner_agreement import make_agreement
from archgen.views.changes.boundary_lines import write_boundary_lines
from archgen.views.changes.comparison_document import ReadingErrors, describe_comparison
from archgen.views.changes.figure_lines import write_load_lines
from archgen.views.changes.named_elements import name_partners
from archgen.views.lookup import Lookup
from tests.agreeing import view
from tests.compare.conftest import Compared, JudgeText
from tests.compare.test_whom_a_change_concerns import CASES, HARVESTER
from tests.property_sizes import try_some

PERSONS = "`sensing.detector.persons` from Vega to Kite and Orsa"
ROWS = "`sensing.finder.rows` from Vega to Orsa"
SPEED = "`navigation.limiter.speed` from Orsa to Kite"
POSE = "`navigation.ekf.pose` from Orsa to Palma"
TOLD = {
    "a rate is halved": [
        f"{SPEED}: rate 10 Hz → 5 Hz; largest gap ~134 ms → ~234 ms",
        f"{PERSONS}, {ROWS}: rate 10 Hz → 5 Hz; largest gap 130 ms → 230 ms",
        "host `front`: 12.5 % → 6.3 % of its cores; used by Vega",
    ],
    "a producer is given to its reader": [
        "`sensing.detector.persons` from Kite (before: Vega) to Orsa",
        "`sensing.detector.persons` from Vega to Kite: no longer",
        "`sensing.lidar.scan` from Vega to Kite: rate 10 Hz; largest gap 115 ms; size 10 kB",
    ],
    "a node is moved to a host of others": [
        f"{POSE}: largest gap 23.5 ms → 25 ms; travels from `rear` to `arm` over `lan` → within `rear`",
        "host `arm`: 10.5 % → 0.5 % of its cores; used by Palma",
        "host `rear`: 6.1 % → 11.1 % of its cores; used by Kite, Orsa and Palma",
    ],
    "an output comes only now and then": [
        f"{SPEED}, {PERSONS}: rate 10 Hz → <= 10 Hz",
        f"no bound any more: largest gap of {SPEED}, {PERSONS}",
    ],
    "a reader asks for what is not offered": [f"{ROWS}: QoS asked best effort → reliable"],
    "a message is larger": [
        f"{POSE}: largest gap 23.5 ms → 24 ms; age on arrival ~3.83 ms → ~84.2 ms",
        f"{SPEED}: largest gap ~134 ms → ~214 ms",
        f"{PERSONS}: size 1 kB → 500 kB; traffic 10 kB/s → 5 MB/s; age on arrival ~15.4 ms → ~95.2 ms",
        f"{ROWS}: age on arrival ~15.4 ms → ~95.2 ms",
        "link `lan`: 0.3 % → 80.2 % of its bandwidth; used by Kite, Orsa, Palma and Vega",
    ],
    "a component is renamed, and the readers' files with it": [],
    "a title": [],
    "a rate that nobody else reads": [],
}


@pytest.mark.parametrize("name", TOLD)
def test_what_is_told(compared: Compared, name: str) -> None:
    comparison = compared(HARVESTER, _edit(name))
    names = name_partners(comparison)
    lines = (*write_boundary_lines(comparison, names), *write_load_lines(comparison, names))
    assert [line.text for line in lines] == TOLD[name]


def test_a_host_whose_cores_nobody_counted_has_no_share(compared: Compared) -> None:
    before, after = (
        text.replace("front: {cores: 2, scheduling: fixed_priority}", "front: {scheduling: fixed_priority}")
        for text in (HARVESTER, _edit("a rate is halved"))
    )
    assert after not in {before, _edit("a rate is halved")}
    comparison = compared(before, after)
    assert write_load_lines(comparison, name_partners(comparison)) == ()


DETECTOR_TIMING = "detector: {timing: {trigger: [scan], wcet: 10 ms}"


@pytest.mark.parametrize(
    ("edits", "told"),
    [
        # The same of several interfaces stands once; what is unknown for one reason, too.
        (
            [(DETECTOR_TIMING, "detector: {timing: {trigger: [scan]}")],
            [f"no figures any more: largest gap and age on arrival of {POSE}, {SPEED}, {PERSONS}, {ROWS}"],
        ),
        # What only comes sooner is one line.
        (
            [("lidar: {timing: {rate: 10 Hz, wcet: 5 ms}", "lidar: {timing: {rate: 10 Hz, wcet: 1 ms}")],
            [f"sooner by up to 8 ms: largest gap of {SPEED}, {PERSONS}, {ROWS}"],
        ),
        # A new output is a change of its own, with its reader; so is one that is gone.
        (
            [("outputs: {speed: Speed}", "outputs: {speed: Speed, steer: Speed}"), ("speed: limiter.speed}", "speed: limiter.speed, steer: limiter.steer}")],
            ["`navigation.limiter.steer` from Orsa to Kite: rate 10 Hz"],
        ),
        ([(", outputs: {speed: Speed}", ""), (", speed: limiter.speed", "")], []),
        # An output that took the place of another one, with what programs meet.
        (
            [("limiter: {", "governor: {title: Keeps people safe, "), ("limiter.speed", "governor.pace"), ("outputs: {speed: Speed}", "outputs: {pace: Speed}"), ("limiter_node: {implements: limiter", "governor_node: {implements: governor, publishes: {pace: /pace}")],
            ["`navigation.governor.pace` (was `navigation.limiter.speed`) from Orsa to Kite: topic `/navigation/limiter/speed` → `/pace`"],
        ),
        # The reader's deadline stands beside the gap that does not keep it.
        (
            [("rate: 10 Hz", "rate: 5 Hz"), ("supervisor_node: {", "supervisor_node: {subscribes: {speed: {qos: {deadline: 200 ms}}}, ")],
            [
                f"{SPEED}: rate 10 Hz → 5 Hz; largest gap ~134 ms → ~234 ms, over the deadline of 200 ms asked for; QoS asked none → deadline 200 ms",
                f"{PERSONS}, {ROWS}: rate 10 Hz → 5 Hz; largest gap 130 ms → 230 ms",
            ],
        ),
    ],
)  # fmt: skip
def test_what_follows_from_one_cause_is_told_once(
    compared: Compared, edits: list[tuple[str, str]], told: list[str]
) -> None:
    after = HARVESTER
    for old, new in edits:
        assert old in after, old
        after = after.replace(old, new)
    comparison = compared(HARVESTER, after)
    lines = [line.text for line in write_boundary_lines(comparison, name_partners(comparison))]
    assert lines == told


@pytest.mark.parametrize("name", try_some(CASES, 12))
def test_json_has_all_of_it(compared: Compared, name: str) -> None:
    schema = json.loads(resources.resource_path("schemas", "diff.schema.json").read_text(encoding="utf-8"))
    comparison = compared(HARVESTER, _edit(name))
    record = json.loads(json.dumps(comparison_record(comparison, ReadingErrors())))
    assert [error.message for error in jsonschema_rs.validator_for(schema).iter_errors(record)] == []
    assert len(record["boundaries"]) == len(comparison.boundaries)


def _edit(name: str) -> str:
    text = HARVESTER
    for old, new in CASES[name][0]:
        text = text.replace(old, new)
    return text


@pytest.fixture(scope="module")
def harvester(judge_text: JudgeText) -> Lookup:
    """Look things up in the robot without an edit."""
    return view(judge_text(HARVESTER))


@pytest.mark.parametrize("name", try_some(CASES, 12))
def test_what_an_agreement_shows_as_another_figure_is_told(
    judge_text: JudgeText, harvester: Lookup, compared: Compared, name: str
) -> None:
    lookups = [harvester, view(judge_text(_edit(name)))]
    comparison = compared(HARVESTER, _edit(name))
    told = {(change.interface_id, pair) for change in comparison.boundaries for pair in _pairs(change)}
    for pair in itertools.combinations(("kite", "orsa", "palma", "vega"), 2):
        changes = make_agreement(lookups[1], *pair, earlier_revision=("a", lookups[0])).changes
        for (interface, (giver, taker)), change in changes.changes_by_key.items() if changes else ():
            terms = [term.name for term in change.terms if term.name.startswith(_FIGURE_TERMS)]
            assert not terms or (interface, (giver, taker)) in told, (interface, terms)


_FIGURE_TERMS = ("Rate", "Largest gap", "Size", "Traffic", "QoS")


def _pairs(change: BoundaryChange) -> set[tuple[str, str]]:
    return {(giver, taker) for giver in change.givers for taker in change.takers}


def test_what_an_error_hides_is_not_called_gone(compared: Compared) -> None:
    unknown_owner = HARVESTER.replace("owner: vega", "owner: nobody").replace("rate: 50 Hz", "rate: 25 Hz")
    changes = compared(HARVESTER, unknown_owner).boundaries
    assert {(change.kind, change.interface_id) for change in changes} == {("changed", "navigation.ekf.pose")}


def test_two_partners_with_one_title_are_told_apart(compared: Compared) -> None:
    twins = HARVESTER.replace("kite: Kite", "kite: Vega")
    comparison = compared(twins, twins.replace("rate: 10 Hz", "rate: 5 Hz"))
    document = describe_comparison(comparison, "a", "b")
    assert document.concerned_partners == ("Vega (`kite`)", "Orsa", "Vega (`vega`)")
    assert document.summary.endswith("; concerns Vega (`kite`), Orsa, Vega (`vega`); no change breaks another partner")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (
            "  sensing:\n    owner: vega",
            "  sensing:\n    owner: kite",
            "group `sensing` belongs to Kite now, not to Vega; read by `navigation.ekf.rows`, `navigation.limiter.persons` and `supervision.supervisor.persons`",
        ),
        ("driver: {", "driver: {owner: kite, ", "`manipulation.driver` belongs to Kite now, not to Palma"),
        (
            "ekf_node: {",
            "ekf_node: {owner: kite, ",
            "node `ekf_node` belongs to Kite now, not to Orsa; read by `manipulation.planner.pose` and `navigation.limiter.pose`",
        ),
        ("    owner: kite\n", "", "group `supervision` belongs to nobody now, not to Kite"),
    ],
)
def test_what_changes_hands_is_told_with_its_readers(compared: Compared, old: str, new: str, told: str) -> None:
    assert told in [change.text for change in compared(HARVESTER, HARVESTER.replace(old, new)).changes]
