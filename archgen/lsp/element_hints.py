"""What stands beside elements in an editor: who reads an output, what a chain takes, topics that follow, colours of names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.checking.reference_index import WrittenName
from archgen.diagnostics import Span
from archgen.frozen import NamedTuple
from archgen.live.warm_project import EditedProject
from archgen.model.port_media import ROS
from archgen.views.lookup import Lookup
from archgen.views.timing.value_format import display_duration

TOKEN_TYPES = {
    "group": "namespace",
    "component": "class",
    "component_type": "interface",
    "input": "parameter",
    "output": "property",
    "node": "variable",
    "type": "type",
    "chain": "function",
    "use_case": "event",
}
"""Kinds of elements in the words that themes of editors know; others are values of a list."""
OTHER_TOKEN = "enumMember"  # noqa: S105 - no password
TOKEN_MODIFIERS = ("declaration", "deprecated")
_HOLDERS = {"component": ("group", "component"), "input": ("group", "component"), "output": ("group", "component")}


class Hint(NamedTuple):
    """A few words at a place."""

    span: Span
    text: str


def list_lenses(project: EditedProject, file: str) -> Iterator[Hint]:
    """Yield what is worth knowing above the elements that a file declares."""
    lookup = project.lookup
    for name in _list_declared(project, file):
        text = "; ".join(_describe(project, lookup, name))
        if text:
            yield Hint(name.span, text)


def _list_declared(project: EditedProject, file: str) -> Iterator[WrittenName]:
    """Yield the declarations in a file, of what stands in a component type one."""
    seen: set[Span] = set()
    for name in project.index.names:
        if name.is_declaration and name.span.file == file and name.span not in seen:
            seen.add(name.span)
            yield name


def _describe(project: EditedProject, lookup: Lookup, name: WrittenName) -> Iterator[str]:
    if name.kind == "output" and name.id in lookup.architecture.outputs:
        yield _count(len({connection.input for connection in lookup.readers_of.get(name.id, ())}), "reader")
    elif name.kind == "chain":
        chain = lookup.architecture.chains.get(name.id)
        bound = project.chain_bounds.get(name.id)
        if chain is not None and bound is not None:
            deadline = f" of {chain.deadline.text}" if chain.deadline else ""
            lags = "" if project.is_whole else " (as it was)"
            yield f"bound {display_duration(bound)}{deadline}{lags}"
    elif name.kind == "group":
        count = sum(len(lookup.findings_of.get(each, ())) for each in _list_parts(lookup, name.id))
        if count:
            yield _count(count, "finding")


def _list_parts(lookup: Lookup, group_id: str) -> Iterable[str]:
    group = lookup.architecture.groups.get(group_id)
    return (group_id, *(component.id for component in group.components.values())) if group else ()


def _count(number: int, word: str) -> str:
    return f"{number or 'no'} {word}{'s' * (number != 1)}"


def list_inlays(project: EditedProject, file: str) -> Iterator[Hint]:
    """Yield the topics on which outputs travel, behind their ids: they follow, or are written at nodes."""
    topics = {
        endpoint.port: endpoint.name
        for endpoint in project.checked.architecture.endpoints
        if endpoint.port and endpoint.name and endpoint.medium == ROS
    }
    for name in _list_declared(project, file):
        if name.kind == "output" and name.id in topics and name.is_exact:
            yield Hint(name.span, topics[name.id])


class Token(NamedTuple):
    """A coloured word: its place, its kind as themes know it, and the numbers of its modifiers."""

    span: Span
    type: str
    modifiers: tuple[str, ...]


def list_tokens(project: EditedProject, file: str) -> Iterator[Token]:
    """Yield the words of all names in a file, in order; of names that overlap the first."""
    outputs = project.checked.architecture.outputs
    end = (0, 0)
    for name in sorted(
        name
        for name in project.index.names
        if name.span.file == file and name.is_exact and name.span.line == name.span.end_line
    ):
        if (name.span.line, name.span.column) < end:
            continue
        end = (name.span.line, name.span.end_column)
        output = outputs.get(name.id) if name.kind == "output" else None
        modifiers = ("declaration",) * name.is_declaration + ("deprecated",) * bool(output and output.deprecated)
        *before, last = name.text.split(".") if name.kind in _HOLDERS else [name.text]
        column = name.span.column
        depth = name.id.count(".") - len(before)
        for number, word in enumerate(before):
            kind = _HOLDERS[name.kind][min(depth + number, 1)]
            span = name.span._replace(column=column, end_column=column + len(word))
            yield Token(span, TOKEN_TYPES[kind], ())
            column += len(word) + 1
        span = name.span._replace(column=column, end_column=column + len(last))
        yield Token(span, TOKEN_TYPES.get(name.kind, OTHER_TOKEN), modifiers)
