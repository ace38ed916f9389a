"""Tables of a Word document: the XML of a table beside its cells."""

from __future__ import annotations

import pytest

from archgen.plugins.tables.office_files import OfficeFile, UnreadableOfficeFileError
from archgen.plugins.tables.word_tables import read_word_tables
from tests.workbooks import make_document, zip_parts


def _cell(content: str, properties: str = "") -> str:
    return f"<w:tc><w:tcPr>{properties}</w:tcPr><w:p><w:r>{content}</w:r></w:p></w:tc>"


def _table(*rows: str) -> str:
    return f"<w:tbl>{''.join(f'<w:tr>{row}</w:tr>' for row in rows)}</w:tbl>"


def _read(body: str) -> list[list[list[str]]]:
    return [
        [[f"{column}: {cell.text}" for column, cell in row.items()] for row in sheet.rows]
        for sheet in read_word_tables("d.docx", OfficeFile(make_document(body)))
    ]


def test_a_row_has_its_cells_by_column() -> None:
    wide = _cell("<w:t>a</w:t>", '<w:gridSpan w:val="2"/>')
    assert _read(_table(wide + _cell("<w:t>b</w:t>"), _cell("") + _cell("<w:t>c</w:t>"))) == [
        [["0: a", "2: b"], ["1: c"]]
    ]


def test_a_cell_merged_downwards_stands_in_each_row() -> None:
    first = _cell("<w:t>G</w:t>", '<w:vMerge w:val="restart"/>') + _cell("<w:t>a</w:t>")
    below = _cell("", "<w:vMerge/>") + _cell("<w:t>b</w:t>")
    assert _read(_table(first, below, below)) == [[["0: G", "1: a"], ["0: G", "1: b"], ["0: G", "1: b"]]]


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("<w:t>a</w:t><w:br/><w:t>b</w:t>", "a\nb"),
        ("<w:t>a</w:t></w:r></w:p><w:p><w:r><w:t>b</w:t>", "a\nb"),
        ("<w:delText>old</w:delText><w:t>new</w:t>", "new"),
        ('<w:t>new</w:t></w:r><w:moveFrom w:id="1"><w:r><w:t>old</w:t></w:r></w:moveFrom><w:r>', "new"),
    ],
)
def test_a_cell_has_the_text_that_is_shown(content: str, text: str) -> None:
    assert _read(_table(_cell(content))) == [[[f"0: {text}"]]]


def test_a_table_inside_a_cell_is_a_part_of_its_text() -> None:
    inner = f"<w:tc><w:p><w:r><w:t>a</w:t></w:r></w:p>{_table(_cell('<w:t>b</w:t>'))}<w:p/></w:tc>"
    assert _read(_table(inner)) == [[["0: a\nb"]]]


def test_a_table_below_another_is_a_table_of_its_own() -> None:
    assert _read(_table(_cell("<w:t>a</w:t>")) + "<w:p/>" + _table(_cell("<w:t>b</w:t>"))) == [[["0: a"]], [["0: b"]]]


def test_what_is_no_document_says_so() -> None:
    with pytest.raises(UnreadableOfficeFileError, match=r"it is no \.docx"):
        read_word_tables("d.docx", OfficeFile(zip_parts({"word/document.xml": "<x/>"})))
