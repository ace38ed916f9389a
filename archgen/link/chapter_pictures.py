"""Look for the pictures that the report's chapters show."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping
from urllib.parse import quote

from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.diagnostics.source_span import SourceTexts, Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.link.report_chapters import ReportChapters, ShownPicture, find_shown_pictures
from archgen.syntax.project_files import ProjectFiles

MISSING_PICTURE = Rule(
    "missing-picture",
    Severity.WARNING,
    "A chapter of the report shows a picture that is not there.",
    # A chapter has no comments of YAML that could silence a line.
    setting="rules: {missing-picture: note}  # off, note, warning or error",
)
_PLAIN_PICTURE = re.compile(r"""!\[[^\[\]]*\]\(([^\s()<>\\]+)(?:[ \t]+"[^"\n]*")?\)""")


def find_missing_pictures(
    chapters: ReportChapters, text_spans: Mapping[str, Span], sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Report the pictures of chapters that the project does not hold; their texts join the sources, to be quoted.

    `text_spans` are the places of the texts that a packed project holds itself, by chapter.
    """
    for path, chapter in chapters.texts.items():
        if not _may_lack_picture(chapters, chapter.folder, chapter.text):
            continue
        absent: dict[str, ShownPicture] = {}
        for picture in find_shown_pictures(chapter.text):
            if _is_missing(chapters, chapter.folder, picture.path):
                absent.setdefault(picture.path, picture)
        file = posixpath.normpath(path)
        if absent and path not in text_spans:
            sources.add_text(file, chapter.text)
        lines = chapter.text.splitlines()
        for picture in absent.values():
            span = text_spans.get(path) or _locate_picture(file, lines, picture)
            yield _report_picture(chapters.files, path, chapter.folder, picture.path, span)


def _may_lack_picture(chapters: ReportChapters, folder: str, text: str) -> bool:
    """Tell whether a text may show a picture that is not there; reading it as Markdown takes longer than the rest of a check."""
    paths = _PLAIN_PICTURE.findall(text)
    return len(paths) != text.count("![") or any(_is_missing(chapters, folder, path) for path in paths)


def _is_missing(chapters: ReportChapters, folder: str, name: str) -> bool:
    path = posixpath.normpath(posixpath.join(folder, name))
    return path not in chapters.packed_pictures and not (_is_inside(path) and chapters.files.has_path(path))


def _is_inside(path: str) -> bool:
    """Tell whether a normal path stays within the project's folder: outside nobody looks, not even whether it exists."""
    return not path.startswith(("/", "../")) and path not in (".", "..") and "\\" not in path


def _locate_picture(file: str, lines: list[str], picture: ShownPicture) -> Span:
    """Return the place of a picture's path, or of the block that shows it where the path stands elsewhere."""
    for number in range(picture.first_line, min(picture.end_line, len(lines) + 1)):
        for written in (picture.path, quote(picture.path)):
            place = re.search(rf"[(<]{re.escape(written)}", lines[number - 1])
            if place:
                return Span(file, number, place.start() + 2, number, place.end() + 1)
    return Span(file, picture.first_line, 1, picture.first_line, 2)


def _report_picture(files: ProjectFiles, chapter: str, folder: str, name: str, span: Span) -> Diagnostic:
    path = posixpath.normpath(posixpath.join(folder, name))
    message = f"the picture `{name}` of the chapter `{chapter}`"
    if not _is_inside(path):
        help_line = "copy it into the project; `/` parts the folders of a path"
        return Diagnostic("missing-picture", f"{message} lies outside the project's folder", span, help=help_line)
    parent, file_name = posixpath.split(path)
    _, _, neighbours = next(iter(files.walk_folders(parent)), ("", [], []))
    help_line = did_you_mean(file_name, neighbours) or "write its path from the chapter's folder"
    return Diagnostic("missing-picture", f"{message} is not there", span, help=help_line)
