"""Zip files with XML: what is damaged, too large or hostile is refused."""

from __future__ import annotations

import pytest

from archgen.plugins.tables import office_files
from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError
from tests.workbooks import zip_parts


# Names of their own: a zip file has the time in it, and with it in the tests' names no two processes have the same tests.
@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", zip_parts({"a": "b"})[:-10]], ids=["empty", "begun", "cut off"])
def test_a_damaged_file_is_refused(data: bytes) -> None:
    with pytest.raises(UnreadableOfficeFileError, match="the file is damaged"):
        OfficeFile(data)


def test_a_part_that_unpacks_to_too_much_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(office_files, "MAX_OFFICE_BYTES", 1000)
    with pytest.raises(UnreadableOfficeFileError, match="is too large"):
        OfficeFile(zip_parts({"bomb.xml": f"<a>{' ' * 100_000}</a>"})).read_part("bomb.xml")


def test_entities_are_not_resolved() -> None:
    text = '<!DOCTYPE a [<!ENTITY e SYSTEM "file:///etc/hostname">]><a>&e;</a>'
    root = OfficeFile(zip_parts({"a.xml": text})).read_part("a.xml")
    assert root is not None
    assert root.text is None


def test_a_part_that_is_not_there_is_none() -> None:
    assert OfficeFile(zip_parts({"a": "b"})).read_part("c") is None


def test_references_are_relative_to_the_part() -> None:
    relations = (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        '<Relationship Id="r1" Target="worksheets/a.xml"/><Relationship Id="r2" Target="/xl/b.xml"/>'
        '<Relationship Id="r3" Target="http://x.org" TargetMode="External"/></Relationships>'
    )
    file = OfficeFile(zip_parts({"xl/_rels/workbook.xml.rels": relations}))
    assert file.targets_of("xl/workbook.xml") == {"r1": "xl/worksheets/a.xml", "r2": "xl/b.xml"}
