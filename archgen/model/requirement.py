"""Requirements: what the system must do, what each is a part of, and what shows that it is met; and the tree of them.

What follows for a whole from its parts takes time in proportion to the tree, however deep it is, and ends where parents
go in a circle.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Literal

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field
from archgen.model.element_annotations import NO_ANNOTATIONS, ElementAnnotations


@dataclass(frozen=True, slots=True)
class TreeRow:
    """A requirement where it stands in the tree; `depth` is 0 at the top.

    One with several parents stands below each of them; what is part of it stands only where it comes first.
    """

    id: str
    depth: int
    is_repeated: bool = False


def index_parts(requirements: Mapping[str, Requirement]) -> dict[str, list[str]]:
    """Return the ids of the requirements that are directly part of each, in their order; nothing for one without parts."""
    parts: dict[str, list[str]] = {}
    for requirement in requirements.values():
        for parent in requirement.parents:
            if parent in requirements:
                parts.setdefault(parent, []).append(requirement.id)
    return parts


def list_below(parts: Mapping[str, Iterable[str]], requirement_id: str) -> Iterator[str]:
    """Yield the ids of all that is part of a requirement, to any depth, each once."""
    yield from _walk_on([requirement_id], lambda each: parts.get(each, ()))


def add_above(requirements: Mapping[str, Requirement], requirement_ids: Iterable[str]) -> frozenset[str]:
    """Return the ids of all that some requirements are part of, to any height."""
    return frozenset(_walk_on(requirement_ids, _parents_in(requirements), keeps_starts=True))


def add_below(requirements: Mapping[str, Requirement], requirement_ids: Iterable[str]) -> frozenset[str]:
    """Return the ids of some requirements, and of all that is part of them."""
    starts = frozenset(requirement_ids)
    parts = index_parts(requirements)
    return starts.union(_walk_on(starts, lambda each: parts.get(each, ())))


def _parents_in(requirements: Mapping[str, Requirement]) -> Callable[[str], Iterable[str]]:
    return lambda each: requirements[each].parents if each in requirements else ()


def _walk_on(
    starts: Iterable[str], list_next: Callable[[str], Iterable[str]], *, keeps_starts: bool = False
) -> Iterator[str]:
    waiting_ids = deque(starts)
    seen_ids = set() if keeps_starts else set(waiting_ids)
    while waiting_ids:
        for each in list_next(waiting_ids.popleft()):
            if each not in seen_ids:
                seen_ids.add(each)
                waiting_ids.append(each)
                yield each


def add_wholes(requirements: Mapping[str, Requirement], own_ids: Iterable[str]) -> frozenset[str]:
    """Return the requirements of which something holds: those of which it is known, and each whose parts all have it."""
    parts = index_parts(requirements)
    missing_counts = {requirement_id: len(part_ids) for requirement_id, part_ids in parts.items()}
    waiting_ids = list(dict.fromkeys(each for each in own_ids if each in requirements))
    holding_ids = set(waiting_ids)
    while waiting_ids:
        for parent in dict.fromkeys(requirements[waiting_ids.pop()].parents):
            if parent not in missing_counts:
                continue
            missing_counts[parent] -= 1
            if not missing_counts[parent] and parent not in holding_ids:
                holding_ids.add(parent)
                waiting_ids.append(parent)
    return frozenset(holding_ids)


def walk_tree(requirements: Mapping[str, Requirement]) -> Iterator[TreeRow]:
    """Yield the requirements from the top down, each followed by its parts; those of a circle come last."""
    parts = index_parts(requirements)
    seen_ids: set[str] = set()
    tops = [each.id for each in requirements.values() if not any(parent in requirements for parent in each.parents)]
    for top in (*tops, *requirements):
        waiting_rows = [TreeRow(top, 0)] if top not in seen_ids else []
        while waiting_rows:
            row = waiting_rows.pop()
            if row.id in seen_ids:
                yield TreeRow(row.id, row.depth, is_repeated=True)
                continue
            seen_ids.add(row.id)
            yield row
            waiting_rows += [TreeRow(part, row.depth + 1) for part in reversed(parts.get(row.id, ()))]


@dataclass(frozen=True, slots=True)
class Verification:
    """What shows that a requirement is met: a use case or a chain by its id, the path of a file, or a sentence."""

    kind: Literal["use_case", "chain", "file", "text"]
    text: str
    at: Span = field(default=NO_SPAN, compare=False, repr=False)

    @property
    def file(self) -> str:
        """The path of the file, without the name of a test behind `::`."""
        return self.text.partition("::")[0]


@dataclass(frozen=True, slots=True)
class Requirement:
    """A declared requirement, with the ids of the requirements that it is a part of and of its use cases."""

    id: str
    title: str
    description: str | None = None
    parents: tuple[str, ...] = ()
    kind: str | None = None
    priority: str | None = None
    rationale: str | None = None
    source: str | None = None
    """The document, meeting or standard that it comes from, as people write it."""
    verified_by: tuple[Verification, ...] = ()
    use_cases: tuple[str, ...] = ()
    tags: tuple[str, ...] = ()
    urls: Mapping[str, str] = field(default_factory=dict)
    annotations: ElementAnnotations = NO_ANNOTATIONS
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
    parent_at: Span = field(default=NO_SPAN, compare=False, repr=False)
    """Where its first parent is written."""
