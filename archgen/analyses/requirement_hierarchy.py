"""Do parents of requirements go in a circle, and is every requirement verified?"""

from __future__ import annotations

from itertools import dropwhile
from typing import TYPE_CHECKING

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model.requirement import add_wholes, index_parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.model.architecture import Architecture
    from archgen.model.requirement import Requirement

_MAX_LISTED = 5


def circular_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """Requirements are part of one another in a circle."""
    requirements = architecture.requirements
    judged_ids: set[str] = set()
    told_ids: set[str] = set()
    for start in requirements:
        if start in judged_ids or not requirements[start].parents:
            continue
        # Down one way at a time, without recursion: the tree may be as deep as there are requirements.
        way: dict[str, Iterator[str]] = {start: iter(requirements[start].parents)}
        judged_ids.add(start)
        while way:
            current = next(reversed(way))
            parent = next(way[current], None)
            if parent is None:
                del way[current]
            elif parent in way and told_ids.isdisjoint((parent, current)):
                circle = list(dropwhile(parent.__ne__, way))
                # Of circles with a part in common one is said: when it is mended, the next is.
                if told_ids.isdisjoint(circle):
                    yield _diagnose_circle(requirements, circle)
                told_ids.update(circle)
            elif parent in requirements and parent not in judged_ids:
                judged_ids.add(parent)
                way[parent] = iter(requirements[parent].parents)


def _diagnose_circle(requirements: Mapping[str, Requirement], circle: list[str]) -> Diagnostic:
    first, *others = (requirements[each] for each in circle)
    if others:
        names = [f"`{each}`" for each in circle[:_MAX_LISTED]]
        rest = [f"{len(circle) - _MAX_LISTED} more"] if len(circle) > _MAX_LISTED else []
        message = f"the requirements {join_words([*names, *rest], 'and')} are part of one another"
    else:
        message = f"the requirement `{first.id}` is its own parent"
    return Diagnostic(
        "circular-requirement",
        message,
        first.parent_at,
        labels=tuple(Label(each.parent_at, f"the parent of `{each.id}`") for each in others[:_MAX_LISTED]),
        help="take out the `parent` of the one that is the whole",
        element=first.id,
    )


def unverified_requirement(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing shows that a requirement is met."""
    if architecture.partial:
        return
    requirements = architecture.requirements
    parts = index_parts(requirements)
    verified_ids = add_wholes(requirements, (each.id for each in requirements.values() if each.verified_by))
    for requirement in requirements.values():
        # Of a whole, its parts are reported.
        if requirement.id not in verified_ids and requirement.id not in parts:
            title = "" if requirement.title == requirement.id else f" ({requirement.title})"
            yield Diagnostic(
                "unverified-requirement",
                f"nothing verifies the requirement `{requirement.id}`{title}",
                requirement.at,
                help="name in `verified_by` the use case, chain or file that shows it, or say it in a sentence",
                element=requirement.id,
            )


RULES = (
    (circular_requirement, Severity.ERROR),
    (unverified_requirement, Severity.OFF),
)
