"""Properties, hints, pictures and terms as people see them; nothing of it where there are none."""

from __future__ import annotations

from pathlib import Path

from archgen.views.elements.annotation_facts import list_annotation_facts, make_image_blocks
from archgen.views.elements.element_card import make_card
from archgen.views.lookup import Lookup
from archgen.views.pages import report_outline, site_pages
from archgen.views.records.resolved_record import make_record
from archgen.views.search import make_search_entries
from archgen.views.shapes import Facts, Markdown, Section, Table
from archgen.views.tables.element_rows import list_element_rows
from archgen.views.tables.property_tables import make_glossary_table, make_property_sections
from tests.views.test_frames import look_up

ROBOT = """\
archgen: 1
site: {repository: "https://github.com/a/b"}
properties:
  sil: {title: Safety integrity level, of: [component, group], type: integer, range: [0, 4], required: true, description: "After **IEC**."}
  mass: {unit: kg, range: [0, .inf]}
glossary: {SIL: Safety  integrity level, Arm: "A *limb*."}
component_types: {cam: {functionality: Sees., image: pics/cam 1.png, status: adapted, contact: a@b.eu, properties: {sil: 1}}}
groups:
  g:
    properties: {sil: 2}
    components:
      eye: {is: cam, title: "Eye [1]", properties: {mass: 2.5 kg}, hints: {orca: {tag: Car}}}
      brain:
        title: Brain
        properties: {sil: 2, site: lab}
        inputs: {image: {from: eye.o, urls: {bus: docs/bus.dbc, paper: "https://x.eu"}, properties: {guard: range}}}
hosts: {pc: {properties: {ram: 8 GB}}}
nodes: {n: {implements: brain, host: pc, properties: {ram: 1 GB}}}
"""
TYPE_OUTPUT = ROBOT.replace("image: pics", "outputs: {o: std_msgs/msg/Bool}, image: pics")


def text_of(section: Section) -> list[str]:
    lines = []
    for block in section.blocks:
        if isinstance(block, Table):
            lines += ["; ".join("".join(run.text for run in cell) for cell in row) for row in block.rows]
        elif isinstance(block, Facts):
            lines += [f"{name}: {''.join(run.text for run in value)}" for name, value in block.rows]
        elif isinstance(block, Markdown):
            lines.append(block.text)
    return lines


def test_each_declared_property_is_listed_with_what_has_it(tmp_path: Path) -> None:
    sections = make_property_sections(look_up(tmp_path, TYPE_OUTPUT))
    assert {section.anchor: text_of(section) for section in sections} == {
        "property:sil": [
            "After **IEC**.",
            "Of: each component and group",
            "Values: 0 to 4",
            "G; group; 2",
            "Cam; component type; 1",
            "Eye [1]; component; 1",
            "Brain; component; 2",
        ],
        "property:mass": ["Values: at least 0 kg", "Unit: kg", "Eye [1]; component; 2.5 kg"],
        "property:": [
            "Pc; host; Ram; 8 GB",
            "Brain; component; Site; lab",
            "Brain image; input; Guard; range",
            "n; node; Ram; 1 GB",
        ],
    }
    (table,) = (block for block in sections[1].blocks if isinstance(block, Table))
    assert table.rows[0][2][0].sort_number == "2.5"


def test_a_part_lists_what_it_shows(tmp_path: Path) -> None:
    sections = make_property_sections(look_up(tmp_path, TYPE_OUTPUT, "brain"))
    assert "Eye [1]; component; 1" not in text_of(sections[0])


def facts_of(lookup: Lookup, component_id: str) -> dict[str, str]:
    facts = list_annotation_facts(lookup, lookup.architecture.components[component_id])
    return {name: "|".join(run.text for run in value) for name, value in facts}


def test_an_element_says_its_properties_and_for_whom_it_has_hints(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, TYPE_OUTPUT)
    assert facts_of(lookup, "g.eye") == {
        "Properties": "Safety integrity level: |1|Mass: |2.5 kg",
        "Hints": "orca: |{tag: Car}",
    }
    (_, value), *_ = list_annotation_facts(lookup, lookup.architecture.components["g.brain"])
    assert [run.ref for run in value if run.ref] == ["property:sil"]
    assert list(list_annotation_facts(lookup, lookup.architecture.outputs["g.eye.o"])) == []


def test_cards(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, TYPE_OUTPUT)
    facts = dict(make_card(lookup, "component", "g.eye").facts)
    assert {key: facts[key] for key in ("status", "contact", "image", "properties", "hints")} == {
        "status": "adapted",
        "contact": "a@b.eu",
        "image": "pics/cam 1.png",
        "properties": "sil: 1, mass: 2.5 kg",
        "hints": "orca: {tag: Car}",
    }
    facts = dict(make_card(lookup, "input", "g.brain.image").facts)
    assert (facts["urls"], facts["properties"]) == ("bus: docs/bus.dbc, paper: https://x.eu", "guard: range")
    assert dict(make_card(lookup, "host", "pc").facts)["properties"] == "ram: 8 GB"


def test_a_picture_is_one_of_the_project_and_a_librarys_is_none(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, TYPE_OUTPUT)
    components = lookup.architecture.components
    assert make_image_blocks(lookup, components["g.eye"]) == [Markdown("![Eye \\[1\\]](<pics/cam%201.png>)")]
    assert make_image_blocks(lookup, components["g.brain"]) == []
    packed = TYPE_OUTPUT.replace("is: cam,", "is: lib.cam,").replace(
        "component_types: {cam:", "libraries: {lib: {component_types: {cam:"
    )
    lookup = look_up(tmp_path, packed.replace("properties: {sil: 1}}}", "properties: {sil: 1}}}}}"))
    assert lookup.architecture.components["g.eye"].image == "pics/cam 1.png"
    assert make_image_blocks(lookup, lookup.architecture.components["g.eye"]) == []


def test_lists_have_a_column_for_each_property(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, TYPE_OUTPUT)
    columns, rows = list_element_rows(lookup, "components")
    assert columns[-3:] == ("property:sil", "property:mass", "property:site")
    assert [row[-3:] for row in rows] == [("1", "2.5 kg", ""), ("2", "", "lab")]
    assert list_element_rows(lookup, "nodes")[0][-1] == "property:ram"
    assert list_element_rows(lookup, "connections")[0][-1] == "place"


def test_terms_are_rows_that_texts_lead_to(tmp_path: Path) -> None:
    table = make_glossary_table(look_up(tmp_path, ROBOT))
    assert table is not None
    assert table.row_anchors == ("term:Arm", "term:SIL")
    assert text_of(Section("x", "X", (table,))) == ["Arm; A *limb*.", "SIL; Safety integrity level"]


def test_pages_and_chapters_only_where_there_is_something(tmp_path: Path) -> None:
    for text, expected in (
        (TYPE_OUTPUT, ["properties", "glossary"]),
        ("archgen: 1\ngroups: {g: {components: {a: A}}}\n", []),
    ):
        lookup = look_up(tmp_path, text)
        pages = site_pages.make_pages(lookup, report_outline.DocumentEdition())
        named = [page.path.removesuffix(".html") for page in pages]
        assert [name for name in ("properties", "glossary") if name in named] == expected
        chapters = report_outline.make_report(lookup, report_outline.DocumentEdition()).sections
        named = [section.anchor.removeprefix("page:") for section in chapters]
        assert [name for name in ("properties", "glossary") if name in named] == expected


def test_other_programs_read_number_and_unit(tmp_path: Path) -> None:
    record = make_record(look_up(tmp_path, TYPE_OUTPUT))
    assert record["components"]["g.eye"]["properties"] == {
        "sil": {"text": "1", "value": 1},
        "mass": {"text": "2.5 kg", "value": 2.5, "unit": "kg"},
    }
    assert record["properties"]["mass"] == {"title": "Mass", "unit": "kg", "range": ["0", "Infinity"]}
    assert record["glossary"] == {"SIL": "Safety  integrity level", "Arm": "A *limb*."}


def test_search_finds_terms_and_values(tmp_path: Path) -> None:
    lookup = look_up(tmp_path, TYPE_OUTPUT)
    entries = make_search_entries(lookup, site_pages.make_pages(lookup, report_outline.DocumentEdition()))
    found = {(entry.kind, entry.title): entry for entry in entries}
    assert found["term", "SIL"].refs[0] == "term:SIL"
    assert found["property", "Safety integrity level"].refs[0] == "property:sil"
    assert "property:sil=1" in found["component", "Eye [1]"].keys
