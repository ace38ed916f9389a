"""Merge the slices: documents become one mapping, in their order; elements that no file declares are reported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Rule, Severity
from archgen.schema import element
from archgen.source import NOWHERE
from archgen.suggest import did_you_mean
from archgen.syntax.tree import Entry, Table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from archgen.syntax.tree import Document, Value

Path = tuple[str, ...]
_SUPPORT = frozenset({"timing", "requirements", "tags", "urls", "layout", "owner"})
"""Keys that supporting files add to components which other files declare: they alone declare nothing."""


def merge(documents: Sequence[Document], lost: frozenset[str] = frozenset()) -> tuple[Table, tuple[Diagnostic, ...]]:
    """Merge documents in normal form into one mapping.

    The documents are not changed (they may be cached for other revisions); the result shares their nodes. `lost_keys`
    are the keys in files that could not be read: an element that one of them may declare is not reported as undeclared.
    """
    found: list[Diagnostic] = []
    root = _join([document.root for document in documents], (), found)
    # Before incomplete elements are looked for, so that an undeclared element is a single finding.
    root, undeclared = _declared(root, documents, lost)
    return root, (*found, *undeclared, *_incomplete(root))


def _join(tables: Sequence[Table], path: Path, found: list[Diagnostic]) -> Table:
    """Merge mappings key by key, in the order of first appearance."""
    # Most subtrees are in one file only: they are shared with its document instead of being rebuilt.
    if len(tables) == 1:
        return tables[0]
    written: dict[str, list[Entry]] = {}
    for table in tables:
        for key, entry in table.entries.items():
            written.setdefault(key, []).append(entry)
    entries = {key: _one(several, (*path, key), found) for key, several in written.items()}
    return Table(entries, tables[0].at if tables else NOWHERE)


def _one(several: list[Entry], path: Path, found: list[Diagnostic]) -> Entry:
    """Merge the entries at one path: mappings key by key; of anything else the first stays, the others are reported."""
    first = several[0]
    if len(several) == 1:
        return first
    # A mapping and a leaf at one path conflict whatever comes first; the mappings among them are merged all the same.
    if isinstance(first.value, Table) and not _is_parameter(path):
        tables = [entry.value for entry in several if isinstance(entry.value, Table)]
        found.extend(_conflict(entry, first, path) for entry in several if not isinstance(entry.value, Table))
        return Entry(first.key, first.at, _join(tables, path, found))
    found.extend(_conflict(entry, first, path) for entry in several[1:])
    return first


def _is_parameter(path: Path) -> bool:
    # nodes, id, parameters, name: a parameter is one value even if it is a mapping, and is never merged.
    return len(path) == 4 and path[0] == "nodes" and path[2] == "parameters"  # noqa: PLR2004


def _conflict(entry: Entry, first: Entry, path: Path) -> Diagnostic:
    owner = element(path[:-1])
    of = f" of `{owner}`" if owner else ""
    message = f"`{path[-1]}`{of} is written in two places"
    label = Label(first.value.at, "first written here")
    help_line = "a value is written once in the whole project, even where both are equal: keep one of them"
    return Diagnostic("conflicting-values", message, entry.value.at, labels=(label,), help=help_line, element=owner)


def _declared(root: Table, documents: Sequence[Document], unread: frozenset[str]) -> tuple[Table, list[Diagnostic]]:
    """Remove the components and groups that no file declares, and report them."""
    groups = root.get("groups")
    if not isinstance(groups, Table):
        return root, []
    # Normal form turns a bare id into `{}`, which merging makes invisible: it must be looked for in the documents.
    lost = [path for path in _candidates(groups) if not _is_empty_somewhere(path, documents)]
    if not lost:
        return root, []
    # Only what is declared is offered as a guess: two slips of the same kind must not suggest each other.
    known = [path for path in _all(groups) if path not in lost]
    found = [_undeclared(groups, path, known) for path in lost if path[-1] not in unread]
    entry = root.entries["groups"]
    kept = _without(groups, frozenset(lost))
    return Table({**root.entries, "groups": Entry("groups", entry.at, kept)}, root.at), found


def _all(groups: Table) -> Iterator[Path]:
    for group in groups:
        yield (group.key,)
        yield from ((group.key, component.key) for component in _components(group.value))


def _candidates(groups: Table) -> Iterator[Path]:
    """Yield the paths of groups with neither title nor components, and of components with supporting keys only."""
    for group in groups:
        if isinstance(group.value, Table) and "title" not in group.value.entries and not any(_components(group.value)):
            yield (group.key,)
        for component in _components(group.value):
            if isinstance(component.value, Table) and _SUPPORT.issuperset(component.value.entries):
                yield (group.key, component.key)


def _components(group: Value) -> Iterable[Entry]:
    components = group.get("components") if isinstance(group, Table) else None
    return components if isinstance(components, Table) else ()


def _is_empty_somewhere(path: Path, documents: Sequence[Document]) -> bool:
    """Whether some document declares an element by its bare id."""
    full = ("groups", path[0]) if len(path) == 1 else ("groups", path[0], "components", path[1])
    return any(_at(document.root, full) for document in documents)


def _at(value: Value | None, path: Path) -> bool:
    for key in path:
        value = value.get(key) if isinstance(value, Table) else None
    return isinstance(value, Table) and not value.entries


def _undeclared(groups: Table, path: Path, known: Sequence[Path]) -> Diagnostic:
    kind = "group" if len(path) == 1 else "component"
    entry = groups.entries[path[0]]
    if len(path) > 1:
        entry = next(component for component in _components(entry.value) if component.key == path[1])
    name = ".".join(path)
    guess = did_you_mean(name, (".".join(other) for other in known if len(other) == len(path)))
    needed = "a title or a component" if kind == "group" else "a title, a functionality, inputs or outputs"
    # An id of an existing element that is nearly the same is the likelier cause: without one the element is new.
    help_line = guess or f"give it {needed} where it belongs"
    return Diagnostic(
        "undeclared-element", f"no file declares the {kind} `{name}`", entry.at, help=help_line, element=name
    )


def _without(groups: Table, lost: frozenset[Path]) -> Table:
    kept: dict[str, Entry] = {}
    for group in groups:
        if (group.key,) in lost:
            continue
        components = [c for c in _components(group.value) if (group.key, c.key) not in lost]
        if isinstance(group.value, Table) and len(components) < sum(1 for _ in _components(group.value)):
            # A group of which nothing is left goes too; nodes are copied, since the documents must not change.
            if not components and "title" not in group.value.entries:
                continue
            old = group.value.entries["components"]
            table = Table({c.key: c for c in components}, old.value.at)
            entries = {**group.value.entries, "components": Entry(old.key, old.at, table)}
            kept[group.key] = Entry(group.key, group.at, Table(entries, group.value.at))
        else:
            kept[group.key] = group
    return Table(kept, groups.at)


# By section, the paths without which an element means nothing. The schema cannot ask for them: in a single slice every
# key may be missing, because another file may write it.
_NEEDED: dict[Path, tuple[Path, ...]] = {
    ("views",): (("show",),),
    ("policies",): (("forbid", "from"), ("forbid", "to")),
    ("review", "accepted"): (("reason",),),
}


def _incomplete(root: Table) -> Iterator[Diagnostic]:
    """Report elements that lack a key without which they mean nothing, in all slices together."""
    for section, needed in _NEEDED.items():
        table = _below(root, section)
        for entry in table if isinstance(table, Table) else ():
            for path in needed:
                if not _has(entry.value, path):
                    message = f"`{entry.key}` lacks `{'.'.join(path)}`"
                    yield Diagnostic("missing-key", message, entry.at, help=_HELP[section[-1]], element=entry.key)


_HELP = {
    "views": 'say what the view shows: `show: "tag:safety"`',
    "policies": "say which flow is forbidden: `forbid: {from: planning, to: motors}`",
    "accepted": "say why the change is right: `camera.image: the tracker moved to depth images`",
}


def _has(value: Value, path: Path) -> bool:
    return _below(value, path) is not None


def _below(value: Value | None, path: Path) -> Value | None:
    for key in path:
        value = value.get(key) if isinstance(value, Table) else None
    return value


RULES: tuple[Rule, ...] = (
    Rule(
        "conflicting-values",
        Severity.ERROR,
        """One value is written in two places of the project.

Why: two files that say the same today say different things tomorrow. Each value has one home.

Bad:

    groups:
      sensing:
        title: Sensing
        components:
          camera:
            performance:
              accuracy: 90 %
              overall: {accuracy: 95 %}
    nodes: {camera: {implements: sensing.camera}}

Good:

    groups:
      sensing:
        title: Sensing
        components:
          camera:
            performance: {accuracy: 90 %}
    nodes: {camera: {implements: sensing.camera}}
""",
        fixed=True,
    ),
    Rule(
        "undeclared-element",
        Severity.ERROR,
        """A file adds to a component or a group that no file declares.

Why: files with timing, requirements or tags refer to components by their ids. A slip in such an id would make a second
component, and the first would stay without its timing.

Bad:

    groups:
      sensing:
        title: Sensing
        components:
          camera: Camera
          camra: {timing: {rate: 10 Hz}}
    nodes: {camera: {implements: sensing.camera}}

Good:

    groups:
      sensing:
        title: Sensing
        components:
          camera: {title: Camera, timing: {rate: 10 Hz}}
    nodes: {camera: {implements: sensing.camera}}
""",
        fixed=True,
    ),
)
