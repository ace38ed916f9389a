"""One sound state of a project, as its pages are made from it: what all of them need, and the rest on demand."""

from __future__ import annotations

from dataclasses import dataclass, replace

from archgen.model.project_history import History
from archgen.pipeline import CheckedProject
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.timing.analysis import Analysis
from archgen.timing.run_analysis import analyse_architecture
from archgen.views.drawings_on_demand import DrawingsOnDemand
from archgen.views.lookup import Lookup
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.tables import project_growth
from archgen.views.timing.timing_lookup import bound_chains


@dataclass(frozen=True, slots=True)
class ProjectState:
    """A checked project with its look-ups, its timing and what its documents contain."""

    checked_project: CheckedProject
    lookup: Lookup
    edition: DocumentEdition
    full_analysis: Analysis
    """The timing with all that pages show; the rules judge a part of it."""


def make_state(checked_project: CheckedProject, options: OutputOptions, last: ProjectState | None) -> ProjectState:
    """Make a state; what cannot have changed is taken from the last one.

    History and revision are those of the last one: git is asked for them by `renew_history`, when nobody waits.
    """
    # The check returns the very same analysis where no figure and no place of one has changed.
    is_same_timing = (
        last is not None
        and checked_project.analysis is not None
        and checked_project.analysis is last.checked_project.analysis
    )
    full_analysis = (
        last.full_analysis if last and is_same_timing else analyse_architecture(checked_project.architecture)
    )
    lookup = replace(
        project_views.make_scoped_lookup(checked_project, options),
        timing=bound_chains(full_analysis, checked_project.architecture),
        repository=project_views.locate_repository(checked_project),
    )
    history = last.edition.history if last else History()
    return _make_with_history(checked_project, options, lookup, full_analysis, (history, _revision_of(last)))


def _revision_of(state: ProjectState | None) -> str:
    return state.edition.revision if state else ""


def renew_history(state: ProjectState, options: OutputOptions) -> ProjectState:
    """Return the state with the history and the revision as git has them now; the same one where they are as they were."""
    history = project_views.read_history(state.checked_project, options)
    revision = project_views.choose_revision(state.checked_project, options)
    if (history, revision) == (state.edition.history, state.edition.revision):
        return state
    return _make_with_history(state.checked_project, options, state.lookup, state.full_analysis, (history, revision))


def _make_with_history(
    checked_project: CheckedProject,
    options: OutputOptions,
    lookup: Lookup,
    full_analysis: Analysis,
    history_and_revision: tuple[History, str],
) -> ProjectState:
    history, revision = history_and_revision
    drawings = DrawingsOnDemand(lookup, options.level or "implementation", project_growth.make_growth_charts(history))
    edition = project_views.make_edition(checked_project, options.level, drawings, history, revision)
    return ProjectState(checked_project, lookup, edition, full_analysis)
