"""Resolve dotted paths, whose leading parts may be left out, to elements.

References in files and selectors share these rules. Every ending of every complete id is a key of the index, so that no
search walks over the elements.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from archgen.frozen import dataclass

LISTED = 8
"""The number of candidates that are listed; there may be ten thousand."""


def made_title(name: str) -> str:
    """Make the title of an element without one from its name: "Object Recognition" for `object_recognition`."""
    return " ".join(word[:1].upper() + word[1:] for word in name.split("_") if word)


class Named(NamedTuple):
    """A reference to an element: its kind (`group`, `component`, `output`, ...) and its complete id."""

    kind: str
    id: str


@dataclass(frozen=True, slots=True)
class Found:
    """The elements that a path may mean: none, one, or several. `count` is their number, `elements` the first few.

    `hidden_elements` are further candidates that lost against the element whose complete id the path is.
    """

    elements: tuple[Named, ...]
    count: int
    hidden: tuple[Named, ...] = ()

    @property
    def one(self) -> Named | None:
        """The element if there is exactly one, else None."""
        return self.elements[0] if self.count == 1 else None


NOTHING = Found((), 0)


class Names:
    """Finds elements by any ending of their complete ids."""

    __slots__ = ("_complete", "_ends", "_ends_in_group")

    def __init__(self, ids: Mapping[str, Iterable[str]]) -> None:
        """Index the complete ids of each kind."""
        self._complete = {kind: frozenset(paths) for kind, paths in ids.items()}
        # By kind: ids by ending, and ids by group and ending. Without the second, candidates in a group would have to
        # be filtered out of all those in the project.
        self._ends: dict[str, dict[str, list[str]]] = {}
        self._ends_in_group: dict[str, dict[tuple[str, str], list[str]]] = {}
        for kind, paths in ids.items():
            self._ends[kind], self._ends_in_group[kind] = _ends(paths)

    def find(self, words: str, kinds: Sequence[str], *, component: str | None = None) -> Found:
        """Resolve a path among some kinds, as written in a component (by complete id) or outside all groups (None).

        A complete id means that element. Otherwise the candidates are the elements whose ids end in the path, and those
        in the component's own group win over others. A path of one word never means the component or its own output.
        """
        ends = {kind: paths for kind in kinds if (paths := self._ends[kind].get(words))}
        if len(ends) == 1 and (component is None or "." in words):
            ((kind, paths),) = ends.items()
            if len(paths) == 1:  # a short cut for what is nearly always the case; `_choose_match` finds the same
                return Found((Named(kind, paths[0]),), 1)
        return self._choose(words, kinds, ends, component) if ends else NOTHING

    def _choose(
        self, words: str, kinds: Sequence[str], ends: Mapping[str, Sequence[str]], component: str | None
    ) -> Found:
        own = self._own(words, component)
        # The order of `kinds` decides between two elements of different kinds that have the same complete id.
        for kind in kinds:
            if words in self._complete[kind]:
                hidden = tuple(name for name in _take(ends, own).elements if name != (kind, words))
                return Found((Named(kind, words),), 1, hidden)
        if component:
            group = component.partition(".")[0]
            found = _take({kind: self._ends_in_group[kind].get((group, words), ()) for kind in kinds}, own)
            if found.count:
                return found
        return _take(ends, own)

    def _own(self, words: str, component: str | None) -> tuple[Named, ...]:
        """Return what a path of one word never means: the component that writes it, and its output of that name."""
        if component is None or "." in words:
            return ()
        own: list[Named] = []
        if component.rpartition(".")[2] == words:
            own.append(Named("component", component))
        if f"{component}.{words}" in self._complete.get("output", ()):
            own.append(Named("output", f"{component}.{words}"))
        return tuple(own)

    def is_complete(self, kind: str, path: str) -> bool:
        """Whether a path is the complete id of an element of this kind."""
        return path in self._complete[kind]

    def ends(self, kind: str) -> Iterable[str]:
        """Return every path that matches some element of a kind, each once."""
        return self._ends[kind]

    def ending(self, kind: str, words: str) -> Sequence[str]:
        """Return the complete ids of a kind that end in a path."""
        return self._ends[kind].get(words, ())


def _ends(paths: Iterable[str]) -> tuple[dict[str, list[str]], dict[tuple[str, str], list[str]]]:
    """Index ids by their endings, and by group and ending; the complete id is an ending only in the first index."""
    everywhere: dict[str, list[str]] = {}
    in_group: dict[tuple[str, str], list[str]] = {}
    for path in paths:
        group, dot, end = path.partition(".")
        everywhere.setdefault(path, []).append(path)
        while dot:
            everywhere.setdefault(end, []).append(path)
            in_group.setdefault((group, end), []).append(path)
            _, dot, end = end.partition(".")
    return everywhere, in_group


def _take(found: Mapping[str, Sequence[str]], own: tuple[Named, ...]) -> Found:
    """Return the first few candidates and the number of all, without the excluded ones."""
    # There may be thousands of candidates: they are counted by the lengths of their lists, never walked through.
    left_out = [name for name in own if name.kind in found]
    names = (Named(kind, path) for kind, paths in found.items() for path in paths)
    first = tuple(islice((name for name in names if name not in left_out), LISTED))
    return Found(first, sum(map(len, found.values())) - len(left_out))
