"""Everything at once: report, site, diagrams, packed file and further backends, below one folder.

What takes long runs side by side, and a build of which nothing changed is not made again.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from archgen import outputs
from archgen.diagnostic import Diagnostic
from archgen.emit import folder, kept, stamp, tree
from archgen.emit.backends import Backend
from archgen.outputs import Ask, Made
from archgen.pipeline import Checked
from archgen.views import pages, record, statistics
from archgen.views import report as report_view
from archgen.views.shapes import Graph


def build(
    checked: Checked, ask: Ask, target: Path, template: Path | None = None, extra: Sequence[str] = ()
) -> Iterator[Path]:
    """Write report, site, diagrams and packed file below a folder, then further backends; yield the paths.

    Nothing is written where all of it is there already, from the same inputs. The caller must exhaust the generator:
    work is done between the yields, and the stamp is stored after the last one.
    """
    # Before any work, so that a misspelt backend fails at once.
    chosen = _backends(checked, extra, ask.allowed)
    # Settled once: git is asked a single time, and the stamp depends on the revision that is printed.
    ask = replace(ask, revision=outputs.revision_of(checked, ask))
    # No stamp with further backends: what their templates read is not among the inputs below.
    name = "" if chosen else stamp.key(_inputs(checked, ask, template))
    parts = stamp.fresh(kept.folder(), name, target, checked.chapters.picture) if name else None
    warned: list[str] = []
    done: list[str] = []
    for part in parts or _build(checked, replace(ask, warn=_noting(ask.warn, warned)), target, template, chosen):
        done.append(part)
        yield target / part / ("index.html" if part == "site" else "")
    # A build with warnings is repeated next time, so that its warnings are repeated, too.
    if name and parts is None and not warned:
        stamp.keep(kept.folder(), name, target, done, checked.chapters.asked)


def _noting(warn: Callable[[str], None], said: list[str]) -> Callable[[str], None]:
    """Return a `warn` that also collects its texts in a list."""

    def warned(text: str) -> None:
        said.append(text)
        warn(text)

    return warned


def _inputs(checked: Checked, ask: Ask, template: Path | None) -> Iterator[object]:
    """Yield all that decides the outputs' bytes, except this program and the pictures of chapters.

    The program is part of the stamp's key; chapter pictures are known only after the writers asked for them.
    """
    project, sources, chapters = checked.architecture.project, checked.sources, checked.chapters
    yield project.id, project.title, ask.words, ask.level, ask.revision
    # `sources` has the text of every file that was read, interface definitions included.
    yield checked.files, checked.all_files, [(file, sources.text(file)) for file in sources.files()]
    yield chapters.order, [(name, chapter.text) for name, chapter in chapters.texts.items()], checked.findings
    yield template and template.read_bytes()
    yield outputs.history_stamp(checked, ask)


def _build(checked: Checked, ask: Ask, target: Path, template: Path | None, chosen: Sequence[Backend]) -> Iterator[str]:
    """Write each part and yield its name."""
    from archgen.emit import graphviz

    with graphviz.early(kept.folder()) as ready, ThreadPoolExecutor(1) as beside:
        made = outputs.make(checked, ask)
        # Other processes draw: meanwhile all that needs no picture is made.
        drawing = beside.submit(outputs.draw_all, made, ask, ("svg", "png", "svg_outlines"), ready)
        outline, listed = report_view.report(made.view, made.edition), tuple(pages.pages(made.view, made.edition))
        packed = outputs.packed(checked).encode()
        pictures = drawing.result()
    # From here on files appear: all views are made and all pictures are drawn.
    tree.write_file(target / "report.docx", outputs.docx(checked, outline, pictures, ask, template))
    yield "report.docx"
    tree.write(outputs.site_tree(checked, made, listed, pictures), target / "site")
    yield "site"
    tree.write(folder.write(pictures, ("svg", "png")), target / "diagrams")
    if pictures:
        yield "diagrams"
    tree.write_file(target / "packed.yaml", packed)
    yield "packed.yaml"
    for backend in chosen:
        _extra(made, backend, target / backend.id)
        yield backend.id


def _backends(checked: Checked, names: Sequence[str], allowed: Collection[str] | None) -> list[Backend]:
    """Return the named text backends. Raise OutputError for unknown, broken or forbidden ones."""
    if not names:
        return []
    from archgen.emit import backends

    found, problems = backends.find(checked.root)
    # Only manifests of backends that are asked for count; a broken one beside them must not stop the build.
    wrong = [problem for problem in problems if any(f"backends/{name}/" in problem.span.file for name in names)]
    _refuse(wrong)
    for name in names:
        if name not in found or found[name].emitter != "text":
            known = ", ".join(name for name, backend in found.items() if backend.emitter == "text")
            msg = f"there is no text backend `{name}`"
            raise tree.OutputError(msg, f"there are {known}")
        # The branch under review may be anybody's: its own backends run only if the trusted revision allows them.
        if found[name].own and allowed is not None and name not in allowed:
            msg = f"the project's own backend `{name}` is not run here: the revision that is trusted does not name it"
            raise tree.OutputError(msg, "add it to `review.backends` there, in a change of its own")
    return [found[name] for name in names]


def _extra(made: Made, backend: Backend, target: Path) -> None:
    """Write the output of one text backend."""
    from archgen.emit import text

    # Made only on demand: a backend names the views that it needs in its manifest.
    shapes: dict[str, Callable[[], object]] = {
        "outline": lambda: report_view.report(made.view, made.edition),
        "pages": lambda: pages.pages(made.view, made.edition),
        "graphs": lambda: tuple(graph for graph in made.graphs.values() if isinstance(graph, Graph)),
        "record": lambda: record.record(made.view),
        "tables": lambda: statistics.statistics(made.view.architecture),
    }
    files, problems = text.write(backend, {name: shapes[name]() for name in backend.views})
    _refuse(problems)
    if files is not None:
        tree.write(files, target)


def _refuse(problems: Sequence[Diagnostic]) -> None:
    """Raise OutputError with all problems, if there are any."""
    if problems:
        said = "; ".join(f"{problem.span}: {problem.message}" for problem in problems)
        raise tree.OutputError(said, problems[0].help)
