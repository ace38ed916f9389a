"""Describe changes in words: what happened, and what it means for those at the other end."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from archgen.compare.change import Change
from archgen.compare.elements import Element, Key
from archgen.compare.phrases import changed_key, listed, short
from archgen.compare.told import Told
from archgen.compare.values import Title, plain
from archgen.compare.wiring import Rewired
from archgen.transform import ros_names

_WORDS = {
    "use_case": "use case",
    "message": "message definition",
    "port": "port",
}
_DOES: Mapping[str, Mapping[str, str]] = {
    "node": {"implements": "implements", "host": "runs on", "container": "runs in the container"},
    "type": {"message": "is"},
    "requirement": {"use_cases": "belongs to"},
    "link": {"connects": "connects"},
    "chain": {"through": "leads through", "deadline": "must end within"},
}
"""For each kind, the keys reported of a new element, each with a verb."""
_MOST = 3
"""Maximal number of effects in one sentence; all of them are in the parts."""


def whole(change: Change, element: Element, told: Told) -> str:
    """Describe an element that was added or removed, with the effects of its connections on others."""
    verb = "is added" if change.kind == "added" else "is removed"
    sort = _WORDS.get(change.sort, change.sort)
    said = f"{sort} `{short(change.element)}`{_called(element)} {verb}{_with(change)}"
    if change.kind == "added":
        said += _being(element)
    effects = list(_effects(change, element, told))
    return "; ".join((said, *_some(effects)))


def _called(element: Element) -> str:
    title = element.values.get("title")
    return f" ({short(title.text)})" if isinstance(title, Title) and not title.made else ""


def _being(element: Element) -> str:
    """Describe what matters most of a new element, such as a node's place or the way of a chain."""
    if element.sort == "policy":
        return f"; nothing may lead from `{short(str(element.values['forbid.from']))}` to `{short(str(element.values['forbid.to']))}`"
    does = [
        f"{verb} {_ticked(named)}"
        for key, verb in _DOES.get(element.sort, {}).items()
        if (named := _several(element.values.get(key)))
    ]
    return f"; it {listed(does)}" if does else ""


def _several(value: object) -> list[str]:
    if isinstance(value, (frozenset, tuple)):
        return sorted(map(str, value)) if isinstance(value, frozenset) else [*map(str, value)]
    return [] if value is None else [str(plain(value))]


def _some(effects: Sequence[str]) -> Sequence[str]:
    more = len(effects) - _MOST
    return effects if more <= 0 else (*effects[:_MOST], f"and {more} more such effects")


def _with(change: Change) -> str:
    """Count the components and ports that were added or removed with it."""
    counts = {"component": 0, "input": 0, "output": 0}
    for part in _below(change):
        if part.sort in counts and part.kind == change.kind:
            counts[part.sort] += 1
    words = [f"{n} {sort}{'s' if n > 1 else ''}" for sort, n in counts.items() if n]
    return f" with {listed(words)}" if words else ""


def _below(change: Change) -> Iterator[Change]:
    for part in change.parts:
        yield part
        yield from _below(part)


def _effects(change: Change, element: Element, told: Told) -> Iterator[str]:
    """Describe who lost the last reader or source or gained the first, and which requirements are served no more."""
    inside = {(part.sort, part.element) for part in (change, *_below(change))}
    # A connection is known by its input.
    names = {name for sort, name in inside if sort == "connection"}
    here, there = (told.old, told.new) if change.kind == "removed" else (told.new, told.old)
    if change.kind == "added" or change.sort == "input":
        yield from _reading(names, inside, told, change.kind)
    for reader in sorted(names):
        name = _common(reader, told)
        for source in sorted(here.sources.get(name, frozenset()) - there.sources.get(name, frozenset())):
            # A source that came or went itself has a change of its own.
            kept = ("output", source) in told.before and ("output", source) in told.after
            if kept and not there.readers.get(source):
                yield _end_of(source, "read", change.kind)
        if ("input", reader) not in inside and not there.sources.get(name):
            yield _end_of(name, "fed", change.kind)
        elif ("input", reader) not in inside:
            yield f"`{name}` {'loses one of its sources' if change.kind == 'removed' else 'gets another source'}"
    if (
        element.sort == "node"
        and change.kind == "removed"
        and isinstance(did := element.values.get("implements"), frozenset)
    ):
        still = {
            name
            for key, other in told.after.items()
            if key[0] == "node"
            for name in _several(other.values.get("implements"))
        }
        left = [name for name in sorted(did) if name not in still and ("component", name) in told.after]
        yield from [f"no node implements {_ticked(left)} any more"] if left else []
    yield from _unserved(element, told)
    if element.sort == "requirement" and change.kind == "removed":
        served = sorted(told.serving[0].get(element.id, ()))
        yield from [f"it was served by {_ticked(served)}"] if served else []


def _reading(names: Iterable[str], inside: Collection[Key], told: Told, kind: str) -> Iterator[str]:
    """Describe what added or removed inputs read from outside of the change, except what is reported anyway."""
    wires, others = (told.new, told.old) if kind == "added" else (told.old, told.new)
    ports = [_common(name, told) for name in names if ("input", name) in inside]
    read = sorted({source for port in ports for source in wires.sources.get(port, frozenset())})
    kept = {name for name in read if ("output", name) in told.before and ("output", name) in told.after}
    said = {name for name in kept if not others.readers.get(name)}
    shown = [_shown("output", name, told) for name in read if name not in said]
    outside = [name for name in shown if ("output", name) not in inside]
    if outside:
        yield f"it {'reads' if kind == 'added' else 'read'} {_ticked(outside)}"


def _common(own: str, told: Told) -> str:
    """Return the common id of an input that may be given by its old one."""
    if ("input", own) in told.before or ("input", own) in told.after:
        return own
    return next((name for (sort, name), e in told.before.items() if sort == "input" and e.own == own), own)


def _shown(sort: str, name: str, told: Told) -> str:
    element = None if (sort, name) in told.after else told.before.get((sort, name))
    return element.own if element else name


def _end_of(name: str, done: str, kind: str) -> str:
    if kind == "removed":
        return f"`{name}` is no longer read by anybody" if done == "read" else f"`{name}` has no source any more"
    return f"`{name}` is read for the first time" if done == "read" else f"`{name}` gets its first source"


def _unserved(element: Element, told: Told) -> Iterator[str]:
    if element.sort not in {"component", "group"}:
        return
    before, after = told.serving
    for requirement in sorted(before):
        if requirement not in after and ("requirement", requirement) in told.after:
            first = min(before[requirement])  # so that one change of several says it
            if element.id == first or first.startswith(f"{element.id}."):
                yield f"no component serves `{requirement}` any more"


def renamed(change: Change, told: Told) -> str:
    """Describe a rename or a move, and the names on the robot that follow it."""
    sort = _WORDS.get(change.sort, change.sort)
    was = change.was or ""
    if change.kind == "moved":
        old, new = was.rpartition("."), change.element.rpartition(".")
        called = "" if old[2] == new[2] else f" and is called `{new[2]}` now"
        said = f"{sort} `{was}` moved to the group `{new[0]}`{called}"
    elif change.sort in {"component", "input", "output"}:
        said = f"{sort} `{was}` is called `{change.element.rpartition('.')[2]}` now"
    else:
        said = f"{sort} `{short(was)}` is called `{short(change.element)}` now"
    sure = "" if change.confidence >= 0.85 else f" (recognised with {round(change.confidence * 100)} % confidence)"  # noqa: PLR2004 - hardly a doubt
    return said + sure + _following(change, told)


def _following(change: Change, told: Told) -> str:
    """Describe which topics, services and actions get another name because nobody named them."""
    if change.sort not in {"group", "component", "output"}:
        return ""
    inside = (port for port in told.unnamed if port == change.element or port.startswith(f"{change.element}."))
    ports = sorted(port for port in inside if ("output", port) in told.before)
    if not ports:
        return ""
    was = told.before["output", ports[0]].own
    more = f", and {len(ports) - 1} more such names follow" if len(ports) > 1 else ""
    return f"; `{ros_names.of_port(was)}` becomes `{ros_names.of_port(ports[0])}`{more}"


def connection(each: Rewired, told: Told) -> str:
    """Describe what an input reads now, and what that leaves unread."""
    reader = f"`{_shown('input', each.input, told)}`"
    if told.gone("input", each.input):
        return _reader_went(each, reader, told)
    said = _reads(each, reader, told)
    unread = [n for n in sorted(each.lost) if ("output", n) in told.after and not told.new.readers.get(n)]
    first = [n for n in sorted(each.gained) if ("output", n) in told.before and not told.old.readers.get(n)]
    said += f"; nobody reads {_ticked(unread)} any more" if unread else ""
    return said + (f"; nobody read {_ticked(first)} before" if first else "")


def _reads(each: Rewired, reader: str, told: Told) -> str:
    """Describe which sources an input gained and lost."""
    lost = [_shown("output", name, told) for name in sorted(each.lost)]
    gained = sorted(each.gained)
    # A reference to what has no output yet stands for itself in the map of connections (`map_connections`).
    if lost and gained and not any(("output", name) in told.after for name in gained):
        return f"{reader} no longer reads {_ticked(lost)}: {_ticked(gained)} {'has' if len(gained) == 1 else 'have'} no output any more"
    if lost and gained:
        return f"{reader} now reads {_ticked(gained)} instead of {_ticked(lost)}"
    if lost:
        removed = all(told.gone("output", name) for name in each.lost)
        why = f", which {'was' if len(lost) == 1 else 'were'} removed" if removed else ""
        return f"{reader} no longer reads {_ticked(lost)}{why}{'' if each.after else '; it has no source any more'}"
    if told.come("input", each.input):
        return f"{reader} reads {_ticked(gained)}"
    if each.before:
        return f"{reader} now also reads {_ticked(gained)}"
    return f"{reader} now reads {_ticked(gained)}, its first source{'s' if len(gained) > 1 else ''}"


def _reader_went(each: Rewired, reader: str, told: Told) -> str:
    """Describe what the removal of a reader means to each of its sources."""
    said = []
    for source in sorted(each.lost):
        if told.gone("output", source) or told.new.readers.get(source):
            continue
        others = len(told.old.readers[source]) - 1
        why = (
            f"its only reader {reader} was removed"
            if not others
            else f"{reader} was removed, and nobody else reads it now"
        )
        said.append(f"`{source}` is no longer read by anybody: {why}")
    return (
        "; ".join(_some(said))
        or f"{reader}, which read {_ticked(_shown('output', s, told) for s in sorted(each.lost))}, was removed"
    )


def port(kind: str, element: Element, told: Told) -> str:
    """Describe that a node carries a port, or no longer does."""
    node, _, name = element.own.partition(".")
    named = ", ".join(sorted(map(str, topics))) if isinstance(topics := element.values.get("topic"), frozenset) else ""
    on = f" on {named}" if named else ""
    verb = "now has" if kind == "added" else "no longer has"
    others = (
        other for other in told.after.values() if other.sort == "port" and other.refs and other.refs == element.refs
    )
    heirs = sorted({other.own.partition(".")[0] for other in others if other.parent != element.parent})
    heir = f": `{heirs[0]}` has it now" if kind == "removed" and len(heirs) == 1 else ""
    return f"node `{node}` {verb} `{name}`{on}{heir}"


def changed(change: Change, told: Told) -> str:
    """Describe the old and new value of a key, and whom that concerns."""
    return "; ".join(filter(None, (changed_key(change), _concerns(change, told))))


def _concerns(change: Change, told: Told) -> str:
    """Describe who is at the other end of a change: readers, carriers, requirements that nothing serves any more."""
    name = change.element
    match change.sort, change.key:
        case "output", "type":
            readers = sorted(told.new.readers.get(name, frozenset()))
            return f"it is read by {_ticked(readers)}" if readers else ""
        case "type", "message" | "size":
            outputs = told.using("output", "type", name)
            return f"{_ticked(outputs)} {'carry' if len(outputs) > 1 else 'carries'} it" if outputs else ""
        case "message", _:
            types = told.using("type", "message", name)
            return f"it carries {_ticked(types)}" if types else ""
        case "component", "requirements":
            before, after = told.serving
            lost = [one for one in sorted(before) if one not in after and name == min(before[one])]
            unserved = [one for one in lost if ("requirement", one) in told.after]
            return f"no component serves {_ticked(unserved)} any more" if unserved else ""
    return ""


def _ticked(names: Iterable[str]) -> str:
    """Return element names in backticks, the surplus counted."""
    every = [f"`{short(name)}`" for name in names]
    most = 2 * _MOST
    return listed(every) if len(every) <= most else listed([*every[: most - 1], f"{len(every) - most + 1} more"])
