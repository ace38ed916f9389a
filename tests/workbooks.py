"""Workbooks and documents for tests, from the XML of their parts."""

from __future__ import annotations

import io
import zipfile

MAIN = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_WORD = 'xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main"'


def zip_parts(parts: dict[str, str]) -> bytes:
    """Return a zip file of these parts."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    return stream.getvalue()


def make_workbook(
    sheets: dict[str, str],
    strings: str = "",
    styles: str = "",
    states: dict[str, str] | None = None,
    properties: str = "",
) -> bytes:
    """Return a workbook: the XML inside of each sheet, of the shared strings and of the styles."""
    entries = "".join(
        f'<sheet name="{name}" sheetId="{number}" r:id="r{number}" {(states or {}).get(name, "")}/>'
        for number, name in enumerate(sheets, 1)
    )
    relations = "".join(
        f'<Relationship Id="r{number}" Type="{_OFFICE}/worksheet" Target="worksheets/sheet{number}.xml"/>'
        for number in range(1, len(sheets) + 1)
    )
    return zip_parts(
        {
            "xl/workbook.xml": f'<workbook {MAIN} xmlns:r="{_OFFICE}">{properties}<sheets>{entries}</sheets></workbook>',
            "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{_RELATIONS}">{relations}</Relationships>',
            "xl/sharedStrings.xml": f"<sst {MAIN}>{strings}</sst>",
            "xl/styles.xml": f"<styleSheet {MAIN}>{styles}</styleSheet>",
        }
        | {
            f"xl/worksheets/sheet{n}.xml": f"<worksheet {MAIN}>{xml}</worksheet>"
            for n, xml in enumerate(sheets.values(), 1)
        }
    )


def make_document(body: str) -> bytes:
    """Return a document with this XML in its body."""
    return zip_parts({"word/document.xml": f"<w:document {_WORD}><w:body>{body}</w:body></w:document>"})
