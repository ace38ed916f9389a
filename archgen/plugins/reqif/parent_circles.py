"""Leave out what would make requirements parts of themselves: other tools allow relations in circles."""

from __future__ import annotations

from collections.abc import Iterator, Mapping


def cut_circles(parents: Mapping[str, dict[str, None]]) -> tuple[tuple[str, str], ...]:
    """Take out of the parents by id what closes a circle, and return it as (part, parent).

    Each requirement is walked once, so that the time is in proportion to the relations.
    """
    closing: list[tuple[str, str]] = []
    done: set[str] = set()
    for start in parents:
        if start not in done:
            closing += _walk_up(start, parents, done)
    for part, parent in closing:
        del parents[part][parent]
    return tuple(closing)


def _walk_up(start: str, parents: Mapping[str, dict[str, None]], done: set[str]) -> Iterator[tuple[str, str]]:
    """Yield the steps that lead from a requirement up to one on the way to it."""
    way = [(start, iter(parents[start]))]
    on_way = {start}
    while way:
        part, above = way[-1]
        parent = next(above, None)
        if parent is None:
            done.add(part)
            on_way.remove(part)
            way.pop()
        elif parent in on_way:
            yield part, parent
        elif parent not in done:
            on_way.add(parent)
            way.append((parent, iter(parents.get(parent, ()))))
