"""Word: an outline with its pictures, written as one .docx. `write` is all that others need.

The document is written as text (see markup.py) into a template (template.py): archgen's own, which lies unpacked in
backends/report/template/, or a partner's .docx or .dotx.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from archgen.emit.docx import assembly, body, contents, flow, properties, titlepage
from archgen.emit.docx.package import TemplateError, pack
from archgen.emit.docx.template import fill, names_in, opened
from archgen.emit.picture import Picture
from archgen.views.shapes import Outline

__all__ = ["TemplateError", "write"]


def write(
    outline: Outline,
    pictures: Mapping[str, Picture],
    *,
    template: bytes | None = None,
    chapter_files: Callable[[str], bytes | None],
) -> tuple[bytes, tuple[str, ...]]:
    """Write a report. Gives the bytes of the .docx, and warnings for who makes it.

    `chapter_files` gives the bytes of a picture by its path in the project, None if there is none.
    Raises TemplateError, with a message for the user, if the template cannot be used.
    """
    document = opened(template)
    titled = "title" in names_in(document.before)
    unknown = fill(document, titlepage.values(outline))
    draft = assembly.draft(
        document, pictures, chapter_files, body.anchors(outline), language=outline.language if template is None else ""
    )
    if template is not None:
        assembly.report_template(draft, unknown)
    first = tuple(titlepage.pieces(draft, outline, titled=titled))
    main = tuple(body.sections(draft, outline))
    base = draft.sheets.base
    cover = 1 if document.before else 0
    known = flow.pages((*first, *flow.settle((*contents.front(draft, {}), *main), base)), base, section=len(first))
    numbers = {mark: page + cover for mark, page in known.items()}
    whole = flow.settle((*contents.front(draft, numbers), *main), base)
    assembly.finish(document, draft, first, whole)
    properties.describe(document.package, outline)
    return pack(document.package), tuple(draft.warnings)
