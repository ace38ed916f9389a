"""Use cases as people see them in text: cards, lists, the resolved record, search, statistics."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.analyses.size_counts import measure_size
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import make_scoped_lookup
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import find_elements
from archgen.views.lookup import Lookup
from archgen.views.records.resolved_record import make_record
from archgen.views.search.functional_entries import make_requirement_entries
from archgen.views.sequences import sequence_charts
from archgen.views.tables.element_rows import list_element_rows
from archgen.views.tables.statistics_tables import format_figures
from archgen.views.timing.timing_lookup import analyse_with_chains

ROBOT = """\
archgen: 1
use_cases:
  UC-1: Plain
  UC-4:
    title: Fetching water
    description: She is thirsty.
    actors: {resident: The resident}
    steps:
      - {from: resident, to: speech, say: asks for water}
      - {from: speech, to: dialogue, say: passes on the words}
      - {from: dialogue, to: dialogue, say: thinks}
      - {from: dialogue, to: planner.plan}
      - {from: dialogue, to: speech, say: never heard}
      - {from: planner, to: dialogue}
requirements: {R-1: {title: It helps, use_cases: [UC-4]}}
groups:
  g:
    components:
      speech: {title: Ears, inputs: {voice: {external: The resident speaks, medium: physical}}, outputs: {words: Words}}
      dialogue: {inputs: {words: speech.words, plan: planner.plan}}
      planner: {outputs: {plan: Plan}}
types: {Words: std_msgs/msg/String, Plan: std_srvs/srv/Trigger}
"""


@pytest.fixture(scope="module")
def lookup(tmp_path_factory: pytest.TempPathFactory) -> Lookup:
    file = tmp_path_factory.mktemp("robot") / "robot.yaml"
    file.write_text(ROBOT, encoding="utf-8")
    return make_scoped_lookup(pipeline.check_project(file), OutputOptions(None, ""))


def test_the_card_tells_the_steps(lookup: Lookup) -> None:
    assert find_elements(lookup, "UC-4") == [("use case", "UC-4")]
    card = make_card(lookup, "use case", "UC-4")
    assert (card.title, card.facts) == (
        "Fetching water",
        (("description", "She is thirsty."), ("actors", "resident (The resident)")),
    )
    lists = dict(card.lists)
    assert lists["steps"] == (
        "1. The resident -> Ears: asks for water [Voice]",
        "2. Ears -> Dialogue: passes on the words [Words]",
        "3. Dialogue: thinks",
        "4. Dialogue -> Planner [Plan]",
        "5. Dialogue -> Ears: never heard [no connection]",
        "6. Planner -> Dialogue [Plan]",
    )
    assert lists["requirements"] == ("R-1",)
    assert [line.partition(":")[0] for line in lists["findings"]] == ["warning[broken-step]"]
    assert dict(make_card(lookup, "use case", "UC-1").lists) == {"requirements": ()}


TIMING = """\
nodes:
  speech: {implements: speech, host: pc, timing: {behaviour: event, wcet: 5 ms, rate: 1 Hz}}
  dialogue: {implements: dialogue, host: pc, timing: {rate: 10 Hz, wcet: 5 ms}}
hosts: {pc: {cores: 4}}
"""


def test_the_card_tells_how_long_they_take(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT + TIMING, encoding="utf-8")
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    from archgen.views.lookup import make_lookup

    timed = make_lookup(architecture, timing_lookup=analyse_with_chains(architecture))
    assert sequence_charts.describe_step_time(timed, "UC-4", 2) == "105 ms"
    assert sequence_charts.describe_step_time(timed, "UC-4", 3) == ""
    assert sequence_charts.describe_step_time(timed, "UC-4", 4) == sequence_charts.NOT_PROVEN
    assert sequence_charts.describe_total(timed, "UC-4").startswith("not proven (>= ")
    assert sequence_charts.describe_total(timed, "UC-1") == ""
    facts = dict(make_card(timed, "use case", "UC-4").facts)
    assert facts["time"] == sequence_charts.describe_total(timed, "UC-4")


BESIDE_ANOTHER = """\
archgen: 1
use_cases: {UC-1: {title: Passing on, steps: [{from: a, to: b}OTHERS]}}
groups:
  g:
    components:
      a: {outputs: {x: X}, timing: {rate: 1 Hz, wcet: 1 ms}}
      b: {inputs: {x: a.x}, outputs: {y: X}, timing: {behaviour: event, wcet: 2 ms}}
      c: {inputs: {y: b.y}, timing: {behaviour: event, wcet: 3 ms}}
      busy: {outputs: {z: {type: X, external: A lamp}}, timing: {rate: 2 Hz, wcet: 40 ms}}
types: {X: std_msgs/msg/Empty}
nodes: {a: {implements: a, host: pc}, b: {implements: b, host: pc}, c: {implements: c, host: pc}, busy: {implements: busy, host: pc}}
hosts: {pc: {cores: 1}}
"""


@pytest.mark.parametrize(("others", "is_less"), [(", {from: b, to: c}", True), ("", False)])
def test_a_whole_that_is_less_than_its_steps_says_why(tmp_path: Path, *, others: str, is_less: bool) -> None:
    (tmp_path / "robot.yaml").write_text(BESIDE_ANOTHER.replace("OTHERS", others), encoding="utf-8")
    architecture = pipeline.check_project(tmp_path / "robot.yaml").architecture
    from archgen.views.lookup import make_lookup

    timed = make_lookup(architecture, timing_lookup=analyse_with_chains(architecture))
    total = sequence_charts.describe_total(timed, "UC-1")
    assert total.startswith("at most ")
    reason = "; the steps add up to more, but what several of them wait for counts once"
    assert sequence_charts.explain_total(timed, "UC-1") == total + (reason if is_less else "")
    assert dict(make_card(timed, "use case", "UC-1").facts)["time"] == sequence_charts.explain_total(timed, "UC-1")


def test_lists(lookup: Lookup) -> None:
    header, rows = list_element_rows(lookup, "use_cases")
    assert [dict(zip(header, row, strict=True))["steps"] for row in rows] == ["0", "6"]
    header, rows = list_element_rows(lookup, "steps")
    assert header == ("use_case", "number", "from", "to", "says", "along", "place")
    assert [row[:6] for row in rows][1:4] == [
        ("UC-4", "2", "g.speech", "g.dialogue", "passes on the words", "g.speech.words"),
        ("UC-4", "3", "g.dialogue", "g.dialogue", "thinks", ""),
        ("UC-4", "4", "g.dialogue", "g.planner.plan", "", "g.planner.plan"),
    ]


def test_the_record(lookup: Lookup) -> None:
    record = make_record(lookup)["use_cases"]
    assert record["UC-1"] == {"title": "Plain"}
    case = record["UC-4"]
    assert isinstance(case, dict)
    assert case["actors"] == {"resident": "The resident"}
    assert case["steps"][0] == {
        "from": {"kind": "actor", "id": "resident"},
        "to": {"kind": "component", "id": "g.speech"},
        "say": "asks for water",
        "inputs": ["g.speech.voice"],
    }
    assert case["steps"][3] == {
        "from": {"kind": "component", "id": "g.dialogue"},
        "to": {"kind": "output", "id": "g.planner.plan"},
        "outputs": ["g.planner.plan"],
    }


def test_search_and_statistics(lookup: Lookup) -> None:
    entries = [entry for entry in make_requirement_entries(lookup) if entry.kind == "use case"]
    assert [entry.text for entry in entries][1].startswith("She is thirsty. The resident asks for water")
    assert measure_size(lookup.architecture).steps == 6
    assert ("steps", "Steps of use cases", "6") in format_figures(measure_size(lookup.architecture))
