"""Import the lists of inputs and outputs in a component's row, and find out where each input comes from."""

from __future__ import annotations

import re

from archgen.importers import values
from archgen.importers.cells import Cell
from archgen.importers.draft import Component, Draft, Input, fold
from archgen.importers.rows import Record
from archgen.model import ids

_NONE = frozenset({"none", "nothing", "no", "no inputs", "no outputs"})


def outputs(draft: Draft, row: Record) -> None:
    """Import the list of outputs in a component's row."""
    cell, component = row.get("output"), row.component
    if row.kind != "component" or row.exact or cell is None or component is None:
        return
    if cell.line.casefold() in _NONE:
        component.none.add("outputs")
        return
    for part in values.several(cell):
        name, colon, text = (word.strip() for word in part.partition(":"))
        given = row.get("type") if len(values.several(cell)) == 1 and not colon else None
        told = (
            values.type_name(draft, given) if given else values.type_name(draft, Cell(text if colon else name, cell.at))
        )
        if name:
            output(draft, component, ids.made(name, "output"), told, cell)


def output(draft: Draft, component: Component, name: str, told: str | None, cell: Cell) -> str:
    """Add an output to a component and return its id; another type on the same id makes another output."""
    held = component.outputs.get(name)
    if name not in component.outputs or held is None:
        draft.give(component, name, told)
    elif told is not None and held != told:
        same = next((key for key, type_ in component.outputs.items() if type_ == told), None)
        free = same or ids.free(name, set(component.outputs))
        if same is None:
            draft.give(component, free, told)
            message = f"the output `{name}` of `{component.name}` carries `{held}`: `{told}` became the output `{free}`"
            draft.note(message, cell.at, "give the outputs names of their own")
        return free
    return name


def inputs(draft: Draft, row: Record) -> None:
    """Import the list of inputs in a component's row, each with its source where that is clear."""
    cell, component = row.get("input"), row.component
    if row.kind != "component" or row.exact or cell is None or component is None:
        return
    if cell.line.casefold() in _NONE:
        component.none.add("inputs")
        return
    for part in values.several(cell):
        name, _, text = (word.strip() for word in part.partition(":"))
        _input(draft, component, name, text or name, cell)


def _input(draft: Draft, component: Component, name: str, text: str, cell: Cell) -> None:
    """Import one input: `WHAT`, `NAME: WHAT`, `WHAT from COMPONENT`, `WHAT <- COMPONENT` or `WHAT @ COMPONENT`."""
    wanted, giver = text, ""
    said = re.match(r"(.+?)(?:\s+from\s+|\s*<-\s*|\s*\u2190\s*|\s*@\s*)(.+)\Z|(.+?)\s*\((?:from\s+)(.+)\)\Z", text)
    if said:
        wanted, giver = (said[1] or said[3]).strip(), (said[2] or said[4]).strip()
        name = wanted if name == text else name
    found = _givers(draft, component, wanted, giver)
    port = component.inputs.setdefault(ids.made(name, "input"), Input())
    if len(found) == 1:
        port.sources += [source for source in found if source not in port.sources]
        return
    if port.sources:
        return
    port.type = values.type_name(draft, Cell(wanted, cell.at))
    if len(found) > 1:
        who = ", ".join(f"`{'.'.join(path)}`" for path in found[:4])
        message = f"`{wanted}` comes from several components ({who}): the input has no source yet"
        draft.say("ambiguous-reference", message, cell.at, f"write `{wanted} from NAME`")
    elif giver:
        message = f"no component is called `{giver}`: the input `{name}` of `{component.name}` has no source yet"
        draft.say("unknown-reference", message, cell.at, draft.guess(giver) or "add a row for it")
    else:
        message = f"no component gives `{wanted}`: the input of `{component.name}` has no source yet"
        draft.say(
            "unknown-reference", message, cell.at, "name it as an output somewhere, or write `WHAT from COMPONENT`"
        )


def _givers(draft: Draft, reader: Component, wanted: str, giver: str) -> list[tuple[str, ...]]:
    """Return the paths that an input may mean."""
    if giver:
        dotted = draft.parts(giver)
        found = draft.named(giver) or ([dotted[0]] if dotted else [])
        return [_output_of(draft, one, wanted) for one in found]
    # A component by that name comes before outputs and types: people list what feeds an input by its component.
    named = [one for one in draft.named(wanted) if one is not reader]
    if named:
        return [(one.group, one.id) for one in named]
    dotted = draft.parts(wanted)
    if dotted and dotted[1]:
        return [_output_of(draft, dotted[0], dotted[1])]
    return [path for path in draft.givers(wanted) if path[:2] != (reader.group, reader.id)]


def _output_of(draft: Draft, one: Component, wanted: str) -> tuple[str, ...]:
    """Return the path of a component's output by its name or type; add the output where there is none."""
    name = next((n for n, told in one.outputs.items() if fold(wanted) in {fold(n), fold(told or "")}), None)
    if name is None:
        name = ids.made(wanted, "output")
        draft.give(one, name, wanted)
    return (one.group, one.id, name)
