"""The Word report as a whole: what judges say of it, and what a reader must find in it."""

from __future__ import annotations

import html
import io
import re
import subprocess
import sys
import zipfile
from itertools import pairwise
from pathlib import Path

import docx
import pytest

from archgen.emit.docx import write
from archgen.emit.picture import Picture
from archgen.views.shapes import Column, Facts, Figure, Markdown, Outline, Paragraph, Section, Table, Text
from tests.emit.docx import inspection, judges, sample
from tests.quiet_seconds import measure_quiet_seconds


def report(outline: Outline) -> bytes:
    return write(outline, sample.pictures(), chapter_files=sample.FILES.get)[0]


def document(data: bytes, part: str = "word/document.xml") -> str:
    return zipfile.ZipFile(io.BytesIO(data)).read(part).decode()


def words(xml: str) -> str:
    return re.sub(r"<[^>]+>", "", xml)


@pytest.mark.parametrize(
    "outline", [sample.outline(), sample.hostile(), Outline("Empty")], ids=["whole", "hostile", "empty"]
)
def test_no_judge_finds_a_fault(outline: Outline, tmp_path: Path) -> None:
    data = report(outline)
    assert inspection.faults(data) == []
    path = tmp_path / "report.docx"
    path.write_bytes(data)
    assert judges.validated(path) == []


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, list[str]]:
    """Write a long report; give it with the text of each page that LibreOffice makes of it."""
    path = tmp_path_factory.mktemp("printed") / "report.docx"
    path.write_bytes(report(sample.outline(5, 5)))
    return path.read_bytes(), judges.pages(path)


@pytest.mark.slow
def test_contents_show_the_pages_where_the_headings_are(printed: tuple[bytes, list[str]]) -> None:
    _, pages = printed
    assert len(pages) > 20
    front = "\n".join(pages[1:5])
    shown = dict(re.findall(r"^ *([0-9A-Z][0-9.]* .+?)\.{3,} *(\d+)$", front, re.MULTILINE))
    assert len(shown) == 36
    for heading, page in shown.items():
        pattern = r"^\s*" + r"\s+".join(re.escape(word) for word in heading.split()) + r"\s*$"
        found = [number for number, text in enumerate(pages, 1) if re.search(pattern, text, re.MULTILINE)]
        assert int(page) in found, f"{heading} is said to be on page {page} and stands on {found}"


@pytest.mark.slow
def test_stored_page_numbers_are_close_to_the_real_ones(printed: tuple[bytes, list[str]]) -> None:
    data, pages = printed
    stored = [int(page) for page in re.findall(r"PAGEREF .*?<w:t [^>]*>(\d+)</w:t>", document(data))]
    shown = [int(page) for text in pages for page in re.findall(r"\.{4,} *(\d+) *$", text, re.MULTILINE)]
    assert len(stored) == len(shown)
    # LibreOffice may have other fonts than Word, and Word other rules than LibreOffice: equal is not to be had.
    assert max(abs(one - other) for one, other in zip(stored, shown, strict=True)) <= 3


def test_the_same_report_is_the_same_bytes() -> None:
    one, two = report(sample.outline(1, 1)), report(sample.outline(1, 1))
    assert one == two
    assert {item.date_time for item in zipfile.ZipFile(io.BytesIO(one)).infolist()} == {(1980, 1, 1, 0, 0, 0)}


@pytest.mark.slow
def test_a_large_report_is_written_in_time() -> None:
    outline, pictures = sample.outline(14, 10), sample.pictures()
    assert measure_quiet_seconds(lambda: write(outline, pictures, chapter_files=sample.FILES.get)) < 1.5


@pytest.mark.slow
def test_a_table_of_thousands_of_rows_is_written_in_time() -> None:
    rows = tuple(tuple((Text(f"row {row}, cell {cell}"),) for cell in range(6)) for row in range(4000))
    table = Table("t", "Many", tuple(Column(f"Column {n}") for n in range(6)), rows)
    written: list[str] = []
    outline = Outline("T", sections=(Section("a", "A", (table,)),))
    # 12 s where lxml moves the rows from one tree into another.
    assert measure_quiet_seconds(lambda: written.append(document(report(outline)))) < 3
    (xml,) = written
    assert xml.count("<w:tr>") == 4001


def test_blanks_between_runs_stay() -> None:
    xml = document(
        report(
            Outline(
                "T", sections=(Section("a", "A", (Paragraph((Text("one"), Text(" "), Text("two", strong=True))),)),)
            )
        )
    )
    assert '<w:t xml:space="preserve">one</w:t></w:r><w:r><w:t xml:space="preserve"> </w:t></w:r>' in xml


def test_properties_say_what_the_report_is_and_nothing_of_python_docx() -> None:
    properties = docx.Document(
        io.BytesIO(report(Outline("A title\x07\nin lines " + "x" * 300, "Sub", language="de")))
    ).core_properties
    assert properties.title == ("A title\ufffd in lines " + "x" * 300)[:255]
    assert (properties.subject, properties.language) == ("Sub", "de")
    assert (properties.author, properties.last_modified_by, properties.modified) == ("", "", None)


def test_only_a_word_file_needs_python_docx(tmp_path: Path) -> None:
    project = tmp_path / "p"
    project.mkdir()
    (project / "archgen.yaml").write_text("archgen: 1\n")
    code = (
        "import sys, archgen\n"
        "from archgen.__main__ import main\n"
        "for arguments in (['--help'], ['check', sys.argv[1]], ['report', '--help']):\n"
        "    sys.argv = ['archgen', *arguments]\n"
        "    try: main()\n"
        "    except SystemExit: pass\n"
        "assert 'docx' not in sys.modules\n"
    )
    code = code.replace("sys.argv[1]", repr(str(project)))
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)  # noqa: S603 - this program
    assert run.returncode == 0, run.stderr
    assert "--help" in run.stdout


def test_headings_are_numbered_and_appendices_lettered() -> None:
    outline = Outline(
        "T",
        sections=(
            Section("a", "First", sections=(Section("b", "Below"), Section("c", "Again"))),
            Section("d", "Second", (Markdown("# From a chapter", shift=1),)),
            Section("e", "Extra", sections=(Section("f", "Inside"),), appendix=True),
        ),
    )
    entries = re.findall(r'w:history="1">(.*?)<w:r><w:tab/>', document(report(outline)))
    assert [words(entry) for entry in entries] == [
        "1  First", "1.1  Below", "1.2  Again", "2  Second", "2.1  From a chapter", "A  Extra", "A.1  Inside",
    ]  # fmt: skip


def test_references_lead_to_bookmarks_or_stay_text() -> None:
    inlines = (
        Text("there", ref="b"),
        Text("nowhere", ref="gone"),
        Text("out", url="https://example.org/?a=1&b=2"),
        Text("trap", url="javascript:x"),
    )
    outline = Outline("T", sections=(Section("a", "A", (Paragraph(inlines),)), Section("b", "B")))
    data = report(outline)
    body = document(data).partition("PAGEREF")[2]
    assert len(re.findall(r"<w:hyperlink [^>]*>(?:(?!</w:hyperlink>).)*there", body)) == 1
    assert re.search(r"<w:r><w:t [^>]*>nowhere</w:t></w:r><w:hyperlink r:id=", body)
    assert re.search(r"<w:r><w:t [^>]*>trap</w:t></w:r>", body)
    assert 'Target="https://example.org/?a=1&amp;b=2" TargetMode="External"' in document(
        data, "word/_rels/document.xml.rels"
    )


def test_captions_are_fields_and_stand_in_their_lists() -> None:
    tables = [Table(name, name, (Column("a"),), (((Text("x"),),),)) for name in ("Ports", "Nodes")]
    figures = [Figure(name, "small", name, "alt") for name in ("Picture", "Other")]
    xml = document(report(Outline("T", sections=(Section("a", "A", (*figures, *tables)),))))
    assert [words(found) for found in re.findall(r'w:history="1">(.*?)<w:r><w:tab/>', xml)] == [
        "1  A",
        "Figure 1: Picture",
        "Figure 2: Other",
        "Table 1: Ports",
        "Table 2: Nodes",
    ]
    assert re.findall(r" (SEQ \w+ \\\* ARABIC) ", xml) == 2 * ["SEQ Figure \\* ARABIC"] + 2 * ["SEQ Table \\* ARABIC"]
    codes = [html.unescape(code).strip() for code in re.findall(r"> (TOC [^<]*)<", xml)]
    assert codes == ['TOC \\o "1-3" \\h \\z \\u', 'TOC \\h \\z \\c "Figure"', 'TOC \\h \\z \\c "Table"']


def test_a_single_figure_or_table_needs_no_list() -> None:
    table = Table("t", "Ports", (Column("a"),), (((Text("x"),),),))
    xml = document(report(Outline("T", sections=(Section("a", "A", (Figure("f", "small", "Picture", "alt"), table)),))))
    assert [html.unescape(code).strip() for code in re.findall(r"> (TOC [^<]*)<", xml)] == ['TOC \\o "1-3" \\h \\z \\u']


def test_neither_the_first_nor_the_last_row_of_a_table_is_alone_on_a_page() -> None:
    table = Table("t", "Ports", (Column("a"),), tuple(((Text(f"row {row}"),),) for row in range(40)), numbered=False)
    xml = document(report(Outline("T", sections=(Section("a", "A", (table,)),))))
    rows = [row for row in re.findall(r"<w:tr>.*?</w:tr>", xml) if "row " in row]
    assert [index for index, row in enumerate(rows) if "<w:keepNext/>" in row] == [0, 38]


def test_what_opens_a_section_stays_with_the_title_behind_it() -> None:
    """A heading and its sentence are not left alone where the title and table behind them go to the next page."""
    table = Table("t", "Ports", (Column("a"),), tuple(((Text(f"row {row}"),),) for row in range(40)), numbered=False)
    opening, title, later = (
        Paragraph((Text(each, strong=each == "Gives"),)) for each in ("It opens.", "Gives", "Later.")
    )
    for blocks, kept in (
        ((opening, title, table), True),
        ((table, opening, title, table), False),
        ((opening, later), False),
    ):
        xml = document(report(Outline("T", sections=(Section("a", "A", blocks),))))
        (paragraph,) = (each for each in re.findall(r"<w:p>(?:(?!</w:p>).)*</w:p>", xml) if "It opens." in each)
        assert ("<w:keepNext/>" in paragraph) == kept


def test_a_table_of_facts_stays_on_one_page() -> None:
    facts = Facts(tuple((f"fact {row}", (Text(f"value {row}"),)) for row in range(12)))
    xml = document(report(Outline("T", sections=(Section("a", "A", (facts,)),))))
    rows = [row for row in re.findall(r"<w:tr>.*?</w:tr>", xml) if "value " in row]
    assert ["<w:keepNext/>" in row for row in rows] == 11 * [True] + [False]


def test_wide_things_turn_the_page_and_back() -> None:
    xml = document(report(sample.outline(1, 1)))
    sizes = re.findall(r'<w:pgSz w:w="(\d+)" w:h="(\d+)"', xml)
    a4, turned, a3 = ("11906", "16838"), ("16838", "11906"), ("23812", "16838")
    assert turned in sizes
    assert sizes[0] == a4
    assert a4 in sizes[sizes.index(a3) :]
    assert a3 in sizes
    assert all(one != other or one == a4 for one, other in pairwise(sizes))


def test_tables_repeat_their_header_and_keep_rows_whole() -> None:
    rows = tuple(((Text(f"row {n}"),),) for n in range(50))
    xml = document(report(Outline("T", sections=(Section("a", "A", (Table("t", "Many", (Column("Name"),), rows),)),))))
    table = xml[xml.index("<w:tbl>") :]
    assert table.count("<w:tr>") == 51
    assert table.count("<w:cantSplit/>") == 51
    assert table.count("<w:tblHeader/>") == 1
    assert table.index("<w:tblHeader/>") < table.index("Name") < table.index("row 0")


def test_pictures_are_sharp_and_described() -> None:
    data = report(Outline("T", sections=(Section("a", "A", (Figure("f", "small", "Picture", "A camera & more"),)),)))
    xml = document(data)
    assert 'descr="A camera &amp; more"' in xml
    assert "asvg:svgBlip" in xml
    names = [name for name in zipfile.ZipFile(io.BytesIO(data)).namelist() if "media" in name]
    assert names == ["word/media/archgen1.png", "word/media/archgen2.svg"]


def test_a_row_that_others_refer_to_has_a_bookmark() -> None:
    table = Table("t", "Requirements", (Column("id"),), (((Text("R-12"),),),), row_anchors=("requirement:R-12",))
    outline = Outline(
        "T", sections=(Section("a", "A", (Paragraph((Text("see R-12", ref="requirement:R-12"),)), table)),)
    )
    data = report(outline)
    assert inspection.faults(data) == []
    assert re.search(
        r"<w:hyperlink w:anchor=\"_ag\w+\"[^>]*><w:r><w:rPr><w:rStyle w:val=\"Hyperlink\"/></w:rPr><w:t [^>]*>see R</w:t><w:noBreakHyphen/><w:t [^>]*>12",
        document(data),
    )


@pytest.mark.parametrize(
    ("width", "height", "paper", "type_size"),
    [
        (300, 100, "A4", 9.0),
        (555, 300, "A4", 7.4),
        (565, 300, "A4", 8.5),
        (655, 300, "A4", 7.4),
        (665, 300, "A4 turned", 9.0),
        (780, 300, "A4 turned", 8.1),
        (1100, 200, "A3 turned", 8.6),
        (600, 1100, "A3", 8.1),
        (200, 900, "A3", 9.0),
    ],
)
def test_a_picture_gets_the_paper_on_which_it_can_be_read(
    width: int, height: int, paper: str, type_size: float
) -> None:
    picture = Picture("p", width, height, png=sample.png(2, 2))
    outline = Outline("T", sections=(Section("a", "A", (Figure("f", "p", "Picture", "alt"),)),))
    xml = document(write(outline, {"p": picture}, chapter_files=sample.FILES.get)[0])
    papers = {"11906": "A4", "16838": "A4 turned" if 'w:w="16838" w:h="11906"' in xml else "A3", "23812": "A3 turned"}
    assert papers[re.findall(r'<w:pgSz w:w="(\d+)"', xml)[-1]] == paper
    shown = int(re.findall(r'<wp:extent cx="(\d+)"', xml)[0]) / 12700
    assert round(9 * shown / width, 1) == type_size
    # What is a little too wide for the text reaches over both margins alike.
    over = re.findall(r'<w:ind w:left="-(\d+)" w:right="-\1"/>', xml)
    assert [round(int(each) / 10) for each in over] == ([round(shown - 453.6)] if paper == "A4" and shown > 454 else [])


def test_a_picture_that_no_paper_shows_legibly_is_left_out() -> None:
    picture = Picture("p", 1400, 1000, png=sample.png(2, 2))
    outline = Outline("T", sections=(Section("a", "A", (Figure("f", "p", "Picture", "Three boxes."),)),))
    xml = document(write(outline, {"p": picture}, chapter_files=sample.FILES.get)[0])
    assert "<wp:extent" not in xml
    assert "This picture is too large to be read on paper; the site has it. Three boxes." in xml
