"""What may stand in a launch file where a value is expected: plain data, substitutions, and what only running it would tell."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from archgen.plugin import dataclass

LaunchValue = Any
"""Text, numbers, booleans, None, lists, tuples and dicts of these; a Substitution; an UnknownValue."""
MAX_TEXT = 20_000
"""How long a text may grow while it is put together: longer ones count as computed."""
_MAX_PARTS = 20_000
"""How many values one value may be put together from."""
OPEN = "$("
OPEN_FILE = "open file"
"""The substitution for a file that a launch file has opened: its path."""


@dataclass(frozen=True, slots=True)
class UnknownValue:
    """What only running the file would tell: `reason` is the expression as it is written, or what it is."""

    reason: str
    line: int = 0
    file: str = ""
    """Where the line stands, if that is another file than the one of what needs the value."""
    is_several: bool = False
    """Whether it stands in a list for any number of items."""


@dataclass(frozen=True, slots=True)
class Substitution:
    """What is filled in when the file is launched.

    `kind` is `join` (its parts one after the other), `path` (with `/` between them), `var`, `share`, `prefix`, `env`,
    `command`, `eval`, `not`, `and`, `or`, `equals`, `differs`, `text_of` (a value that stays text), `typed` (a value and
    the name of its type), or the word of a launch file for what archgen leaves as it is.
    """

    kind: str
    parts: tuple[LaunchValue, ...] = ()


VERY_LONG = UnknownValue("a very long text")


def join_values(parts: Sequence[LaunchValue]) -> LaunchValue:
    """Return parts one after the other: one text where all of them are plain."""
    if len(parts) == 1:
        return parts[0]
    if all(isinstance(part, str | int | float) for part in parts):
        texts = [*map(write_plain, parts)]
        return "".join(texts) if sum(map(len, texts)) <= MAX_TEXT else VERY_LONG
    return Substitution("join", tuple(parts))


def is_plain(value: LaunchValue) -> bool:
    """Whether a value is a text, a number, a boolean or None: no module, function or action."""
    return value is None or isinstance(value, bool | int | float | str)


def name_object(value: object) -> UnknownValue:
    """Return a module, function or action that stands where a value is expected as what is not known."""
    name = getattr(value, "name", None)
    return UnknownValue(name if isinstance(name, str) else type(value).__name__)


def write_plain(value: LaunchValue) -> str:
    """Return a plain value as a launch file writes it."""
    # A boolean is a number to Python, and would be written in its words.
    if isinstance(value, bool):
        return "true" if value else "false"
    return "" if value is None else str(value)


def describe_launch_value(value: LaunchValue, depth: int = 0) -> str:
    """Return a value as launch files in XML write it, with nothing filled in: `$(var use_sim_time)`."""
    if depth > 20:  # noqa: PLR2004 - a substitution in a substitution: nobody reads further
        return "..."
    if isinstance(value, UnknownValue):
        return f"<{value.reason}>"
    if isinstance(value, Substitution):
        return _describe_substitution(value, depth + 1)
    if isinstance(value, Mapping):
        return (
            "{"
            + ", ".join(
                f"{describe_launch_value(k, depth + 1)}: {describe_launch_value(v, depth + 1)}"
                for k, v in value.items()
            )
            + "}"
        )
    if isinstance(value, list | tuple):
        return "".join(describe_launch_value(part, depth + 1) for part in value)
    return write_plain(value) if is_plain(value) else f"<{name_object(value).reason}>"


def _describe_substitution(value: Substitution, depth: int) -> str:  # noqa: PLR0911 - a kind each
    parts = [describe_launch_value(part, depth) for part in value.parts]
    match value.kind:
        case "join":
            return "".join(parts)
        case "path":
            return "/".join(parts)
        case "typed" | "text_of":
            return parts[0]
        case "share" | "prefix":
            return f"$(find-pkg-{value.kind} {parts[0]})"
        case "var":
            return f"$(var {parts[0]})"
        case "equals" | "differs":
            return f"{parts[0]} {'==' if value.kind == 'equals' else '!='} {parts[1]}"
        case "not":
            return f"not {parts[0]}"
        case "and" | "or":
            return f" {value.kind} ".join(parts)
        case "eval":
            return f"$(eval {shlex.quote(parts[0])})"
        case kind:
            return f"$({' '.join([kind, *parts])})"


def has_unknown(value: LaunchValue, depth: int = 0) -> UnknownValue | None:
    """Return the first thing in a value that only running the file would tell, or None."""
    if isinstance(value, UnknownValue):
        return value
    if depth > 20:  # noqa: PLR2004 - as above
        return UnknownValue("values nested very deep")
    inner: Sequence[LaunchValue] = ()
    if isinstance(value, Substitution):
        inner = value.parts
    elif isinstance(value, list | tuple):
        inner = value
    elif isinstance(value, Mapping):
        inner = [*value.keys(), *value.values()]
    return next((found for part in inner if (found := has_unknown(part, depth + 1))), None)


def copy_value(value: LaunchValue, pay: Callable[[int], bool]) -> LaunchValue:
    """Return a value that nothing changes afterwards; an UnknownValue for one that is put together from too many."""
    left = _MAX_PARTS

    def copy_part(part: LaunchValue, depth: int) -> LaunchValue:
        nonlocal left
        left -= 1
        if left < 0 or depth > 40 or not pay(1):  # noqa: PLR2004 - deeper than anybody writes, and than it may be walked through
            raise OverflowError
        if isinstance(part, Substitution):
            return Substitution(part.kind, tuple(copy_part(inner, depth + 1) for inner in part.parts))
        if isinstance(part, list | tuple):
            return [copy_part(inner, depth + 1) for inner in part]
        if isinstance(part, Mapping):
            return {key: copy_part(inner, depth + 1) for key, inner in part.items()}
        return part

    try:
        return copy_part(value, 0)
    except OverflowError:
        return UnknownValue("very many values in one another")
