"""ReqIF as it is written: sound XML that a library of others reads, the same bytes each time, whatever the texts hold."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from archgen.emit.reqif import render_reqif
from archgen.emit.reqif.reqif_writer import make_attribute, make_xhtml
from archgen.views.requirement_exchange import ExchangedRequirement, RequirementExchange

NASTY = 'a "b" <script>&amp; \x00\x1b[31m ]]> \ud800 \u202e'


def make(name: str, *parents: str, text: str = "", kind: str = "") -> ExchangedRequirement:
    return ExchangedRequirement(
        name, f"Title of {name} {text}", text, kind, "must", text, text, ("t",), parents, ("UC-1",),
        (("use_case", "UC-1"), ("file", "a.py")), text, "open",
    )  # fmt: skip


def exchange(*requirements: ExchangedRequirement, tree: tuple[tuple[str, int], ...]) -> RequirementExchange:
    return RequirementExchange("robot", f"Robot {NASTY}", requirements, tree, (("UC-1", "Walks"),))


SMALL = exchange(
    make("R-1", text=NASTY, kind="safety"),
    make("R-2", "R-1"),
    make("R-3", "R-1", "R-2"),
    tree=(("R-1", 0), ("R-2", 1), ("R-3", 2), ("R-3", 1)),
)


def test_hostile_texts_stay_texts() -> None:
    data = render_reqif(SMALL)
    assert data == render_reqif(SMALL)
    root = ET.fromstring(data)  # noqa: S314 - our own file
    assert not [element for element in root.iter() if element.tag.endswith("script")]
    ids = [element.get("IDENTIFIER") for element in root.iter() if element.get("IDENTIFIER")]
    assert len(ids) == len(set(ids))
    assert [name for name in ids if not re.fullmatch(r"[A-Za-z_][\w.-]*", str(name))] == []
    references = {element.text for element in root.iter() if element.tag.endswith("-REF")}
    assert references - set(ids) == set()


def test_a_library_of_others_reads_it(tmp_path: Path) -> None:
    parser = pytest.importorskip("reqif.parser")
    file = tmp_path / "small.reqif"
    file.write_bytes(render_reqif(SMALL))
    bundle = parser.ReqIFParser.parse(str(file))
    (specification,) = bundle.core_content.req_if_content.specifications
    tree = [(each.spec_object, each.level) for each in bundle.iterate_specification_hierarchy(specification)]
    assert tree == [("requirement-R-1", 1), ("requirement-R-2", 2), ("requirement-R-3", 3), ("requirement-R-3", 2)]
    assert bundle.get_spec_object_by_ref("requirement-R-2").spec_object_type == "type-requirement"
    relations = bundle.core_content.req_if_content.spec_relations
    assert ("requirement-R-3", "requirement-R-2") in {(each.source, each.target) for each in relations}


@pytest.mark.parametrize(
    ("text", "xhtml"),
    [
        ("one\ntwo\n\n\nthree", "<xhtml:p>one<xhtml:br/>two</xhtml:p><xhtml:p>three</xhtml:p>"),
        ("a  b\n    c", "<xhtml:p>a\u00a0 b<xhtml:br/>\u00a0\u00a0\u00a0\u00a0c</xhtml:p>"),
        ("<b> & \x00", "<xhtml:p>&lt;b&gt; &amp; \ufffd</xhtml:p>"),
    ],
)
def test_text_becomes_paragraphs(text: str, xhtml: str) -> None:
    assert make_xhtml(text) == f"<xhtml:div>{xhtml}</xhtml:div>"


def test_attributes_are_one_line() -> None:
    assert make_attribute('a\n "b" <c>') == "a &quot;b&quot; &lt;c&gt;"
