"""Promised and expected told apart: each term with what an owner wrote, and with what only follows."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.views.agreement.partner_agreement import make_agreement
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
      lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      eye: {inputs: {scan: lidar.scan}, outputs: {stop: std_msgs/msg/Header}}
      desk: {outputs: {ask: std_srvs/srv/Trigger}}
  drive:
    owner: b
    components:
      base: {inputs: {stop: eye.stop, ask: desk.ask}}
nodes:
  lidar_driver: {implements: lidar, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
  eye_node: {implements: eye, host: pc, timing: {wcet: 20 ms, trigger: [scan]}}
  desk_node: {implements: desk, timing: {wcet: 20 ms}}
  base_node: {implements: base, host: pc, timing: {rate: 2 Hz, wcet: 1 ms}}
hosts: {pc: {cores: 4}}
"""
TIMING = "timing: {wcet: 20 ms, trigger: [scan]}"


def edit(*edits: tuple[str, str]) -> str:
    source = ROBOT
    for old, new in edits:
        assert old in source
        source = source.replace(old, new)
    return source


def promises(folder: Path, source: str, title: str = "Eye · stop") -> dict[str, tuple[str, str]]:
    outline = make_agreement(view(checked(folder, source)), "a", "b").outline
    table = next(
        block
        for block in section(outline, title).blocks
        if isinstance(block, Table) and block.columns[1].title == "Promised by Alpha"
    )
    assert [column.title for column in table.columns] == ["Term", "Promised by Alpha", "Expected, not promised"]
    return {text(name): (text(promised), text(expected)) for name, promised, expected in table.rows}


def facts(folder: Path, source: str, title: str = "Eye · stop") -> dict[str, list[str]]:
    outline = make_agreement(view(checked(folder, source)), "a", "b").outline
    block = next(block for block in section(outline, title).blocks if isinstance(block, Facts))
    return {name: text(value).split("\n") for name, value in block.rows}


@pytest.mark.parametrize(
    ("new", "term", "promised", "expected"),
    [
        (TIMING, "Rate", "nothing", "10 Hz · 100 ms, event-driven, follows from the rate of lidar_driver"),
        (TIMING, "Largest gap", "nothing", "125 ms, follows from when eye_node is activated and how long it takes"),
        (TIMING, "QoS offered", "nothing", "default: reliable, depth 10 (ROS's default)"),
        ("timing: {rate: 5 Hz, wcet: 20 ms}", "Rate", "5 Hz · 200 ms", ""),
        ("timing: {period: 200 ms, wcet: 20 ms}", "Rate", "5 Hz · 200 ms", ""),
        ("timing: {rate: 5 Hz, jitter: 3 ms, wcet: 20 ms}", "Jitter", "up to 3 ms", ""),
        (
            "timing: {behaviour: event, rate: 5 Hz, wcet: 20 ms}",
            "Rate",
            "5 Hz · 200 ms, event-driven",
            "10 Hz, follows from its inputs",
        ),
        (
            "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {conditional: true}}}",
            "Sent",
            "only when there is something to send",
            "",
        ),
        (
            "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {conditional: true}}}",
            "Rate",
            "nothing",
            "at most 10 Hz, event-driven, follows from the rate of lidar_driver",
        ),
        (
            "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {conditional: true, max_gap: 3 s}}}",
            "Largest gap",
            "3 s",
            "",
        ),
        ("timing: {behaviour: once, wcet: 20 ms}", "Rate", "once", ""),
        (
            "publishes: {stop: {qos: {reliability: best_effort, depth: 1}}}",
            "QoS offered",
            "default: best effort, depth 1",
            "",
        ),
        ("status: planned", "Rate", "nothing", "not known"),
    ],
)
def test_what_an_owner_wrote_is_promised_and_all_else_expected(
    tmp_path: Path, new: str, term: str, promised: str, expected: str
) -> None:
    source = edit(
        (TIMING, new), *([(" timing: {rate: 10 Hz, wcet: 5 ms}", " status: planned")] if "planned" in new else [])
    )
    assert promises(tmp_path, source)[term] == (promised, expected)


@pytest.mark.parametrize(
    ("new", "row"),
    [
        (
            "timing: {wcet: 20 ms}",
            ("nothing", "20 ms or more, follows from its execution time, a core of its own assumed"),
        ),
        ("host: pc, timing: {wcet: 20 ms}", ("nothing", "20 ms, follows from the load of its host")),
        ("timing: {wcet: 20 ms, response: 50 ms}", ("50 ms", "")),
        ("status: planned", ("nothing", "not known")),
    ],
)
def test_a_written_response_is_a_promise_to_answer(tmp_path: Path, new: str, row: tuple[str, str]) -> None:
    assert promises(tmp_path, edit(("timing: {wcet: 20 ms}}", f"{new}}}")), "Desk · ask")["Answers within"] == row


def test_a_written_size_is_promised_and_a_computed_one_follows_from_the_definition(tmp_path: Path) -> None:
    fixed = edit(("std_msgs/msg/Header", "geometry_msgs/msg/Point"))
    assert promises(tmp_path, fixed)["Size"] == ("nothing", "28 B, follows from the definition of the message")
    written = (
        edit(("stop: std_msgs/msg/Header", "stop: Stop"))
        + "types: {Stop: {message: std_msgs/msg/Header, size: 40 B}}\n"
    )
    assert promises(tmp_path, written)["Size"] == ("40 B", "")


QUIET = "nothing is promised for this case"


@pytest.mark.parametrize(
    ("old", "new", "sentences"),
    [
        (TIMING, TIMING, [QUIET]),
        (
            TIMING,
            "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {conditional: true, max_gap: 3 s}}}",
            [
                "It is sent only when there is something to send, but Alpha lets no more than 3 s pass between two messages."
            ],
        ),
        (
            TIMING,
            "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {conditional: true}}}",
            ["It is sent only when there is something to send: Alpha does not promise how long it may be silent."],
        ),
        (TIMING, "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {max_gap: 3 s}}}", [QUIET]),
        (
            "stop: eye.stop",
            "stop: {from: eye.stop, optional: true}",
            ["Base of Beta works without it: its input stop is optional."],
        ),
        (
            TIMING,
            "publishes: {stop: {qos: {deadline: 1 s, lifespan: 2 s, liveliness: manual_by_topic, lease_duration: 3 s}}}",
            [
                "Alpha lets no more than 1 s pass between two messages (deadline of the quality of service).",
                "A message that is older than 2 s is not delivered any more (lifespan).",
                "Alpha counts as gone after 3 s without a sign of life (lease duration).",
            ],
        ),
    ],
)
def test_what_holds_where_data_is_late_is_only_what_the_model_says(
    tmp_path: Path, old: str, new: str, sentences: list[str]
) -> None:
    assert facts(tmp_path, edit((old, new)))["When late or missing"] == sentences


@pytest.mark.parametrize(
    ("written", "role"),
    [
        ("stop: eye.stop", "reads"),
        ("stop: {from: eye.stop, freshness: 200 ms}", "reads (no older than 200 ms)"),
        ("stop: {from: eye.stop, freshness: 1 s, optional: true}", "reads (optional, no older than 1 s)"),
    ],
)
def test_who_reads_says_how_old_it_may_be(tmp_path: Path, written: str, role: str) -> None:
    outline = make_agreement(view(checked(tmp_path, edit(("stop: eye.stop", written)))), "a", "b").outline
    tables = [block for block in section(outline, "Eye · stop").blocks if isinstance(block, Table)]
    assert role in [text(cell) for table in tables for row in table.rows for cell in row]


@pytest.mark.parametrize(
    ("edits", "sentences"),
    [
        (
            [(TIMING, "publishes: {stop: {qos: {deadline: 100 ms}}}, " + TIMING)],
            ["The QoS deadline of 100 ms that eye_node promises may not be kept: up to 125 ms is expected."],
        ),
        ([(TIMING, "publishes: {stop: {qos: {deadline: 200 ms}}}, " + TIMING)], []),
        (
            [
                (TIMING, "publishes: {stop: {qos: {deadline: 200 ms}}}, timing: {wcet: 150 ms, trigger: [scan]}"),
                ("cores: 4", "cores: 1"),
            ],
            ["The QoS deadline of 200 ms that eye_node promises may not be kept: there is no bound."],
        ),
        (
            [
                ("rate: 10 Hz", "rate: 0.1 Hz"),
                (TIMING, "timing: {wcet: 20 ms, trigger: [scan], outputs: {stop: {conditional: true, max_gap: 3 s}}}"),
            ],
            ["The largest gap of 3 s that eye_node promises may not be kept: up to 10.025 s is expected."],
        ),
        (
            [("stop: eye.stop", "stop: {from: eye.stop, type: Halt}")],
            ["Base expects Halt as stop, and is given std_msgs/msg/Header."],
        ),
    ],
)
def test_what_does_not_fit_together_is_an_open_point(
    tmp_path: Path, edits: list[tuple[str, str]], sentences: list[str]
) -> None:
    source = edit(*edits) + ("types: {Halt: std_msgs/msg/String}\n" if "Halt" in edits[0][1] else "")
    points = facts(tmp_path, source).get("Open points", [])
    open_terms = ("The size", "No quality of service", "No rate")
    assert [point for point in points if not point.startswith(open_terms)] == sentences


@pytest.mark.parametrize(
    ("through", "titles"),
    [("lidar, eye, base", ["Eye · stop", "Eye · more"]), ("lidar, eye.stop, base", ["Eye · stop"])],
)
def test_a_chain_that_names_an_output_passes_through_no_other(tmp_path: Path, through: str, titles: list[str]) -> None:
    source = edit(("{stop: std_msgs/msg/Header}", "{stop: std_msgs/msg/Header, more: std_msgs/msg/Header}"))
    source = source.replace("stop: eye.stop", "stop: eye.stop, more: eye.more")
    outline = make_agreement(
        view(checked(tmp_path, f"{source}chains: {{halt: {{through: [{through}], deadline: 1 s}}}}\n")), "a", "b"
    ).outline
    assert [
        title
        for title in ("Eye · stop", "Eye · more")
        if any(
            isinstance(block, Table) and block.columns[0].title.startswith("Chain")
            for block in section(outline, title).blocks
        )
    ] == titles
