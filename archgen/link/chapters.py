"""Read the report's chapters: which ones, in what order, the text of the project's own, and the pictures in them."""

from __future__ import annotations

import base64
import binascii
import posixpath
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from urllib.parse import unquote

from archgen.diagnostic import Diagnostic, Rule, Severity
from archgen.model.document import GENERATED, Chapter
from archgen.source import Span
from archgen.suggest import did_you_mean
from archgen.syntax.files import Files, read, read_bytes
from archgen.syntax.tree import Listing, Scalar, Table

MISSING_CHAPTER = Rule(
    "missing-chapter",
    Severity.ERROR,
    """\
The report asks for a chapter that is neither one that archgen writes nor a file of the project.

Why: The document would lack what its readers were promised. archgen writes the chapters overview, groups, deployment,
timing, chains, views, types, connections, requirements, open_points and statistics; every other entry of `report.chapters` is the
path of a CommonMark file inside the project's folder.

Bad:
    report: {chapters: [group, connections]}
    groups:
      sensing:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
          screen: {inputs: {image: camera.image}}
    nodes:
      camera: {implements: camera}
      screen: {implements: screen}

Good:
    report: {chapters: [groups, connections]}
    groups:
      sensing:
        components:
          camera: {outputs: {image: sensor_msgs/msg/Image}}
          screen: {inputs: {image: camera.image}}
    nodes:
      camera: {implements: camera}
      screen: {implements: screen}
""",
    fixed=True,
)


@dataclass(frozen=True, slots=True)
class Chapters:
    """The chapters of the report: the order of all, and those that the project wrote, by path.

    Frozen, but `picture_cache` is filled as pictures are read.
    """

    files: Files
    order: tuple[str, ...] = GENERATED
    texts: Mapping[str, Chapter] = field(default_factory=dict)
    packed: Mapping[str, bytes] = field(default_factory=dict)
    """Pictures that a packed project holds itself, by path; they win over files."""
    asked: dict[str, bytes | None] = field(default_factory=dict, compare=False, repr=False)
    """Pictures read so far, None for one that is absent: each is read once, so that all outputs have the same bytes."""

    def picture(self, path: str) -> bytes | None:
        """Read a picture by its path in the project; None if there is no such file inside the project."""
        clean = posixpath.normpath(path)
        if clean not in self.asked:
            self.asked[clean] = self._picture(clean)
        return self.asked[clean]

    def _picture(self, clean: str) -> bytes | None:
        if clean in self.packed:
            return self.packed[clean]
        if clean.startswith(("/", "../")) or clean == ".." or "\\" in clean or "\0" in clean:
            return None
        return read_bytes(self.files, clean)

    def pictures(self) -> dict[str, bytes]:
        """Read all pictures that the chapters show; return their bytes by path."""
        found = {}
        for chapter in self.texts.values():
            for name in shown(chapter.text):
                clean = posixpath.normpath(posixpath.join(chapter.folder, name))
                stem = clean.removesuffix(".svg")
                # Programs that cannot show SVG use a PNG of the same name instead.
                for path in (clean, f"{stem}.png") if stem != clean else (clean,):
                    data = self.picture(path)
                    if data is not None:
                        found[path] = data
        return found


def shown(markdown: str) -> Iterator[str]:
    """Yield the paths of the pictures in a Markdown text, percent-decoded, without those with a scheme (`https:`)."""
    from markdown_it import MarkdownIt

    for block in MarkdownIt("commonmark", {"html": False}).parse(markdown):
        # Pictures are inline tokens, which markdown-it keeps one level below the blocks.
        for token in block.children or ():
            address = str(token.attrs.get("src", "")) if token.type == "image" else ""
            if address and ":" not in address.split("/", 1)[0]:
                yield unquote(address)


def chapters(merged: Table, files: Files) -> tuple[Chapters, tuple[Diagnostic, ...]]:
    """Read the chapters that the merged project asks for; without `report.chapters` those that archgen writes."""
    report = merged.get("report")
    if not isinstance(report, Table):
        return Chapters(files), ()
    listed = report.get("chapters")
    entries = [item for item in listed.items if isinstance(item, Scalar)] if isinstance(listed, Listing) else None
    packed = dict(_texts(report.get("texts")))
    order, texts, diagnostics = [], {}, []
    for entry in entries or ():
        name = entry.text
        if name in order:
            continue
        if name not in GENERATED:
            # A packed project holds its chapters' text under `report.texts` and needs no files.
            text, problem = (packed[name], None) if name in packed else _read(files, name, entry.at)
            if problem:
                diagnostics.append(problem)
                continue
            texts[name] = Chapter(name, text)
        order.append(name)
    wanted = tuple(order) if entries is not None else GENERATED
    return Chapters(files, wanted, texts, dict(_pictures(report.get("pictures")))), tuple(diagnostics)


def _texts(value: object) -> Iterator[tuple[str, str]]:
    for entry in value if isinstance(value, Table) else ():
        if isinstance(entry.value, Scalar):
            yield entry.key, entry.value.text


def _pictures(value: object) -> Iterator[tuple[str, bytes]]:
    for path, text in _texts(value):
        try:
            yield path, base64.b64decode(text, validate=True)
        except binascii.Error:
            continue  # reported where the chapter shows the picture


def _read(files: Files, name: str, at: Span) -> tuple[str, Diagnostic | None]:
    if not name.endswith(".md"):
        said = did_you_mean(name, GENERATED) or f"archgen writes {', '.join(GENERATED)}; a file ends in .md"
        return "", Diagnostic("missing-chapter", f"there is no chapter `{name}`", at, help=said)
    clean = posixpath.normpath(name)
    if clean.startswith(("/", "../")):
        return "", Diagnostic("missing-chapter", f"the chapter `{name}` lies outside the project's folder", at)
    text = read(files, clean)
    if text.problem:
        message = (
            f"the chapter `{name}` cannot be read: {text.problem.message.removeprefix('the file cannot be read: ')}"
        )
        return "", Diagnostic("missing-chapter", message, at, help=text.problem.help)
    return text.text, None
