"""Prove an insertion: the file says what it said plus the new element, and no other element of the project changed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from archgen import pipeline
from archgen.diagnostic import Diagnostic, Severity
from archgen.edit.element import Element
from archgen.model.architecture import Architecture
from archgen.pipeline import Checked
from archgen.project.loaded import load_from
from archgen.syntax import yaml
from archgen.syntax.overlay import Overlay
from archgen.syntax.tree import plain


@dataclass(frozen=True, slots=True)
class Consequences:
    """What an insertion would do besides adding its element: new errors, and other elements that change."""

    errors: tuple[Diagnostic, ...]
    changed: tuple[str, ...]


def holds(before: str, after: str, path: tuple[str, ...], element: Element) -> bool:
    """Return whether a text says exactly what it said before, plus the element."""
    old, _ = yaml.parse("before", before)
    new, found = yaml.parse("after", after)
    # Notes and `swallowed-text` do not count here: the data themselves are compared below.
    if old is None or new is None or any(d.severity is not Severity.NOTE for d in found if d.rule != "swallowed-text"):
        return False
    expected = _with(plain(old.root), path, element)
    # An element in braces has no empty keys, so either form may be read back.
    given = _with(plain(old.root), path, element.inline())
    return _ordered(plain(new.root)) in (_ordered(expected), _ordered(given))


def _with(data: object, path: tuple[str, ...], element: Element) -> object:
    found = data if isinstance(data, dict) else {}
    if not path:
        return {**found, element.id: element.data}
    return {**found, path[0]: _with(found.get(path[0]), path[1:], element)}


def _ordered(data: object) -> object:
    """Return data as tuples, so that the order of mappings counts: elements appear in it."""
    if isinstance(data, dict):
        return tuple((key, _ordered(value)) for key, value in data.items())
    if isinstance(data, list):
        return [_ordered(value) for value in data]
    return (type(data), repr(data))


def consequences(checked: Checked, file: str, text: str, own: str) -> Consequences:
    """Judge the project with one file's text replaced, in memory; `element_id` is the id of the new element."""
    after = _judged(checked, file, text)
    # Changes the project that was passed in: errors about the new text are shown with lines of the new text.
    checked.sources.add(file, text)  # what is quoted of it now
    # Compared without their places: the insertion moves the lines below it.
    known = {(d.rule, d.message) for d in checked.findings}
    errors = (d for d in after.findings if d.severity is Severity.ERROR and (d.rule, d.message) not in known)
    return Consequences(tuple(errors), tuple(_changed(checked.architecture, after.architecture, own)))


def _judged(checked: Checked, file: str, text: str) -> Checked:
    files = checked.loaded.files
    return pipeline.judge(load_from(Overlay(files.root, {file: text.encode()}, files), first_file(checked)))


def first_file(checked: Checked) -> str:
    """Return the file that was read first: archgen.yaml, or the only one."""
    return checked.sources.files()[0]


def _changed(old: Architecture, new: Architecture, own: str) -> Iterator[str]:
    """Yield the elements of the functional level that differ from before; edges show where references lead."""
    for name, component in old.components.items():
        if new.components.get(name) != component:
            yield name
    for name, group in old.groups.items():
        now = new.groups.get(name)
        if now is None or replace(now, components=group.components, at=group.at) != group:
            yield name
    before, after = {(e.output, e.input) for e in old.edges}, {(e.output, e.input) for e in new.edges}
    yield from sorted(
        f"{a} -> {b}" for a, b in before ^ after if own not in {a.rpartition(".")[0], b.rpartition(".")[0]}
    )
    yield from (name for name, node in old.nodes.items() if node.written and name not in new.nodes)
