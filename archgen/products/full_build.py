"""Everything at once: report, site, diagrams, packed file and further backends, below one folder.

What takes long runs side by side, and a build of which nothing changed is not made again.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.emit import file_tree, picture_files
from archgen.emit.backend_manifests import Backend
from archgen.pipeline import CheckedProject
from archgen.products import build_stamp, project_outputs, report_cache
from archgen.products.project_outputs import OutputOptions, ProjectViews
from archgen.views import resolved_record
from archgen.views.pages import report_outline as report_view
from archgen.views.pages import site_pages
from archgen.views.shapes import Graph
from archgen.views.tables import statistics_tables


def build_outputs(
    checked_project: CheckedProject,
    options: OutputOptions,
    target: Path,
    template: Path | None = None,
    backend_names: Sequence[str] = (),
) -> Iterator[Path]:
    """Write report, site, diagrams and packed file below a folder, then further backends; yield the paths.

    Nothing is written where all of it is there already, from the same inputs. The caller must exhaust the generator:
    work is done between the yields, and the stamp is stored after the last one.
    """
    # Before any work, so that a misspelt backend fails at once.
    text_backends = _find_backends(checked_project, backend_names, options.allowed_backends)
    # Settled once: git is asked a single time, and the stamp depends on the revision that is printed.
    options = replace(options, revision=project_outputs.choose_revision(checked_project, options))
    # No stamp with further backends: what their templates read is not among the inputs below.
    stamp_key = "" if text_backends else build_stamp.make_stamp_key(_build_inputs(checked_project, options, template))
    fresh_parts = (
        build_stamp.find_fresh_parts(
            report_cache.cache_folder(), stamp_key, target, checked_project.chapters.read_picture
        )
        if stamp_key
        else None
    )
    warnings: list[str] = []
    written_parts: list[str] = []
    for part in fresh_parts or _write_parts(
        checked_project,
        replace(options, warn=_record_warnings(options.warn, warnings)),
        target,
        template,
        text_backends,
    ):
        written_parts.append(part)
        yield target / part / ("index.html" if part == "site" else "")
    # A build with warnings is repeated next time, so that its warnings are repeated, too.
    if stamp_key and fresh_parts is None and not warnings:
        build_stamp.store_stamp(
            report_cache.cache_folder(), stamp_key, target, written_parts, checked_project.chapters.picture_cache
        )


def _record_warnings(warn: Callable[[str], None], warnings: list[str]) -> Callable[[str], None]:
    """Return a `warn` that also collects its texts in a list."""

    def warn_and_record(text: str) -> None:
        warnings.append(text)
        warn(text)

    return warn_and_record


def _build_inputs(checked_project: CheckedProject, options: OutputOptions, template: Path | None) -> Iterator[object]:
    """Yield all that decides the outputs' bytes, except this program and the pictures of chapters.

    The program is part of the stamp's key; chapter pictures are known only after the writers asked for them.
    """
    project, sources, chapters = checked_project.architecture.project, checked_project.sources, checked_project.chapters
    yield project.id, project.title, options.selector_text, options.level, options.revision
    # `sources` has the text of every file that was read, interface definitions included.
    yield (
        checked_project.yaml_files,
        checked_project.input_files,
        [(file, sources.text_of(file)) for file in sources.file_names()],
    )
    yield chapters.order, [(name, chapter.text) for name, chapter in chapters.texts.items()], checked_project.findings
    yield template and template.read_bytes()
    yield project_outputs.identify_history(checked_project, options)


def _write_parts(
    checked_project: CheckedProject,
    options: OutputOptions,
    target: Path,
    template: Path | None,
    text_backends: Sequence[Backend],
) -> Iterator[str]:
    """Write each part and yield its name."""
    from archgen.emit import graphviz

    with graphviz.start_early_workers(report_cache.cache_folder()) as workers, ThreadPoolExecutor(1) as executor:
        project_views = project_outputs.make_views(checked_project, options)
        # Other processes draw: meanwhile all that needs no picture is made.
        drawing_future = executor.submit(
            project_outputs.draw_views, project_views, options, ("svg", "png", "svg_outlines"), workers
        )
        outline, page_list = (
            report_view.make_report(project_views.lookup, project_views.edition),
            tuple(site_pages.make_pages(project_views.lookup, project_views.edition)),
        )
        packed = project_outputs.make_packed_yaml(checked_project).encode()
        pictures = drawing_future.result()
    # From here on files appear: all views are made and all pictures are drawn.
    file_tree.write_file(
        target / "report.docx", project_outputs.make_report_docx(checked_project, outline, pictures, options, template)
    )
    yield "report.docx"
    file_tree.write_tree(
        project_outputs.make_site_tree(checked_project, project_views, page_list, pictures), target / "site"
    )
    yield "site"
    file_tree.write_tree(picture_files.build_picture_tree(pictures, ("svg", "png")), target / "diagrams")
    if pictures:
        yield "diagrams"
    file_tree.write_file(target / "packed.yaml", packed)
    yield "packed.yaml"
    for backend in text_backends:
        _write_backend(project_views, backend, target / backend.id)
        yield backend.id


def _find_backends(
    checked_project: CheckedProject, names: Sequence[str], allowed_names: Collection[str] | None
) -> list[Backend]:
    """Return the named text backends. Raise OutputError for unknown, broken or forbidden ones."""
    if not names:
        return []
    from archgen.emit import backend_manifests

    backends_by_name, problems = backend_manifests.find_backends(checked_project.root)
    # Only manifests of backends that are asked for count; a broken one beside them must not stop the build.
    relevant_problems = [
        problem for problem in problems if any(f"backends/{name}/" in problem.span.file for name in names)
    ]
    _raise_problems(relevant_problems)
    for name in names:
        if name not in backends_by_name or backends_by_name[name].emitter != "text":
            text_backend_names = ", ".join(
                name for name, backend in backends_by_name.items() if backend.emitter == "text"
            )
            msg = f"there is no text backend `{name}`"
            raise file_tree.OutputError(msg, f"there are {text_backend_names}")
        # The branch under review may be anybody's: its own backends run only if the trusted revision allows them.
        if backends_by_name[name].from_project and allowed_names is not None and name not in allowed_names:
            msg = f"the project's own backend `{name}` is not run here: the revision that is trusted does not name it"
            raise file_tree.OutputError(msg, "add it to `review.backends` there, in a change of its own")
    return [backends_by_name[name] for name in names]


def _write_backend(project_views: ProjectViews, backend: Backend, target: Path) -> None:
    """Write the output of one text backend."""
    from archgen.emit import text

    # Made only on demand: a backend names the views that it needs in its manifest.
    shapes: dict[str, Callable[[], object]] = {
        "outline": lambda: report_view.make_report(project_views.lookup, project_views.edition),
        "pages": lambda: site_pages.make_pages(project_views.lookup, project_views.edition),
        "graphs": lambda: tuple(graph for graph in project_views.drawings.values() if isinstance(graph, Graph)),
        "record": lambda: resolved_record.make_record(project_views.lookup),
        "tables": lambda: statistics_tables.make_statistics_tables(project_views.lookup.architecture),
    }
    files, problems = text.render_backend(backend, {name: shapes[name]() for name in backend.views})
    _raise_problems(problems)
    if files is not None:
        file_tree.write_tree(files, target)


def _raise_problems(problems: Sequence[Diagnostic]) -> None:
    """Raise OutputError with all problems, if there are any."""
    if problems:
        message = "; ".join(f"{problem.span}: {problem.message}" for problem in problems)
        raise file_tree.OutputError(message, problems[0].help)
