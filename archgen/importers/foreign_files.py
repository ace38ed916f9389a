"""Read files of other tools within limits: bytes, the members of zip archives, and XML as a tree that knows its places.

It takes time and memory in proportion to the file, whatever it holds. Entities and document types of XML are refused:
nothing is expanded, and nothing outside the file is asked for.
"""

from __future__ import annotations

import io
import lzma
import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import IO
from xml.parsers import expat

from archgen.diagnostics import Span
from archgen.frozen import dataclass
from archgen.importers.foreign_import import ForeignFileError
from archgen.regular_files import open_named_file

MAX_DEPTH = 200
"""Elements nest no deeper than this: models have about 30, and code that walks down a tree has an end."""
MAX_ELEMENTS = 500_000
"""A tree takes about 2 kB of memory for each: so many are a model of a hundred thousand classes, or of 50 MB."""
MAX_NAMESPACES = 200
"""So many may have names in one place: they are copied for each element that gives a name to one more."""
_NO_NAMESPACES: Mapping[str, str] = MappingProxyType({"xml": "http://www.w3.org/XML/1998/namespace"})


class XmlElement:
    """An element as it is written, with its place. `line` and `column` count from 1."""

    __slots__ = ("attributes", "children", "column", "line", "namespace", "prefix", "tag", "text")

    def __init__(
        self, name: str, attributes: dict[str, str], namespaces: Mapping[str, str], place: tuple[int, int]
    ) -> None:
        self.prefix, _, self.tag = name.rpartition(":")
        self.namespace = namespaces.get(self.prefix, "")
        self.attributes = attributes
        """By their names as they are written: `xmi:id`."""
        self.children: list[XmlElement] = []
        self.text = ""
        """All text directly in the element."""
        self.line, self.column = place

    def find(self, tag: str) -> XmlElement | None:
        """Return the first child with a tag, or None."""
        return next((child for child in self.children if child.tag == tag), None)

    def find_all(self, tag: str) -> list[XmlElement]:
        """Return all children with a tag."""
        return [child for child in self.children if child.tag == tag]

    def walk(self) -> Iterator[XmlElement]:
        """Yield this element and all below, in the order of the file."""
        stack = [self]
        while stack:
            element = stack.pop()
            yield element
            # The one that was put down last is taken first.
            stack.extend(reversed(element.children))

    def span(self, file: str) -> Span:
        """Return the place of the element's beginning in a file of this name."""
        return Span(file, self.line, self.column, self.line, self.column + 1)


def parse_xml(file: str, data: bytes) -> XmlElement:
    """Return the outermost element of a file; `file` is its name in messages. Raise ForeignFileError."""
    return _TreeBuilder(file).build(data)


class XmlEvents:
    """What expat tells of one file: a subclass takes its elements and texts one by one, in their order."""

    malformed_help = "export it again from the tool that wrote it"
    doctype_help = "models need neither: take out the `<!DOCTYPE ...>`"

    def __init__(self, file: str) -> None:
        """Take the file's name in messages."""
        self.file = file
        self.is_root_seen = False
        self.parser = expat.ParserCreate()
        # Else expat calls back for each line of a text by itself.
        self.parser.buffer_text = True
        self.parser.buffer_size = 65_536
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end
        self.parser.CharacterDataHandler = self.add_text
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self.parser.EntityDeclHandler = self._refuse_doctype

    def start(self, name: str, attributes: dict[str, str]) -> None:
        """Take the beginning of an element."""
        raise NotImplementedError

    def end(self, name: str) -> None:
        """Take the end of an element."""
        raise NotImplementedError

    def add_text(self, text: str) -> None:
        """Take a piece of text."""
        raise NotImplementedError

    @contextmanager
    def explained(self) -> Iterator[None]:
        """Feed the parser inside of this: what expat raises becomes a ForeignFileError."""
        try:
            yield
        except expat.ExpatError as error:
            problem = explain_syntax(error, is_root_seen=self.is_root_seen, malformed_help=self.malformed_help)
            raise self.refuse(problem.message, problem.help_line, None if problem.is_at_end else error) from None
        except (LookupError, ValueError) as error:
            problem = explain_encoding(error)
            raise self.refuse(problem.message, problem.help_line) from None

    def refuse(self, message: str, help_line: str, error: expat.ExpatError | None = None) -> ForeignFileError:
        """Return why the file is not read, with the place of an error, else the one that the parser has come to."""
        line = error.lineno if error else self.parser.CurrentLineNumber
        column = (error.offset if error else self.parser.CurrentColumnNumber) + 1
        return ForeignFileError(message, Span(self.file, line, column, line, column + 1), help_line)

    def _refuse_doctype(self, *_: object) -> None:
        raise self.refuse("it declares a document type or entities, which archgen does not follow", self.doctype_help)


class _TreeBuilder(XmlEvents):
    """The elements that are open between two events of the parser."""

    def __init__(self, file: str) -> None:
        super().__init__(file)
        self._root: XmlElement | None = None
        self._count = 0
        self._open: list[tuple[XmlElement, Mapping[str, str], list[str]]] = []

    def build(self, data: bytes) -> XmlElement:
        with self.explained():
            self.parser.Parse(data, True)  # noqa: FBT003 - expat's signature
        assert self._root is not None  # noqa: S101 - a file without an element is a syntax error
        return self._root

    def start(self, name: str, attributes: dict[str, str]) -> None:
        namespaces = self._open[-1][1] if self._open else _NO_NAMESPACES
        # Most elements declare none and share the mapping of the one around: half a million copies would fill memory.
        declared = {
            attribute.partition(":")[2]: value
            for attribute, value in attributes.items()
            if attribute == "xmlns" or attribute.startswith("xmlns:")
        }
        namespaces = {**namespaces, **declared} if declared else namespaces
        if len(namespaces) > MAX_NAMESPACES:
            words = f"more than {MAX_NAMESPACES} namespaces have names here"
            raise self.refuse(words, "no model needs so many: export it again")
        place = (self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1)
        element = XmlElement(name, attributes, namespaces, place)
        if self._open:
            self._open[-1][0].children.append(element)
        elif self._root is None:
            self._root, self.is_root_seen = element, True
        if len(self._open) >= MAX_DEPTH:
            raise self.refuse(f"its elements nest deeper than {MAX_DEPTH}", "no model does: export it again")
        self._count += 1
        if self._count > MAX_ELEMENTS:
            raise self.refuse(f"it has more than {MAX_ELEMENTS:,} elements", "export the model in parts")
        self._open.append((element, namespaces, []))

    def add_text(self, text: str) -> None:
        if self._open:
            self._open[-1][2].append(text)

    def end(self, name: str) -> None:  # noqa: ARG002 - the element knows it
        element, _, texts = self._open.pop()
        # Text comes in pieces between the children; added up piece by piece it would take the square of its length.
        element.text = "".join(texts)


_ENCODING_HELP = "save it as UTF-8, and let its first line say so"
_WRONG_ENCODINGS = frozenset({expat.errors.XML_ERROR_UNKNOWN_ENCODING, expat.errors.XML_ERROR_INCORRECT_ENCODING})
_UNENDED = frozenset(
    {
        expat.errors.XML_ERROR_NO_ELEMENTS,
        expat.errors.XML_ERROR_UNCLOSED_TOKEN,
        expat.errors.XML_ERROR_PARTIAL_CHAR,
        expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION,
    }
)


@dataclass(frozen=True, slots=True)
class XmlProblem:
    """Why a file is not read, and what to do."""

    message: str
    help_line: str
    is_at_end: bool = False
    """Whether it shows at the place that the parser has come to, rather than at the error's own."""


def explain_syntax(error: expat.ExpatError, *, is_root_seen: bool, malformed_help: str) -> XmlProblem:
    """Explain what is wrong with the text of a file; `malformed_help` says what to do where it is no XML."""
    message = expat.ErrorString(error.code)
    if message in _UNENDED:
        words = "only the first part of a file is there: it ends before its elements do"
        words = words if is_root_seen else "it is empty, or no XML: there is no element in it"
        return XmlProblem(words, "export it again, or copy it again as a whole", is_at_end=True)
    if message in _WRONG_ENCODINGS:
        return XmlProblem(f"its encoding cannot be read ({message})", _ENCODING_HELP, is_at_end=True)
    return XmlProblem(f"this is not XML as it should be ({message})", malformed_help)


def explain_encoding(error: LookupError | ValueError) -> XmlProblem:
    """Explain that Python, which expat asks, does not know the encoding of the file's first line."""
    return XmlProblem(f"its encoding cannot be read ({error})", _ENCODING_HELP, is_at_end=True)


MAX_MODEL_BYTES = 64_000_000
"""So much is read of one file, or of all members of an archive together."""
_MOST_UNPACKED = 40
"""Of models packed by their tools, ten to thirty times as much comes out; of a megabyte that was made to hurt, a thousand times."""
_ALWAYS_UNPACKED_BYTES = 4_000_000
ZIP_BEGINNING = b"PK\x03\x04"
ARCHIVE_DAMAGE = (
    *(zipfile.BadZipFile, zlib.error, lzma.LZMAError, RuntimeError, EOFError, ValueError, struct.error),
    NotImplementedError,
)
"""What Python's zipfile raises for archives that are none, broken, or locked by a password."""


def read_bounded(path: Path, max_bytes: int = MAX_MODEL_BYTES) -> bytes:
    """Return what a file holds. Raise ForeignFileError for one that is too large, no file, or cannot be read."""
    try:
        if not path.is_file():
            words = "it is a folder, or no plain file" if path.exists() else "there is no such file"
            raise ForeignFileError(words, Span.of_file(str(path)), "name the file of the model")
        with open_named_file(path) as stream:
            return _read_part(str(path), stream, max_bytes, max_bytes)
    except OSError as error:
        words = f"it cannot be read ({error.strerror})"
        raise ForeignFileError(words, Span.of_file(str(path)), "look at its rights") from None


def read_archive_members(path: Path, endings: tuple[str, ...]) -> Iterator[tuple[str, bytes]]:
    """Yield name and bytes of each member of a zip archive whose name ends so. Nothing of it is written to the disk.

    Names are for messages only: they may lead anywhere. Raise ForeignFileError.
    """
    try:
        with open_named_file(path) as file, zipfile.ZipFile(file) as archive:
            bytes_left = most_bytes = limit_unpacked(file, MAX_MODEL_BYTES)
            for member in archive.infolist():
                if member.filename.lower().endswith(endings):
                    with archive.open(member) as stream:
                        data = _read_part(f"{path} [{member.filename}]", stream, bytes_left, most_bytes)
                    bytes_left -= len(data)
                    yield member.filename, data
    except ARCHIVE_DAMAGE as error:
        words = f"the zip file is damaged ({error})"
        raise ForeignFileError(words, Span.of_file(str(path)), "export it again") from None
    except OSError as error:
        words = f"it cannot be read ({error.strerror or error})"
        raise ForeignFileError(words, Span.of_file(str(path)), "look at its rights") from None


def limit_unpacked(archive: IO[bytes], max_bytes: int) -> int:
    """Return how many bytes may come out of an archive, `max_bytes` at most."""
    return min(max_bytes, max(_MOST_UNPACKED * archive.seek(0, io.SEEK_END), _ALWAYS_UNPACKED_BYTES))


def _read_part(name: str, stream: IO[bytes], max_bytes: int, told_bytes: int) -> bytes:
    # One byte more than allowed: what a zip file says of its sizes may be a lie.
    data = stream.read(max_bytes + 1)
    if len(data) > max_bytes:
        words = f"it is larger than {told_bytes // 1_000_000} MB"
        raise ForeignFileError(words, Span.of_file(name), "export the model in parts")
    return data
