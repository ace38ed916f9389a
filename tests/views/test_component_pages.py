"""The site's pages of composed components and of component types, and what the search finds of them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.emit.site.page_links import collect_links
from archgen.emit.site.site_navigation import build_navigation
from archgen.model.architecture import Architecture
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import make_lookup
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.pages.single_page import make_page_at
from archgen.views.pages.site_pages import make_pages
from archgen.views.report.condensed_blocks import make_ros_blocks
from archgen.views.search import make_search_entries
from archgen.views.shapes import Facts, Inlines, Page, Table
from archgen.views.timing.timing_lookup import bound_chains

ROBOT = """
archgen: 1
component_types:
  motor:
    title: Motor
    functionality: Turns.
    inputs: {target: Goal}
    outputs: {state: State}
    timing: {period: 10 ms, wcet: 1 ms}
  fast_motor: {is: motor, title: Fast motor}
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}}
groups:
  arms:
    components:
      arm:
        functionality: Moves.
        inputs: {goal: planner.goal}
        outputs: {state: {from: elbow.state}}
        components:
          shoulder: {is: motor, inputs: {target: self.goal}}
          elbow: {is: fast_motor, inputs: {target: self.goal}, timing: {wcet: 2 ms}, functionality: Bends.}
          hand: {inputs: {goal: self.goal}, components: {finger: {same_as: motor, inputs: {target: self.goal}}}}
      planner: {inputs: {state: arm.state}, outputs: {goal: Goal}}
      smooth: {is: "filter<State>", inputs: {raw: arm.state}}
"""
PLAIN = "archgen: 1\ngroups: {g: {components: {a: {outputs: {x: X}}, b: {inputs: {x: a.x}}}}}\n"


def read_project(tmp_path: Path, text: str) -> Architecture:
    """Return the architecture of a one-file project."""
    (tmp_path / "archgen.yaml").write_text(text)
    return pipeline.check_project(tmp_path).architecture


@pytest.fixture
def robot(tmp_path: Path) -> Architecture:
    """Return an arm with a hand inside, and motors of two types."""
    return read_project(tmp_path, ROBOT)


def list_pages(architecture: Architecture) -> dict[str, Page]:
    """Return the pages by their anchors."""
    return {page.anchor: page for page in make_pages(make_lookup(architecture), DocumentEdition())}


def read_text(inlines: Inlines) -> str:
    """Return runs as text, lines with ` | ` between them."""
    return "".join(f"{' | ' if run.line_break else ''}{run.text}" for run in inlines)


def read_facts(page: Page) -> dict[str, str]:
    """Return the facts of a page."""
    facts = next(block for block in page.section.blocks if isinstance(block, Facts))
    return {name: read_text(value) for name, value in facts.rows}


def read_table(page: Page, caption: str) -> list[list[str]]:
    """Return the rows of the table with this caption."""
    tables = {block.caption: block for block in page.section.blocks if isinstance(block, Table)}
    return [[read_text(cell) for cell in row] for row in tables[caption].rows]


def test_pages_lie_inside_of_one_another_as_components_do(robot: Architecture) -> None:
    pages = list_pages(robot)
    assert [title for title, _ in pages["component:arms.arm.hand.finger"].crumbs] == ["Overview", "Arms", "Arm", "Hand"]
    assert pages["component:arms.arm.hand"].path == "components/arms.arm.hand.html"
    assert pages["component:arms.arm"].lead == "Composed component with 3 components inside"
    assert read_table(pages["group:arms"], "Components of Arms")[0][:2] == ["Arm (3 components)", ""]


def test_the_page_of_a_composed_component_says_what_stands_behind_its_ports(robot: Architecture) -> None:
    page = list_pages(robot)["component:arms.arm"]
    assert read_table(page, "Arm: inputs") == [
        ["goal", "Planner · goal", "Goal", "Shoulder · target | Elbow · target | Hand · goal", "digital"]
    ]
    assert read_table(page, "Arm: outputs") == [
        ["state", "State", "Elbow · state", "Planner · state | Smooth · raw", "digital"]
    ]
    assert [row[:2] for row in read_table(page, "Components of Arm")] == [
        ["Shoulder", "Motor"],
        ["Elbow", "Fast motor"],
        ["Hand (1 component)", ""],
    ]


def test_a_source_inside_of_a_composed_component_is_named_with_the_port(robot: Architecture) -> None:
    pages = list_pages(robot)
    assert read_table(pages["component:arms.planner"], "Planner: inputs")[0][1] == "Elbow · state through Arm · state"
    assert read_table(pages["component:arms.arm.shoulder"], "Shoulder: inputs")[0][1] == (
        "Planner · goal through Arm · goal"
    )


def test_an_instance_says_its_type_and_what_it_says_otherwise(robot: Architecture) -> None:
    pages = list_pages(robot)
    facts = read_facts(pages["component:arms.arm.elbow"])
    assert facts["Type"] == "Fast motor"
    assert facts["Otherwise than its type"] == "functionality: Bends. | wcet: 2 ms archgen.yaml:21"
    assert "Otherwise than its type" not in read_facts(pages["component:arms.arm.shoulder"])
    assert read_facts(pages["component:arms.arm.hand.finger"])["Type"] == "Motor, exactly (a reference)"
    assert read_facts(pages["component:arms.smooth"])["Type"] == "Filter<State>"


def test_a_type_has_a_page_with_its_ports_and_instances(robot: Architecture) -> None:
    pages = list_pages(robot)
    page = pages["component_type:motor"]
    assert read_facts(page) == {"Made from it": "Fast motor", "Instances": "3 instances"}
    assert read_table(page, "Ports of Motor") == [["in", "target", "Goal"], ["out", "state", "State"]]
    assert read_table(page, "Instances of Motor") == [
        ["Shoulder", "Arms · Arm", "Motor", ""],
        ["Elbow", "Arms · Arm", "Fast motor", "functionality: Bends. | wcet: 2 ms archgen.yaml:21"],
        ["Finger", "Arms · Arm · Hand", "Motor", "a reference: exactly its type"],
    ]
    assert read_facts(pages["component_type:fast_motor"])["Made from"] == "Motor"
    assert read_table(pages["component_type:filter"], "Ports of Filter")[0] == ["in", "raw", "T (generic)"]
    assert [row[0] for row in read_table(pages["page:component_types"], "Types of components")] == [
        "Motor",
        "Fast motor",
        "Filter",
    ]


def test_without_types_nothing_is_said_of_them(tmp_path: Path) -> None:
    plain = read_project(tmp_path, PLAIN)
    pages = list_pages(plain)
    assert "page:component_types" not in pages
    assert pages["page:index"].lead == "Software architecture: 2 components, 1 group, 1 connection and 2 nodes"
    assert "Type" not in read_facts(pages["component:g.a"])
    assert "Components" not in read_facts(pages["group:g"])
    assert [row[0] for row in read_table(pages["group:g"], "Components of G")] == ["A", "B"]


@pytest.mark.parametrize(
    "anchor", ["component:arms.arm", "component:arms.arm.hand.finger", "component_type:motor", "page:component_types"]
)
def test_a_page_by_itself_is_the_same(robot: Architecture, anchor: str) -> None:
    assert make_page_at(make_lookup(robot), DocumentEdition(), anchor) == list_pages(robot)[anchor]


def test_a_composed_component_that_is_not_designed_to_its_end_has_one_page(tmp_path: Path) -> None:
    text = """
archgen: 1
groups:
  g:
    components:
      shell: {outputs: {o: State}, components: {leaf: {outputs: {x: X}}}}
      reader: {inputs: {o: shell.o}}
"""
    lookup = make_lookup(read_project(tmp_path, text))
    pages = make_pages(lookup, DocumentEdition())
    assert [page.path for page in pages if page.anchor == "component:g.shell"] == ["components/g.shell.html"]
    page = next(page for page in pages if page.anchor == "component:g.shell")
    assert read_table(page, "Shell: outputs") == [["o", "State", "nothing inside yet", "Reader · o", "digital"]]
    titles = [entry.title for entry in make_search_entries(lookup, pages) if entry.kind == "component"]
    assert sorted(titles) == ["Leaf", "Reader", "Shell"]


def test_the_search_finds_composed_components_and_types(robot: Architecture) -> None:
    lookup = make_lookup(robot)
    entries = {entry.refs[0]: entry for entry in make_search_entries(lookup, make_pages(lookup, DocumentEdition()))}
    assert entries["component:arms.arm"].line == "composed of 3 components · Arms"
    assert entries["component:arms.arm.hand.finger"].line == "Arms · Arm · Hand"
    assert (entries["component_type:motor"].kind, entries["component_type:motor"].title) == ("component type", "Motor")


def test_the_tree_is_open_down_to_the_reader(robot: Architecture) -> None:
    pages = tuple(list_pages(robot).values())
    navigation = build_navigation(pages, collect_links(pages), [("groups", "Groups")])
    by_anchor = {page.anchor: page for page in pages}
    inner_tree = navigation.write_tree(by_anchor["component:arms.arm.hand.finger"], "")
    assert '<li><a href="components/arms.arm.hand.finger.html" aria-current="page">Finger</a></li>' in inner_tree
    assert ">Elbow</a>" in inner_tree
    # Elsewhere in the group the arm is closed.
    outer_tree = navigation.write_tree(by_anchor["component:arms.planner"], "")
    assert ">Arm</a>" in outer_tree
    assert ">Elbow</a>" not in outer_tree


def test_what_the_whole_says_of_its_time_stands_beside_the_worst_way_through_it(tmp_path: Path) -> None:
    timed = ROBOT.replace("functionality: Moves.", "functionality: Moves.\n        timing: {deadline: 9 ms}")
    (tmp_path / "archgen.yaml").write_text(timed)
    checked = pipeline.check_project(tmp_path)
    assert checked.analysis is not None
    lookup = make_lookup(checked.architecture, timing_lookup=bound_chains(checked.analysis, checked.architecture))
    facts = read_facts(next(page for page in make_pages(lookup, DocumentEdition()) if page.section.title == "Arm"))
    assert (facts["Timing"], facts["Worst way through it"]) == ("deadline 9 ms", "2 ms: elbow")
    assert dict(make_card(lookup, "composed", "arms.arm").facts)["worst way"] == "2 ms: elbow"
    assert "worst way" not in dict(make_card(lookup, "composed", "arms.arm.hand").facts)


SET = """
archgen: 1
component_types:
  driver:
    title: Driver
    outputs: {scan: Scan}
    parameters: {prefix: "", rate: {value: 10, unit: Hz, range: [1, 50]}, mode: {choices: [a, b]}}
    open: [plugins]
    operations: {reset: {response: Ok, call: synchronous}}
    frames: {"$(self.prefix)laser": {parent: base_link, static: true}, "$(self.prefix)spin": {rate: 5 Hz}}
groups:
  g:
    components:
      left: {is: driver, parameters: {prefix: left_}}
      pair:
        parameters: {side: right}
        components: {inner: {is: driver, parameters: {prefix: {from: self.side}}}}
"""


def test_a_type_says_what_its_instances_can_be_set_to_and_asked_for_and_their_frames(tmp_path: Path) -> None:
    pages = list_pages(read_project(tmp_path, SET))
    page = pages["component_type:driver"]
    assert read_table(page, "Driver: parameters") == [
        ["prefix", "", "", "", ""],
        ["rate", "10", "Hz", "1 to 50", ""],
        ["mode", "still to be given", "", "a, b", ""],
        ["plugins.*", "", "", "any", "open set"],
    ]
    assert read_table(page, "Driver: operations") == [["reset", "Ok", "synchronous"]]
    assert read_table(page, "Frames of each Driver") == [
        ["$(self.prefix)laser", "base_link", "static"],
        ["$(self.prefix)spin", "a root", "5 Hz"],
    ]
    assert [row[3] for row in read_table(page, "Instances of Driver")] == [
        "parameter prefix: left_ archgen.yaml:14",
        "",
    ]
    assert read_table(pages["component:g.pair"], "Pair: parameters") == [["side", "right"]]


def test_the_page_of_a_container_says_its_program(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X}}}}}\n"
        "containers: {plain: {threads: 1}, own: {namespace: s, package: p, executable: e, parameters: {a: {b: 1}, c: true}}}\n"
    )
    architecture = read_project(tmp_path, text)
    pages = list_pages(architecture)
    assert read_facts(pages["container:plain"]) == {"Host": "not known yet", "Threads": "1"}
    assert read_facts(pages["container:own"]) == {
        "Host": "not known yet",
        "Threads": "1 (nothing is written)",
        "ROS name": "/s/own",
        "Package": "p",
        "Executable": "e",
        "Parameters": "a: {b: 1} | c: true",
    }
    facts = dict(make_card(make_lookup(architecture), "container", "own").facts)
    assert (facts["ROS name"], facts["parameters"]) == ("/s/own", "{a: {b: 1}, c: true}")
    assert "ROS name" not in dict(make_card(make_lookup(architecture), "container", "plain").facts)


def test_a_program_has_no_ros_name(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X}}, b: {outputs: {y: Y}}}}}\n"
        "nodes: {stage: {implements: a, kind: program, command: [stage]}, n: {implements: b}}\n"
    )
    lookup = make_lookup(read_project(tmp_path, text))
    cards = {name: dict(make_card(lookup, "node", name).facts) for name in ("stage", "n")}
    assert cards["n"]["ROS name"] == "/n"
    assert "ROS name" not in cards["stage"]
    components = lookup.architecture.components
    on_paper = {name: str(make_ros_blocks(lookup, components[name])) for name in ("g.a", "g.b")}
    assert ("ROS name" in on_paper["g.a"], "ROS name" in on_paper["g.b"]) == (False, True)


def test_a_node_says_how_it_is_called_and_what_it_calls_otherwise(tmp_path: Path) -> None:
    text = (
        "groups: {g: {components: {a: {outputs: {x: X}}}}}\n"
        "types: {X: std_msgs/msg/String}\n"
        "nodes: {n: {implements: a, language: cpp, arguments: [--model, a b], remaps: {/tf: tf},\n"
        "            publishes: {x: {topic: /x, own_name: out}}}}\n"
    )
    lookup = make_lookup(read_project(tmp_path, text))
    on_paper = str(make_ros_blocks(lookup, lookup.architecture.components["g.a"]))
    assert "--model 'a b'" in on_paper
    assert "C++" in on_paper
    words = re.findall(r"Text\(text='([^']*)'", on_paper)
    assert words[words.index("out") : words.index("tf") + 1] == ["out", " is ", "/x", ", ", "/tf", " is ", "tf"]


def test_the_page_of_a_node_has_the_open_points_of_the_components_that_it_serves(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(f"{PLAIN}nodes: {{n: {{implements: g.b, package: p}}}}\n")
    checked = pipeline.check_project(tmp_path)
    lookup = make_lookup(checked.architecture, checked.findings)
    pages = {page.anchor: page for page in make_pages(lookup, DocumentEdition())}
    (section,) = (each for each in pages["node:n"].section.sections if each.title == "Open points")
    (table,) = section.blocks
    assert isinstance(table, Table)
    words = " ".join(read_text(cell) for row in table.rows for cell in row)
    assert "g.b still lacks" in words.replace("`", "")
    assert "g.a still lacks" not in words.replace("`", "")
