"""Import rows that connect a component's output to a component's input."""

from __future__ import annotations

from typing import NamedTuple

from archgen.importers import ports, values
from archgen.importers.cells import Cell
from archgen.importers.draft import UNSORTED, Component, Draft, Input
from archgen.importers.rows import Record
from archgen.model import ids


class End(NamedTuple):
    """One end of a connection: a component, and the name of its port if the cell has one (`component.output`)."""

    component: Component
    port: str


class Flow(NamedTuple):
    """What flows: the output's id (empty where it is not known) and its type."""

    output: str
    type: str | None


def connect(draft: Draft, row: Record) -> None:
    """Import one connection."""
    if row.kind != "connection":
        return
    if row.exact:
        _connect_paths(draft, row)
        return
    first = row.get("from") or (row.get("component") if row.get("to") else None)
    last = row.get("to") or (row.get("component") if row.get("from") else None)
    if first is None and last is None:
        return  # a formula stood there, and was said
    source = _end(draft, row, first, "from_group") if first else None
    target = _end(draft, row, last, "to_group") if last else None
    if (first and source is None) or (last and target is None):
        return
    _say_open(draft, row, source, target)
    told = _type(draft, row)
    name = _output(draft, row, source, told) if source else ""
    # `import_node_row` comes later, and needs the component and output that this row is about.
    row.component = source.component if source else None
    row.cells["output"] = Cell(name, row.first.at)
    if target:
        _feed(draft, row, (source, target), Flow(name, told))
    rate = row.get("rate") or row.get("period")
    if rate and source:
        unit = row.units.get("rate" if row.get("rate") else "period", "Hz" if row.get("rate") else "ms")
        _rate(draft, source.component, rate, unit)
    if row.get("requirement"):
        message = "requirements of a connection were not taken: components have them"
        draft.say("wrong-value", message, row.cells["requirement"].at, "write them in a component's row")


def _say_open(draft: Draft, row: Record, source: End | None, target: End | None) -> None:
    """Report a connection without a source."""
    if source is None and target is not None:
        message = f"nothing says where this comes from: the input of `{target.component.name}` has no source yet"
        draft.say("missing-key", message, row.first.at, "fill in the component that gives it")


def _end(draft: Draft, row: Record, cell: Cell, group_key: str) -> End | None:
    """Find the component that a cell names; add one that no row declares, and report it."""
    outer = row.get(group_key) or (row.get("group") if group_key == "from_group" else None)
    name = cell.line
    named = draft.named(name)
    if row.get(group_key):
        return End(draft.component(draft.group(row.cells[group_key].line, cell.at), name, cell.at), "")
    # A component of the row's own group comes before namesakes in other groups.
    inside = [one for one in named if outer and one.group == draft.group(outer.line, outer.at).id] or named
    if len(inside) == 1:
        return End(inside[0], "")
    if inside:
        groups = ", ".join(f"`{one.group}`" for one in inside)
        message = f"`{name}` is a component in several groups ({groups}): this row was not taken"
        draft.say("ambiguous-reference", message, cell.at, f"write `{inside[0].group}.{inside[0].id}`")
        return None
    parts = draft.parts(name)
    if parts:
        return End(*parts)
    return End(_new(draft, cell, outer), "")


def _new(draft: Draft, cell: Cell, outer: Cell | None) -> Component:
    """Add a component that no row declares."""
    guess = draft.guess(cell.line)
    group = draft.group(outer.line if outer else UNSORTED, cell.at)
    made = draft.component(group, cell.line, cell.at)
    if draft.complete:
        message = f"no row declares the component `{cell.line}`: it was added to the group `{group.id}`"
        draft.say("unknown-reference", message, cell.at, f"{guess}or add a row for it" if guess else "add a row for it")
    return made


def _type(draft: Draft, row: Record) -> str | None:
    """Read the row's type, or else its message."""
    cell, message = row.get("type"), row.get("message")
    told = values.type_name(draft, cell) if cell else None
    return told or (values.message(draft, message) if message else None)


def _output(draft: Draft, row: Record, source: End, told: str | None) -> str:
    """Return the output's id: as the row names it, as its type is called, or the only one of the component."""
    held = source.component.outputs
    cell = row.get("output")
    name = cell.line if cell else source.port
    if not name and told:
        name = next((key for key, type_ in held.items() if type_ == told), "") or told.rpartition("/")[2]
    if not name and len(held) == 1:
        return next(iter(held))
    if not name:
        return ""
    key = name if name in held else ids.made(name, "output")
    return ports.output(draft, source.component, key, told, cell or row.first)


def _feed(draft: Draft, row: Record, ends: tuple[End | None, End], flow: Flow) -> None:
    """Connect a component's input to its source, and describe it."""
    (source, target), name, told = ends, flow.output, flow.type
    cell = row.get("input")
    wanted = cell.line if cell else target.port
    made = ids.made(wanted, "input") if wanted else name
    if not made:
        made = source.component.id if source else "input"
    path = _path(source, name) if source else ()
    held = target.component.inputs.get(made)
    # Without a name of its own the input is called like the output. A second source of the same type feeds the same
    # input; one of another type must not, and gets an input named after its component.
    if held and not wanted and held.sources and path and path not in held.sources and _types(draft, held, told):
        made = ids.free(
            f"{made}_{source.component.id}"[: ids.LONGEST].strip("_") if source else made, set(target.component.inputs)
        )
    port = target.component.inputs.setdefault(made, Input())
    if path and path not in port.sources:
        port.sources.append(path)
    elif not path and told:
        port.type = port.type or told
    text = row.get("description") or row.get("functionality")
    if text and port.description is None:
        port.description = text.line
    elif text and port.description != text.line:
        draft.say(
            "conflicting-values",
            f"another row describes the input `{made}`: this was not taken",
            text.at,
            "say it once",
        )


def _types(draft: Draft, held: Input, told: str | None) -> bool:
    """Return whether an input already takes a type other than this one."""
    known = {
        draft.groups[path[0]].components[path[1]].outputs.get(path[2])
        for path in held.sources
        if len(path) == 3  # noqa: PLR2004 - group, component, output
    }
    return told not in known


def _path(source: End, name: str) -> tuple[str, ...]:
    """Return the path of an output, or of its component where the output is not known."""
    one = source.component
    return (one.group, one.id, name) if name else (one.group, one.id)


def _rate(draft: Draft, component: Component, cell: Cell, unit: str) -> None:
    """Set a component's rate; a different one from an earlier row stays."""
    told = values.timing(draft, cell, unit)
    if told is not None and component.keys.setdefault("timing", told) != told:
        message = f"`{component.name}` has another rate already: this was not taken"
        draft.say(
            "conflicting-values", message, cell.at, "a component has one rate; slower outputs are written by hand"
        )


def _connect_paths(draft: Draft, row: Record) -> None:
    """Import a connection that `archgen list` wrote: complete paths at both ends."""
    source, target = row.get("from"), row.get("to")
    if source is None or target is None:
        return
    path = tuple(source.line.split("."))
    group, _, rest = target.line.partition(".")
    component, _, port = rest.partition(".")
    reader = draft.component(draft.group(group, target.at), component, target.at)
    held = reader.inputs.setdefault(port, Input())
    if path not in held.sources:
        held.sources.append(path)
    if len(path) > 1:
        giver = draft.component(draft.group(path[0], source.at), path[1], source.at)
        told = _type(draft, row) if row.get("type") and row.cells["type"].line != "?" else None
        if len(path) == 3:  # noqa: PLR2004 - group, component, output
            draft.give(giver, path[2], giver.outputs.get(path[2]) or told)
