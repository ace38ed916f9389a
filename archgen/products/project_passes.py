"""Passes as people ask for them by name: those of archgen, and a project's own where these may run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.frozen import NamedTuple
from archgen.passes import Pass, order_passes
from archgen.passes.patterns.pattern_registry import find_known_passes
from archgen.pipeline import CheckedProject, transform_project
from archgen.products.trusted_backends import TrustedRevision, refuse_untrusted_pass


class ChosenPasses(NamedTuple):
    """The passes that somebody asks for."""

    names: tuple[str, ...]
    ordered: tuple[Pass, ...]
    """The same with those that they need, in the order in which they run."""
    known: Mapping[str, Pass]
    """All passes that there are, by name."""


def choose_passes(
    checked_project: CheckedProject, names: Sequence[str], trusted_revision: TrustedRevision | None = None
) -> ChosenPasses:
    """Return the passes of these names. Raise UnknownPassError, and UntrustedPassError for forbidden ones.

    Of the project's own passes those may run that `trusted_revision` allows; None allows all of them.
    """
    known = find_known_passes(checked_project.loaded_project)
    ordered = order_passes(names, known.passes)
    for each in ordered if trusted_revision is not None else ():
        if each.name in known.own_files and trusted_revision is not None:
            files = checked_project.loaded_project.files
            refuse_untrusted_pass(each.name, known.own_files[each.name], files, trusted_revision)
    return ChosenPasses(tuple(names), ordered, known.passes)


def transform_by_name(checked_project: CheckedProject, chosen_passes: ChosenPasses) -> CheckedProject:
    """Return what passes make of a project, judged again."""
    return transform_project(checked_project, chosen_passes.names, chosen_passes.known)
