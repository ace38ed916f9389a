"""What outputs promise in agreements, beside what follows: for each reader the words of the port that it names."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.partner_interfaces import find_interfaces_between
from archgen.model.quantity import parse_quantity
from archgen.timing.chains.measured_comparison import Observation
from archgen.views.agreement.output_promises import list_counted_ports
from archgen.views.agreement.partner_agreement import make_agreement
from archgen.views.agreement.signed_terms import has_departures
from archgen.views.lookup import Lookup
from archgen.views.shapes import Facts, Table
from tests.agreeing import checked, section, text, view

ROBOT = """\
archgen: 1
ros: {distro: jazzy}
partners: {a: Alpha, b: Beta}
groups:
  sense:
    owner: a
    components:
      eye: {outputs: {rows: {type: Rows, promise: {rate: 10 Hz, max_gap: 150 ms, max_age: 300 ms, unit: m, frame: base, range: [0, 30]}, version: 2, deprecated: {until: 2999-06-01, use: new}}, new: Rows}}
      head:
        outputs: {kept: {from: lens.heads}, slow: {from: lens.heads, promise: {rate: 5 Hz}}}
        components: {lens: {outputs: {heads: {type: Rows, promise: {rate: 20 Hz, unit: cm}}}}}
  drive:
    owner: b
    components:
      plan: {inputs: {rows: {from: eye.rows, freshness: 100 ms}, heads: head.kept}}
      reach: {inputs: {slow: head.slow}}
types: {Rows: std_msgs/msg/Bool}
nodes:
  eye: {implements: eye, timing: {period: 200 ms, wcet: 4 ms}}
  lens: {implements: lens, timing: {period: 50 ms, wcet: 4 ms}}
  plan: {implements: plan, timing: {period: 20 ms, wcet: 4 ms}}
"""


def _section(folder: Path, title: str, source: str = ROBOT) -> tuple[dict[str, str], dict[str, tuple[str, str]]]:
    blocks = section(make_agreement(view(checked(folder, source)), "a", "b").outline, title).blocks
    facts = next(block for block in blocks if isinstance(block, Facts))
    table = next(block for block in blocks if isinstance(block, Table) and block.columns[0].title == "Term")
    rows = {text(name): (text(promised), text(expected)) for name, promised, expected in table.rows}
    return {name: text(value) for name, value in facts.rows}, rows


def test_what_is_promised_stands_beside_what_follows(tmp_path: Path) -> None:
    facts, rows = _section(tmp_path, "Eye · rows")
    assert facts["Version by its owner"] == "2"
    assert facts["Deprecated"] == "until 2999-06-01, use new instead"
    assert rows["Rate"] == ("at least 10 Hz", "5 Hz · 200 ms, follows from the timing that is written")
    assert rows["Largest gap"][0] == "at most 150 ms"
    assert rows["Greatest age"] == ("no older than 300 ms", "204 ms, follows from how often it is sent and read")
    assert (rows["Range of values"][0], rows["Frame"][0]) == ("0 to 30 m", "base")
    assert "Unit" not in rows
    assert facts["Open points"].split("\n")[1:] == [
        "eye.rows promises 10 Hz: 5 Hz follows from the timing.",
        "eye.rows promises gaps of at most 150 ms: it may be 204 ms between two messages.",
        "plan.rows needs what is no older than 100 ms: it may be 204 ms old when it is read.",
        "plan.rows needs what is no older than 100 ms, and 300 ms is promised.",
    ]


def test_readers_of_different_ports_see_different_figures(tmp_path: Path) -> None:
    _, rows = _section(tmp_path, "Head · Lens · heads")
    assert rows["Rate"][0].split("\n") == ["at least 20 Hz for plan.heads", "at least 5 Hz for reach.slow"]
    assert rows["Unit"][0] == "cm for plan.heads, reach.slow"
    outline = make_agreement(view(checked(tmp_path, ROBOT)), "a", "b").outline
    table = next(block for block in section(outline, "At a glance").blocks if isinstance(block, Table))
    assert "at least 20 Hz for plan.heads, at least 5 Hz for reach.slow\npromised" in [
        text(row[3]) for row in table.rows
    ]


def _lookup(folder: Path, source: str) -> Lookup:
    return view(checked(folder, source))


@pytest.mark.parametrize(
    ("old", "new", "weaker"),
    [
        ("rate: 10 Hz", "rate: 5 Hz", ["Rate (promised)"]),
        ("rate: 10 Hz", "rate: 11 Hz", []),
        ("max_age: 300 ms, ", "", ["Greatest age (promised)"]),
        ("rate: 5 Hz", "rate: 4 Hz", ["Rate (promised)"]),
        ("rate: 20 Hz", "rate: 19 Hz", []),
        ("range: [0, 30]", "range: [0, 31]", ["Range of values (promised)"]),
        ("range: [0, 30]", "range: [1, 29]", []),
    ],
)
def test_a_signed_promise_that_is_weakened_is_told(tmp_path: Path, old: str, new: str, weaker: list[str]) -> None:
    before, after = _lookup(tmp_path / "1", ROBOT), _lookup(tmp_path / "2", ROBOT.replace(old, new, 1))
    changes = make_agreement(after, "a", "b", earlier_revision=("v1", before)).changes
    assert changes
    terms = [term for change in changes.changes_by_key.values() for term in change.terms]
    assert [term.name for term in terms if term.is_weaker] == weaker
    assert changes.earlier_versions != changes.later_versions


def test_nothing_is_counted_on_where_a_topic_has_no_output(tmp_path: Path) -> None:
    lookup = _lookup(tmp_path, ROBOT.replace("rows: {from: eye.rows, freshness: 100 ms}, ", ""))
    counted = [list_counted_ports(lookup, each) for each in find_interfaces_between(lookup.architecture, "a", "b")]
    assert [[port.port.id for port in ports] for ports in counted] == [["sense.head.kept", "sense.head.slow"]]


def _observation(name: str, **figures: str) -> Observation:
    dimensions = {"rate": "frequency"}
    quantities = {key: parse_quantity(value, dimensions.get(key, "duration")) for key, value in figures.items()}
    return Observation(name, {key: value for key, value in quantities.items() if value}, NO_SPAN)


@pytest.mark.parametrize(
    ("observation", "measured"),
    [
        (
            _observation("/sense/eye/rows", rate="4.9 Hz", max_period="120 ms", delay="2 ms"),
            {
                "Rate": ("4.9 Hz, worse than promised", True),
                "Largest gap": ("120 ms", False),
                "Greatest age": ("2 ms on arrival", False),
            },
        ),
        (_observation("eye", period="50 ms"), {"Rate": ("20 Hz", False)}),
        (_observation("lens", rate="1 Hz"), {}),
    ],
)
def test_what_was_measured_stands_beside_it_and_is_marked_where_it_is_worse(
    tmp_path: Path, observation: Observation, measured: dict[str, tuple[str, bool]]
) -> None:
    outline = make_agreement(view(checked(tmp_path, ROBOT)), "a", "b", observations=[observation]).outline
    blocks = section(outline, "Eye · rows").blocks
    table = next(block for block in blocks if isinstance(block, Table) and block.columns[0].title == "Term")
    assert [column.title for column in table.columns][3:] == (["Measured"] if measured else [])
    cells = {text(row[0]): row[3] for row in table.rows if len(row) > 3 and row[3]}
    assert {name: (text(cell), cell[0].status == "missed") for name, cell in cells.items()} == measured


KEPT = """\
project: {id: p, title: P}
partners: {a: A, b: B}
types: {Rows: std_msgs/msg/Int32}
hosts: {pc: {cores: 1, scheduling: fixed_priority}}
groups:
  sense: {owner: a, components: {eye: {outputs: {rows: {type: Rows, promise: {max_gap: 130 ms}}}}, log: Log}}
  act: {owner: b, components: {base: {inputs: {rows: {from: eye.rows, freshness: 100 ms}}}}}
nodes:
  eye: {implements: eye, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}, publishes: {rows: {qos: {deadline: 130 ms}}}}
  base: {implements: base, host: pc, timing: {behaviour: event, wcet: 5 ms}}
  log: {implements: log, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
"""
LOG = "log, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}"
UNKNOWN = "nobody knows it without figures of log."


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        # What a figure was taken from is no longer shown to be kept: no more as signed than what is broken.
        (
            LOG,
            LOG.replace(", wcet: 5 ms", ""),
            [
                f"The QoS deadline of 130 ms that eye promises may not be kept: {UNKNOWN}",
                f"base.rows needs what is no older than 100 ms: {UNKNOWN}",
                f"eye.rows promises gaps of at most 130 ms: {UNKNOWN}",
            ],
        ),
        (
            LOG,
            LOG.replace("5 ms", "80 ms"),
            [
                "The QoS deadline of 130 ms that eye promises may not be kept: up to 190 ms is expected.",
                "eye.rows promises gaps of at most 130 ms: it may be 190 ms between two messages.",
            ],
        ),
        # That is how people begin.
        ("log: Log}", "log: Log, stub: Stub}", []),
    ],
)
def test_what_was_kept_when_it_was_signed_has_to_be(tmp_path: Path, old: str, new: str, told: list[str]) -> None:
    later = KEPT.replace(old, new)
    assert later != KEPT
    later += "  stub: {implements: stub, host: pc, timing: {rate: 10 Hz}}\n" if "stub" in new else ""
    before, after = _lookup(tmp_path / "1", KEPT), _lookup(tmp_path / "2", later)
    changes = make_agreement(after, "a", "b", earlier_revision=("v1", before)).changes
    assert changes is not None
    terms = [term for key in changes.changes_by_key for term in changes.terms_of(key)]
    assert sorted(term.after or "" for term in terms if term.term_kind == "contradictions") == told
    assert has_departures(changes) is bool(told)
