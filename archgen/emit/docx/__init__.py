"""Word: an outline with its pictures, written as one .docx. `write` is all that others need.

python-docx opens the template (archgen's own, which lies unpacked in backends/report/template/, or a partner's .docx or .dotx)
and holds the package: styles, sections, headers, pictures, properties. The text is written as XML (see `word_xml`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from archgen.emit.docx.contents_lists import (
    list_placeholder_values,
    write_contents,
    write_core_properties,
    write_front_sections,
    write_title_page,
)
from archgen.emit.docx.document_text import format_document
from archgen.emit.docx.docx_writer import embed_code_font, save_package
from archgen.emit.docx.page_flow import assign_sheets, estimate_pages, fill_pages, narrow_margins
from archgen.emit.docx.report_template import (
    clean_settings,
    create_writer,
    open_template,
    replace_document_text,
    warn_of_template,
)
from archgen.emit.docx.section_pieces import list_anchors, write_sections
from archgen.emit.docx.template_placeholders import (
    fill_placeholders,
    find_contents_mark,
    find_placeholders,
    place_contents,
)
from archgen.emit.picture import Picture
from archgen.emit.template_package import TemplateError
from archgen.frozen import replace
from archgen.views.shapes import Outline

__all__ = ["TemplateError", "write"]


def write(
    outline: Outline,
    pictures: Mapping[str, Picture],
    *,
    template: bytes | None = None,
    chapter_files: Callable[[str], bytes | None],
) -> tuple[bytes, tuple[str, ...]]:
    """Return a report as the bytes of a .docx, and warnings for who writes it.

    `chapter_files` returns the bytes of a picture by its path in the project, None if there is none.
    Raises TemplateError, with a message for the user, if the template cannot be used.
    """
    report_template = open_template(template)
    cover_names = find_placeholders(report_template.before) - {"contents"}
    contents_mark = find_contents_mark(report_template.before)
    unknown_names = fill_placeholders(report_template, list_placeholder_values(outline), contents_mark)
    language = outline.language if template is None else ""
    writer = create_writer(report_template, pictures, chapter_files, list_anchors(outline), language)
    if not outline.has_large_paper:
        writer.paper = replace(writer.paper, large=())
    if outline.has_narrow_margins and template is None:
        writer.paper = narrow_margins(writer.paper)
    if template is not None:
        warn_of_template(writer, unknown_names)
    title_page = tuple(write_title_page(writer, outline, cover_names))
    front = tuple(write_front_sections(writer, outline, cover_names))
    base = writer.paper.base
    sections = fill_pages(assign_sheets(tuple(write_sections(writer, outline)), base), base)
    # The lists take pages themselves: they are written once to be measured, and once with the numbers.
    in_cover = contents_mark is not None
    contents = tuple(write_contents(writer, {}, outline.lists, one_column=in_cover))
    flow = assign_sheets((*front, *(() if in_cover else contents), *sections), base)
    pages = estimate_pages((*title_page, *flow), base, section_start=len(title_page))
    # How long a cover is, only Word knows; nearly all take one page, and contents in it begin another.
    cover_pages = 1 if report_template.before else 0
    if in_cover:
        cover_pages += math.ceil(math.fsum(piece.height for piece in contents) / base.text_height)
    numbers = {bookmark: page + cover_pages for bookmark, page in pages.items()}
    contents = tuple(write_contents(writer, numbers, outline.lists, one_column=in_cover))
    if contents_mark is None:
        flow = assign_sheets((*front, *contents, *sections), base)
    else:
        report_template = place_contents(report_template, contents_mark, "".join(piece.xml for piece in contents))
    document = report_template.document
    clean_settings(document)
    embed_code_font(document, writer.styles)
    write_core_properties(document, report_template.package, outline)
    replace_document_text(document, format_document(report_template, writer, title_page, flow))
    return save_package(report_template.package), tuple(writer.warnings)
