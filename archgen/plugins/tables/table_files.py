"""Read the tables of a file, whatever its form: text with separators, a workbook, a document."""

from __future__ import annotations

from archgen.plugin.findings import Diagnostic
from archgen.plugin.importing import SourceTexts, Span
from archgen.plugins.tables import separated_text
from archgen.plugins.tables.column_headings import HeadingMap
from archgen.plugins.tables.table_cells import TableSheet, TableTooLargeError, make_error

_ZIP_MAGIC, _COMPOUND_MAGIC = b"PK\x03\x04", b"\xd0\xcf\x11\xe0"


def read_sheets(
    name: str, data: bytes, heading_map: HeadingMap, diagnostics: list[Diagnostic], sources: SourceTexts
) -> list[TableSheet]:
    """Return the tables of a file; none where it cannot be read, which is reported."""
    try:
        if data.startswith(_ZIP_MAGIC):
            return _read_office_file(name, data, diagnostics)
        if data.startswith(_COMPOUND_MAGIC):
            message = "this is a workbook or document of the old form, or one with a password"
            help_line = "save it as .xlsx, .docx or `CSV UTF-8`, without a password"
            diagnostics.append(make_error("syntax-error", message, Span.of_file(name), help_line))
            return []
        text, text_diagnostics = separated_text.decode_table(name, data)
        diagnostics.extend(text_diagnostics)
        sources.add_text(name, text)
        return [separated_text.read_text_table(name, text, heading_map, diagnostics)] if text else []
    except TableTooLargeError as error:
        diagnostics.append(error.diagnostic)
        return []


def _read_office_file(name: str, data: bytes, diagnostics: list[Diagnostic]) -> list[TableSheet]:
    # Imported here: reading XML takes time to load, and most tables are plain text.
    from archgen.plugins.tables import word_tables, workbook_sheets
    from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError

    try:
        office_file = OfficeFile(data)
        if "word/document.xml" in office_file.names:
            return word_tables.read_word_tables(name, office_file)
        if "xl/workbook.xml" in office_file.names:
            return workbook_sheets.read_workbook(name, office_file, diagnostics)
        reason = "it holds neither a workbook (.xlsx) nor a document (.docx)"
    except UnreadableOfficeFileError as error:
        reason = str(error)
    message = f"this file cannot be read: {reason}"
    diagnostics.append(
        make_error("syntax-error", message, Span.of_file(name), "save it as .xlsx, .docx or `CSV UTF-8`")
    )
    return []
