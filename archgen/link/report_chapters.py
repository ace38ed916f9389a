"""Read the report's chapters: which ones, in what order, the text of the project's own, and the pictures in them."""

from __future__ import annotations

import base64
import binascii
import posixpath
from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import NamedTuple
from urllib.parse import unquote

from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.frozen import dataclass
from archgen.link.report_front import read_report_settings
from archgen.link.svg_cleaning import clean_project_svg, is_svg
from archgen.model.document_chapters import GENERATED_CHAPTERS, Chapter
from archgen.model.report_settings import ReportSettings
from archgen.syntax.project_files import ProjectFiles, read_binary_file, read_text_file
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

MISSING_CHAPTER = Rule(
    "missing-chapter",
    Severity.ERROR,
    "The report asks for a chapter that is neither one that archgen writes nor a file of the project.",
    fixed=True,
)


@dataclass(frozen=True, slots=True)
class ReportChapters:
    """The chapters of the report: the order of all, and those that the project wrote, by path.

    Frozen, but `picture_cache` is filled as pictures are read.
    """

    files: ProjectFiles
    order: tuple[str, ...] = GENERATED_CHAPTERS
    texts: Mapping[str, Chapter] = field(default_factory=dict)
    packed_pictures: Mapping[str, bytes] = field(default_factory=dict)
    """Pictures that a packed project holds itself, by path; they win over files."""
    settings: ReportSettings = field(default_factory=ReportSettings)
    """What stands beside the chapters: level, first pages, lists."""
    image_paths: tuple[str, ...] = ()
    """Pictures that elements name, by their normal paths."""
    picture_cache: dict[str, bytes | None] = field(default_factory=dict, compare=False, repr=False)
    """Pictures read so far, None for one that is absent: each is read once, so that all outputs have the same bytes."""

    def read_picture(self, path: str) -> bytes | None:
        """Read a picture by its path in the project; None if there is no such file inside the project.

        What is SVG comes cleaned, and is None if it cannot be: no output may publish a stranger's scripts.
        """
        normal_path = posixpath.normpath(path)
        if normal_path not in self.picture_cache:
            data = self._load_picture(normal_path)
            self.picture_cache[normal_path] = clean_project_svg(data) if data is not None and is_svg(data) else data
        return self.picture_cache[normal_path]

    def _load_picture(self, normal_path: str) -> bytes | None:
        if normal_path in self.packed_pictures:
            return self.packed_pictures[normal_path]
        if normal_path.startswith(("/", "../")) or normal_path == ".." or "\\" in normal_path or "\0" in normal_path:
            return None
        return read_binary_file(self.files, normal_path)

    def list_picture_paths(self) -> tuple[str, ...]:
        """Return the paths of all pictures that chapters and elements show; some may be absent."""
        paths: dict[str, None] = dict.fromkeys(self.image_paths)
        paths |= {f"{path.removesuffix('.svg')}.png": None for path in self.image_paths if path.endswith(".svg")}
        for chapter in self.texts.values():
            for picture in find_shown_pictures(chapter.text):
                normal_path = posixpath.normpath(posixpath.join(chapter.folder, picture.path))
                paths[normal_path] = None
                if normal_path.endswith(".svg"):
                    # Programs that cannot show SVG use a PNG of the same name instead.
                    paths[f"{normal_path.removesuffix('.svg')}.png"] = None
        return tuple(paths)

    def read_pictures(self) -> dict[str, bytes]:
        """Read all pictures that chapters and elements show; return their bytes by path."""
        pictures = {path: self.read_picture(path) for path in self.list_picture_paths()}
        return {path: data for path, data in pictures.items() if data is not None}


class ShownPicture(NamedTuple):
    """A picture in a Markdown text: its path, percent-decoded, and the lines (from 1, the end exclusive) of its block."""

    path: str
    first_line: int
    end_line: int


def find_shown_pictures(markdown: str) -> Iterator[ShownPicture]:
    """Yield the pictures in a Markdown text, without those with a scheme (`https:`)."""
    from markdown_it import MarkdownIt

    for block in MarkdownIt("commonmark", {"html": False}).parse(markdown):
        first_line, end_line = block.map or (0, 0)
        # Pictures are inline tokens, which markdown-it keeps one level below the blocks.
        for token in block.children or ():
            address = str(token.attrs.get("src", "")) if token.type == "image" else ""
            if address and ":" not in address.split("/", 1)[0]:
                yield ShownPicture(unquote(address), first_line + 1, end_line + 1)


def read_chapters(root: MappingNode, files: ProjectFiles) -> tuple[ReportChapters, tuple[Diagnostic, ...]]:
    """Read the chapters that the merged project asks for; without `report.chapters` those that archgen writes."""
    report = root.get("report")
    if not isinstance(report, MappingNode):
        return ReportChapters(files), ()
    chapters_node = report.get("chapters")
    entries = (
        [item for item in chapters_node.items if isinstance(item, ScalarNode)]
        if isinstance(chapters_node, SequenceNode)
        else None
    )
    packed_texts = dict(_list_texts(report.get("texts")))
    order, texts, diagnostics = [], {}, []
    for entry in entries or ():
        name = entry.text
        if name in order:
            continue
        if name not in GENERATED_CHAPTERS:
            # A packed project holds its chapters' text under `report.texts` and needs no files.
            text, problem = (
                (packed_texts[name], None) if name in packed_texts else _read_chapter(files, name, entry.span)
            )
            if problem:
                diagnostics.append(problem)
                continue
            texts[name] = Chapter(name, text)
        order.append(name)
    chapter_order = tuple(order) if entries is not None else GENERATED_CHAPTERS
    pictures = dict(_decode_pictures(report.get("pictures")))
    settings = read_report_settings(root)
    return ReportChapters(files, chapter_order, texts, pictures, settings), tuple(diagnostics)


def locate_packed_texts(root: MappingNode) -> dict[str, Span]:
    """Return the places of the chapters' texts that a packed project holds itself, by chapter."""
    report = root.get("report")
    texts = report.get("texts") if isinstance(report, MappingNode) else None
    return {entry.key: entry.key_span for entry in (texts if isinstance(texts, MappingNode) else ())}


def _list_texts(node: object) -> Iterator[tuple[str, str]]:
    for entry in node if isinstance(node, MappingNode) else ():
        if isinstance(entry.value, ScalarNode):
            yield entry.key, entry.value.text


def _decode_pictures(node: object) -> Iterator[tuple[str, bytes]]:
    for path, text in _list_texts(node):
        try:
            yield path, base64.b64decode(text, validate=True)
        except binascii.Error:
            continue  # reported where the chapter shows the picture


def _read_chapter(files: ProjectFiles, name: str, span: Span) -> tuple[str, Diagnostic | None]:
    if not name.endswith(".md"):
        help_line = (
            did_you_mean(name, GENERATED_CHAPTERS)
            or f"archgen writes {', '.join(GENERATED_CHAPTERS)}; a file ends in .md"
        )
        return "", Diagnostic("missing-chapter", f"there is no chapter `{name}`", span, help=help_line)
    normal_path = posixpath.normpath(name)
    if normal_path.startswith(("/", "../")):
        return "", Diagnostic("missing-chapter", f"the chapter `{name}` lies outside the project's folder", span)
    file_text = read_text_file(files, normal_path)
    if file_text.problem:
        message = f"the chapter `{name}` cannot be read: {file_text.problem.message.removeprefix('the file cannot be read: ')}"
        return "", Diagnostic("missing-chapter", message, span, help=file_text.problem.help)
    return file_text.text, None
