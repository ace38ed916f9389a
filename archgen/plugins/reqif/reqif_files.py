"""Open ReqIF files: a single one, or those of a zip file (.reqifz), within limits.

Parse one ReqIF file as a stream: in time and memory in proportion to what it holds, whatever it is.

Entities and document types are refused: nothing is expanded, and nothing outside the file is asked for.

What a ReqIF file holds, as far as it is read: objects with values, types, hierarchies, relations.
"""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from archgen.plugin.importing import (
    ARCHIVE_DAMAGE,
    ZIP_BEGINNING,
    ForeignFileError,
    Span,
    XmlEvents,
    limit_unpacked,
    open_named_file,
)


@dataclass(slots=True)
class ReqifObject:
    """An object; `values` are texts by the id of the attribute, of enumerations the ids of the values."""

    id: str
    long_name: str
    file: str
    line: int
    type_id: str = ""
    values: dict[str, str] = field(default_factory=dict)
    choices: dict[str, list[str]] = field(default_factory=dict)


@dataclass(slots=True)
class ReqifRelation:
    """A relation from one object to another."""

    type_id: str = ""
    source: str = ""
    target: str = ""


@dataclass(slots=True)
class HierarchyEntry:
    """An object where it stands in a specification; `parent` is the position of the entry above, -1 at the top."""

    object_id: str
    specification: str
    parent: int


@dataclass(slots=True)
class ReqifDocument:
    """All that was read of the files, by their ids."""

    source_tool: str = ""
    objects: dict[str, ReqifObject] = field(default_factory=dict)
    repeated: list[ReqifObject] = field(default_factory=list)
    """Objects whose id another one has already."""
    names: dict[str, str] = field(default_factory=dict)
    """The long names of types, attributes and values of enumerations."""
    relations: list[ReqifRelation] = field(default_factory=list)
    entries: list[HierarchyEntry] = field(default_factory=list)


MAX_BYTES = 500_000_000
"""So much is read of one file, or of all in a zip file together."""
_CHUNK = 1 << 18
_MAX_TOKEN_BYTES = 4_000_000


def read_reqif_file(path: Path) -> ReqifDocument:
    """Read a .reqif or .reqifz file. Raise ForeignFileError for what is none, and OSError."""
    document = ReqifDocument()
    with open_named_file(path) as stream:
        is_zip = stream.read(4) == ZIP_BEGINNING
        stream.seek(0)
        if is_zip:
            _read_archive(path.name, stream, document)
        else:
            parse_reqif(path.name, _ByteLimit(path.name, MAX_BYTES).read_chunks(stream), document)
    return document


def _read_archive(name: str, stream: IO[bytes], document: ReqifDocument) -> None:
    """Read each .reqif of a zip file; nothing of it is written to the disk."""
    limit = _ByteLimit(name, limit_unpacked(stream, MAX_BYTES))
    try:
        with zipfile.ZipFile(stream) as archive:
            members = [each for each in archive.infolist() if each.filename.lower().endswith(".reqif")]
            if not members:
                raise ForeignFileError("there is no .reqif file in it", Span.of_file(name), "export it again as ReqIF")
            for member in members:
                with archive.open(member) as part:
                    parse_reqif(f"{name} [{member.filename}]", limit.read_chunks(part), document)
    except (*ARCHIVE_DAMAGE, OSError) as error:  # a member that begins before the file does, too
        raise ForeignFileError(f"the zip file is damaged ({error})", Span.of_file(name), "export it again") from None


class _ByteLimit:
    """Counts what is read: what a zip file says of its sizes may be a lie."""

    def __init__(self, name: str, max_bytes: int) -> None:
        self._name, self._max_bytes, self._bytes_left = name, max_bytes, max_bytes

    def read_chunks(self, stream: IO[bytes]) -> Iterator[bytes]:
        while chunk := stream.read(_CHUNK):
            self._bytes_left -= len(chunk)
            if self._bytes_left < 0:
                words = f"it is larger than {self._max_bytes // 1_000_000} MB"
                raise ForeignFileError(words, Span.of_file(self._name), "export the specifications one by one")
            yield chunk


_NAMED_ELEMENTS = frozenset(
    {"SPEC-OBJECT-TYPE", "SPEC-RELATION-TYPE", "SPECIFICATION-TYPE", "ENUM-VALUE"}
    | {
        f"ATTRIBUTE-DEFINITION-{sort}"
        for sort in ("XHTML", "STRING", "ENUMERATION", "INTEGER", "REAL", "BOOLEAN", "DATE")
    }
)


def parse_reqif(file: str, chunks: Iterable[bytes], document: ReqifDocument) -> None:
    """Read a file into a document. Raise ForeignFileError."""
    _ReqifParser(file, document).parse(chunks)


class _ReqifParser(XmlEvents):
    """The state between two elements: which object, value or relation is open."""

    malformed_help = "a ReqIF file is XML in UTF-8; export it again"
    doctype_help = "ReqIF needs neither: take out the `<!DOCTYPE ...>`"

    def __init__(self, file: str, document: ReqifDocument) -> None:
        super().__init__(file)
        self._document = document
        self._local_names: dict[str, str] = {}
        self._object: ReqifObject | None = None
        self._relation: ReqifRelation | None = None
        self._side = ""
        self._value: str | None = None
        self._definition = ""
        self._choices: list[str] = []
        self._xhtml: XhtmlText | None = None
        self._text: list[str] | None = None
        self._specification = ""
        self._open_entries: list[int] = []

    def parse(self, chunks: Iterable[bytes]) -> None:
        with self.explained():
            given_bytes = 0
            for chunk in chunks:
                self.parser.Parse(chunk, False)  # noqa: FBT003 - expat's signature
                given_bytes += len(chunk)
                # What has not ended yet, expat reads from its beginning again with each piece of the file.
                if given_bytes - self.parser.CurrentByteIndex > _MAX_TOKEN_BYTES:
                    words = f"a tag or comment in it is longer than {_MAX_TOKEN_BYTES // 1_000_000} MB"
                    raise self.refuse(words, self.malformed_help)
            self.parser.Parse(b"", True)  # noqa: FBT003

    def _local(self, name: str) -> str:
        local = self._local_names.get(name)
        if local is None:
            local = self._local_names[name] = name.rpartition(":")[2]
        return local

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        # The same few names come again and again: the look-up is written out here, where every element passes.
        local = self._local_names.get(name) or self._local(name)
        if self._xhtml is not None:
            self._xhtml.start(local, attributes)
        elif self._object is not None:
            self._start_in_object(local, attributes)
        elif local in {"SOURCE", "TARGET"}:
            self._side = local
        elif local in {"SPEC-OBJECT-REF", "SPEC-RELATION-TYPE-REF", "SOURCE-TOOL-ID"}:
            self._text = []
        else:
            self._start_element(local, attributes)

    def _start_element(self, local: str, attributes: Mapping[str, str]) -> None:
        """Take the beginning of what has an identity of its own."""
        if not self.is_root_seen:
            self.is_root_seen = True
            if local != "REQ-IF":
                words = f"its outermost element is `{local[:60]}`, not `REQ-IF`: this is no ReqIF"
                raise self.refuse(words, "export the requirements as ReqIF (.reqif or .reqifz)")
        elif local == "SPEC-OBJECT":
            line = self.parser.CurrentLineNumber
            name = attributes.get("LONG-NAME", "")
            self._object = ReqifObject(attributes.get("IDENTIFIER", ""), name, self.file, line)
        elif local in _NAMED_ELEMENTS:
            self._document.names[attributes.get("IDENTIFIER", "")] = attributes.get("LONG-NAME", "")
        elif local == "SPEC-RELATION":
            self._relation = ReqifRelation()
        elif local == "SPECIFICATION":
            self._specification = attributes.get("LONG-NAME", "")
        elif local == "SPEC-HIERARCHY":
            parent = self._open_entries[-1] if self._open_entries else -1
            self._open_entries.append(len(self._document.entries))
            self._document.entries.append(HierarchyEntry("", self._specification, parent))

    def _start_in_object(self, local: str, attributes: Mapping[str, str]) -> None:
        if local.startswith("ATTRIBUTE-VALUE-"):
            self._value, self._definition, self._choices = attributes.get("THE-VALUE"), "", []
        elif local.endswith("-REF"):
            self._text = []
        elif local == "THE-VALUE":
            self._xhtml = XhtmlText()

    def add_text(self, text: str) -> None:
        if self._xhtml is not None:
            self._xhtml.add(text)
        elif self._text is not None:
            self._text.append(text)

    def end(self, name: str) -> None:
        local = self._local_names[name]
        if self._xhtml is not None:
            if local == "THE-VALUE":
                self._value, self._xhtml = self._xhtml.finish(), None
            else:
                self._xhtml.end(local)
            return
        if self._text is not None:
            self._take_reference(local, "".join(self._text).strip())
            self._text = None
        if self._object is not None:
            self._end_in_object(local, self._object)
        elif local == "SPEC-RELATION" and self._relation is not None:
            self._document.relations.append(self._relation)
            self._relation = None
        elif local == "SPEC-HIERARCHY":
            self._open_entries.pop()

    def _end_in_object(self, local: str, current: ReqifObject) -> None:
        if local == "SPEC-OBJECT":
            # References mean the first one; the others are told.
            if current.id in self._document.objects:
                self._document.repeated.append(current)
            else:
                self._document.objects[current.id] = current
            self._object = None
        elif local.startswith("ATTRIBUTE-VALUE-"):
            if self._choices:
                current.choices[self._definition] = self._choices
            elif self._value and self._value.strip():
                current.values[self._definition] = self._value
            self._value = None

    def _take_reference(self, local: str, text: str) -> None:
        if self._object is not None:
            if local == "SPEC-OBJECT-TYPE-REF":
                self._object.type_id = text
            elif local == "ENUM-VALUE-REF":
                self._choices.append(text)
            elif local.startswith("ATTRIBUTE-DEFINITION-"):
                self._definition = text
        elif local == "SOURCE-TOOL-ID":
            self._document.source_tool = text
        elif self._relation is not None:
            if local == "SPEC-RELATION-TYPE-REF":
                self._relation.type_id = text
            elif self._side == "SOURCE":
                self._relation.source = text
            else:
                self._relation.target = text
        elif self._open_entries and local == "SPEC-OBJECT-REF":
            self._document.entries[self._open_entries[-1]].object_id = text


_BLOCKS = frozenset({"p", "div", "h1", "h2", "h3", "h4", "h5", "h6", "table", "blockquote", "pre", "dl", "dt", "dd"})
_MARKS = {"b": "**", "strong": "**", "i": "*", "em": "*", "code": "`", "tt": "`"}
_UNSHOWN = frozenset({"script", "style"})
"""What they hold is no text: nobody reads it in the other tool either."""
_BLANKS = re.compile(r"[ \t\r\n]+")
_EMPTY_LINES = re.compile(r"\n(?:[ \t]*\n)+")
NO_BREAK_SPACE = "\u00a0"
"""A blank that counts: XHTML folds the others."""


class XhtmlText:
    """Takes the parts of one text in their order, and gives the whole as CommonMark."""

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._lists: list[int | None] = []
        """The lists around: the number of the last item, None where they have none."""
        self._unshown_depth = 0

    def start(self, name: str, attributes: Mapping[str, str]) -> None:
        """Take the beginning of an element."""
        if name in _UNSHOWN:
            self._unshown_depth += 1
        elif name in _BLOCKS:
            self._parts.append("\n\n")
        elif name == "br":
            self._parts.append("\n")
        elif name in _MARKS:
            self._parts.append(_MARKS[name])
        elif name in {"ul", "ol"}:
            self._parts.append("" if self._lists else "\n\n")
            self._lists.append(0 if name == "ol" else None)
        elif name == "li":
            self._start_item()
        elif name == "tr":
            self._parts.append("\n")
        elif name in {"object", "img"}:
            picture = attributes.get("data") or attributes.get("src") or "without a name"
            self._parts.append(f" (picture {picture.rpartition('/')[2]}) ")

    def end(self, name: str) -> None:
        """Take the end of an element."""
        if name in _UNSHOWN:
            self._unshown_depth -= 1
        elif name in _BLOCKS:
            self._parts.append("\n\n")
        elif name in _MARKS:
            self._parts.append(_MARKS[name])
        elif name in {"ul", "ol"} and self._lists:
            self._lists.pop()
            self._parts.append("" if self._lists else "\n\n")
        elif name in {"td", "th"}:
            self._parts.append(" | ")

    def add(self, text: str) -> None:
        """Take a piece of text."""
        if not self._unshown_depth:
            self._parts.append(_fold_blanks(text))

    def _start_item(self) -> None:
        number = self._lists[-1] if self._lists else None
        if number is not None:
            self._lists[-1] = number + 1
        mark = "-" if number is None else f"{number + 1}."
        self._parts.append(f"\n{NO_BREAK_SPACE * 2 * (min(len(self._lists), 20) - 1)}{mark} ")

    def finish(self) -> str:
        """Return the text, without blanks at its ends."""
        text = "".join(self._parts).strip("\n")
        lines = (_fold_blanks(line).strip(" ").removesuffix(" |") for line in text.split("\n"))
        return _EMPTY_LINES.sub("\n\n", "\n".join(lines)).strip("\n").replace(NO_BREAK_SPACE, " ").strip()


def _fold_blanks(text: str) -> str:
    """Fold runs of blanks to one; most texts have none, and need no search by a pattern."""
    has_runs = "\n" in text or "  " in text or "\t" in text or "\r" in text
    return _BLANKS.sub(" ", text) if has_runs else text
