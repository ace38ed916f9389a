"""From a checked project to files: which views are made, which emitter writes them, and where to."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import git
from archgen.diagnostics.common_wording import shorten_hash
from archgen.emit import file_tree, picture_files
from archgen.emit.picture import Picture
from archgen.git.project_revision import find_revision
from archgen.history import count_history
from archgen.model import selector_evaluation
from archgen.model.project_history import History
from archgen.model.selector_evaluation import Selection
from archgen.model.selector_parser import SelectorProblem
from archgen.pipeline import CheckedProject
from archgen.products import report_cache
from archgen.project import ProjectNotFoundError
from archgen.views import drawing_set, resolved_record
from archgen.views.chart_shapes import Drawing
from archgen.views.lookup import DocumentScope, Lookup, make_lookup
from archgen.views.pages import report_outline as report_view
from archgen.views.pages import site_pages
from archgen.views.pages.report_outline import DetailLevel, DocumentEdition
from archgen.views.shapes import Outline, Page
from archgen.views.tables import project_growth, statistics_tables
from archgen.views.timing.timing_lookup import analyse_with_chains

if TYPE_CHECKING:
    from archgen.emit.graphviz.worker_pool import DrawingWorker

"""Digits of a commit's hash that are printed: enough to be unique in a repository of this size."""
DrawingProgress = Callable[[int, int], None]
"""Called with the number of pictures drawn so far, and of all pictures."""


@dataclass(frozen=True, slots=True)
class OutputOptions:
    """What to show and how to print it: a selection, a level of detail, a revision.

    `selector_text` is the selector as the user wrote it. `progress` is called during long work, `warn` for what an
    output could not contain as asked for.
    """

    selection: Selection | None = None
    selector_text: str = ""
    level: DetailLevel | None = None
    revision: str | None = None
    progress: DrawingProgress | None = None
    warn: Callable[[str], None] = lambda _text: None
    show_history: bool = True
    """Whether documents show how the project grew; only possible where git can tell."""
    allowed_backends: Collection[str] | None = None
    """The only backends of the project itself that may run; None allows all of them."""


def select_elements(
    checked_project: CheckedProject, selector_text: str
) -> tuple[Selection, tuple[SelectorProblem, ...]]:
    """Evaluate a selector against a project; `finding:` refers to the project's findings.

    Return the selection and the problems of the selector; errors among them make the selection unusable.
    """
    return selector_evaluation.evaluate_selector(
        selector_text, checked_project.architecture, _elements_by_rule(checked_project)
    )


def _elements_by_rule(checked_project: CheckedProject) -> Mapping[str, frozenset[str]]:
    """Return the ids of elements with findings, by rule."""
    rule_elements: dict[str, set[str]] = {}
    for finding in checked_project.findings:
        if finding.element:
            rule_elements.setdefault(finding.rule, set()).add(finding.element)
    return {rule: frozenset(elements) for rule, elements in rule_elements.items()}


def make_scoped_lookup(checked_project: CheckedProject, options: OutputOptions) -> Lookup:
    """Build the look-ups for the selected part of a project."""
    scope = (
        DocumentScope(options.selection.components, options.selection.nodes, options.selector_text)
        if options.selection
        else DocumentScope()
    )
    return make_lookup(checked_project.architecture, checked_project.findings, scope)


def write_report(
    checked_project: CheckedProject, options: OutputOptions, target: Path, template: Path | None = None
) -> None:
    """Write the Word report. Raise OSError, or OutputError for what the user can mend."""
    project_views = make_views(checked_project, options)
    # A PNG for programs that know no SVG; an SVG with text as outlines, since the reader's Word may lack the font.
    outline = report_view.make_report(project_views.lookup, project_views.edition)
    file_tree.write_file(
        target,
        make_report_docx(
            checked_project, outline, draw_views(project_views, options, ("png", "svg_outlines")), options, template
        ),
    )


def write_site(checked_project: CheckedProject, options: OutputOptions, target: Path) -> None:
    """Write the static site into a folder."""
    project_views = make_views(checked_project, options)
    page_list = tuple(site_pages.make_pages(project_views.lookup, project_views.edition))
    file_tree.write_tree(
        make_site_tree(checked_project, project_views, page_list, draw_views(project_views, options, ("svg",))), target
    )


def write_diagrams(
    checked_project: CheckedProject,
    options: OutputOptions,
    target: Path,
    formats: Sequence[str],
    name_patterns: Sequence[str] = (),
) -> int:
    """Write pictures in the given formats (svg, png, pdf, dot) and return how many there are.

    `name_patterns` select pictures by id. Raise OutputError where none matches, or where no picture can be drawn.
    """
    project_views = make_views(checked_project, options)
    chosen_drawings = {
        name: graph
        for name, graph in project_views.drawings.items()
        if not name_patterns or _matches_any(name, name_patterns)
    }
    if name_patterns and not chosen_drawings:
        available_names = ", ".join(list(project_views.drawings)[:8])
        msg = f"no picture is called {' or '.join(name_patterns)}"
        raise file_tree.OutputError(msg, f"there are {available_names}, ...")
    # `dot` is not drawn: it is the source, which every picture carries.
    pictures = draw_or_warn(
        tuple(chosen_drawings.values()),
        tuple(picture_format for picture_format in formats if picture_format != "dot"),
        options,
    )
    # `draw_or_warn` only warns without the drawing libraries; here the pictures are all that was asked for.
    if chosen_drawings and not pictures:
        msg = "no picture could be drawn, nothing was written"
        raise file_tree.OutputError(msg)
    file_tree.write_tree(picture_files.build_picture_tree(pictures, formats), target)
    return len(pictures)


def write_packed(checked_project: CheckedProject, target: Path) -> None:
    """Write the packed project."""
    file_tree.write_file(target, make_packed_yaml(checked_project).encode())


def write_resolved(checked_project: CheckedProject, options: OutputOptions, target: Path) -> None:
    """Write the resolved model as YAML for other programs."""
    from archgen.syntax import yaml_writer

    data = resolved_record.make_record(make_scoped_lookup(checked_project, options))
    file_tree.write_file(target, yaml_writer.write_yaml(data).encode())


@dataclass(frozen=True, slots=True)
class ProjectViews:
    """The views that documents are written from."""

    lookup: Lookup
    edition: DocumentEdition
    drawings: Mapping[str, Drawing]


def make_views(checked_project: CheckedProject, options: OutputOptions) -> ProjectViews:
    """Make the views: look-ups with timing, drawings, history, and what the documents contain."""
    lookup = replace(
        make_scoped_lookup(checked_project, options), timing=analyse_with_chains(checked_project.architecture)
    )
    project_history = read_history(checked_project, options)
    all_drawings = drawing_set.make_drawings(lookup, options.selection, options.level or "implementation")
    all_drawings |= {chart.id: chart for chart in project_growth.make_growth_charts(project_history)}
    edition = DocumentEdition(
        revision=choose_revision(checked_project, options),
        level=options.level or "implementation",
        chapter_names=checked_project.chapters.order,
        project_chapters=checked_project.chapters.texts,
        drawings=all_drawings,
        statistics=statistics_tables.make_statistics_tables(checked_project.architecture),
        history=project_history,
        has_errors=checked_project.has_errors,
    )
    return ProjectViews(lookup, edition, all_drawings)


def read_history(checked_project: CheckedProject, options: OutputOptions) -> History:
    """Return how the project grew, month by month.

    Empty where it is not wanted, for a part of the project, for a project read from a commit, and outside of a
    repository.
    """
    if not options.show_history or options.selection is not None or checked_project.loaded_project.files.commit:
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
    """Return a text that changes whenever the history may change; much cheaper than reading the history.

    The conditions must be those of `read_history`.
    """
    if not options.show_history or options.selection is not None or checked_project.loaded_project.files.commit:
        return ""
    try:
        repository = git.find_repository(checked_project.root)
        # Completing a shallow clone lengthens the history without moving HEAD.
        return f"{git.resolve_revision(repository, 'HEAD')} {repository.is_shallow}"
    except git.GitError:
        return ""


def choose_revision(checked_project: CheckedProject, options: OutputOptions) -> str:
    """Return the revision to print: the one asked for, else the commit that the files belong to."""
    if options.revision is not None:
        return options.revision
    commit = checked_project.loaded_project.files.commit
    return shorten_hash(commit) if commit else find_revision(checked_project.root, checked_project.input_files)


def _matches_any(name: str, patterns: Sequence[str]) -> bool:
    """Whether a name matches any of the patterns, with case as it is."""
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def draw_views(
    project_views: ProjectViews, options: OutputOptions, formats: Sequence[str], workers: Sequence[DrawingWorker] = ()
) -> Mapping[str, Picture]:
    """Draw all pictures of a project, on idle `workers` where there are some."""
    return draw_or_warn(tuple(project_views.drawings.values()), formats, options, workers)


def draw_or_warn(
    graphs: Sequence[Drawing], formats: Sequence[str], options: OutputOptions, workers: Sequence[DrawingWorker] = ()
) -> Mapping[str, Picture]:
    """Draw graphs and charts; links in a picture lead to `#` and an element's anchor.

    Where the machine lacks the drawing libraries, warn and return nothing: everything else can still be written.
    """
    from archgen.emit import graphviz

    try:
        pictures = graphviz.draw_pictures(
            graphs,
            formats,
            resolve_link=lambda ref: f"#{ref}",
            cache=report_cache.cache_folder(),
            progress=options.progress,
            ready_workers=workers,
        )
    except graphviz.MissingGraphviz as error:
        options.warn(str(error))
        return {}
    for picture in pictures.values():
        if picture.warning:
            options.warn(f"{picture.id}: {picture.warning}")
    return pictures


def make_report_docx(
    checked_project: CheckedProject,
    outline: Outline,
    pictures: Mapping[str, Picture],
    options: OutputOptions,
    template: Path | None,
) -> bytes:
    """Return the Word report as bytes: from the cache, or written anew."""
    template_data = template.read_bytes() if template else None

    # Called on a miss only. The cache hands in a reader that records which chapter pictures the writer asks for.
    def write_anew(chapter_files: report_cache.ChapterFileReader) -> report_cache.ReportWithWarnings:
        """Write the report, with a broken template as the user's mistake."""
        from archgen.emit import docx

        try:
            return docx.write(outline, pictures, template=template_data, chapter_files=chapter_files)
        except docx.TemplateError as error:
            raise file_tree.OutputError(str(error)) from None

    chapter_pictures = checked_project.chapters.read_picture
    document, warnings = report_cache.get_or_write_report(
        report_cache.cache_folder(),
        outline,
        pictures,
        template=template_data,
        chapter_files=chapter_pictures,
        write_report=write_anew,
    )
    # Warnings are cached with the report: a report from the cache must warn as the first one did.
    for warning in warnings:
        options.warn(warning)
    return document


def make_site_tree(
    checked_project: CheckedProject,
    project_views: ProjectViews,
    page_list: Sequence[Page],
    pictures: Mapping[str, Picture],
) -> file_tree.FileTree:
    """Return the files of the site."""
    from archgen.emit import site as emitter

    return emitter.build_site(
        page_list,
        pictures,
        title=checked_project.architecture.project.title,
        revision=project_views.edition.revision,
        notices=report_view.make_notices(project_views.lookup, project_views.edition),
        chapter_files=checked_project.chapters.read_picture,
    )


def make_packed_yaml(checked_project: CheckedProject) -> str:
    """Return the packed project as YAML."""
    from archgen.syntax import yaml_writer

    packed_project = checked_project.pack_project()
    return yaml_writer.write_yaml(packed_project.data, packed_project.comments)
