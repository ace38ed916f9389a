"""The views that a project's outputs are written from: look-ups of the selected part, drawings, history, revision."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING

from archgen import git
from archgen.diagnostics import shorten_hash
from archgen.frozen import dataclass, replace
from archgen.git.project_revision import find_revision, find_revision_date
from archgen.model import selector_evaluation
from archgen.model.project_history import History
from archgen.model.selector_evaluation import Selection
from archgen.model.selector_parser import SelectorProblem
from archgen.model.source_repository import SourceRepository
from archgen.pipeline import CheckedProject, index_all_rules
from archgen.products import report_cache
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.model.partner_interfaces import PartnerPair
    from archgen.views.agreement.interface_record import SignedTag
    from archgen.views.lookup import Lookup
    from archgen.views.pages.report_outline import DetailLevel, DocumentEdition
    from archgen.views.pages.variant_chapter import VariantDifference
    from archgen.views.picture_shapes import Drawing

_SHORT_HASH_LENGTH = 10
"""Digits of a commit's hash that are printed: enough to be unique in a repository of this size."""


def select_elements(
    checked_project: CheckedProject, selector_text: str
) -> tuple[Selection, tuple[SelectorProblem, ...]]:
    """Evaluate a selector against a project; `finding:` refers to the project's findings.

    Return the selection and the problems of the selector; errors among them make the selection unusable.
    """
    rule_elements: dict[str, set[str]] = {}
    for finding in checked_project.findings:
        if finding.element:
            rule_elements.setdefault(finding.rule, set()).add(finding.element)
    return selector_evaluation.evaluate_selector(
        selector_text,
        checked_project.architecture,
        {rule: frozenset(elements) for rule, elements in rule_elements.items()},
    )


def make_scoped_lookup(checked_project: CheckedProject, options: OutputOptions) -> Lookup:
    """Build the look-ups for the selected part of a project."""
    from archgen.views.lookup import DocumentScope, make_lookup

    scope = (
        DocumentScope(options.selection.components, options.selection.nodes, options.selector_text)
        if options.selection
        else DocumentScope()
    )
    return make_lookup(checked_project.architecture, checked_project.findings, scope)


def list_rows(
    checked_project: CheckedProject, options: OutputOptions, kind: str
) -> tuple[Sequence[str], Sequence[Sequence[str]]]:
    """Return columns and rows of a project's elements: what `archgen list --of KIND` lists."""
    from archgen.views.tables import element_rows

    lookup = make_scoped_lookup(checked_project, options)
    if kind == "requirements" and lookup.chains_for_requirement:
        from archgen.views.lookup import add_timing
        from archgen.views.timing.timing_lookup import analyse_with_chains, bound_chains

        # Whether a requirement is met may hang on a chain's deadline.
        analysis, architecture = checked_project.analysis, checked_project.architecture
        timing = bound_chains(analysis, architecture) if analysis else analyse_with_chains(architecture)
        lookup = add_timing(lookup, timing)
    return element_rows.list_element_rows(lookup, kind)


@dataclass(frozen=True, slots=True)
class ProjectViews:
    """The views that documents are written from."""

    lookup: Lookup
    edition: DocumentEdition
    drawings: Mapping[str, Drawing]


def make_views(
    checked_project: CheckedProject,
    options: OutputOptions,
    *,
    undrawn_kinds: Collection[str] = (),
    is_report_alone: bool = False,
) -> ProjectViews:
    """Make the views: look-ups with timing, drawings, history, and what the documents contain.

    There is no drawing of the `undrawn_kinds`, nor for a report alone of runs in which a chain is late.
    """
    from archgen.products.seen_robots import read_seen_robots
    from archgen.views import drawing_set
    from archgen.views.lookup import add_timing
    from archgen.views.tables import statistics_tables
    from archgen.views.timing.timing_lookup import add_late_runs, complete_with_chains

    timing_lookup = complete_with_chains(checked_project.analysis, checked_project.architecture)
    timing_lookup = timing_lookup if is_report_alone else add_late_runs(timing_lookup)
    lookup = replace(
        add_timing(make_scoped_lookup(checked_project, options), timing_lookup),
        repository=locate_repository(checked_project),
    )
    project_history = read_history(checked_project, options)
    all_drawings = drawing_set.make_drawings(
        lookup, options.selection, options.level or "implementation", undrawn_kinds=undrawn_kinds, depth=options.depth
    )
    all_drawings |= {chart.id: chart for chart in statistics_tables.make_growth_charts(project_history)}
    if options.changes and not is_report_alone:
        from archgen.views.changes.site_changes import mark_drawings

        all_drawings = mark_drawings(all_drawings, options.changes)
    revision = choose_revision(checked_project, options)
    edition = make_edition(checked_project, options.level, all_drawings, project_history, revision)
    signed_tags = list_signed_tags(checked_project) if options.show_history else {}
    seen_robots, unread_record = read_seen_robots(checked_project)
    edition = replace(
        edition,
        variants=_find_differences(checked_project),
        changes=options.changes,
        date=_find_date(checked_project, options),
        signed_tags=signed_tags,
        seen_robots=seen_robots,
        unread_record=unread_record,
    )
    return ProjectViews(lookup, edition, all_drawings)


def _find_differences(checked_project: CheckedProject) -> Mapping[str, VariantDifference]:
    """Return what is different in each variant; nothing is loaded for a project without any."""
    if not checked_project.variants:
        return {}
    from archgen.products.variant_differences import find_variant_differences

    return find_variant_differences(checked_project)


def make_edition(
    checked_project: CheckedProject,
    level: DetailLevel | None,
    drawings: Mapping[str, Drawing],
    project_history: History,
    revision: str,
) -> DocumentEdition:
    """Say what documents contain beside the architecture."""
    from archgen.findings import rule_pages
    from archgen.products.seen_robots import find_seen_components
    from archgen.views.pages.report_outline import DocumentEdition
    from archgen.views.tables import statistics_tables

    found_rules = {finding.rule for finding in checked_project.findings}
    return DocumentEdition(
        revision=revision,
        level=level or "implementation",
        settings=checked_project.chapters.settings,
        chapter_names=checked_project.chapters.order,
        project_chapters=checked_project.chapters.texts,
        drawings=drawings,
        statistics=statistics_tables.make_statistics_tables(
            checked_project.architecture, find_seen_components(checked_project)
        ),
        history=project_history,
        rule_pages={
            rule.name: rule_pages.rule_page_to_markdown(rule).partition("\n")[2]
            for rule in index_all_rules().values()
            if rule.name in found_rules
        },
        has_errors=checked_project.has_errors,
    )


def locate_repository(checked_project: CheckedProject) -> SourceRepository | None:
    """Return where the project's files are on the web, with the folder that git tells where none is written."""
    repository = checked_project.architecture.repository
    if repository is None or repository.folder is not None:
        return repository
    try:
        return replace(repository, folder=git.find_repository(checked_project.root).prefix)
    except git.GitError:
        return repository


def list_signed_tags(checked_project: CheckedProject) -> Mapping[PartnerPair, tuple[SignedTag, ...]]:
    """Return the tags that record signatures of two partners, newest first, by pairs in the order of their declaration."""
    from archgen.git.commit_log import list_tags_below
    from archgen.views.agreement.interface_record import SignedTag

    order = {partner: number for number, partner in enumerate(checked_project.architecture.partners)}
    tags: dict[PartnerPair, tuple[SignedTag, ...]] = {}
    # One call for all pairs: a project of 30 partners has 435 of them.
    for tag in list_tags_below(checked_project.root, ["signed"]) if len(order) > 1 else ():
        pair = _find_pair(order, tag.name.split("/")[1])
        if pair:
            signed_tag = SignedTag(tag.name, tag.date, tag.tagger, tag.subject, shorten_hash(tag.commit))
            tags[pair] = (*tags.get(pair, ()), signed_tag)
    return tags


def _find_pair(order: Mapping[str, int], name: str) -> PartnerPair | None:
    """Return the two partners whose ids a name joins, in the order of their declaration."""
    words = name.split("-")
    for count in range(1, len(words)):
        first, second = "-".join(words[:count]), "-".join(words[count:])
        if first in order and second in order and first != second:
            return (first, second) if order[first] < order[second] else (second, first)
    return None


def _find_date(checked_project: CheckedProject, options: OutputOptions) -> str:
    """Return the day of the revision that is printed; empty where the revision is one that somebody named."""
    if options.revision not in {None, find_revision(checked_project.root, checked_project.input_files)}:
        return ""
    return find_revision_date(checked_project.root, checked_project.input_files)


def _shows_history(checked_project: CheckedProject, options: OutputOptions) -> bool:
    """Whether documents show the history: not if it is not wanted, nor for a part, nor for a project from a commit."""
    return options.show_history and options.selection is None and not checked_project.loaded_project.files.commit


def read_history(checked_project: CheckedProject, options: OutputOptions) -> History:
    """Return how the project grew, month by month; empty where documents do not show it, and outside of a repository."""
    from archgen.history import count_history
    from archgen.project import ProjectNotFoundError

    if not _shows_history(checked_project, options):
        return History()
    try:
        # `least` 2: one month makes no chart, so it is not even counted.
        return count_history(
            checked_project.loaded_project.files.root / checked_project.loaded_project.first_file,
            "month",
            cache=report_cache.cache_folder(),
            least_points=2,
        )
    except (git.GitError, ProjectNotFoundError):
        return History()


def identify_history(checked_project: CheckedProject, options: OutputOptions) -> str:
    """Return a text that changes whenever the history may change; much cheaper than reading the history."""
    if not _shows_history(checked_project, options):
        return ""
    try:
        repository = git.find_repository(checked_project.root)
        # Deepening or completing a shallow clone lengthens the history without moving HEAD.
        return f"{git.resolve_revision(repository, 'HEAD')} {git.list_cut_commits(repository)}"
    except git.GitError:
        return ""


def choose_revision(checked_project: CheckedProject, options: OutputOptions) -> str:
    """Return the revision to print: the one asked for, else the commit that the files belong to."""
    if options.revision is not None:
        return options.revision
    commit = checked_project.loaded_project.files.commit
    return commit[:_SHORT_HASH_LENGTH] if commit else find_revision(checked_project.root, checked_project.input_files)
