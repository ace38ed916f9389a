"""The filters of templates: they put text safely where it is needed, be it Markdown, code span, Mermaid or identifier.

The names in `TEMPLATE_FILTERS` are part of docs/backends.md.

Of those that write code whatever a text says stays inside of what the filter makes of it: a string, a comment, a word or an
identifier of a language. The names in `CODE_FILTERS` are part of docs/own_generators.md.
"""

from __future__ import annotations

import dataclasses
import json
import math
import re
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, TypeVar

from markupsafe import Markup

from archgen.emit.markdown.comment_sentences import CONTROL_CHARACTER, escape_markdown, make_code_span
from archgen.emit.safe_names import make_identifier, make_slug
from archgen.model.code_names import make_camel_name, make_identifier_in, make_ros_name, make_snake_name
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph, Lifeline, SequenceChart, SequenceMessage

if TYPE_CHECKING:
    from markdown_it import MarkdownIt

_PLAIN_SHELL_WORD = re.compile(r"[A-Za-z0-9_@%+=:,./-]+\Z", re.ASCII)
_LINE_BREAKS = re.compile(
    r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ufeff\ud800-\udfff\u200e\u200f\u202a-\u202e\u2066-\u2069\ufffe\uffff]+"
)
"""Controls and all that some language or editor takes for the end of a line, or for another direction of writing."""
_XML_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_COMMENT_ENDS = (
    ("*/", "* /"),
    ("/*", "/ *"),
    ("?>", "? >"),
    ("-->", "-- >"),
    ("<!--", "<! --"),
    ("--", "- -"),
    ("??", "? ?"),
)
"""What ends or opens a comment in some language, and trigraphs: `??/` is a backslash in old C++."""


def _print_text(value: object) -> str:
    return value if isinstance(value, str) else str(value)


def write_python_string(value: object) -> str:
    """Return text as a string of Python, of printable ASCII; in double quotes only where that saves escapes."""
    text = _print_text(value)
    if "'" in text and '"' not in text:
        return '"' + "".join(_escape_python(character) for character in text) + '"'
    escaped = "".join(character if character == '"' else _escape_python(character) for character in text)
    return "'" + escaped.replace("'", "\\'") + "'"


def write_python_value(value: object) -> str:
    """Return a value of a parameter as Python has it: texts, numbers, True and False, and lists of them."""
    if value is None or isinstance(value, bool | int):
        return repr(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else f"float({write_python_string(repr(value))})"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(write_python_value(each) for each in value) + "]"
    return write_python_string(value)


def _escape_python(character: str) -> str:
    code = ord(character)
    if character in '"\\':
        return "\\" + character
    if 0x20 <= code < 0x7F:  # noqa: PLR2004 - printable ASCII
        return character
    short = {"\n": "\\n", "\t": "\\t", "\r": "\\r"}.get(character)
    return short or (f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}")  # noqa: PLR2004


def write_cpp_string(value: object) -> str:
    """Return text as a string of C++: bytes of UTF-8 in octal where they are not printable ASCII, no trigraphs."""
    return '"' + "".join(_escape_cpp_byte(byte) for byte in _print_text(value).encode("utf-8", "replace")) + '"'


def write_cpp_value(value: object) -> str:
    """Return a value of a parameter as C++ has it: texts, numbers, true and false, and lists of them in braces."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        # There is no literal of the least number: it would be the one above the greatest, with a minus.
        return str(value) if value > -(2**63) else "std::numeric_limits<std::int64_t>::min()"
    if isinstance(value, float):
        if math.isfinite(value):
            return repr(value)
        name = "quiet_NaN" if math.isnan(value) else "infinity"
        return f"{'-' if value < 0 else ''}std::numeric_limits<double>::{name}()"
    if isinstance(value, list | tuple):
        return "{" + ", ".join(write_cpp_value(each) for each in value) + "}"
    return write_cpp_string(value)


def _escape_cpp_byte(byte: int) -> str:
    if byte in b'"\\?':
        return "\\" + chr(byte)
    # Octal ends after three digits; a hexadecimal escape would take the digits that follow.
    return chr(byte) if 0x20 <= byte < 0x7F else {10: "\\n", 9: "\\t"}.get(byte) or f"\\{byte:03o}"  # noqa: PLR2004


def write_java_string(value: object) -> str:
    """Return text as a string of Java. Its unicode escapes are read before anything else: quotes and ends of lines have others."""
    units = _print_text(value).encode("utf-16-be", "surrogatepass")
    codes = (int.from_bytes(units[position : position + 2], "big") for position in range(0, len(units), 2))
    return '"' + "".join(_escape_java_unit(code) for code in codes) + '"'


def write_java_value(value: object) -> str:
    """Return a value of a parameter as Java has it: texts, booleans, long and double, and lists of them."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return f"{value}L"
    if isinstance(value, float):
        special = {math.inf: "Double.POSITIVE_INFINITY", -math.inf: "Double.NEGATIVE_INFINITY"}
        return repr(value) if math.isfinite(value) else special.get(value, "Double.NaN")
    if isinstance(value, list | tuple):
        return "List.of(" + ", ".join(write_java_value(each) for each in value) + ")"
    return write_java_string(value)


def _escape_java_unit(code: int) -> str:
    character = chr(code)
    short = {"\n": "\\n", "\r": "\\r", "\t": "\\t", '"': '\\"', "\\": "\\\\", "\f": "\\f", "\b": "\\b"}.get(character)
    if short:
        return short
    return character if 0x20 <= code < 0x7F else f"\\u{code:04x}" if code >= 0x20 else f"\\{code:03o}"  # noqa: PLR2004


def write_xml(value: object) -> str:
    """Return text for an element or a quoted attribute of XML; characters that XML cannot hold are replaced."""
    text = _XML_FORBIDDEN.sub("\ufffd", _print_text(value))
    for character, entity in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;"), ("'", "&#39;")):
        text = text.replace(character, entity)
    # In an attribute a parser makes blanks of these, unless they are written so.
    return text.replace("\r", "&#13;").replace("\n", "&#10;").replace("\t", "&#9;")


def write_yaml_scalar(value: object) -> str:
    """Return a value as a scalar of YAML on one line; text is quoted, so that `no` and `1.0` stay texts."""
    if value is None or isinstance(value, bool | int):
        return json.dumps(value)
    if isinstance(value, float):
        # YAML 1.1 takes `1e+16` for a text: a number of it has a point.
        text = repr(value) if "." in repr(value) else repr(value).replace("e", ".0e")
        return {"inf": ".inf", "-inf": "-.inf", "nan": ".nan"}.get(text, text)
    text = _print_text(value).encode("utf-16", "replace").decode("utf-16", "replace")
    # The escapes of Python are those of YAML as well.
    return (
        '"' + "".join(each if each.isprintable() and each not in '"\\' else _escape_python(each) for each in text) + '"'
    )


def write_shell_word(value: object) -> str:
    """Return text as one word of a POSIX shell. No program can be given the character NUL: it is left out."""
    text = _print_text(value).replace("\0", "")
    if _PLAIN_SHELL_WORD.match(text):
        return text
    return "'" + text.replace("'", "'\"'\"'") + "'"


def write_one_line(value: object) -> str:
    """Return text on one line, without controls and marks of direction: what is left to escape depends on the language."""
    return " ".join(_LINE_BREAKS.sub(" ", _print_text(value)).split())


def write_line_comment(value: object) -> str:
    """Return text for a comment of one line in any language: it ends no comment, and continues on no next line."""
    # A backslash joins lines in C++ and starts the unicode escapes of Java, wherever they stand.
    text = write_one_line(value).replace("\\", "/")
    for _ in range(2):
        for mark, replacement in _COMMENT_ENDS:
            text = text.replace(mark, replacement)
    return text


CODE_FILTERS: Mapping[str, Callable[[object], str]] = {
    "camel": lambda value: make_camel_name(_print_text(value)),
    "cpp_name": lambda value: make_identifier_in("cpp", _print_text(value)),
    "cpp_string": write_cpp_string,
    "cpp_value": write_cpp_value,
    "java_name": lambda value: make_identifier_in("java", _print_text(value)),
    "java_string": write_java_string,
    "java_value": write_java_value,
    "line_comment": write_line_comment,
    "one_line": write_one_line,
    "python_name": lambda value: make_identifier_in("python", _print_text(value)),
    "python_string": write_python_string,
    "python_value": write_python_value,
    "ros_name": lambda value: make_ros_name(_print_text(value)),
    "shell_word": write_shell_word,
    "snake": lambda value: make_snake_name(_print_text(value)),
    # Templates of XML escape what is no Markup.
    "xml": lambda value: Markup(write_xml(value)),  # noqa: S704 - it is escaped
    "yaml_scalar": write_yaml_scalar,
}


_URL_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


def safe_commonmark(text: object) -> str:
    """Return CommonMark as it is if it holds no HTML, and only relative, http, https and mailto addresses; else as
    plain text.
    """
    parser = _commonmark_parser()
    text = CONTROL_CHARACTER.sub("\ufffd", str(text))
    tokens = [token for block in parser.parse(text) for token in (block, *(block.children or ()))]
    addresses = [str(token.attrs.get(name, "")) for token in tokens for name in ("href", "src")]
    if any(token.type.startswith("html_") for token in tokens) or any(_is_strange(address) for address in addresses):
        return "\n".join(escape_markdown(line) for line in text.split("\n"))
    return text


@cache
def _commonmark_parser() -> MarkdownIt:
    """Create a parser that takes every address for a link: `_is_strange` judges them, not the library."""
    from markdown_it import MarkdownIt

    class LenientParser(MarkdownIt):
        def validateLink(self, url: str) -> bool:  # noqa: ARG002, N802 - the library's
            return True

    return LenientParser("commonmark", {"html": True})


def _is_strange(address: str) -> bool:
    return bool(_URL_SCHEME.match(address)) and not address.lower().startswith(("http://", "https://", "mailto:"))


def draw_mermaid(graph: object) -> str:
    """Write a graph, as templates get it, as a Mermaid flowchart without the fence around it; a large one is folded."""
    # Imported here, as below: most backends draw nothing, and generators are run again and again.
    from archgen.emit.markdown.mermaid_chart import fold_for_mermaid, write_flowchart

    return "\n".join(write_flowchart(fold_for_mermaid(graph_from_plain(graph)), has_stable_names=True))


def draw_mermaid_sequence(sequence: object) -> str:
    """Write a sequence, as templates get it, as a Mermaid sequence diagram without the fence around it."""
    from archgen.emit.markdown.mermaid_chart import write_sequence_diagram

    return "\n".join(write_sequence_diagram(sequence_from_plain(sequence)))


def _escape_mermaid(text: object) -> str:
    from archgen.emit.markdown.mermaid_chart import escape_mermaid

    return escape_mermaid(str(text))


def make_escape_filter(table: Mapping[str, str]) -> Callable[[object], str]:
    """Make a filter that replaces each character of a text by its entry in the table; all others stay."""
    replacements = str.maketrans(dict(table))
    # One pass: what an entry puts in place is not replaced again, so `{"&": "&amp;"}` is safe in any order.
    return lambda text: str(text).translate(replacements)


def _write_csv_row(cells: Iterable[object]) -> str:
    """Return the cells of a row of CSV, without the end of its line."""
    from archgen.emit.csv_rows import write_csv_rows

    return write_csv_rows([["" if cell is None else str(cell) for cell in cells]]).rstrip("\r\n")


TEMPLATE_FILTERS: dict[str, Any] = {
    **CODE_FILTERS,
    "code": make_code_span,
    "csv_row": _write_csv_row,
    "commonmark": safe_commonmark,
    "identifier": make_identifier,
    "markdown": escape_markdown,
    "mermaid": _escape_mermaid,
    "mermaid_graph": draw_mermaid,
    "mermaid_sequence": draw_mermaid_sequence,
    "slug": lambda text: make_slug(str(text)),
}


Shape = TypeVar("Shape", Box, Arrow, Cluster, Graph, Lifeline, SequenceMessage, SequenceChart)


def graph_from_plain(data: object) -> Graph:
    """Return the graph that `shape_to_plain` made plain data of. Raise TypeError for anything else."""
    if not isinstance(data, Mapping) or data.get("shape") != "graph":
        raise TypeError("`mermaid_graph` takes one of `graphs`")
    parts: dict[str, Any] = {
        "boxes": tuple(_from_plain(Box, box) for box in data["boxes"]),
        "arrows": tuple(_from_plain(Arrow, arrow) for arrow in data["arrows"]),
        "clusters": tuple(_from_plain(Cluster, cluster) for cluster in data["clusters"]),
    }
    return _from_plain(Graph, {**data, **parts})


def sequence_from_plain(data: object) -> SequenceChart:
    """Return the sequence that `shape_to_plain` made plain data of. Raise TypeError for anything else."""
    if not isinstance(data, Mapping) or data.get("shape") != "sequencechart":
        raise TypeError("`mermaid_sequence` takes one of `sequences`")
    parts: dict[str, Any] = {
        "lifelines": tuple(_from_plain(Lifeline, lifeline) for lifeline in data["lifelines"]),
        "messages": tuple(_from_plain(SequenceMessage, message) for message in data["messages"]),
    }
    return _from_plain(SequenceChart, {**data, **parts})


def _from_plain(shape: type[Shape], data: Mapping[str, Any]) -> Shape:
    names = {field.name for field in dataclasses.fields(shape)}
    values: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in data.items() if name in names
    }
    return shape(**values)
