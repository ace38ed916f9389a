"""Read the report's chapters: which ones, in what order, the text of the project's own, and the pictures in them.

Look for the pictures that the report's chapters show. Read what a project says of its report beside the chapters.

Clean the SVG pictures that a project brings: nothing in them runs, and nothing is loaded from elsewhere.

Opened on its own, an SVG is a document like a page: scripts in it run in the origin of the site that holds it.
"""

from __future__ import annotations

import base64
import binascii
import posixpath
import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from urllib.parse import quote, unquote

from archgen.diagnostics import Diagnostic, SourceTexts, Span, did_you_mean
from archgen.frozen import NamedTuple, dataclass, field
from archgen.link import mapping_values
from archgen.link.value_readers import read_values
from archgen.model.document_chapters import GENERATED_CHAPTERS, Chapter
from archgen.model.report_settings import HistoryEntry, ReportSettings
from archgen.syntax.project_files import ProjectFiles, read_binary_file, read_text_file
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode, list_entries


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


@lru_cache(maxsize=256)
def find_shown_pictures(markdown: str) -> tuple[ShownPicture, ...]:
    """Return the pictures in a Markdown text, without those with a scheme (`https:`); a build asks for them four times."""
    return tuple(_list_shown_pictures(markdown))


def _list_shown_pictures(markdown: str) -> Iterator[ShownPicture]:
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
    return {entry.key: entry.key_span for entry in list_entries(report, "texts")}


def _list_texts(node: YamlNode | None) -> Iterator[tuple[str, str]]:
    for entry in list_entries(node):
        if isinstance(entry.value, ScalarNode):
            yield entry.key, entry.value.text


def _decode_pictures(node: YamlNode | None) -> Iterator[tuple[str, bytes]]:
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


_KEPT_DATA = {"image": ["png", "jpeg", "gif"]}
_REFERENCE = re.compile(rb"""(\s)(?:xlink:)?href="(?!#|data:image/)[^"]*\"""")
_STYLE_ADDRESS = re.compile(rb"""url\((?!\s*['"]?(?:#|data:image/))[^)]*\)""", re.IGNORECASE)


def is_svg(data: bytes) -> bool:
    """Whether bytes are markup, and no picture of pixels: a browser takes what begins with `<` for a document."""
    return data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<")


def clean_project_svg(data: bytes) -> bytes | None:
    """Return the picture without scripts, handlers, foreign objects and outside addresses; None if it is no sound SVG."""
    # Imported here: only projects that show an SVG need it. It knows the elements and attributes of SVG that are harmless.
    from py_svg_hush import filter_svg

    if b"<!ENTITY" in data:  # entities may name files, or grow without end; drawing programs write none that matter
        return None
    try:
        harmless: bytes = filter_svg(data, keep_data_url_mime_types=_KEPT_DATA)
    except ValueError:
        return None
    # Of foreign addresses it keeps the path (`https://a.org/b.png` becomes `/b.png`), and it keeps relative ones: they
    # would be loaded from the site itself, or from the disk where the site is opened from there.
    return _STYLE_ADDRESS.sub(b"url(#)", _REFERENCE.sub(rb"\1", harmless))


def read_report_settings(root: MappingNode) -> ReportSettings:
    """Read the section `report` of the merged project; what is of the wrong kind reads as not written."""
    report = mapping_values.get_mapping(root, "report")
    abbreviations = mapping_values.get_mapping(report, "abbreviations")
    return ReportSettings(
        **read_values("report", ReportSettings, report),
        history=tuple(_list_versions(report)),
        abbreviations=tuple(
            (entry.key, entry.value.text)
            for entry in abbreviations
            if isinstance(entry.value, ScalarNode) and entry.value.value is not None
        ),
        lists=tuple(
            name  # type: ignore[misc]
            for name in dict.fromkeys(mapping_values.get_texts(report, "lists"))
            if name in {"figures", "tables"}
        ),
    )


def _list_versions(report: MappingNode) -> Iterator[HistoryEntry]:
    node = report.get("history")
    for item in node.items if isinstance(node, SequenceNode) else ():
        if isinstance(item, MappingNode):
            values = (mapping_values.get_text(item, key) or "" for key in ("version", "date", "author", "change"))
            yield HistoryEntry(*values)


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
