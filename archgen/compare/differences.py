"""Find what differs between two versions (elements, keys, connections), and which of it is one change."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from archgen.compare import keys, sentences
from archgen.compare.change import Change
from archgen.compare.elements import Element, Key
from archgen.compare.names import Names
from archgen.compare.told import Told
from archgen.compare.wiring import Rewired, Wires, rewired

RANKS = {
    sort: rank
    for rank, sort in enumerate(
        (
            *("project", "chapter", "partner", "use_case", "requirement", "group", "component", "output", "input"),
            *("connection", "type", "message", "node", "port", "host", "container", "link", "chain", "policy", "view"),
        )
    )
}
"""The position of each kind of element in the order in which changes are reported."""


@dataclass(slots=True)
class Differences:
    """Collects the changes between two versions. `attached_changes` belong to an element that was added or removed."""

    before: Mapping[Key, Element]
    after: Mapping[Key, Element]
    names: Names
    told: Told
    _sharing: frozenset[Key] = frozenset()
    """Nodes that share their components with other nodes in both versions, and therefore say which ports they carry."""
    top: list[Change] = field(default_factory=list)
    hanging: dict[Key, list[Change]] = field(default_factory=lambda: defaultdict(list))

    def all(self, old: Wires, new: Wires) -> tuple[Change, ...]:
        """Return all changes in the order of the report. Call it once: it fills `top_changes`."""
        # "carried" is only among the values of a port where the node must say that it carries it: internal ports, and
        # components with several nodes.
        carriers = (
            {e.parent for e in side.values() if e.parent and "carried" in e.values}
            for side in (self.before, self.after)
        )
        self._sharing = frozenset.intersection(*map(frozenset, carriers))
        # Connections and ports come before `_add_whole_elements`: it attaches what they left in `attached_changes`, and
        # what is attached afterwards would be lost.
        self._connections(old, new)
        self._renames()
        for key, element in self.after.items():
            if key in self.before:
                self._keys(self.before[key], element)
            elif element.sort == "port":
                self._port(None, element)
        for key, element in self.before.items():
            if key not in self.after and element.sort == "port":
                self._port(element, None)
        self._whole()
        return tuple(sorted(self.top, key=rank))

    def _whole(self) -> None:
        """Add the elements that were added or removed, each with its parts inside the same change."""
        for kind, here, there in (("removed", self.before, self.after), ("added", self.after, self.before)):
            below: dict[Key, list[Element]] = defaultdict(list)
            roots = []
            for key, element in here.items():
                if key in there or not element.stated or element.sort == "port" or self.told.unknown(key):
                    continue
                if element.parent is not None and element.parent in here and element.parent not in there:
                    below[element.parent].append(element)
                else:
                    roots.append(element)
            self.top += (self._one(kind, element, below) for element in roots)

    def _one(self, kind: str, element: Element, below: Mapping[Key, list[Element]]) -> Change:
        key = (element.sort, element.id)
        parts = [self._one(kind, part, below) for part in below.get(key, ())] + self.hanging.pop(key, [])
        change = Change("added" if kind == "added" else "removed", element.sort, element.own)
        change = replace(change, parts=tuple(sorted(parts, key=rank)))
        return replace(change, text=sentences.whole(change, element, self.told))

    def _renames(self) -> None:
        for (sort, name), confidence in self.names.confidence.items():
            old = self.names.back[sort][name]
            there = self.after.get((sort, name))
            if there is None or (sort, name) not in self.before:
                continue
            moved = sort == "component" and self._home(old) != there.parent
            change = Change("moved" if moved else "renamed", sort, name, was=old, confidence=confidence)
            self.top.append(replace(change, text=sentences.renamed(change, self.told)))

    def _home(self, component: str) -> Key:
        return "group", self.names.to("group", component.partition(".")[0])

    def _keys(self, old: Element, new: Element) -> None:
        if old.values == new.values:
            return
        for key, before, after in keys.changed(old, new, self.before, self.after):
            if not self.told.unread((new.sort, new.id), before, after):
                self.top.append(self._changed(new, key, before, after))

    def _changed(self, element: Element, key: str, before: object, after: object) -> Change:
        change = Change("changed", element.sort, element.id, key=key, before=before, after=after)
        return replace(change, text=sentences.changed(change, self.told))

    def _port(self, old: Element | None, new: Element | None) -> None:
        """Add what a node says of a port in one version only: to the port's change, to the node's, or as a change of
        its own.
        """
        there = new or old
        if there is None or there.parent is None:
            return
        # Compared with an element without values, every value of the port is a change of its own.
        nothing = replace(there, values={})
        port = self._came_or_went(there.refs[0]) if there.refs else None
        node = there.parent if (there.parent in self.before) != (there.parent in self.after) else None
        home = node or port
        if home or ("carried" in there.values and there.parent in self._sharing):
            kind = "added" if new else "removed"
            change = Change("added" if new else "removed", "port", there.own)
            change = replace(change, text=sentences.port(kind, there, self.told))
            (self.hanging[home] if home else self.top).append(change)
        else:
            self._keys(old or nothing, new or nothing)

    def _came_or_went(self, port: str) -> Key | None:
        """Return the outermost element with which a port was added or removed, None if the port is in both versions."""
        # A port's complete id does not say its direction.
        keys_of = (("output", port), ("input", port))
        key = next((key for key in keys_of if (key in self.before) != (key in self.after)), None)
        return self._outermost(key) if key else None

    def _outermost(self, key: Key) -> Key:
        """Return the component of a port if it was added or removed too, else the port."""
        parent = (self.before.get(key) or self.after[key]).parent
        gone = parent is not None and (parent in self.before) != (parent in self.after)
        return parent if gone and parent is not None else key

    def _connections(self, old: Wires, new: Wires) -> None:
        for each in rewired(old, new):
            if self._unread(each):
                continue
            home = self._cause(each)
            before, after = sorted(each.before), sorted(each.after)
            kind = "changed" if before and after else "added" if after else "removed"
            own = self._own(each.input) if kind == "removed" else each.input
            change = Change(kind, "connection", own, before=self._owns(before), after=after)  # type: ignore[arg-type]
            change = replace(change, text=sentences.connection(each, self.told))
            (self.hanging[home] if home else self.top).append(change)

    def _unread(self, each: Rewired) -> bool:
        """Whether a connection only seems to have changed because one of its ends could not be read."""
        before, after = self.told.lost
        if not (before or after):
            return False
        words = {part for output in each.lost for part in (*output.split("."), *each.input.split("."))}
        came = {part for output in each.gained for part in (*output.split("."), *each.input.split("."))}
        return not (after.isdisjoint(words) and before.isdisjoint(came))

    def _cause(self, each: Rewired) -> Key | None:
        """Return the element whose addition or removal took the connection along, if there is one."""
        key = ("input", each.input)
        if (key in self.before) != (key in self.after):
            return self._outermost(key)
        # The reader was rewired to something that exists: that is its own decision, whatever became of the old source.
        if each.lost and any(("output", name) in self.after for name in each.gained):
            return None
        here, there = (self.before, self.after) if each.lost else (self.after, self.before)
        moved = [("output", name) for name in sorted(each.lost or each.gained)]
        if all(output in here and output not in there for output in moved):
            return self._outermost(moved[0])
        return None

    def _own(self, name: str) -> str:
        element = self.before.get(("input", name))
        return element.own if element else name

    def _owns(self, outputs: list[str]) -> list[str]:
        """Return the outputs of the first version by the ids that they had there."""
        return sorted(self.before[key].own if (key := ("output", name)) in self.before else name for name in outputs)


def rank(change: Change) -> tuple[int, str, int, str]:
    """Return the sort key of a change: kind of element, id, what happened, key."""
    kinds = ("renamed", "moved", "removed", "added", "changed")
    return RANKS[change.sort], change.element, kinds.index(change.kind), change.key or ""
