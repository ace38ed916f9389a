"""Files that are no models, or models that contradict themselves: a clear word, in bounded time."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignFileError
from archgen.plugins.xmi.xmi_import import read_xmi
from tests.plugins.xmi.uml_models import merge_sections, read_model, tell_notes, write_model


def refuse(file: Path) -> str:
    with pytest.raises(ForeignFileError) as caught:
        read_xmi([file])
    assert caught.value.help_line
    return caught.value.message


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "it is empty, or no XML: there is no element in it"),
        (b"archgen: 1", "this is not XML as it should be (syntax error)"),
        (b"<html/>", "there is no UML model in it: its outermost element is `html`"),
        (
            b'<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;">]><x>&b;</x>',
            "it declares a document type or entities, which archgen does not follow",
        ),
        (
            b'<!DOCTYPE x SYSTEM "file:///etc/passwd"><x/>',
            "it declares a document type or entities, which archgen does not follow",
        ),
        (
            b'<XMI xmi.version="1.2"><XMI.content/></XMI>',
            "it is XMI 1.2 (UML 1), as ArgoUML writes it; archgen reads XMI 2 (UML 2)",
        ),
        (
            write_model('<packagedElement xmi:type="uml:Class" xmi:id="a" name="a"/>').encode()[:-30],
            "only the first part of a file is there: it ends before its elements do",
        ),
        (
            b'<?xml version="1.0" encoding="no-such"?><a/>',
            "its encoding cannot be read (unknown encoding: no-such)",
        ),
        (
            b'<?xml version="1.0" encoding="UTF-8"?>' + write_model("<a name='\xe4'/>").encode("latin-1"),
            "this is not XML as it should be (not well-formed (invalid token))",
        ),
    ],
)
def test_what_is_no_model_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    file = tmp_path / "lab.xmi"
    file.write_bytes(content)
    told = refuse(file)
    assert told == message or (message.startswith("its encoding") and told.startswith("its encoding cannot be read"))


def test_windows_1252_is_read_as_enterprise_architect_writes_it(tmp_path: Path) -> None:
    file = tmp_path / "lab.xmi"
    model = write_model('<packagedElement xmi:type="uml:Class" xmi:id="a" name="Höhe (Maß)"/>')
    file.write_bytes(b'<?xml version="1.0" encoding="windows-1252"?>' + model.encode("windows-1252"))
    assert merge_sections(read_xmi([file]))["component_types"] == {
        "hoehe_mass": {"title": "Höhe (Maß)", "hints": {"uml": {"id": "a"}}}
    }


def test_archives_hold_models(tmp_path: Path) -> None:
    file = tmp_path / "lab.mdzip"
    model = write_model('<packagedElement xmi:type="uml:Class" xmi:id="a" name="a"/>')
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("com.nomagic.magicdraw.uml_model.model", model)
        archive.writestr("../../outside.txt", "x")
    assert list(merge_sections(read_xmi([file]))["component_types"]) == ["a"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["lab.mdzip"]


def test_archives_without_a_model_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "lab.zargo"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("lab.argo", "x")
    assert refuse(file) == "there is no UML model in this archive"
    file.write_bytes(file.read_bytes()[:40])
    assert refuse(file).startswith("the zip file is damaged")


def test_an_archive_of_argouml_is_refused_in_words(tmp_path: Path) -> None:
    file = tmp_path / "lab.zargo"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("lab.xmi", '<XMI xmi.version="1.2"/>')
    assert refuse(file).startswith("it is XMI 1.2 (UML 1)")


def test_large_files_and_archives_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "lab.xmi"
    with file.open("wb") as stream:
        stream.truncate(65_000_000)
    assert refuse(file) == "it is larger than 64 MB"
    archive_file = tmp_path / "lab.mdzip"
    with zipfile.ZipFile(archive_file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("bomb.xmi", b"\0" * 65_000_000)
    assert archive_file.stat().st_size < 1_000_000
    assert refuse(archive_file) == "it is larger than 4 MB"


def make_classes(generals: dict[str, str]) -> str:
    return "\n".join(
        f'<packagedElement xmi:type="uml:Class" xmi:id="{name}" name="{name}"><generalization xmi:id="g{name}" '
        f'general="{general}"/></packagedElement>'
        for name, general in generals.items()
    )


def test_circles_of_generalizations_are_cut(tmp_path: Path) -> None:
    imported = read_model(tmp_path, make_classes({"a": "b", "b": "c", "c": "a", "d": "d"}))
    types = merge_sections(imported)["component_types"]
    assert {name: each.get("is") for name, each in types.items()} == {"a": "b", "b": "c", "c": None, "d": None}
    assert [each for each in tell_notes(imported) if "itself" in each] == [
        f"{line} uml:Generalization not taken: the Class `{name}` would be made from itself: the generalizations go round "
        "in a circle"
        for line, name in ((4, "c"), (5, "d"))
    ]


def test_a_component_realized_by_what_is_made_from_it(tmp_path: Path) -> None:
    contents = (
        '<packagedElement xmi:type="uml:Component" xmi:id="c" name="c" isAbstract="true"><realization xmi:id="r" '
        'realizingClassifier="k"/></packagedElement>\n' + make_classes({"k": "c"})
    )
    types = merge_sections(read_model(tmp_path, contents))["component_types"]
    assert [name for name, each in types.items() if "is" in each] in (["c"], ["k"])


def test_a_part_does_not_contain_itself(tmp_path: Path) -> None:
    contents = "\n".join(
        f'<packagedElement xmi:type="uml:Class" xmi:id="{name}" name="{name}"><ownedAttribute xmi:type="uml:Port" '
        f'xmi:id="{name}port" name="x"/><ownedAttribute xmi:type="uml:Property" xmi:id="{name}part" name="inner" '
        f'aggregation="composite" type="{other}"/></packagedElement>'
        for name, other in (("a", "b"), ("b", "a"))
    )
    imported = read_model(tmp_path, contents)
    types = merge_sections(imported)["component_types"]
    assert [list(each.get("components", {})) for each in types.values()] == [["inner"], []]
    assert len([each for each in tell_notes(imported) if "the component type would contain itself" in each]) == 1


def test_ids_that_are_there_twice_mean_the_first(tmp_path: Path) -> None:
    contents = "\n".join(
        [
            '<packagedElement xmi:type="uml:Class" xmi:id="x" name="first"/>',
            '<packagedElement xmi:type="uml:Class" xmi:id="x" name="second"/>',
            make_classes({"k": "x"}),
        ]
    )
    imported = read_model(tmp_path, contents)
    assert merge_sections(imported)["component_types"]["k"]["is"] == "first"
    assert (
        "3 xmi:id noted: the Class `second` has the id of another element: references mean the first one of the two"
        in tell_notes(imported)
    )


def test_what_lies_in_other_files_is_noted_and_not_opened(tmp_path: Path) -> None:
    contents = (
        '<packagedElement xmi:type="uml:Class" xmi:id="k" name="k"><generalization xmi:id="g">'
        '<general xmi:type="uml:Class" href="file:///etc/passwd#_1"/></generalization></packagedElement>'
    )
    imported = read_model(tmp_path, contents)
    assert "is" not in merge_sections(imported)["component_types"]["k"]
    assert any(
        "is made from a class that is not among the classes of these files" in each for each in tell_notes(imported)
    )


def test_a_connector_into_a_file_that_is_not_given_says_so(tmp_path: Path) -> None:
    contents = (
        '<packagedElement xmi:type="uml:Component" xmi:id="k" name="k">'
        '<ownedAttribute xmi:type="uml:Port" xmi:id="p" name="p"/>'
        '<ownedConnector xmi:id="c" name="wire"><end xmi:id="e" role="p"/>'
        '<end xmi:id="f"><role xmi:type="uml:Port" href="drivers.uml#far_port"/></end></ownedConnector></packagedElement>'
    )
    notes = [each for each in read_model(tmp_path, contents).notes if each.kind == "uml:Connector"]
    assert [(each.message, each.help_line) for each in notes] == [
        (
            "the Connector `wire` is not taken: `far_port`, which it joins, lies in a file that is not among those that are read",
            "give that file, too",
        )
    ]


def test_several_files_refer_to_one_another(tmp_path: Path) -> None:
    base, robot = tmp_path / "base.uml", tmp_path / "robot.uml"
    base.write_text(write_model('<packagedElement xmi:type="uml:Class" xmi:id="b" name="base"/>'), encoding="utf-8")
    robot.write_text(
        write_model(
            '<packagedElement xmi:type="uml:Class" xmi:id="b" name="own"><generalization xmi:id="g">'
            '<general xmi:type="uml:Class" href="base.uml#b"/></generalization></packagedElement>'
        ),
        encoding="utf-8",
    )
    types = merge_sections(read_xmi([robot, base]))["component_types"]
    assert types["own"]["is"] == "base"


@pytest.mark.parametrize("step", [1, -1])
def test_classes_one_above_another_are_cut_where_the_language_ends(tmp_path: Path, step: int) -> None:
    classes = [
        f'<packagedElement xmi:type="uml:Component" xmi:id="k{number}" name="k{number}">'
        f'<generalization xmi:id="g{number}" general="k{number + 1}"/></packagedElement>'
        for number in range(200)
    ]
    imported = read_model(tmp_path, "\n".join(classes[::step]))
    types = merge_sections(imported)["component_types"]
    longest = 0
    for name in types:
        length, current = 0, name
        while "is" in types[current]:
            length, current = length + 1, types[current]["is"]
        longest = max(longest, length)
    assert longest == 49  # the lowest one of 50 is made from by nobody: a component, not a type
    cut = [each for each in tell_notes(imported) if "is made from a class that is made from a class" in each]
    assert 3 <= len(cut) <= 4
