"""Parse interface definitions of ROS: `.msg`, `.srv` and `.action` files, in the grammars of ROS 1 and of ROS 2.

All errors of a file are reported at once, each with its position. What is refused is what the builds of ROS refuse
(genmsg for ROS 1, rosidl_adapter for ROS 2). Whether the messages that fields name exist is checked when linking.
"""

from __future__ import annotations

import re
from dataclasses import field

from archgen.diagnostic import Diagnostic, Label, Rule, Severity
from archgen.frozen import dataclass
from archgen.model.interfaces import Field, Interface
from archgen.source import Span
from archgen.suggest import did_you_mean
from archgen.syntax.interface_types import Complaint, FieldType, literal_types, read_type
from archgen.syntax.literals import complaint, default_complaint

NAME = "invalid-interface"
RULES = (
    Rule(
        NAME,
        Severity.ERROR,
        """A definition of a message, a service or an action that ROS would refuse.

Why: archgen reads the project's own `.msg`, `.srv` and `.action` files (`ros: {interfaces: [...]}`) to know which
messages exist and what is in them. A definition with a mistake builds nowhere; here it is shown before anybody tries.
The grammar is that of ROS 1 where the distribution is noetic, and that of ROS 2 everywhere else.

Bad:

    ros:
      distro: jazzy
      definitions:
        demo_msgs/msg/Grasp: |
          float64 width
          uint8 QUALITY=300

Good:

    ros:
      distro: jazzy
      definitions:
        demo_msgs/msg/Grasp: |
          float64 width
          uint8 QUALITY=255
""",
        fixed=True,
    ),
)

_PARTS = {"msg": 1, "srv": 2, "action": 3}
_KINDS = {"msg": "a message", "srv": "a service", "action": "an action"}
_LINE_END = re.compile(r"\r\n|\r|\n")
# Names in ROS 1 (genmsg) and in ROS 2 (rosidl_adapter), by what they name.
_LOOSE = {"field": re.compile(r"[A-Za-z]\w*\Z", re.ASCII), "constant": re.compile(r"[A-Za-z_]\w*\Z", re.ASCII)}
_STRICT = {
    "field": re.compile(r"[a-z](?:_?[a-z0-9])*\Z", re.ASCII),
    "constant": re.compile(r"[A-Z](?:_?[A-Z0-9])*\Z", re.ASCII),
}
_OPTIONAL = re.compile(r"@optional(?: +|\Z)")
"""The annotation `@optional`, in front of a field or on the line above it: rosidl 5.1 and newer."""
_NAMES = {
    ("field", True): "letters, digits and underscores, a letter first",
    ("constant", True): "letters, digits and underscores, no digit first",
    ("field", False): "small letters, digits and single underscores, a letter first, as in `gripper_width`",
    ("constant", False): "capitals, digits and single underscores, a capital first, as in `MAX_WIDTH`",
}


@dataclass(frozen=True, slots=True)
class Definition:
    """A parsed definition: its sound fields, and the messages that they name, each with the span of the name."""

    interface: Interface
    references: tuple[tuple[str, Span], ...]
    diagnostics: tuple[Diagnostic, ...]


@dataclass(slots=True)
class _Reading:
    """The state of reading one definition: what was found up to the current line."""

    file: str
    package: str
    ros1: bool
    fields: list[Field] = field(default_factory=list)
    names: dict[tuple[str, str], Span] = field(default_factory=dict)
    references: list[tuple[str, Span]] = field(default_factory=list)
    diagnostics: list[Diagnostic] = field(default_factory=list)

    def place(self, number: int, start: int, end: int) -> Span:
        return Span(self.file, number, start + 1, number, max(start, end) + 1)

    def part(self) -> tuple[Field, ...]:
        """Close a part of a service or an action and return its fields; the next part may use the same names again."""
        done = tuple(self.fields)
        self.fields.clear()
        self.names.clear()
        return done

    def name(self, what: str, name: str, at: Span) -> bool:
        """Check the name of a field or a constant; False, and a diagnostic, if it is malformed or already taken."""
        pattern = (_LOOSE if self.ros1 else _STRICT)[what]
        if not pattern.match(name):
            self.say(f"`{name}` is no name of a {what}", at, _NAMES[what, self.ros1])
            return False
        first = self.names.setdefault((what, name), at)
        if first is not at:
            self.say(f"there are two {what}s `{name}`", at, labels=(Label(first, "the first one"),))
        # Identity, not equality: setdefault gives back the very span that was passed in if the name is new.
        return first is at

    def say(self, message: str, at: Span, help_: str | None = None, labels: tuple[Label, ...] = ()) -> None:
        self.diagnostics.append(Diagnostic(NAME, message, at, labels=labels, help=help_))


def parse(text: str, name: str, file: str, *, ros1: bool) -> Definition:
    """Parse the definition of `package/msg/Name` (or srv, action). It never raises; unsound lines are left out."""
    package, kind = name.split("/")[:2]
    reading = _Reading(file, package, ros1)
    parts, separators = list[tuple[Field, ...]](), list[Span]()
    for number, line in enumerate(_LINE_END.split(text), 1):
        # genmsg takes whatever follows the dashes as a comment, rosidl_adapter wants the bare line.
        if line.startswith("---") if ros1 else line == "---":
            separators.append(reading.place(number, 0, 3))
            parts.append(reading.part())
        else:
            _line(reading, number, line)
    parts.append(reading.part())
    _count(reading, kind, separators)
    # Always as many parts as the kind has, so that later stages need not check.
    sound = tuple(parts[: _PARTS[kind]]) + ((),) * (_PARTS[kind] - len(parts))
    return Definition(Interface(name, sound), tuple(reading.references), tuple(reading.diagnostics))


def _count(reading: _Reading, kind: str, separators: list[Span]) -> None:
    """Report too many or too few lines `---`: a message has none, a service one, an action two."""
    wanted = _PARTS[kind] - 1
    if len(separators) > wanted:
        allowed = ("no line", "one line", "two lines")[wanted]
        reading.say(f"the definition of {_KINDS[kind]} has {allowed} `---`", separators[wanted])
    elif len(separators) < wanted:
        needed = "a line `---` between request and response"
        if kind == "action":
            needed = "a line `---` after the goal and one after the result"
        reading.say(f"the definition of {_KINDS[kind]} needs {needed}", Span.of_file(reading.file))


def _line(reading: _Reading, number: int, line: str) -> None:
    """Read one line: blank, a constant, or a field."""
    code = line.split("#", 1)[0]
    # rosidl_adapter turns tabs into blanks first, genmsg does not. One for one, so columns stay right.
    code = (code if reading.ros1 else code.replace("\t", " ")).rstrip()
    start = _skip(code, 0)
    if start == len(code):
        return
    if not reading.ros1:
        if start:
            reading.say("a definition of ROS 2 begins in the first column", reading.place(number, 0, start))
        optional = _OPTIONAL.match(code, start)
        start = optional.end() if optional else start
        if start == len(code):
            return
    end = code.find(" ", start)
    if end < 0:
        _incomplete(reading, code[start:], reading.place(number, start, len(code)))
    elif "=" in code[end:]:
        _constant(reading, number, code, line, (start, end))
    else:
        _field(reading, number, code, (start, end))


def _skip(code: str, column: int) -> int:
    """Return the column (from 0) of the next word at or after a column; the line's length if there is none."""
    return len(code) - len(code[column:].lstrip())


def _incomplete(reading: _Reading, written: str, at: Span) -> None:
    if written.startswith("---"):
        reading.say("a separating line is `---` and nothing else", at, "take away what follows the three dashes")
    elif "\t" in written:
        reading.say("in ROS 1 a blank stands between type and name, not a tab", at)
    else:
        reading.say(f"`{written}` is no definition: a type and a name are needed", at, "for instance `float64 width`")


def _constant(reading: _Reading, number: int, code: str, line: str, columns: tuple[int, int]) -> None:
    """Read `uint8 LIMIT=3`. The value of a string constant in ROS 1 is the whole rest of the line, even with a `#`."""
    start, end = columns
    type_, rest = code[start:end], _skip(code, end)
    equals = code.index("=", end)
    name = code[rest:equals].rstrip()
    reading.name("constant", name, reading.place(number, rest, rest + len(name)))
    if type_ not in literal_types(ros1=reading.ros1):
        at = reading.place(number, start, end)
        reading.say(f"a constant has a builtin type, not `{type_}`", at, _builtin(type_, reading))
        return
    source = line.rstrip() if reading.ros1 and type_ == "string" else code
    first = _skip(source, equals + 1)
    reason = complaint(type_, source[first:], None, ros1=reading.ros1)
    if reason:
        at = reading.place(number, first, max(len(source), first + 1))
        reading.say(f"`{source[first:]}` is no value of `{type_}`", at, reason)


def _builtin(type_: str, reading: _Reading) -> str | None:
    return did_you_mean(type_, literal_types(ros1=reading.ros1))


def _field(reading: _Reading, number: int, code: str, columns: tuple[int, int]) -> None:
    """Read `float64 width`, in ROS 2 perhaps with a default: `float64 width 0.1`."""
    start, end = columns
    at = reading.place(number, start, end)
    type_ = read_type(code[start:end], reading.package, ros1=reading.ros1)
    if isinstance(type_, Complaint):
        reading.say(type_.message, at, type_.help)
    elif not type_.builtin:
        reading.references.append((type_.base, at))
    rest = _skip(code, end)
    name = code[rest:].split(" ", 1)[0]
    # The name is registered even if the type is wrong, so that a second field of this name is still reported.
    named = reading.name("field", name, reading.place(number, rest, rest + len(name)))
    first = _skip(code, rest + len(name))
    if first < len(code):
        _default(reading, type_, code[first:], reading.place(number, first, len(code)))
    if named and isinstance(type_, FieldType):
        reading.fields.append(Field(name, type_.name, type_.array))


def _default(reading: _Reading, type_: FieldType | Complaint, value: str, at: Span) -> None:
    if reading.ros1:
        reading.say("a field of ROS 1 has no default", at, "a comment begins with `#`; a constant is `uint8 NAME=3`")
    elif isinstance(type_, Complaint):
        return
    elif not type_.builtin:
        reading.say("only a field of a builtin type has a default", at)
    else:
        reason = default_complaint(type_, value)
        if reason:
            reading.say(f"`{value}` is no value of `{type_.name}{type_.array}`", at, reason)
