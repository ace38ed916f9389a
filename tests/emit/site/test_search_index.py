"""The index of the site's search: what it holds, in which order, and that it is plain data of small files."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.emit.site.page_links import SiteLinks
from archgen.emit.site.script_files import MAX_PART_BYTES, build_search_files
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.views.search import make_search_entries
from archgen.views.search.search_entry import SearchEntry

ROOT = Path(__file__).resolve().parents[3]
ROBOT = """\
archgen: 1
project: {id: r, title: Robot}
partners: {acme: {title: ACME, description: Makes *arms*}}
requirements: {R-1: {title: It sees, tags: [must]}}
hosts: {pc: {title: Base Computer, cores: 4}}
types: {Cloud: {message: sensor_msgs/msg/PointCloud2}}
chains: {c: {title: Seen, through: [sensing.camera, sensing.finder], deadline: 1 s}}
groups:
  sensing:
    title: Sensing
    owner: acme
    components:
      camera: {title: Camera, functionality: Sees **everything**, tags: [safety], outputs: {cloud: Cloud}}
      finder: {title: Finder, requirements: [R-1, Finds all], inputs: {scene: camera.cloud}}
nodes: {eye: {implements: [sensing.camera], host: pc, package: eye_pkg}}
"""


def entries_of(text: str, folder: Path) -> dict[str, list[SearchEntry]]:
    file = folder / "robot.yaml"
    file.write_text(text, encoding="utf-8")
    inputs = ProductInputs(pipeline.check_project(file), OutputOptions(revision="test"))
    by_kind: dict[str, list[SearchEntry]] = {}
    for entry in make_search_entries(inputs.views.lookup, inputs.pages):
        by_kind.setdefault(entry.kind, []).append(entry)
    return by_kind


def links_to(*anchors: str) -> SiteLinks:
    return SiteLinks({anchor: f"{anchor}.html" for anchor in anchors}, {}, {}, {})


def files_of(entries: Sequence[SearchEntry], *anchors: str) -> dict[str, str]:
    return {path: data.decode() for path, data in build_search_files(entries, links_to(*anchors))}


def arguments_of(script: str) -> list[object]:
    """Read the data that a script hands over: it must be a single call, and its arguments JSON."""
    call, _, rest = script.partition("(")
    assert call in {"archgenSearch.index", "archgenSearch.names", "archgenSearch.texts"}
    assert rest.endswith(");\n")
    return list(json.loads(f"[{rest[:-3]}]"))


@pytest.mark.parametrize(
    ("kind", "title", "line", "ref"),
    [
        ("component", "Camera", "Sensing · ACME", "component:sensing.camera"),
        ("group", "Sensing", "group of 2 components · ACME", "group:sensing"),
        ("node", "/eye", "Base Computer · implements Camera · ACME", "node:eye"),
        ("topic", "/sensing/camera/cloud", "sensor_msgs/msg/PointCloud2 · from eye · 1 reader", "topic:/sensing/camera/cloud"),
        ("type", "Cloud", "type · sensor_msgs/msg/PointCloud2", "type:Cloud"),
        ("message", "sensor_msgs/msg/PointCloud2", "message · 9 fields", "message:sensor_msgs/msg/PointCloud2"),
        ("field", "PointCloud2 · height", "uint32 · of sensor_msgs/msg/PointCloud2", "message:sensor_msgs/msg/PointCloud2"),
        ("field", "Header · stamp", "builtin_interfaces/msg/Time · of std_msgs/msg/Header", "message:std_msgs/msg/Header"),
        ("requirement", "R-1 It sees", "served by Finder", "requirement:R-1"),
        ("requirement", "Finds all", "of Finder, in its own words", "component:sensing.finder"),
        ("port", "Finder · scene", "input of Sensing · ACME", "table:inputs/sensing.finder"),
        ("connection", "Camera · cloud → Finder · scene", "connection · Cloud", "table:inputs/sensing.finder"),
        ("chain", "Seen", "chain of effect · deadline 1 s", "chain:c"),
        ("host", "Base Computer", "host · 4 cores", "host:pc"),
        ("partner", "ACME", "partner", "partner:acme"),
        ("page", "Connections", "", "page:connections"),
    ],
)  # fmt: skip
def test_everything_with_a_name_is_found(kind: str, title: str, line: str, ref: str, tmp_path: Path) -> None:
    found = [(entry.title, entry.line, entry.refs[0]) for entry in entries_of(ROBOT, tmp_path)[kind]]
    assert (title, line, ref) in found


def test_findings_lead_to_the_page_of_their_element(tmp_path: Path) -> None:
    titles = {entry.title: entry for entry in entries_of(ROBOT, tmp_path)["finding"]}
    finding = next(entry for title, entry in titles.items() if "camera" in title)
    assert finding.refs == ("findings:sensing.camera", "page:findings")
    assert finding.line.startswith(("warning", "note", "error"))


def test_selectors_and_texts_find_a_component(tmp_path: Path) -> None:
    camera = entries_of(ROBOT, tmp_path)["component"][0]
    assert camera.keys == ("sensing.camera", "owner:acme", "tag:safety")
    assert camera.text == "Sees everything"


def test_each_heading_of_a_chapter_has_its_own_text(tmp_path: Path) -> None:
    (tmp_path / "risks.md").write_text("# Risks\n\nFew.\n\n## Fire\n\nA *hot* battery.\n", encoding="utf-8")
    by_kind = entries_of(ROBOT + "report: {chapters: [risks.md]}\n", tmp_path)
    assert [(e.title, e.line, e.text) for e in by_kind["chapter"]] == [
        ("Risks", "chapter", "Few."),
        ("Fire", "chapter · Risks", "A hot battery."),
    ]


def test_what_leads_nowhere_is_left_out() -> None:
    entries = [SearchEntry("node", "a", "", ("node:a",)), SearchEntry("node", "b", "", ("gone", "node:b"))]
    files = files_of(entries, "node:b")
    assert arguments_of(files["assets/search/node-1.js"]) == ["node", "b\t\t", "node:b.html"]


def test_names_are_loaded_before_texts_and_one_kind_is_one_part() -> None:
    kinds = ("component", "message", "field", "message")
    entries = [SearchEntry(kind, kind, "", ("x",), (), "a text") for kind in kinds]
    files = files_of(entries, "x")
    (index,) = arguments_of(files["assets/search/index.js"])
    assert isinstance(index, dict)
    assert index["parts"] == [
        "component-1",
        "message-1",
        "field-1",
        "component-text-1",
        "message-text-1",
        "field-text-1",
    ]
    assert arguments_of(files["assets/search/message-1.js"])[1] == "message\t\t\nmessage\t\t"
    assert arguments_of(files["assets/search/message-text-1.js"]) == ["message", "0\ta text\n1\ta text"]


def test_an_address_is_written_once_for_rows_that_share_it() -> None:
    entries = [SearchEntry("port", name, "", (ref,)) for name, ref in (("a", "x"), ("b", "x"), ("c", "y"))]
    assert arguments_of(files_of(entries, "x", "y")["assets/search/port-1.js"])[2] == "x.html\n\ny.html"


def test_the_empty_box_gets_open_points_and_selectors() -> None:
    entries = [
        SearchEntry("finding", "Nobody reads it", "warning", ("x",), ("finding:unread-output",)),
        SearchEntry("component", "A", "", ("x",), ("g.a", "owner:acme", "tag:safety", "tag:other")),
    ]
    (index,) = arguments_of(files_of(entries, "x")["assets/search/index.js"])
    assert isinstance(index, dict)
    assert index["open"] == [["Nobody reads it", "warning", "finding", "x.html"]]
    assert index["examples"] == ["owner:acme", "tag:safety"]
    assert {"who", "reads", "the"} <= set(index["questionWords"])


def test_no_file_is_large_and_no_text_is_lost() -> None:
    words = " ".join(f"word{number}" for number in range(90_000))
    entries = [SearchEntry("chapter", "Long", "", ("x",), (), words)]
    entries += [SearchEntry("port", f"Port {number} " + "x" * 80, "", ("x",)) for number in range(12_000)]
    files = files_of(entries, "x")
    assert max(len(script.encode()) for script in files.values()) < 1.1 * MAX_PART_BYTES
    texts = [str(arguments_of(script)[1]) for path, script in files.items() if "chapter-text" in path]
    assert len(texts) > 1
    pieces = [line.partition("\t")[2] for text in texts for line in text.split("\n")]
    assert "".join(pieces) == words
    ports = [str(arguments_of(script)[1]) for path, script in files.items() if "/port-" in path]
    assert sum(text.count("\n") + 1 for text in ports) == 12_000


def test_hostile_texts_stay_data_on_one_line() -> None:
    hostile = "</script>\"');alert(1)//\n\t\u2028\u202e\x00\ud800 😀"
    files = files_of([SearchEntry("node", hostile, hostile, ("x",), (hostile,), hostile)], "x")
    shown = "</script>\"');alert(1)// \u202e\ufffd\ufffd 😀"
    assert arguments_of(files["assets/search/node-1.js"]) == ["node", f"{shown}\t{shown}\t{shown}", "x.html"]


def test_the_vendored_library_is_the_one_that_the_tool_names() -> None:
    sys.path.insert(0, str(ROOT / "tools"))
    import vendor_search

    assert vendor_search.list_changed_files() == []
    assert f"(v{vendor_search.VERSION})" in (vendor_search.FOLDER / "ufuzzy.js").read_text(encoding="utf-8")
