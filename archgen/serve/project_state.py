"""One sound state of a project, as its pages are made from it: what all of them need, and the rest on demand."""

from __future__ import annotations

from archgen.frozen import dataclass, replace
from archgen.live.warm_project import WarmProject
from archgen.model.project_history import History
from archgen.model.selector_evaluation import Selection
from archgen.pipeline import CheckedProject, stand_in_variants
from archgen.products import project_views
from archgen.products.compared_versions import ProjectVersion
from archgen.products.comparison_documents import list_changes_since
from archgen.products.output_options import OutputOptions
from archgen.timing.analysis import Analysis
from archgen.timing.run_analysis import analyse_architecture
from archgen.views.changes.site_changes import SiteChanges
from archgen.views.drawings_on_demand import DrawingsOnDemand
from archgen.views.lookup import Lookup
from archgen.views.pages.report_outline import DocumentEdition
from archgen.views.tables import statistics_tables
from archgen.views.timing.timing_lookup import bound_chains


@dataclass(frozen=True, slots=True)
class ProjectState:
    """A checked project with its look-ups, its timing and what its documents contain."""

    checked_project: CheckedProject
    lookup: Lookup
    edition: DocumentEdition
    full_analysis: Analysis
    """The timing with all that pages show; the rules judge a part of it."""
    selection: Selection | None = None
    """What pages and pictures show, None for all."""


class SelectionError(ValueError):
    """What the selector names is not there; the message says why."""


def read_project(warm_project: WarmProject, variants: tuple[str, ...]) -> CheckedProject:
    """Return a project as it stands in some of its variants; with all of them where none is named.

    Raise `project.ProjectNotFoundError`, and `pipeline.UnknownVariantError` where it has one of them not.
    """
    checked_project = warm_project.check(variants or None)
    if not variants:
        return checked_project
    return stand_in_variants(checked_project, variants, warm_project.cache.analysis_memory)


def make_state(checked_project: CheckedProject, options: OutputOptions, last: ProjectState | None) -> ProjectState:
    """Make a state; what cannot have changed is taken from the last one. Raise `SelectionError`.

    History, revision and changes are those of the last one: `renew_history` and `renew_changes` come when nobody waits.
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
    selection = _select_elements(checked_project, options.selector_text)
    lookup = replace(
        project_views.make_scoped_lookup(checked_project, replace(options, selection=selection)),
        timing=bound_chains(full_analysis, checked_project.architecture),
        repository=project_views.locate_repository(checked_project),
    )
    last_edition = last.edition if last else DocumentEdition()
    state = ProjectState(checked_project, lookup, last_edition, full_analysis, selection)
    return _renew_edition(state, options, last_edition.history, last_edition.revision, last_edition.changes)


def _select_elements(checked_project: CheckedProject, selector_text: str) -> Selection | None:
    """Return what a selector names, None for all. Raise `SelectionError`."""
    if not selector_text:
        return None
    selection, problems = project_views.select_elements(checked_project, selector_text)
    for problem in problems:
        if problem.severity == "error":
            raise SelectionError(f"{problem.message}; {problem.help}" if problem.help else problem.message)
    return selection


def renew_history(state: ProjectState, options: OutputOptions) -> ProjectState:
    """Return the state with the history and the revision as git has them now; the same one where they are as they were."""
    history = project_views.read_history(state.checked_project, options)
    revision = project_views.choose_revision(state.checked_project, options)
    if (history, revision) == (state.edition.history, state.edition.revision):
        return state
    return _renew_edition(state, options, history, revision, state.edition.changes)


def renew_changes(state: ProjectState, options: OutputOptions, old_version: ProjectVersion) -> ProjectState:
    """Return the state with what changed since an earlier version."""
    changes = list_changes_since(old_version, state.checked_project)
    return _renew_edition(state, options, state.edition.history, state.edition.revision, changes)


def _renew_edition(
    state: ProjectState, options: OutputOptions, history: History, revision: str, changes: SiteChanges | None
) -> ProjectState:
    """Return a state with its documents made anew."""
    charts = statistics_tables.make_growth_charts(history)
    level = options.level or "implementation"
    drawings = DrawingsOnDemand(state.lookup, level, charts, state.selection, changes)
    edition = project_views.make_edition(state.checked_project, options.level, drawings, history, revision)
    return replace(state, edition=replace(edition, changes=changes))
