"""Pack a project: its merged slices as plain data, with everything from other files put in.

The packed file must give the same report as the folder (docs/decisions/0002-packed-attachments.md).
"""

from __future__ import annotations

import base64
from collections.abc import Iterable, Mapping
from dataclasses import field

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.mapping import Type
from archgen.syntax.tree import Entry, Ignore, Listing, Scalar, Table, Value

Place = tuple[str | int, ...]
_BARE = frozenset(
    {"archgen", "optional", "conditional", "cores", "threads", "depth", "every", "priority", "core"},
)
"""Keys whose values are numbers or booleans; everything else outside of parameters is text."""
_RAW = frozenset({"parameters", "calls"})
"""Keys below which values keep the kind that they were written in."""


@dataclass(slots=True)
class Packed:
    """A project as one mapping, and the ignore comments by the path of the value that each belongs to."""

    data: dict[str, object] = field(default_factory=dict)
    comments: dict[Place, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Attachments:
    """The contents of files other than YAML.

    The project's own interfaces by full name, its chapters by path, and the pictures in the chapters by path.
    """

    definitions: Mapping[str, str] = field(default_factory=dict)
    texts: Mapping[str, str] = field(default_factory=dict)
    pictures: Mapping[str, bytes] = field(default_factory=dict)


def pack(merged: Table, architecture: Architecture, ignores: Iterable[Ignore], attached: Attachments) -> Packed:
    """Return the packed project."""
    # Comments are found by their line and taken out of this dict as their elements are packed.
    waiting = {(ignore.at.file, ignore.at.line): ignore for ignore in ignores}
    packed = Packed()
    whole = _table(merged, (), packed.comments, waiting, raw=False)
    project = {"id": architecture.project.id, "title": architecture.project.title}
    whole["archgen"] = 1
    whole["project"] = {**project, **_mapping(whole.get("project"))}
    # A packed file is the whole project: nothing may send its readers to other files.
    whole.pop("sources", None)
    ros = {key: value for key, value in _mapping(whole.get("ros")).items() if key != "interfaces"}
    if attached.definitions:
        ros["definitions"] = {**_mapping(ros.get("definitions")), **attached.definitions}
    report = _mapping(whole.get("report"))
    if attached.texts:
        report["texts"] = dict(attached.texts)
    if attached.pictures:
        report["pictures"] = {path: base64.b64encode(data).decode("ascii") for path, data in attached.pictures.items()}
    types = _mapping(whole.get("types"))
    # Of the shipped type mapper, what the project uses: another version of archgen may map these types differently.
    types |= {t.name: _type(t) for t in architecture.types.values() if t.origin == "shipped" and t.name not in types}
    rest = {"ros": ros, "report": report, "types": types}
    whole |= {key: value for key, value in rest.items() if value}
    first = ("archgen", "project")
    packed.data = {key: whole[key] for key in first} | {key: whole[key] for key in whole if key not in first}
    return packed


def _mapping(value: object) -> dict[str, object]:
    return dict(value) if isinstance(value, dict) else {}


def _type(mapped: Type) -> dict[str, object]:
    keys = ("message", "comment", "status", "request", "response", "feedback")
    data: dict[str, object] = {key: getattr(mapped, key) for key in keys if getattr(mapped, key)}
    return data | ({"size": str(mapped.size)} if mapped.size else {})


def _value(
    value: Value, place: Place, comments: dict[Place, str], waiting: dict[tuple[str, int], Ignore], *, raw: bool
) -> object:
    if isinstance(value, Table):
        return _table(value, place, comments, waiting, raw=raw)
    if isinstance(value, Listing):
        items = []
        for number, item in enumerate(value.items):
            _comment(item.at.file, item.at.line, (*place, number), comments, waiting)
            items.append(_value(item, (*place, number), comments, waiting, raw=raw))
        return items
    return _scalar(value, raw=raw)


def _scalar(scalar: Scalar, *, raw: bool) -> object:
    # As text `1.10` stays `1.10`; as a number it would become 1.1.
    return scalar.value if raw else scalar.text


def _table(
    table: Table, place: Place, comments: dict[Place, str], waiting: dict[tuple[str, int], Ignore], *, raw: bool
) -> dict[str, object]:
    data: dict[str, object] = {}
    # An entry before what is in it: of several values on one line the outermost gets the comment.
    for entry in table:
        here = (*place, entry.key)
        _comment(entry.at.file, entry.at.line, here, comments, waiting)
        data[entry.key] = _value(entry.value, here, comments, waiting, raw=raw or _is_raw(entry))
    return data


def _is_raw(entry: Entry) -> bool:
    return entry.key in _RAW or (entry.key in _BARE and isinstance(entry.value, Scalar))


def _comment(
    file: str, line: int, here: Place, comments: dict[Place, str], waiting: dict[tuple[str, int], Ignore]
) -> None:
    """Attach the ignore comment of a line to the first value on that line; it is taken out of `pending_ignores`."""
    ignore = waiting.pop((file, line), None)
    if ignore is not None:
        comments[here] = f"archgen: ignore[{', '.join(ignore.rules)}] {ignore.why}".rstrip()
