"""Resolve dotted paths, whose leading parts may be left out, to elements.

References in files and selectors share these rules. Every ending of every complete id is a key of the index, so that no
search walks over the elements.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import islice

from archgen.frozen import NamedTuple, dataclass

MAX_LISTED = 8
"""The number of candidates that are listed; there may be ten thousand."""


def title_from_id(element_name: str) -> str:
    """Make the title of an element without one from its name: "Object Recognition" for `object_recognition`."""
    return " ".join(word[:1].upper() + word[1:] for word in element_name.split("_") if word)


class ElementRef(NamedTuple):
    """A reference to an element: its kind (`group`, `component`, `output`, ...) and its complete id."""

    kind: str
    id: str


@dataclass(frozen=True, slots=True)
class PathMatch:
    """The elements that a path may mean: none, one, or several. `count` is their number, `elements` the first few.

    `hidden_elements` are further candidates that lost against the element whose complete id the path is.
    """

    elements: tuple[ElementRef, ...]
    count: int
    hidden_elements: tuple[ElementRef, ...] = ()

    @property
    def unique_element(self) -> ElementRef | None:
        """The element if there is exactly one, else None."""
        return self.elements[0] if self.count == 1 else None


NO_MATCH = PathMatch((), 0)


class PathIndex(NamedTuple):
    """The ids of one kind, by what a path may be. Without those by group, candidates would be filtered out of all."""

    complete: frozenset[str]
    ends: Mapping[str, Sequence[str]]
    """Complete ids by ending."""
    ends_in_group: Mapping[tuple[str, str], Sequence[str]]
    """The same by group and ending."""


class PathResolver:
    """Finds elements by any ending of their complete ids."""

    __slots__ = ("_complete", "_ends", "_ends_in_group")

    def __init__(
        self,
        ids: Mapping[str, Iterable[str]],
        make_index: Callable[[str, Iterable[str]], PathIndex] = lambda _kind, paths: index_paths(paths),
    ) -> None:
        """Index the complete ids of each kind; `make_index` takes a kind and its ids."""
        indexes = {kind: make_index(kind, paths) for kind, paths in ids.items()}
        self._complete = {kind: index.complete for kind, index in indexes.items()}
        self._ends = {kind: index.ends for kind, index in indexes.items()}
        self._ends_in_group = {kind: index.ends_in_group for kind, index in indexes.items()}

    def resolve_path(self, path: str, kinds: Sequence[str], *, component_id: str | None = None) -> PathMatch:
        """Resolve a path among some kinds, as written in a component (by complete id) or outside all groups (None).

        A complete id means that element. Otherwise the candidates are the elements whose ids end in the path, and those
        in the component's own group win over others. A path of one word never means the component or its own output.
        """
        ids_by_kind = {kind: element_ids for kind in kinds if (element_ids := self._ends[kind].get(path))}
        if len(ids_by_kind) == 1 and (component_id is None or "." in path):
            ((kind, element_ids),) = ids_by_kind.items()
            if len(element_ids) == 1:  # a short cut for what is nearly always the case; `_choose_match` finds the same
                return PathMatch((ElementRef(kind, element_ids[0]),), 1)
        return self._choose_match(path, kinds, ids_by_kind, component_id) if ids_by_kind else NO_MATCH

    def _choose_match(
        self, path: str, kinds: Sequence[str], ids_by_kind: Mapping[str, Sequence[str]], component_id: str | None
    ) -> PathMatch:
        excluded = self._own_elements(path, component_id)
        # The order of `kinds` decides between two elements of different kinds that have the same complete id.
        for kind in kinds:
            if path in self._complete[kind]:
                hidden = tuple(name for name in _match_endings(ids_by_kind, excluded).elements if name != (kind, path))
                return PathMatch((ElementRef(kind, path),), 1, hidden)
        if component_id:
            group = component_id.partition(".")[0]
            match = _match_endings({kind: self._ends_in_group[kind].get((group, path), ()) for kind in kinds}, excluded)
            if match.count:
                return match
        return _match_endings(ids_by_kind, excluded)

    def _own_elements(self, path: str, component_id: str | None) -> tuple[ElementRef, ...]:
        """Return what a path of one word never means: the component that writes it, and its output of that name."""
        if component_id is None or "." in path:
            return ()
        own_elements: list[ElementRef] = []
        if component_id.rpartition(".")[2] == path:
            own_elements.append(ElementRef("component", component_id))
        if f"{component_id}.{path}" in self._complete.get("output", ()):
            own_elements.append(ElementRef("output", f"{component_id}.{path}"))
        return tuple(own_elements)

    def path_endings(self, kind: str) -> Iterable[str]:
        """Return every path that matches some element of a kind, each once."""
        return self._ends[kind]

    def ids_ending_in(self, kind: str, path: str) -> Sequence[str]:
        """Return the complete ids of a kind that end in a path."""
        return self._ends[kind].get(path, ())


def index_paths(element_ids: Iterable[str]) -> PathIndex:
    """Index ids by their endings, and by group and ending; the complete id is an ending only in the first index."""
    element_ids = tuple(element_ids)
    everywhere: dict[str, list[str]] = {}
    in_group: dict[tuple[str, str], list[str]] = {}
    for element_id in element_ids:
        group, dot, ending = element_id.partition(".")
        everywhere.setdefault(element_id, []).append(element_id)
        while dot:
            everywhere.setdefault(ending, []).append(element_id)
            in_group.setdefault((group, ending), []).append(element_id)
            _, dot, ending = ending.partition(".")
    return PathIndex(frozenset(element_ids), everywhere, in_group)


def _match_endings(ids_by_kind: Mapping[str, Sequence[str]], excluded: tuple[ElementRef, ...]) -> PathMatch:
    """Return the first few candidates and the number of all, without the excluded ones."""
    # There may be thousands of candidates: they are counted by the lengths of their lists, never walked through.
    left_out_elements = [name for name in excluded if name.kind in ids_by_kind]
    names = (ElementRef(kind, path) for kind, paths in ids_by_kind.items() for path in paths)
    first_elements = tuple(islice((name for name in names if name not in left_out_elements), MAX_LISTED))
    return PathMatch(first_elements, sum(map(len, ids_by_kind.values())) - len(left_out_elements))
