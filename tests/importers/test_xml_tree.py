"""Trees of XML files know their places; what is no XML, half of it or hostile is told in words."""

from __future__ import annotations

import pytest

from archgen.importers import foreign_files
from archgen.importers.foreign_files import MAX_DEPTH, parse_xml
from archgen.importers.foreign_import import ForeignFileError

MODEL = b"""<?xml version="1.0" encoding="UTF-8"?>
<xmi:XMI xmlns:xmi="http://www.omg.org/spec/XMI/20131001" xmlns="urn:none">
  <part xmi:id="a">one<inner/>two</part>
    <part xmi:id="b"><u:deep xmlns:u="urn:u"/></part>
</xmi:XMI>
"""


def test_elements_have_names_attributes_texts_and_places() -> None:
    root = parse_xml("model.xmi", MODEL)
    assert (root.prefix, root.tag, root.namespace) == ("xmi", "XMI", "http://www.omg.org/spec/XMI/20131001")
    first, second = root.find_all("part")
    assert (first.attributes, first.text, first.namespace) == ({"xmi:id": "a"}, "onetwo", "urn:none")
    assert str(second.span("model.xmi")) == "model.xmi:4:5"
    deep = second.find("deep")
    assert deep is not None
    assert deep.namespace == "urn:u"
    assert [element.tag for element in root.walk()] == ["XMI", "part", "inner", "part", "deep"]
    assert root.find("nothing") is None


def test_windows_encodings_are_read() -> None:
    text = '<?xml version="1.0" encoding="windows-1252"?><a name="Gr\u00f6\u00dfe"/>'
    assert parse_xml("ea.xml", text.encode("cp1252")).attributes == {"name": "Größe"}


@pytest.mark.parametrize(
    ("data", "message", "place"),
    [
        (b"", "it is empty, or no XML: there is no element in it", "1:1"),
        (b"<a>\n<b>", "only the first part of a file is there: it ends before its elements do", "2:4"),
        (b"<a>\n</b>", "this is not XML as it should be (mismatched tag)", "2:3"),
        (b"<!DOCTYPE a [<!ENTITY x 'y'>]><a>&x;</a>", "it declares a document type or entities", "1:13"),
        (b'<?xml version="1.0" encoding="klingon"?><a/>', "its encoding cannot be read", "1:31"),
        (b"<a>" * (MAX_DEPTH + 1), f"its elements nest deeper than {MAX_DEPTH}", "1:601"),
    ],
)
def test_what_cannot_be_read_is_told_with_its_place(data: bytes, message: str, place: str) -> None:
    with pytest.raises(ForeignFileError) as caught:
        parse_xml("model.xmi", data)
    assert caught.value.message.startswith(message)
    assert str(caught.value.span) == f"model.xmi:{place}"
    assert caught.value.help_line


def test_a_file_of_too_many_elements_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foreign_files, "MAX_ELEMENTS", 3)
    assert parse_xml("model.xmi", b"<a><b/><b/></a>").tag == "a"
    with pytest.raises(ForeignFileError, match="it has more than 3 elements"):
        parse_xml("model.xmi", b"<a><b/><b/><b/></a>")


def test_very_many_namespaces_in_one_place_are_refused() -> None:
    declared = " ".join(f'xmlns:n{number}="urn:{number}"' for number in range(foreign_files.MAX_NAMESPACES))
    with pytest.raises(ForeignFileError, match="more than 200 namespaces have names here") as caught:
        parse_xml("model.xmi", f"<a {declared}>\n<b/></a>".encode())
    assert (caught.value.span.line, caught.value.span.column) == (1, 1)
