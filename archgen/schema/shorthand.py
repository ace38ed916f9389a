"""Expand the short forms, file by file, so that later stages never see them: every element becomes a mapping.

Empty entries are removed too (they count as not written), but below an id an empty entry declares the element and
becomes `{}`. Normalising twice changes nothing.
"""

from __future__ import annotations

import unicodedata
from dataclasses import field
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label
from archgen.frozen import dataclass
from archgen.syntax.tree import Entry, Listing, Scalar, Table

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.source import Span
    from archgen.syntax.tree import Document, Value


@dataclass(frozen=True, slots=True)
class Form:
    """What a kind of element looks like.

    A scalar or list in the element's place is the value of every key in `short_keys`. The keys in `list_keys` always
    hold lists. `keyed_forms` are the keys that hold elements by id, `part_forms` those that hold a single one. The
    values of `raw_keys` are left as they are.
    """

    short: tuple[str, ...] = ()
    lists: frozenset[str] = frozenset()
    keyed: Mapping[str, Form] = field(default_factory=dict)
    parts: Mapping[str, Form] = field(default_factory=dict)
    raw: frozenset[str] = frozenset()


_PLAIN = Form()
_TITLED = Form(("title",))
_TOPIC = Form(("topic",), frozenset({"topic"}), parts={"qos": Form(("profile",))})
_CALL = Form(("name",))
_USES = {"publishes": _TOPIC, "subscribes": _TOPIC, "serves": _CALL, "calls": _CALL}
_COMPONENT = Form(
    ("title",),
    keyed={
        "inputs": Form(("from",), frozenset({"from"})),
        "outputs": Form(("type",)),
        "performance": _PLAIN,
    },
)
_NODE = Form(
    ("implements",),
    frozenset({"implements", "kind"}),
    keyed=_USES,
    parts={"internal": Form(keyed=_USES)},
    raw=frozenset({"parameters"}),
)
# One latency is both the best and the worst: a constant.
_LINK = Form(("connects",), frozenset({"connects"}), parts={"latency": Form(("best", "worst"))})
_ROOT = Form(
    keyed={
        "partners": _TITLED,
        "use_cases": _TITLED,
        "requirements": _TITLED,
        "groups": Form(("title",), keyed={"components": _COMPONENT}),
        "nodes": _NODE,
        "types": Form(("message",)),
        "hosts": _TITLED,
        "containers": Form(("host",)),
        "links": _LINK,
        "chains": Form(("through",), frozenset({"through"})),
        "views": Form(("show",)),
        "policies": _PLAIN,
    },
    parts={"review": Form(lists=frozenset({"backends"}), keyed={"accepted": Form(("reason",))})},
)


def normalise(document: Document) -> tuple[Diagnostic, ...]:
    """Bring a validated document into the normal form. Its tree is changed in place."""
    # Types and indicators first: both look at short forms that _normalise_mapping expands.
    types = document.root.get("types")
    found = tuple(_fold_types(types)) if isinstance(types, Table) else ()
    groups = document.root.get("groups")
    clashes = tuple(_overall(groups)) if isinstance(groups, Table) else ()
    _table(document.root, _ROOT)
    return found + clashes


def fold(name: str) -> str:
    """Return a type's name as it is compared: runs of blanks folded to one, in Unicode's composed form (NFC)."""
    # Nearly every name is plain ASCII without double blanks and needs no work.
    return name if name.isascii() and "  " not in name and name == name.strip() else _folded(name)


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", " ".join(name.split()))


def _element(value: Value, form: Form) -> Table:
    """Return an element as a mapping: itself, or its short form expanded; empty becomes `{}`."""
    if isinstance(value, Table):
        _table(value, form)
        return value
    if isinstance(value, Scalar) and value.value is None:
        return Table({}, value.at)
    # All keys share the node where there are several: safe, because scalars and lists are not changed after this.
    return Table({key: Entry(key, value.at, _leaf(key, value, form)) for key in form.short}, value.at)


def _leaf(key: str, value: Value, form: Form) -> Value:
    return Listing([value], value.at) if key in form.lists and isinstance(value, Scalar) else value


def _table(table: Table, form: Form) -> None:
    """Bring the entries of a mapping into the normal form in place, and drop those that are empty."""
    empty: list[str] = []
    for key, entry in table.entries.items():
        value = entry.value
        if isinstance(value, Scalar) and value.value is None:
            empty.append(key)
        elif key in form.parts:
            entry.value = _element(value, form.parts[key])
        elif isinstance(value, Table):
            _below(key, value, form)
        else:
            entry.value = _leaf(key, value, form)
    for key in empty:
        del table.entries[key]


def _below(key: str, value: Table, form: Form) -> None:
    if key in form.keyed:
        element_form = form.keyed[key]
        for element in value.entries.values():
            element.value = _element(element.value, element_form)
    elif key not in form.raw:
        _table(value, _PLAIN)


def _fold_types(types: Table) -> Iterator[Diagnostic]:
    """Replace the names of types by their folded form, and report names that fold to the same."""
    if all(fold(key) == key for key in types.entries):
        return
    folded: dict[str, Entry] = {}
    for entry in types:
        name = fold(entry.key)
        first = folded.setdefault(name, entry)
        if first is not entry:
            yield _twice("duplicate-key", f"the type `{name}` is written twice", entry.at, first.at)
        entry.key = name
    types.entries = folded


# The figures of an indicator that may be written directly in `performance`.
_DIRECT = ("accuracy", "execution_time")


def _overall(groups: Table) -> Iterator[Diagnostic]:
    """Move figures written directly in `performance` into its indicator `overall`."""
    for group in groups:
        components = group.value.get("components") if isinstance(group.value, Table) else None
        for component in components if isinstance(components, Table) else ():
            performance = component.value.get("performance") if isinstance(component.value, Table) else None
            if isinstance(performance, Table):
                yield from _hoist(performance)


def _hoist(performance: Table) -> Iterator[Diagnostic]:
    direct = [performance.entries[key] for key in _DIRECT if isinstance(performance.get(key), Scalar)]
    for entry in direct:
        del performance.entries[entry.key]
    written = [entry for entry in direct if isinstance(entry.value, Scalar) and entry.value.value is not None]
    if not written:
        return
    # Validation has left either a mapping or an empty `overall:`, which gives way to the figures.
    overall = performance.entries.get("overall")
    if overall is None or not isinstance(overall.value, Table):
        overall = Entry("overall", written[0].at, Table({}, written[0].at))
        performance.entries = {"overall": overall} | performance.entries | {"overall": overall}
    for entry in written:
        first = overall.value.entries.setdefault(entry.key, entry) if isinstance(overall.value, Table) else entry
        if first is not entry:
            message = f"`{entry.key}` of the indicator `overall` is written twice"
            yield _twice("conflicting-values", message, entry.value.at, first.value.at)


def _twice(rule: str, message: str, at: Span, first: Span) -> Diagnostic:
    return Diagnostic(rule, message, at, labels=(Label(first, "first written here"),))
