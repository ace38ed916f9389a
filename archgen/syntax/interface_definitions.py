"""Parse interface definitions of ROS: `.msg`, `.srv` and `.action` files, in the grammars of ROS 1 and of ROS 2.

All errors of a file are reported at once, each with its position. What is refused is what the builds of ROS refuse
(genmsg for ROS 1, rosidl_adapter for ROS 2). Whether the messages that fields name exist is checked when linking.
"""

from __future__ import annotations

import re

from archgen.diagnostics import Diagnostic, Label, Span, did_you_mean
from archgen.frozen import NamedTuple, dataclass, field
from archgen.model.known_interfaces import Interface, InterfaceConstant, InterfaceField
from archgen.syntax.interface_literals import (
    FieldType,
    TypeComplaint,
    explain_bad_default,
    explain_bad_literal,
    list_literal_types,
    read_field_type,
)

INVALID_INTERFACE = "invalid-interface"

_PART_COUNTS = {"msg": 1, "srv": 2, "action": 3}
_KIND_PHRASES = {"msg": "a message", "srv": "a service", "action": "an action"}
_LINE_END = re.compile(r"\r\n|\r|\n")
# Names in ROS 1 (genmsg) and in ROS 2 (rosidl_adapter), by what they name.
_ROS1_NAMES = {"field": re.compile(r"[A-Za-z]\w*\Z", re.ASCII), "constant": re.compile(r"[A-Za-z_]\w*\Z", re.ASCII)}
_ROS2_NAMES = {
    "field": re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII),
    "constant": re.compile(r"[A-Z](?:_?[A-Z0-9])*\Z", re.ASCII),
}
_OPTIONAL_ANNOTATION = re.compile(r"@optional(?: +|\Z)")
"""The annotation `@optional`, in front of a field or on the line above it: rosidl 5.1 and newer."""
_HEADER_FIELD = re.compile(r"(?:std_msgs/(?:msg/)?)?Header +header\b")
_HEADER_WORD = re.compile(r"\b(?:header|stamp\w*|time\w*|frame\w*)\b", re.IGNORECASE)
_NAME_HELP = {
    ("field", True): "letters, digits and underscores, a letter first",
    ("constant", True): "letters, digits and underscores, no digit first",
    ("field", False): "small letters, digits and single underscores, a letter first, as in `gripper_width`",
    ("constant", False): "capitals, digits and single underscores, a capital first, as in `MAX_WIDTH`",
}


@dataclass(frozen=True, slots=True)
class InterfaceDefinition:
    """A parsed definition: its sound fields, and the messages that they name, each with the span of the name."""

    interface: Interface
    references: tuple[tuple[str, Span], ...]
    diagnostics: tuple[Diagnostic, ...]


class _DefinitionLine(NamedTuple):
    """A line of a field or a constant: its text, the part without its comment, and the comment that belongs to it."""

    number: int
    text: str
    code: str
    comment: str


@dataclass(slots=True)
class _DefinitionReader:
    """The state of reading one definition: what was found up to the current line."""

    file: str
    package: str
    ros1: bool
    fields: list[InterfaceField] = field(default_factory=list)
    constants: list[InterfaceConstant] = field(default_factory=list)
    comment_lines: list[str] = field(default_factory=list)
    """The comments that stand alone so far, those right above the current line last."""
    own_comments: int = 0
    """How many of these stand right above the current line, and belong to it if it is a field or a constant."""
    introduction: str = ""
    name_spans: dict[tuple[str, str], Span] = field(default_factory=dict)
    references: list[tuple[str, Span]] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def span_of(self, line_number: int, start: int, end: int) -> Span:
        return Span(self.file, line_number, start + 1, line_number, max(start, end) + 1)

    def close_part(self) -> tuple[tuple[InterfaceField, ...], tuple[InterfaceConstant, ...]]:
        """Close a part of a service or an action; the next part may use the same names again."""
        part = tuple(self.fields), tuple(self.constants)
        self.fields.clear()
        self.constants.clear()
        self.name_spans.clear()
        self.own_comments = 0
        return part

    def add_comment(self, comment: str) -> None:
        """Remember a line that is nothing but a comment; an empty line ends what belongs to the next field."""
        if comment:
            self.comment_lines.append(comment)
        self.own_comments = self.own_comments + 1 if comment else 0

    def take_comment(self, code: str, comment: str) -> str:
        """Return the comment of a field or constant: the lines right above it, and what stands behind it.

        What stands above the header of a message, and does not speak of it, is an introduction: it stays by itself.
        """
        start = len(self.comment_lines) - self.own_comments
        lines = [*self.comment_lines[start:], comment]
        if _HEADER_FIELD.match(code) and not any(map(_HEADER_WORD.search, lines[:-1])):
            self.introduction, self.own_comments = " ".join(lines[:-1]), 0
            return comment
        del self.comment_lines[start:]
        self.own_comments = 0
        return " ".join(filter(None, lines))

    def check_name(self, kind: str, name: str, span: Span) -> bool:
        """Check the name of a field or a constant; False, and a diagnostic, if it is malformed or already taken."""
        help_line = explain_bad_name(kind, name, ros1=self.ros1)
        if help_line:
            self.add_diagnostic(f"`{name}` is no name of a {kind}", span, help_line)
            return False
        first_span = self.name_spans.setdefault((kind, name), span)
        if first_span is not span:
            self.add_diagnostic(f"there are two {kind}s `{name}`", span, labels=(Label(first_span, "the first one"),))
        # Identity, not equality: setdefault gives back the very span that was passed in if the name is new.
        return first_span is span

    def add_diagnostic(
        self, message: str, span: Span, help_line: str | None = None, labels: tuple[Label, ...] = ()
    ) -> None:
        self.diagnostics.append(Diagnostic(INVALID_INTERFACE, message, span, labels=labels, help=help_line))


def explain_bad_name(kind: str, name: str, *, ros1: bool) -> str | None:
    """Return how ROS writes the name of a `field` or a `constant`; None for a name that it takes."""
    pattern = (_ROS1_NAMES if ros1 else _ROS2_NAMES)[kind]
    return None if pattern.match(name) else _NAME_HELP[kind, ros1]


def parse_interface_definition(text: str, name: str, file: str, *, ros1: bool) -> InterfaceDefinition:
    """Parse the definition of `package/msg/Name` (or srv, action). It never raises; unsound lines are left out."""
    package, kind = name.split("/")[:2]
    reader = _DefinitionReader(file, package, ros1)
    parts, separators = list[tuple[tuple[InterfaceField, ...], tuple[InterfaceConstant, ...]]](), list[Span]()
    for line_number, line in enumerate(_LINE_END.split(text), 1):
        # genmsg takes whatever follows the dashes as a comment, rosidl_adapter wants the bare line.
        if line.startswith("---") if ros1 else line == "---":
            separators.append(reader.span_of(line_number, 0, 3))
            parts.append(reader.close_part())
        else:
            _read_line(reader, line_number, line)
    parts.append(reader.close_part())
    _check_separators(reader, kind, separators)
    # Always as many parts as the kind has, so that later stages need not check.
    sound_parts = [*parts[: _PART_COUNTS[kind]], *[((), ())] * (_PART_COUNTS[kind] - len(parts))]
    interface = Interface(
        name,
        tuple(fields for fields, _ in sound_parts),
        tuple(constants for _, constants in sound_parts) if any(constants for _, constants in sound_parts) else (),
        "\n".join(reader.comment_lines),
        reader.introduction,
    )
    return InterfaceDefinition(interface, tuple(reader.references), tuple(reader.diagnostics))


def _check_separators(reader: _DefinitionReader, kind: str, separators: list[Span]) -> None:
    """Report too many or too few lines `---`: a message has none, a service one, an action two."""
    expected_count = _PART_COUNTS[kind] - 1
    if len(separators) > expected_count:
        allowed = ("no line", "one line", "two lines")[expected_count]
        reader.add_diagnostic(
            f"the definition of {_KIND_PHRASES[kind]} has {allowed} `---`", separators[expected_count]
        )
    elif len(separators) < expected_count:
        needed_text = "a line `---` between request and response"
        if kind == "action":
            needed_text = "a line `---` after the goal and one after the result"
        reader.add_diagnostic(f"the definition of {_KIND_PHRASES[kind]} needs {needed_text}", Span.of_file(reader.file))


def _read_line(reader: _DefinitionReader, line_number: int, line: str) -> None:
    """Read one line: blank, a constant, or a field."""
    code, _, comment = line.partition("#")
    comment = comment.strip()
    # rosidl_adapter turns tabs into blanks first, genmsg does not. One for one, so columns stay right.
    code = (code if reader.ros1 else code.replace("\t", " ")).rstrip()
    start = _find_next_word(code, 0)
    if start == len(code):
        reader.add_comment(comment)
        return
    if not reader.ros1:
        if start:
            reader.add_diagnostic(
                "a definition of ROS 2 begins in the first column", reader.span_of(line_number, 0, start)
            )
        optional = _OPTIONAL_ANNOTATION.match(code, start)
        start = optional.end() if optional else start
        if start == len(code):
            reader.add_comment(comment)
            return
    whole_line = _DefinitionLine(line_number, line, code, reader.take_comment(code, comment))
    end = code.find(" ", start)
    if end < 0:
        _report_incomplete_line(reader, code[start:], reader.span_of(line_number, start, len(code)))
    elif "=" in code[end:]:
        _read_constant(reader, whole_line, start, end)
    else:
        _read_field(reader, whole_line, start, end)


def _find_next_word(code: str, column: int) -> int:
    """Return the column (from 0) of the next word at or after a column; the line's length if there is none."""
    return len(code) - len(code[column:].lstrip())


def _report_incomplete_line(reader: _DefinitionReader, code: str, span: Span) -> None:
    if code.startswith("---"):
        reader.add_diagnostic(
            "a separating line is `---` and nothing else", span, "take away what follows the three dashes"
        )
    elif "\t" in code:
        reader.add_diagnostic("in ROS 1 a blank stands between type and name, not a tab", span)
    else:
        reader.add_diagnostic(
            f"`{code}` is no definition: a type and a name are needed", span, "for instance `float64 width`"
        )


def _read_constant(reader: _DefinitionReader, line: _DefinitionLine, start: int, end: int) -> None:
    """Read `uint8 LIMIT=3`. The value of a string constant in ROS 1 is the whole rest of the line, even with a `#`."""
    line_number, text, code, comment = line
    type_name, name_column = code[start:end], _find_next_word(code, end)
    equals_column = code.index("=", end)
    name = code[name_column:equals_column].rstrip()
    is_name_sound = reader.check_name(
        "constant", name, reader.span_of(line_number, name_column, name_column + len(name))
    )
    if type_name not in list_literal_types(ros1=reader.ros1):
        span = reader.span_of(line_number, start, end)
        reader.add_diagnostic(
            f"a constant has a builtin type, not `{type_name}`", span, _suggest_builtin_type(type_name, reader)
        )
        return
    source = text.rstrip() if reader.ros1 and type_name == "string" else code
    value_column = _find_next_word(source, equals_column + 1)
    reason = explain_bad_literal(type_name, source[value_column:], None, ros1=reader.ros1)
    if reason:
        span = reader.span_of(line_number, value_column, max(len(source), value_column + 1))
        reader.add_diagnostic(f"`{source[value_column:]}` is no value of `{type_name}`", span, reason)
    elif is_name_sound:
        # In ROS 1 a text goes on to the end of the line, so that nothing behind it is a comment.
        own_comment = "" if source is not code else comment
        reader.constants.append(InterfaceConstant(name, type_name, source[value_column:].rstrip(), own_comment))


def _suggest_builtin_type(type_name: str, reader: _DefinitionReader) -> str | None:
    return did_you_mean(type_name, list_literal_types(ros1=reader.ros1))


def _read_field(reader: _DefinitionReader, line: _DefinitionLine, start: int, end: int) -> None:
    """Read `float64 width`, in ROS 2 perhaps with a default: `float64 width 0.1`."""
    line_number, _, code, comment = line
    type_span = reader.span_of(line_number, start, end)
    field_type = read_field_type(code[start:end], reader.package, ros1=reader.ros1)
    if isinstance(field_type, TypeComplaint):
        reader.add_diagnostic(field_type.message, type_span, field_type.help)
    elif not field_type.is_builtin:
        reader.references.append((field_type.base, type_span))
    name_column = _find_next_word(code, end)
    name = code[name_column:].split(" ", 1)[0]
    # The name is registered even if the type is wrong, so that a second field of this name is still reported.
    is_name_sound = reader.check_name("field", name, reader.span_of(line_number, name_column, name_column + len(name)))
    default_column = _find_next_word(code, name_column + len(name))
    if default_column < len(code):
        _check_default(
            reader, field_type, code[default_column:], reader.span_of(line_number, default_column, len(code))
        )
    if is_name_sound and isinstance(field_type, FieldType):
        reader.fields.append(InterfaceField(name, field_type.name, field_type.array, code[default_column:], comment))


def _check_default(reader: _DefinitionReader, field_type: FieldType | TypeComplaint, value: str, span: Span) -> None:
    if reader.ros1:
        reader.add_diagnostic(
            "a field of ROS 1 has no default", span, "a comment begins with `#`; a constant is `uint8 NAME=3`"
        )
    elif isinstance(field_type, TypeComplaint):
        return
    elif not field_type.is_builtin:
        reader.add_diagnostic("only a field of a builtin type has a default", span)
    else:
        reason = explain_bad_default(field_type, value)
        if reason:
            reader.add_diagnostic(f"`{value}` is no value of `{field_type.name}{field_type.array}`", span, reason)
