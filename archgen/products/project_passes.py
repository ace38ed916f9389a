"""Passes as people ask for them by name: those of archgen, and a project's own where these may run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from archgen.emit.file_tree import OutputError
from archgen.passes import PASSES, UnknownPassError, order_passes
from archgen.passes.patterns.pattern_registry import SHIPPED_PREFIX, KnownPasses, find_known_passes
from archgen.pipeline import CheckedProject, transform_project
from archgen.products.trusted_backends import TrustedRevision, refuse_untrusted_pass


class PassRow(NamedTuple):
    """A pass as `archgen transform --list` shows it."""

    name: str
    title: str
    origin: str
    """Who brings it: `archgen`, `rules` of archgen, or the file of the project."""
    needs: tuple[str, ...]
    leaves: tuple[str, ...]


def transform_by_name(
    checked_project: CheckedProject, names: Sequence[str], trusted_revision: TrustedRevision | None = None
) -> CheckedProject:
    """Return what passes make of a project, judged again. Raise OutputError for unknown and forbidden ones.

    Of the project's own passes those may run that `trusted_revision` allows; None allows all of them.
    """
    known = find_known_passes(checked_project.loaded_project)
    try:
        ordered_passes = order_passes(names, known.passes)
    except UnknownPassError as error:
        raise OutputError(str(error)) from None
    if trusted_revision is not None:
        _refuse_untrusted(checked_project, [each.name for each in ordered_passes], known, trusted_revision)
    return transform_project(checked_project, names, known.passes)


def _refuse_untrusted(
    checked_project: CheckedProject, names: Sequence[str], known: KnownPasses, trusted_revision: TrustedRevision
) -> None:
    files = checked_project.loaded_project.files
    for name in names:
        if name in known.own_files:
            refuse_untrusted_pass(name, known.own_files[name], files, trusted_revision)


def list_pass_rows(checked_project: CheckedProject | None) -> Iterator[PassRow]:
    """Yield all passes: those of archgen, those that it has as rules, and the project's own."""
    known = find_known_passes(checked_project.loaded_project if checked_project else None)
    for each in known.passes.values():
        origin = known.own_files.get(each.name, "rules" if each.name.startswith(SHIPPED_PREFIX) else "archgen")
        yield PassRow(each.name, each.title, origin, each.needs, each.leaves)


def list_pass_names() -> list[str]:
    """Return the names of the passes of archgen."""
    return list(PASSES)
