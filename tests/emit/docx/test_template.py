"""A partner's template: its styles, cover, headers and paper are taken; what it lacks is added; what is no template is refused."""

from __future__ import annotations

import io
import itertools
import re
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import docx
import pytest
from docx.document import Document
from docx.oxml import OxmlElement
from docx.oxml.ns import qn
from docx.shared import Mm

from archgen.emit.docx import TemplateError, write
from archgen.views.shapes import Markdown, Outline, Section, Text
from tests.emit.docx import inspection, judges, sample
from tests.property_sizes import try_some

Change = Callable[[Document], None]


def saved(*changes: Change) -> bytes:
    """Make a template out of python-docx's own: real styles of Word, letter paper."""
    document = docx.Document()
    for change in changes:
        change(document)
    target = io.BytesIO()
    document.save(target)
    return target.getvalue()


def rewritten(data: bytes, part: str, old: str, new: str) -> bytes:
    source, target = zipfile.ZipFile(io.BytesIO(data)), io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        for name in source.namelist():
            content = source.read(name)
            if name == part:
                assert old.encode() in content
                content = content.replace(old.encode(), new.encode())
            archive.writestr(name, content)
    return target.getvalue()


def dotx(data: bytes) -> bytes:
    kind = "application/vnd.openxmlformats-officedocument.wordprocessingml."
    return rewritten(data, "[Content_Types].xml", f"{kind}document.main+xml", f"{kind}template.main+xml")


def a5(document: Document) -> None:
    section = document.sections[0]
    section.page_width, section.page_height = Mm(148), Mm(210)
    section.left_margin = section.right_margin = Mm(15)


def without_styles(document: Document) -> None:
    styles = document.styles
    for name in (
        "Caption",
        "Table Grid",
        "Title",
        "Subtitle",
        "List Bullet",
        "List Number",
        "Quote",
        "TOC Heading",
        "Heading 4",
    ):
        styles[name].delete()


def own_names(document: Document) -> None:
    """Headings and captions under names that Word does not know, found by outline level and by what captions are called."""
    for level in range(1, 10):
        style = document.styles[f"Heading {level}"]
        element = style.element
        element.find(qn("w:name")).set(qn("w:val"), f"Partner Kapitel {level}")
        element.set(qn("w:styleId"), f"Kapitel{level}")
    for item in document.styles.element.iter(qn("w:basedOn"), qn("w:next"), qn("w:link")):
        item.set(qn("w:val"), re.sub(r"^Heading(\d)$", r"Kapitel\1", item.get(qn("w:val"))))
    caption = document.styles["Caption"].element
    caption.find(qn("w:name")).set(qn("w:val"), "Partner Beschriftung")
    caption.set(qn("w:styleId"), "PBeschriftung")


def covered(document: Document) -> None:
    document.add_heading("ACME deliverable", 0)
    document.add_paragraph("{{title}}, version {{ Version }}, {{unheard of}}")
    document.add_table(1, 2)
    document.sections[0].header.paragraphs[0].text = "ACME confidential {{revision}}"
    document.add_paragraph("{{report}}")
    document.add_paragraph("The end of the deliverable")


def broken_paper(document: Document) -> None:
    document.sections[0].left_margin = Mm(400)


def numbered(document: Document) -> None:
    """Give the first heading a number in Roman letters, as the template's own."""
    numbering = document.part.numbering_part.element
    abstract, num = OxmlElement("w:abstractNum"), OxmlElement("w:num")
    abstract.set(qn("w:abstractNumId"), "77")
    level = OxmlElement("w:lvl")
    level.set(qn("w:ilvl"), "0")
    for name, value in (("w:numFmt", "upperRoman"), ("w:pStyle", "Heading1"), ("w:lvlText", "Part %1")):
        item = OxmlElement(name)
        item.set(qn("w:val"), value)
        level.append(item)
    abstract.append(level)
    numbering.insert(0, abstract)
    num.set(qn("w:numId"), "77")
    link = OxmlElement("w:abstractNumId")
    link.set(qn("w:val"), "77")
    num.append(link)
    numbering.append(num)
    properties = document.styles["Heading 1"].element.get_or_add_pPr()
    properties.get_or_add_numPr().get_or_add_numId().val = 77


def report(template: bytes, outline: Outline | None = None) -> tuple[bytes, tuple[str, ...]]:
    return write(outline or sample.outline(1, 2), sample.pictures(), template=template, chapter_files=sample.FILES.get)


def part(data: bytes, name: str = "word/document.xml") -> str:
    return zipfile.ZipFile(io.BytesIO(data)).read(name).decode()


TEMPLATES: dict[str, Callable[[], bytes]] = {
    "letter": saved,
    "a5": lambda: saved(a5),
    "own names": lambda: saved(own_names),
    "missing styles": lambda: saved(without_styles),
    "dotx": lambda: dotx(saved()),
    "cover": lambda: saved(covered),
    "numbered": lambda: saved(numbered),
    "broken paper": lambda: saved(broken_paper),
    "all at once": lambda: dotx(saved(a5, own_names, covered)),
}


@cache
def template_named(name: str) -> bytes:
    return TEMPLATES[name]()


_JUDGED_TOGETHER = {"a5", "own names", "dotx", "cover"}
"""What "all at once" has in it: Microsoft's judge, which takes seconds, sees it there."""


@pytest.mark.parametrize("name", try_some(TEMPLATES, 3))
def test_inspection_finds_no_fault(name: str) -> None:
    assert inspection.faults(report(template_named(name))[0]) == []


@pytest.mark.parametrize("name", try_some(sorted(TEMPLATES.keys() - _JUDGED_TOGETHER)))
def test_no_judge_finds_a_fault(name: str, tmp_path: Path) -> None:
    data, _ = report(template_named(name))
    path = tmp_path / "report.docx"
    path.write_bytes(data)
    assert judges.validated(path) == []


@pytest.mark.parametrize(
    ("name", "size", "width"),
    [("letter", (12240, 15840), 8640), ("a5", (8391, 11906), 6690), ("broken paper", (11906, 16838), 9072)],
)
def test_the_paper_decides_the_widths(name: str, size: tuple[int, int], width: int) -> None:
    xml = part(report(template_named(name))[0])
    assert f'<w:pgSz w:w="{size[0]}" w:h="{size[1]}"' in xml
    tables = [int(text) for text in re.findall(r'<w:tblW w:w="(\d+)" w:type="dxa"/>', xml)]
    assert tables
    assert min(abs(table - width) for table in tables) <= 4
    pictures = [int(text) / 635 for text in re.findall(r'<wp:extent cx="(\d+)"', xml)]
    assert max(pictures) <= max(2 * size[0], size[1])


def test_own_heading_and_caption_styles_are_used() -> None:
    xml = part(report(template_named("own names"))[0])
    assert '<w:pStyle w:val="Kapitel1"/>' in xml
    assert '<w:pStyle w:val="Kapitel2"/>' in xml
    assert '<w:pStyle w:val="PBeschriftung"/>' in xml
    assert "Heading1" not in xml


def test_missing_styles_are_added_and_named() -> None:
    data, warnings = report(template_named("missing styles"))
    said = next(warning for warning in warnings if "has no style" in warning)
    for name in (
        "Title",
        "Subtitle",
        "heading 4",
        "caption",
        "Table Grid",
        "TOC Heading",
        "toc 1",
        "table of figures",
        "Hyperlink",
    ):
        assert f"`{name}`" in said
    assert '<w:name w:val="table of figures"/>' in part(data, "word/styles.xml")


def test_cover_header_and_closing_words_stay_and_are_filled_in() -> None:
    data, warnings = report(template_named("cover"))
    xml = part(data)
    texts = re.findall(r"<w:t[ >][^<]*", xml)
    flat = "".join(text.partition(">")[2] for text in texts)
    assert (
        flat.index("ACME deliverable")
        < flat.index("Architecture of a robot that helps, version 1.0, ")
        < flat.index("Contents")
    )
    assert flat.endswith("The end of the deliverable")
    assert "{{" not in flat
    assert flat.count("Architecture of a robot that helps") == 1
    assert "ACME confidential 3f2a91c" in part(data, "word/header1.xml")
    assert (
        "the template asks for {{unheard of}} on its cover, which the report does not have: it stays empty" in warnings
    )


def test_contents_stand_where_the_cover_asks_for_them() -> None:
    def cover(document: Document) -> None:
        document.add_paragraph("Deliverable")
        document.add_paragraph("{{Contents}}")
        document.add_paragraph("End of the cover")
        document.sections[0].footer.paragraphs[0].text = "see {{contents}}"

    data, warnings = report(saved(cover), Outline("T", sections=(Section("a", "First"), Section("b", "Second"))))
    flat = "".join(text.partition(">")[2] for text in re.findall(r"<w:t[ >][^<]*", part(data)))
    assert flat.startswith("DeliverableContents1  First")
    assert flat.index("Second") < flat.index("End of the cover")
    assert flat.count("Contents") == 1
    (warning,) = [text for text in warnings if "contents" in text]
    assert warning.startswith(
        "the template asks for {{contents}} in a header or footer, which the report does not have"
    )
    assert warning.endswith("it stays empty (it goes into a paragraph of its own on the cover)")


def test_a_name_that_word_cut_into_runs_is_filled_in() -> None:
    def cut(document: Document) -> None:
        paragraph = document.add_paragraph("by {{ti")
        paragraph.add_run("tle}}")

    assert "by Architecture of a robot that helps" in part(report(saved(cut))[0])


def test_own_numbers_of_headings_stay() -> None:
    data, _ = report(template_named("numbered"), Outline("T", sections=(Section("a", "First"), Section("b", "Second"))))
    assert re.findall(r"(Part \w+)  \w+</w:t>", part(data)) == ["Part I", "Part II"]


def test_settings_that_ask_or_fetch_are_taken_out() -> None:
    def asking(document: Document) -> None:
        document.settings.element.insert(0, OxmlElement("w:updateFields"))

    assert "updateFields" not in part(report(saved(asking))[0], "word/settings.xml")


def test_a_cover_keeps_its_pictures() -> None:
    """A report from before as the template: pictures of both have the same names at first."""
    other = sample.png(7, 5)
    cover = write(
        Outline("T", sections=(Section("a", "A", (Markdown("![red](red.png)"),)),)),
        {},
        chapter_files=lambda _path: other,
    )[0]
    data, _ = report(cover)
    names = zipfile.ZipFile(io.BytesIO(data)).namelist()
    assert len(names) == len(set(names))
    pictures = [zipfile.ZipFile(io.BytesIO(data)).read(name) for name in names if name.startswith("word/media/")]
    assert other in pictures
    assert sample.FILES["docs/pictures/red.png"] in pictures
    shown = docx.Document(io.BytesIO(data))
    first = next(shown.element.iter(qn("a:blip"))).get(qn("r:embed"))
    assert shown.part.related_parts[first].blob == other


def test_relationships_that_lead_nowhere_do_no_harm() -> None:
    image = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/image"
    nowhere = f'<Relationship Id="gone" Type="{image}" Target="NULL"/>'
    header = "word/_rels/header1.xml.rels"
    template = rewritten(
        template_named("cover"), "word/_rels/document.xml.rels", "</Relationships>", f"{nowhere}</Relationships>"
    )
    source = zipfile.ZipFile(io.BytesIO(template))
    parts = {name: source.read(name).decode("latin-1") for name in source.namelist()}
    namespace = "http://schemas.openxmlformats.org/package/2006/relationships"
    parts[header] = f'<Relationships xmlns="{namespace}">{nowhere}</Relationships>'
    data, _ = report(packed(parts))
    assert inspection.faults(data) == []
    assert "NULL" not in part(data, "word/_rels/document.xml.rels")
    assert 'Target="NULL" TargetMode="External"' in part(data, header)


def test_sizes_as_google_docs_writes_them_are_read() -> None:
    template = rewritten(
        template_named("letter"), "word/document.xml", 'w:right="1800"', 'w:right="1440.0000000000002"'
    )
    tables = [int(text) for text in re.findall(r'<w:tblW w:w="(\d+)" w:type="dxa"/>', part(report(template)[0]))]
    assert min(abs(table - 9000) for table in tables) <= 4


def test_what_stands_twice_or_under_another_type_is_used_once() -> None:
    """The styles are related twice, and their content type is that of any XML."""
    styles = "application/vnd.openxmlformats-officedocument.wordprocessingml.styles+xml"
    relation = 'Type="http://schemas.openxmlformats.org/officeDocument/2006/relationships/styles"'
    again = f'<Relationship Id="again" {relation} Target="styles.xml"/></Relationships>'
    template = rewritten(
        template_named("letter"), "[Content_Types].xml", f'ContentType="{styles}"', 'ContentType="text/xml"'
    )
    template = rewritten(template, "word/_rels/document.xml.rels", "</Relationships>", again)
    data, warnings = report(template)
    assert inspection.faults(data) == []
    assert part(data, "word/_rels/document.xml.rels").count(relation) == 1
    assert warnings == report(template_named("letter"))[1]


def zipped(**parts: str) -> bytes:
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return target.getvalue()


def bomb() -> bytes:
    target = io.BytesIO()
    with (
        zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("word/document.xml", "w", force_zip64=True) as stream,
    ):
        for _ in range(210):
            stream.write(b"\0" * 1_000_000)
    return target.getvalue()


WORD = "application/vnd.openxmlformats-officedocument.wordprocessingml.document.main+xml"
MACROS = "application/vnd.ms-word.document.macroEnabled.main+xml"


@pytest.mark.parametrize(
    ("template", "message"),
    try_some([
        (lambda: b"", "the template is no Word file: it cannot be opened as a package (File is not a zip file)"),
        (lambda: b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"x" * 99, "protected with a password or is an old .doc"),
        (lambda: zipped(a="b"), "it is a zip file without `[Content_Types].xml`"),
        (lambda: saved()[:20_000], "the template is no Word file: it cannot be opened as a package"),
        (bomb, "unpacked it is larger than 200 MB"),
        (lambda: zipped(**{f"p{n}": "" for n in range(4001)}), "it has 4001 parts"),
        (lambda: rewritten(saved(), "[Content_Types].xml", WORD, MACROS), "it holds macros or controls"),
        (lambda: rewritten(saved(), "[Content_Types].xml", WORD, "text/xml"), "its main part is not a Word document"),
        (lambda: rewritten(saved(), "word/styles.xml", "<w:styles", "<!DOCTYPE x [<!ENTITY e SYSTEM 'file:///etc/passwd'>]><w:styles"), "declares a document type"),
        (lambda: rewritten(saved(), "word/document.xml", "</w:body>", ""), "its part `word/document.xml` is not well-formed XML"),
        (lambda: rewritten(saved(), "word/document.xml", "w:document", "w:documents"), "its part `word/document.xml` holds no document"),
        (lambda: rewritten(saved(), "word/document.xml", "http://schemas.openxmlformats.org/wordprocessingml/2006/main", "http://purl.oclc.org/ooxml/wordprocessingml/main"), "Strict Open XML"),
    ], 6),
)  # fmt: skip
def test_what_is_no_template_is_refused(template: Callable[[], bytes], message: str) -> None:
    with pytest.raises(TemplateError) as error:
        report(template(), Outline("T", facts=(("Version", (Text("1"),)),)))
    assert message in str(error.value)


def test_a_long_chain_of_parts_is_refused() -> None:
    """python-docx walks from part to part by recursion."""
    namespace = "http://schemas.openxmlformats.org/package/2006/relationships"
    source = zipfile.ZipFile(io.BytesIO(template_named("letter")))
    parts = {name: source.read(name).decode("latin-1") for name in source.namelist()}
    for number in range(1500):
        relation = f'<Relationship Id="next" Type="x/chain" Target="link{number + 1}.xml"/>'
        parts[f"word/link{number}.xml"] = "<link/>"
        parts[f"word/_rels/link{number}.xml.rels"] = f'<Relationships xmlns="{namespace}">{relation}</Relationships>'
    first = '<Relationship Id="chain" Type="x/chain" Target="link0.xml"/></Relationships>'
    relations = "word/_rels/document.xml.rels"
    parts[relations] = parts[relations].replace("</Relationships>", first)
    with pytest.raises(TemplateError, match="the template is damaged: it cannot be opened as a Word document"):
        report(packed(parts), Outline("T"))


@pytest.mark.slow
def test_a_damaged_template_is_refused_or_used_but_never_a_traceback() -> None:
    outline = Outline("T", facts=(("Version", (Text("1"),)),), sections=(Section("a", "A"),))
    source = zipfile.ZipFile(io.BytesIO(template_named("cover")))
    parts = {name: source.read(name).decode("latin-1") for name in source.namelist()}
    used = 0
    new_values = itertools.cycle(('""', '"-1"', '"NaN"'))
    for name, content in parts.items():
        values = [match.span() for match in re.finditer(r'"[^"<>]*"', content)][:: max(1, content.count('"') // 2)]
        damaged = [content[:start] + next(new_values) + content[end:] for start, end in values]
        for text in ("", content[: len(content) // 2], *damaged):
            try:
                report(packed({**parts, name: text}), outline)
                used += 1
            except TemplateError as error:
                assert str(error).startswith("the template is")  # noqa: PT017 - either outcome is right
    assert used


def packed(parts: dict[str, str]) -> bytes:
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        for name, text in parts.items():
            archive.writestr(name, text.encode("latin-1"))
    return target.getvalue()
