"""Find the changes that made a figure worse: those of the activities that it consists of, or of what precedes them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from archgen.compare.change import Change
from archgen.compare.elements import Element, Key
from archgen.compare.losses.both import Both
from archgen.compare.losses.connections import because
from archgen.compare.names import Names
from archgen.compare.timed import Timed, matters
from archgen.model.architecture import Architecture
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis
from archgen.timing.bounds import share
from archgen.timing.system import Activity

Part = tuple[str, str]
"""An activity in both versions: the common ids of its component and of its node ("" for a planned one)."""
_LESS_IS_WORSE = frozenset({"cores", "threads", "bandwidth", "timing.every", "timing.throttle", "deadline"})
_MORE_IS_WORSE = frozenset(
    {"timing.wcet", "timing.bcet", "timing.response", "timing.jitter", "latency.best", "latency.worst", "size"}
)
_EITHER = frozenset({"host", "container", "implements", "kind", "qos", "message", "fields", "connects", "through"})


@dataclass
class Causes:
    """Both versions with their timing analyses. Activities have the ids of the second version."""

    both: Both
    timed: Timed

    def part(self, activity: Activity) -> Part:
        """Return the common key of an activity of the second version."""
        return _part(activity, self.both.after, Names())

    @property
    def _listed(self) -> tuple[Mapping[Key, Element], Mapping[Key, Element]]:
        return self.both.told.before, self.both.told.after

    @cached_property
    def before(self) -> Mapping[Part, str]:
        """Return the activities of the first version by their common keys."""
        found = self.timed.before.system.activities
        return {_part(each, self.both.before, self.both.names): name for name, each in found.items()}

    def was(self, name: str) -> str | None:
        """Return the id that an activity of the second version had in the first one."""
        return self.before.get(self.part(self.timed.after.system.activities[name]))

    def owner(self, name: str) -> str | None:
        """Return the partner who owned an activity of the second version before, or owns it if it is new."""
        component, node = self.part(self.timed.after.system.activities[name])
        return self.both.owner("component", component) or self.both.owner("node", node)

    def owned(self, names: Iterable[str]) -> dict[str, list[str]]:
        """Return the given activities of the second version by owner."""
        return _grouped((self.owner(name), name) for name in sorted(set(names)))

    def owned_before(self, names: Iterable[str]) -> dict[str, list[str]]:
        """Return the given activities of the first version by owner."""
        system = self.timed.before.system
        parts = {name: _part(system.activities[name], self.both.before, self.both.names) for name in names}
        owner = self.both.owner
        return _grouped((owner("component", c) or owner("node", n), name) for name, (c, n) in sorted(parts.items()))

    def cut(self, names: Sequence[str]) -> tuple[list[int], Sequence[str]]:
        """Return the indices of changes that cut a path of the first version, and the activities from there on."""
        found, behind = list[int](), len(names)
        for number, name in enumerate(names):
            places = list(self._cutting(self.timed.before.system.activities[name]))
            found += places
            behind = min(behind, number) if places else behind
        return list(dict.fromkeys(found or [*self._touching(names)][:1])), names[behind:] if found else names

    def _touching(self, names: Iterable[str]) -> Iterator[int]:
        """Yield the indices of changes of the components and nodes behind activities of the first version."""
        for activity in map(self.timed.before.system.activities.__getitem__, names):
            component, node = _part(activity, self.both.before, self.both.names)
            yield from self._worse([("component", component), ("node", node)])

    def _cutting(self, activity: Activity) -> Iterator[int]:
        """Yield the indices of changes that removed an activity of the first version, or what it read."""
        component, node = _part(activity, self.both.before, self.both.names)
        yield from self.both.of_kind("component", component, "removed")
        yield from self.both.of_kind("node", node, "removed")
        for key in activity.inputs:
            reader = self.both.names.to("input", key)
            told = self.both.told
            for output in sorted(told.old.sources.get(reader, frozenset()) - told.new.sources.get(reader, frozenset())):
                own = self.both.of_kind("connection", reader, "removed", "changed")
                wanted = ("input", reader) in told.after  # else its own partner no longer asks for it
                yield from (because(self.both, output) if wanted else []) or own

    def heavier(self, names: Iterable[str]) -> list[str]:
        """Return those activities that take more of their core than before."""
        found = []
        for name in names:
            was = self.was(name)
            now, before = _share(self.timed.after, name), _share(self.timed.before, was) if was else None
            if now and (before is None or before < now):
                found.append(name)
        return found

    def of(self, worse: Sequence[str]) -> list[int]:
        """Return the indices of changes that made activities worse: of their own figures, else of what shares their
        host or feeds them.

        Only if no figure explains it, of what they read.
        """
        return self._followed(worse, self._figures) or self._followed(worse, self._reading)

    def _followed(self, worse: Iterable[str], find: Callable[[str], Iterable[int]]) -> list[int]:
        found: dict[int, None] = {}
        seen, waiting = set[str](), list(worse)
        # Breadth first, and not beyond an activity whose own figures explain it: the nearest cause is the cause.
        while waiting:
            name = waiting.pop(0)
            if name in seen:
                continue
            seen.add(name)
            own = list(find(name))
            found.update(dict.fromkeys(own))
            if not own:
                waiting += self._behind(name)
        return sorted(found)

    def any(self) -> list[int]:
        """Return the indices of all changes that can make a figure worse. The path of another chain does not."""
        every = ((place, change) for place, change in enumerate(self.both.changes) if change.sort != "chain")
        return [place for place, change in every if any(self.worse(one) for one in self.both.all_of(change))]

    def worse(self, change: Change) -> bool:
        """Whether a change can make a figure worse. A better figure is never blamed."""
        if not matters(change):
            return False
        key = change.key or ""
        if change.kind != "changed" or not key or key in _EITHER:
            return True
        # Bounds are sums, so each figure makes them worse in one direction only (docs/decisions/0007-breaking-
        # changes.md).
        less = key in _LESS_IS_WORSE
        if less or key in _MORE_IS_WORSE:
            was, now = (_number(e.get((change.sort, change.element)), key) for e in self._listed)
            return was is None or now is None or (now < was if less else now > was)
        return key.startswith("timing.")

    def _figures(self, name: str) -> Iterator[int]:
        """Yield the indices of changes of an activity's figures or place."""
        activity = self.timed.after.system.activities[name]
        component, node = self.part(activity)
        # A node that was added with its component explains nothing more.
        new = self.both.of_kind("component", component, "added")
        names = [("component", component), ("host", activity.host or ""), ("container", activity.container or "")]
        names += [] if new else [("node", node), ("node", activity.node)]
        yield from new
        yield from self._worse(names)

    def _reading(self, name: str) -> Iterator[int]:
        """Yield the indices of changes of what an activity reads and writes."""
        activity = self.timed.after.system.activities[name]
        held = self.both.after.components.get(self.part(activity)[0])
        inputs = [port.id for port in held.inputs.values()] if held else []
        names = [("output", key) for key in activity.outputs]
        yield from self._worse([*names, *((sort, key) for key in inputs for sort in ("input", "connection"))])

    def _worse(self, names: Iterable[Key]) -> Iterator[int]:
        for sort, one in names:
            yield from (place for place, change in self.both.found(sort, one) if self.worse(change))

    def _behind(self, name: str) -> Iterator[str]:
        """Yield what feeds an activity at another rate than before, and what takes more of its host."""
        system = self.timed.after.system
        for arc in system.into.get(name, ()):
            was = self.was(arc.source)
            if was is None or self.timed.before.paces[was].rate.value != self.timed.after.paces[arc.source].rate.value:
                yield arc.source
        host = system.activities[name].host
        load = self.timed.after.hosts.get(host) if host else None
        yield from self.heavier(part for part, _ in load.parts) if load else ()


def _part(activity: Activity, found: Architecture, names: Names) -> Part:
    node = found.nodes[activity.node]
    component = activity.component or next(iter(node.implements), "")
    return names.to("component", component), names.to("node", node.id) if node.written else ""


def _share(found: Analysis, name: str) -> Fraction | None:
    return share(found.system, name, found.paces[name]).value


def _number(element: Element | None, key: str) -> Fraction | None:
    value = element.values.get(key) if element else None
    return value.value if isinstance(value, Quantity) else Fraction(value) if isinstance(value, int) else None


def _grouped(pairs: Iterable[tuple[str | None, str]]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for owner, name in pairs:
        if owner:
            found.setdefault(owner, []).append(name)
    return found
