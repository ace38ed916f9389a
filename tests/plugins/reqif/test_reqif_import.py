"""ReqIF as Doors writes it becomes requirements, and every object is accounted for; bad files get clear words."""

from __future__ import annotations

import io
import tracemalloc
import zipfile
from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignFileError, ImportedRequirements
from archgen.plugins.reqif import reqif_files as files_module
from archgen.plugins.reqif.reqif_files import XhtmlText, read_reqif_file
from archgen.plugins.reqif.reqif_import import (
    fold_attribute_name,
    is_requirement_id,
    make_distinct_id,
    make_requirement_id,
    read_requirements,
)
from tests.quiet_seconds import measure_quiet_seconds

DOORS = Path(__file__).parent / "doors.reqif"


def take(path: Path) -> ImportedRequirements:
    return read_requirements(path, ())


def test_a_file_of_doors_becomes_requirements_in_the_order_of_its_specifications() -> None:
    assert take(DOORS).requirements == {
        "R-2": {
            "title": "The robot stops in time.",
            "priority": "Must_have",
            "hints": {"reqif": {"identifier": "_2", "id": "2"}},
            "source": "System, Driving",
        },
        "Bremse-4": {
            "title": "It brakes hard.",
            "description": "It brakes **hard**.\n\n- on tiles\n- on carpet <b> & mats",
            "hints": {"reqif": {"identifier": "_4", "id": "Bremse 4"}},
            "parent": ["Hoehe-3", "R-2"],
            "source": "System, Driving",
        },
        "Hoehe-3": {
            "title": "Door sills",
            "description": "It drives over sills.\n\nSee (picture sill.png)",
            "hints": {"reqif": {"identifier": "_3", "id": "Höhe 3"}},
            "source": "Mechanics",
        },
    }


def test_every_object_attribute_and_relation_is_accounted_for() -> None:
    taken = take(DOORS)
    assert [(each.fate, each.name, each.id, each.reason) for each in taken.accounts] == [
        ("left out", "1 Driving", "", "a heading"),
        ("taken", "2", "R-2", "`2` is no id here"),
        ("taken", "Bremse 4", "Bremse-4", "`Bremse 4` is no id here"),
        ("taken", "Höhe 3", "Hoehe-3", "`Höhe 3` is no id here"),
        ("not taken", "_5", "", "it has no text"),
        ("left out", "_6", "", "it is marked as deleted"),
        ("not taken", "_2", "", "another object has its identifier"),
    ]
    assert taken.accounts[1].place == "doors.reqif:36"
    assert (dict(taken.unread_attributes), dict(taken.unread_relations)) == (
        {"Review status": 1},
        {"conflicts with": 1},
    )


def test_a_zip_file_holds_several(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "all.reqifz", "w") as archive:
        archive.writestr("a/doors.reqif", DOORS.read_bytes())
        archive.writestr("files/sill.png", b"picture")
    taken = take(tmp_path / "all.reqifz")
    assert list(taken.requirements) == ["R-2", "Bremse-4", "Hoehe-3"]
    assert taken.accounts[0].place == "all.reqifz [a/doors.reqif]:31"


def zipped(name: str, content: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, content)
    return stream.getvalue()


BOMB = b'<!DOCTYPE a [<!ENTITY x "ha"><!ENTITY y "&x;&x;&x;">]>\n<REQ-IF>&y;</REQ-IF>'


@pytest.mark.parametrize(
    ("content", "place", "words"),
    [
        (b"", "1:1", "it is empty, or no XML: there is no element in it"),
        (DOORS.read_bytes()[:5000], "52:9", "only the first part of a file is there"),
        (b"<html><body/></html>", "1:1", "its outermost element is `html`, not `REQ-IF`"),
        (b"<REQ-IF>\n<a></b></REQ-IF>", "2:6", "this is not XML as it should be (mismatched tag)"),
        (b"<REQ-IF>\xff</REQ-IF>", "1:9", "this is not XML as it should be"),
        (
            b'<?xml version="1.0" encoding="klingon"?><REQ-IF/>',
            "1:31",
            "its encoding cannot be read (unknown encoding: klingon)",
        ),
        (BOMB, "1:13", "it declares a document type or entities"),
        (b'<!DOCTYPE REQ-IF SYSTEM "file:///etc/passwd"><REQ-IF/>', "1:45", "it declares a document type"),
        (b"PK\x03\x04 and no more", "1:1", "the zip file is damaged"),
        (zipped("readme.txt", b"text"), "1:1", "there is no .reqif file in it"),
        (zipped("../../a.reqif", BOMB), "1:13", "it declares a document type or entities"),
    ],
)
def test_what_is_no_reqif_is_told_with_its_place(content: bytes, place: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "bad.reqif").write_bytes(content)
    with pytest.raises(ForeignFileError) as caught:
        read_reqif_file(tmp_path / "bad.reqif")
    assert caught.value.message.startswith(words)
    assert f"{caught.value.span.line}:{caught.value.span.column}" == place
    assert caught.value.help_line
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.reqif"]


def test_what_unpacks_to_too_much_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files_module, "MAX_BYTES", 2_000_000)
    (tmp_path / "big.reqifz").write_bytes(zipped("big.reqif", b"<REQ-IF>" + b" " * 5_000_000 + b"</REQ-IF>"))
    with pytest.raises(ForeignFileError, match="it is larger than 2 MB"):
        read_reqif_file(tmp_path / "big.reqifz")


@pytest.mark.parametrize(
    ("foreign", "prefix", "identifier", "made"),
    [
        ("SRS-12", "", "_x", "SRS-12"),
        ("12", "", "_x", "R-12"),
        ("12", "SRS-", "_x", "SRS-12"),
        ("SRS-12", "SRS-", "_x", "SRS-12"),
        ("Höhe 3 / b", "", "_x", "Hoehe-3-b"),
        ("", "", "_1a2b", "R-1a2b"),
        ("Σ", "", "_x", make_requirement_id("Σ", "", "")),
        ("a" * 70, "", "_x", "a" * 55 + "-77a1a6d0"),
    ],
)
def test_ids_are_made_stably(foreign: str, prefix: str, identifier: str, made: str) -> None:
    made_id = make_requirement_id(foreign, prefix, identifier)
    assert is_requirement_id(made_id)
    assert made_id[:55] == made[:55]
    assert made_id == make_requirement_id(foreign, prefix, identifier)
    assert is_requirement_id(make_distinct_id(made_id, identifier))
    assert make_distinct_id(made_id, "_x") != make_distinct_id(made_id, "_y")


def test_names_of_attributes_are_folded() -> None:
    names = ("ReqIF.ForeignID", "reqif.foreignid", "Object Text", "ReqIF")
    assert [fold_attribute_name(name) for name in names] == ["foreignid", "foreignid", "objecttext", "reqif"]


def test_lists_tables_and_breaks_become_text() -> None:
    text = XhtmlText()
    for name in ("ol", "li"):
        text.start(name, {})
    text.add("one")
    text.start("ul", {})
    text.start("li", {})
    text.add("inner\n   line")
    for name in ("li", "ul", "li"):
        text.end(name)
    text.start("li", {})
    text.add("two")
    text.end("ol")
    text.start("tr", {})
    for cell in ("a", "b"):
        text.start("td", {})
        text.add(cell)
        text.end("td")
    text.start("br", {})
    text.start("em", {})
    text.add("end")
    text.end("em")
    assert text.finish() == "1. one\n  - inner line\n2. two\n\na | b\n*end*"


@pytest.mark.parametrize("name", ["script", "style"])
def test_what_is_never_shown_is_no_text(name: str) -> None:
    text = XhtmlText()
    text.add("It stops")
    text.start(name, {})
    text.add("alert(1)")
    text.end(name)
    text.add(" in time.")
    assert text.finish() == "It stops in time."


def write_large(path: Path, size: int) -> int:
    text = DOORS.read_text(encoding="utf-8")
    start, end = (
        text.index('      <rq:SPEC-OBJECT IDENTIFIER="_2">'),
        text.index('      <rq:SPEC-OBJECT IDENTIFIER="_3">'),
    )
    one, place = (
        text[start:end].replace("in time.", "in time. " + "On tiles, on carpets and at night. " * 20),
        text.index("<rq:SPEC-OBJECTS>") + len("<rq:SPEC-OBJECTS>"),
    )
    count = size // len(one)
    many = (one.replace('"_2"', f'"_o{n}"').replace('THE-VALUE="2"', f'THE-VALUE="n{n}"') for n in range(count))
    path.write_text(text[:place] + "".join(many) + text[place:], encoding="utf-8")
    return count


def test_a_large_file_is_read_in_time_and_memory_in_proportion(tmp_path: Path) -> None:
    count = write_large(tmp_path / "large.reqif", 5_000_000)
    taken: list[int] = []
    assert measure_quiet_seconds(lambda: taken.append(len(take(tmp_path / "large.reqif").requirements))) < 3
    assert taken == [count + 3]
    tracemalloc.start()
    read_reqif_file(tmp_path / "large.reqif")
    assert tracemalloc.get_traced_memory()[1] < 25_000_000
    tracemalloc.stop()


def test_a_tree_of_ten_thousand_levels_is_read(tmp_path: Path) -> None:
    objects = "".join(
        f'<SPEC-OBJECT IDENTIFIER="o{n}"><VALUES><ATTRIBUTE-VALUE-STRING THE-VALUE="T{n}"><DEFINITION>'
        "<ATTRIBUTE-DEFINITION-STRING-REF>a</ATTRIBUTE-DEFINITION-STRING-REF></DEFINITION></ATTRIBUTE-VALUE-STRING></VALUES></SPEC-OBJECT>"
        for n in range(10_000)
    )
    opened = "".join(
        f"<SPEC-HIERARCHY><OBJECT><SPEC-OBJECT-REF>o{n}</SPEC-OBJECT-REF></OBJECT><CHILDREN>" for n in range(10_000)
    )
    closed = "</CHILDREN></SPEC-HIERARCHY>" * 10_000
    named = '<ATTRIBUTE-DEFINITION-STRING IDENTIFIER="a" LONG-NAME="ReqIF.Name"/>'
    (tmp_path / "deep.reqif").write_text(
        f"<REQ-IF>{named}{objects}<SPECIFICATION>{opened}{closed}</SPECIFICATION></REQ-IF>", encoding="utf-8"
    )
    taken = take(tmp_path / "deep.reqif").requirements
    assert taken["o9999"] == {"title": "T9999", "hints": {"reqif": {"identifier": "o9999"}}, "parent": ["o9998"]}
