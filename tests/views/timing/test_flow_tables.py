"""The page of a node: its flows with partner, age and deadlines, the chains through it, what no chain says, whom to talk to."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from archgen import pipeline
from archgen.model.element_ids import is_id
from archgen.views.element_readers import list_reliance
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.pages.site_pages import make_pages
from archgen.views.shapes import Bullets, Inlines, Markdown, Section, Table
from archgen.views.timing import flow_tables
from archgen.views.timing.flow_tables import (
    list_activities,
    list_flow_rows,
    list_own_activities,
    list_time_left,
    make_flow_sections,
    make_unjudged_blocks,
)
from archgen.views.timing.timing_lookup import analyse_with_chains

ROBOT = """\
partners: {p: Partner P, q: Partner Q}
groups:
  see: {owner: p, components: {camera: {inputs: {light: {external: light, medium: physical}}, outputs: {picture: Image}}}}
  act: {owner: q, components: {stop: {inputs: {picture: camera.picture, pose: odometry.pose}, outputs: {halt: {type: Halt, medium: physical, external: wheels}}},
                               odometry: {inputs: {ticks: {external: ticks, medium: physical}}, outputs: {pose: Pose}}}}
types: {Image: sensor_msgs/msg/Image, Pose: geometry_msgs/msg/Pose}
nodes:
  camera: {implements: camera, host: h, timing: {rate: 50 Hz, wcet: 2 ms}}
  stop: {implements: stop, host: k, timing: {rate: 10 Hz, wcet: 5 ms}}
  odometry: {implements: odometry, host: k, timing: {rate: 100 Hz, wcet: 1 ms}}
hosts: {h: {cores: 1}, k: {cores: 1}}
links: {lan: {title: Cable, connects: [h, k], latency: {best: 1 ms, worst: 4 ms}}}
chains: {see: {title: Sees and stops, through: [camera, stop], deadline: 400 ms}}
"""


def _look_up(folder: Path, text: str = ROBOT) -> Lookup:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    checked = pipeline.check_project(folder / "robot.yaml")
    assert not checked.has_errors
    return make_lookup(checked.architecture, checked.findings, timing_lookup=analyse_with_chains(checked.architecture))


def _read(cell: Inlines) -> str:
    return "".join(f" / {run.text}" if run.line_break else run.text for run in cell)


def test_a_row_says_who_gives_it_how_old_it_is_and_what_rests_on_it(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path)
    taken, given = list_flow_rows(lookup, list_activities(lookup, (lookup.architecture.nodes["stop"],)))
    assert given == []
    cells = [[_read(cell) if isinstance(cell, tuple) else cell for cell in row] for row in taken]
    assert cells == [
        ["picture", "Camera / Partner P · by Cable", "/see/camera/picture / sensor_msgs/msg/Image / default: reliable, depth 10", "50 Hz", "22 ms", "6 ms", "6 ms", "107 ms", "sampled; 80 % never read", "Sees and stops 400 ms", "Image"],
        ["pose", "Odometry / same host", "/act/odometry/pose / geometry_msgs/msg/Pose 60 B / default: reliable, depth 10", "100 Hz", "16 ms", "6 ms", "6 ms", "107 ms", "sampled; 90 % never read; up to 12 may wait, the queue holds 10", "", "Pose"],
    ]  # fmt: skip


CALLS = """\
partners: {p: Partner P, q: {title: Partner Q, contact: mia@q.example}}
groups:
  see: {owner: p, components: {asker: {inputs: {answer: server.answer}}}}
  act: {owner: q, components: {server: {outputs: {answer: Answer}}}}
types: {Answer: std_srvs/srv/Trigger}
milestones: {trial: {title: First trial, date: "2027-03-01", needs: "owner:q"}, other: {needs: asker}}
nodes:
  asker: {implements: asker, host: h, timing: {rate: 10 Hz, wcet: 2 ms, calls: {answer: 1/5}}}
  server: {implements: server, host: h, timing: {wcet: 5 ms}}
hosts: {h: {cores: 2}}
"""


def test_a_server_is_told_how_often_it_is_called_within_what_time_and_by_whom(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path, CALLS)
    (row,), given = list_flow_rows(lookup, list_activities(lookup, (lookup.architecture.nodes["server"],)))
    assert given == []
    assert (_read(row.rate), row.reading) == ("2 Hz", "called; worked off within 5 ms")
    lists = {name: dict(make_card(lookup, "node", name).lists) for name in ("asker", "server")}
    assert lists["server"]["who to talk to"] == ("Partner P calls answer",)
    assert lists["asker"]["who to talk to"] == ("Partner Q answers answer · mia@q.example",)


def test_it_is_said_by_when_an_element_is_needed(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path, CALLS)
    said = {
        name: [
            _read(line)
            for line in list_reliance(lookup, lookup.architecture.components[name])
            if "Needed" in _read(line)
        ]
        for name in ("act.server", "see.asker")
    }
    assert said == {"act.server": ["Needed for First trial on 2027-03-01"], "see.asker": ["Needed for Other"]}


def test_the_quality_of_service_is_that_of_the_elements_own_end(tmp_path: Path) -> None:
    text = ROBOT.replace(
        "timing: {rate: 50 Hz, wcet: 2 ms}}",
        "timing: {rate: 50 Hz, wcet: 2 ms}, publishes: {picture: {topic: /picture, qos: {depth: 3}}}}",
    )
    lookup = _look_up(tmp_path, text)
    ends = {}
    for name, side in (("camera", 1), ("stop", 0)):
        rows = list_flow_rows(lookup, list_activities(lookup, (lookup.architecture.nodes[name],)))[side]
        ends[name] = [_read(row.topic).rpartition(" / ")[2] for row in rows if row.port == "picture"]
    assert ends == {"camera": ["default: reliable, depth 3"], "stop": ["default: reliable, depth 10"]}


def test_a_sensor_of_two_nodes_begins_with_the_first_one(tmp_path: Path) -> None:
    """What the second node works on is what the first one took from the world."""
    raw = "raw: {topic: /raw, message: sensor_msgs/msg/Image}"
    text = ROBOT.replace(
        "  camera: {implements: camera, host: h, timing: {rate: 50 Hz, wcet: 2 ms}}",
        f"  grabber: {{implements: camera, host: h, timing: {{rate: 50 Hz, wcet: 2 ms}}, internal: {{publishes: {{{raw}}}}}}}\n"
        "  camera: {implements: camera, host: h, timing: {behaviour: event, wcet: 3 ms}, publishes: {picture: /picture},"
        f" internal: {{subscribes: {{{raw}}}}}}}",
    )
    text = text.replace("through: [camera, stop]", "through: [grabber, camera, stop]")
    lookup = _look_up(tmp_path, text)
    taken, _ = list_flow_rows(lookup, list_activities(lookup, (lookup.architecture.nodes["stop"],)))
    ages = [(row.port, _read(row.age), _read(row.since_sensing)) for row in taken]
    assert ages[0] == ("picture", "9 ms", "14 ms")


def test_the_page_has_chains_what_no_chain_says_and_whom_to_talk_to(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path)
    sections = make_flow_sections(lookup, lookup.architecture.nodes["stop"])
    assert [section.title for section in sections] == [
        "Takes in and gives out",
        "Chains through it",
        "What no chain says",
        "Who to talk to",
    ]
    (chains,) = sections[1].blocks
    assert isinstance(chains, Table)
    assert [_read(cell) for cell in chains.rows[0]][2:] == [
        "22 ms",
        "111 ms",
        "0 ms",
        "133 ms",
        "400 ms",
        "met · 267 ms left",
    ]
    assert chains.rows[0][1][0].meter is not None
    assert "Partner P gives picture" in str([_read(item) for item in sections[3].blocks[0].items])  # type: ignore[union-attr]


def test_the_lines_make_a_chain_that_says_what_the_page_says(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path)
    blocks = list(make_unjudged_blocks(lookup, list_activities(lookup, (lookup.architecture.nodes["stop"],))))
    text = next(block.text for block in blocks if isinstance(block, Markdown))
    lines = text.removeprefix("```yaml\n").removesuffix("\n```")
    assert yaml.safe_load(lines) == {"chains": {"odometry_to_stop": {"through": ["odometry", "stop"]}}}
    told = next(_read(item) for block in blocks if hasattr(block, "items") for item in block.items)
    longer = _look_up(tmp_path, ROBOT.replace("chains: {", "chains: {odometry_to_stop: {through: [odometry, stop]}, "))
    assert longer.timing is not None
    (result,) = (each for each in longer.timing.chains if each.id == "odometry_to_stop")
    assert (
        told
        == f"pose: {(result.bound.value or 0) / 10**6} ms at most from what odometry senses until stop has acted on it."
    )


def test_the_lines_that_make_chains_have_ids_that_archgen_takes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lookup = _look_up(tmp_path)
    activities = list_activities(lookup, (lookup.architecture.nodes["stop"],))
    ((way, _),) = flow_tables.list_unjudged_lines(lookup, activities)
    # What two nodes of one component send each other has a topic, and no port that names it.
    arc = replace(way.flow.arc, input="/Chosen/it")
    first, *_, last = way.through
    others = [
        replace(way, flow=replace(way.flow, arc=arc), through=(first,) * length + (last,)) for length in (1, 2, 3)
    ]
    found = [(way, "a"), *((each, "b") for each in others)]
    monkeypatch.setattr(flow_tables, "list_unjudged_lines", lambda *_: found)
    text = next(block.text for block in make_unjudged_blocks(lookup, activities) if isinstance(block, Markdown))
    chains = yaml.safe_load(text.removeprefix("```yaml\n").removesuffix("\n```"))["chains"]
    names = list(chains)
    # The same way by another input is said once.
    assert names == ["odometry_to_stop", *(f"odometry_to_stop_by_chosen_it{number}" for number in ("", "_2"))]
    assert len({tuple(chain["through"]) for chain in chains.values()}) == 3
    assert all(is_id(name) for name in names)


def test_site_pages_and_cards_have_the_same_rows(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path)
    pages = {page.anchor: page for page in make_pages(lookup, DocumentEdition())}
    tables = [_list_flows(pages[anchor].section) for anchor in ("node:stop", "component:act.stop")]
    assert tables[0] == tables[1]
    assert len(tables[0]) == 2
    for kind, name in (("node", "stop"), ("component", "act.stop")):
        lists = dict(make_card(lookup, kind, name).lists)
        assert [line.partition(" <-")[0] for line in lists["takes in"]] == [row[0] for row in tables[0]]
        assert all(row[5] in line for row, line in zip(tables[0], lists["takes in"], strict=True))
        assert lists["chains"] == ("see: met · 267 ms left; 111 ms of 133 ms here",)
        assert lists["how long it may take"] == (
            "within 6 ms (any order of execution): 5 ms of its own, 1 ms odometry",
        )
        assert lists["what no chain says"][0].startswith("pose: ")


def test_a_response_on_several_cores_says_in_what_of_it_others_may_come_first(tmp_path: Path) -> None:
    lookup = _look_up(tmp_path, ROBOT.replace("k: {cores: 1}", "k: {cores: 2}").replace("host: h", "host: k"))
    lists = dict(make_card(lookup, "node", "stop").lists)
    (line,) = lists["how long it may take"]
    assert line.startswith("within ")
    assert ": 5 ms of its own, " in line
    assert line.endswith(" in which others may come first: camera, odometry")


def _list_flows(section: Section) -> list[list[str]]:
    flows = next(each for each in section.sections if each.title == "Takes in and gives out")
    (table,) = flows.blocks
    assert isinstance(table, Table)
    return [[_read(cell) for cell in row] for row in table.rows]


def test_what_rates_and_deadlines_leave_is_said_where_no_execution_time_is_written(tmp_path: Path) -> None:
    text = ROBOT.replace("rate: 10 Hz, wcet: 5 ms", "rate: 3 Hz").replace("deadline: 400 ms", "deadline: 500 ms")
    lookup = _look_up(tmp_path, text.replace("timing: {rate: 100 Hz, wcet: 1 ms}", "timing: {behaviour: event}"))
    nodes = lookup.architecture.nodes
    left = {
        name: [_read(line) for line in list_time_left(lookup, list_own_activities(lookup, nodes[name]))]
        for name in nodes
    }
    assert left == {
        "camera": [],
        "stop": ["less than 333 ms a run, at 3 Hz", "Sees and stops 500 ms: <= 141 ms left, together with odometry"],
        "odometry": ["nothing that is written limits it"],
    }
    reentrant = _look_up(
        tmp_path, text.replace("{implements: stop,", "{implements: stop, reentrant: true, threads: 2,")
    )
    found = list_time_left(reentrant, list_own_activities(reentrant, reentrant.architecture.nodes["stop"]))
    assert list(map(_read, found)) == ["Sees and stops 500 ms: <= 141 ms left"]
    sections = {
        each.title: each.blocks for each in make_flow_sections(lookup, lookup.architecture.components["act.stop"])
    }
    _, bullets = sections["How long it may take"]
    assert isinstance(bullets, Bullets)
    lines = tuple(map(_read, bullets.items))
    assert lines == tuple(left["stop"]) == dict(make_card(lookup, "node", "stop").lists)["how long it may take"]


def test_it_is_said_who_reads_from_an_element_and_who_reads_from_those(tmp_path: Path) -> None:
    text = ROBOT.replace("pose: odometry.pose}", "pose: {from: odometry.pose, optional: true}}").replace(
        "outputs: {halt", "outputs: {word: Image, halt"
    )
    text = text.replace("hosts:", "  log: {implements: log, start: {after: camera}}\nhosts:").replace(
        "groups:\n", "groups:\n  out: {components: {log: {inputs: {word: stop.word}}}}\n"
    )
    lookup = _look_up(tmp_path, text)
    command = "archgen impact --component {} says which deadlines, use cases and requirements rest on it"
    expected = {
        "see.camera": [
            "Read from it (1): Stop",
            "Read from those (1): Log",
            "Wait for it at the start (1): log",
            command.format("see.camera"),
        ],
        "act.odometry": [
            "Read from it (1): Stop",
            "Read from those (1): Log",
            "Can do without it (1): Stop",
            command.format("act.odometry"),
        ],
        "out.log": [],
    }
    found = {name: list(map(_read, list_reliance(lookup, lookup.architecture.components[name]))) for name in expected}
    assert found == expected
    lines = list(map(_read, list_reliance(lookup, lookup.architecture.nodes["camera"])))
    assert lines == expected["see.camera"]
    assert dict(make_card(lookup, "node", "camera").lists)["what rests on it"] == tuple(lines)


def test_without_timing_there_is_nothing(tmp_path: Path) -> None:
    lookup = make_lookup(_look_up(tmp_path).architecture)
    assert list_flow_rows(lookup, ()) == ([], [])
    assert make_flow_sections(lookup, lookup.architecture.nodes["stop"]) == []


def test_of_a_way_that_nobody_would_write_as_a_chain_its_command_is_said(tmp_path: Path) -> None:
    last = 25
    components = "".join(
        f"      c{number}: {{inputs: {{{'x: {external: light}' if number == 0 else f'x: c{number - 1}.y'}}}, outputs: {{y: T}}}}\n"
        for number in range(last + 1)
    )
    nodes = "".join(
        f"  c{number}: {{implements: c{number}, timing: {{wcet: 1 ms{', rate: 1 Hz' if number == 0 else ''}}}}}\n"
        for number in range(last + 1)
    )
    text = f"groups:\n  g:\n    components:\n{components}nodes:\n{nodes}types: {{T: std_msgs/msg/Bool}}\n"
    lookup = _look_up(tmp_path, text)
    blocks = list(make_unjudged_blocks(lookup, list_activities(lookup, (lookup.architecture.nodes[f"c{last}"],))))
    assert not any(isinstance(block, Markdown) for block in blocks)
    (line,) = next(block for block in blocks if isinstance(block, Bullets)).items
    assert _read(line) == (
        f"x: from c0, which is {last} elements away; archgen timing --from c0 --to c{last} says how long it takes."
    )
    short = list(make_unjudged_blocks(lookup, list_activities(lookup, (lookup.architecture.nodes["c19"],))))
    assert isinstance(short[-1], Markdown)
