"""Text backends as products: which one a name means, which verb makes it, and how its templates get the views."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Literal

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.suggestions import did_you_mean
from archgen.emit import file_tree
from archgen.emit.backend_manifests import CALLED_EMITTERS, Backend
from archgen.pipeline import CheckedProject
from archgen.products.product_inputs import FinishProduct, MadeProduct, Product, ProductInputs
from archgen.products.product_table import PRODUCTS
from archgen.products.trusted_backends import TrustedRevision, refuse_untrusted
from archgen.views import resolved_record
from archgen.views.generation import GENERATION_VIEWS
from archgen.views.generation.generation_context import GenerationContext
from archgen.views.graph_shapes import Graph
from archgen.views.requirement_exchange import make_requirement_exchange
from archgen.views.sequence_shapes import SequenceChart
from archgen.views.tables import statistics_tables

BackendTarget = Literal["documents", "workspace", "file"]
_COMMANDS: Mapping[BackendTarget, str] = {
    "documents": "archgen build --backend {}",
    "workspace": "archgen generate {}",
    "file": "archgen export {}",
}
_TARGET_PHRASES: Mapping[BackendTarget, str] = {
    "documents": "documents",
    "workspace": "a workspace",
    "file": "a single file",
}


def choose_backends(
    checked_project: CheckedProject,
    names: Sequence[str],
    makes: BackendTarget,
    trusted_revision: TrustedRevision | None,
    *,
    other_outputs: Collection[str] = (),
) -> tuple[Backend, ...]:
    """Return the named text backends. Raise OutputError for unknown, broken or forbidden ones, and for others' verbs.

    Of the project's own backends those may run that `trusted_revision` allows; None allows all of them. `other_outputs`
    are further names that could have been meant.
    """
    if not names:
        return ()
    from archgen.emit import backend_manifests

    backends_by_name, problems = backend_manifests.find_backends(checked_project.root)
    # Only manifests of backends that are asked for count; a broken one beside them must not stop the build.
    raise_problems([p for p in problems if any(f"backends/{name}/" in p.span.file for name in names)])
    for name in names:
        _refuse_unusable(backends_by_name, name, makes, other_outputs)
        if backends_by_name[name].from_project and trusted_revision is not None:
            refuse_untrusted(backends_by_name[name], trusted_revision)
    return tuple(backends_by_name[name] for name in dict.fromkeys(names))


def _refuse_unusable(
    backends_by_name: Mapping[str, Backend], name: str, makes: BackendTarget, other_outputs: Collection[str]
) -> None:
    """Raise OutputError unless there is a text backend of this name that makes what the verb is for."""
    usable_names = list(other_outputs) + [
        backend_id
        for backend_id, backend in backends_by_name.items()
        if backend.emitter in CALLED_EMITTERS and backend.makes == makes
    ]
    backend = backends_by_name.get(name)
    if backend is None or backend.emitter not in CALLED_EMITTERS:
        msg = f"there is no {'output' if other_outputs else 'text backend'} `{name}`"
        listed_names = f"there are {', '.join(usable_names)}"
        raise file_tree.OutputError(msg, did_you_mean(name, usable_names) or listed_names)
    if backend.makes != makes:
        msg = f"the backend `{name}` makes {_TARGET_PHRASES[backend.makes]}, not {_TARGET_PHRASES[makes]}"
        raise file_tree.OutputError(msg, f"`{_COMMANDS[backend.makes].format(name)}` makes it")
    # `PRODUCTS` are written into the same folder, and `--only` names both.
    if backend.from_project and name in PRODUCTS:
        msg = f"the backend `{name}` is called as an output of archgen itself"
        raise file_tree.OutputError(msg, "give it another `id`, and its folder the same name")


def make_backend_product(backend: Backend) -> Product:
    """Make the product of a text backend."""

    def start(inputs: ProductInputs) -> FinishProduct:
        # Templates run when the product is finished: a mistake in them costs this backend's output alone.
        return lambda _pictures: MadeProduct(_render_backend(inputs, backend))

    # What templates read is not among the inputs of a build, so a backend is made each time.
    return Product(backend.id, backend.id, start, follows_inputs=False)


def render_single_file(inputs: ProductInputs, backend: Backend) -> bytes:
    """Return the file of a backend that makes a single one. Raise OutputError where its template fails."""
    if backend.emitter == "reqif":
        from archgen.emit.reqif import render_reqif

        return render_reqif(make_requirement_exchange(inputs.timed_lookup))
    (content,) = _render_backend(inputs, backend).files.values()
    return content


def _render_backend(inputs: ProductInputs, backend: Backend) -> file_tree.FileTree:
    """Return the files of a text backend. Raise OutputError where its templates fail."""
    from archgen.emit import text

    context = GenerationContext(inputs.checked_project.architecture, options=backend.options)
    views, findings = make_backend_views(inputs, backend, context)
    for finding in findings:
        inputs.options.warn(f"{finding.span}: {finding.message}")
    files, problems = text.render_backend(backend, views)
    raise_problems(problems)
    return files or file_tree.make_file_tree(())


def make_backend_views(
    inputs: ProductInputs, backend: Backend, context: GenerationContext
) -> tuple[Mapping[str, object], tuple[Diagnostic, ...]]:
    """Return the views that a backend names in its manifest, and what those for generators leave out."""
    # Made only on demand: a backend names the views that it needs in its manifest.
    shapes: dict[str, Callable[[], object]] = {
        "outline": lambda: inputs.outline,
        "pages": lambda: inputs.pages,
        "graphs": lambda: tuple(graph for graph in inputs.views.drawings.values() if isinstance(graph, Graph)),
        "sequences": lambda: tuple(each for each in inputs.views.drawings.values() if isinstance(each, SequenceChart)),
        "record": lambda: resolved_record.make_record(inputs.views.lookup),
        "tables": lambda: statistics_tables.make_statistics_tables(inputs.views.lookup.architecture),
    }
    views = {name: shapes[name]() for name in backend.views if name in shapes}
    generated_views = {name: GENERATION_VIEWS[name](context) for name in backend.views if name in GENERATION_VIEWS}
    views |= {name: view.data for name, view in generated_views.items()}
    findings = (finding for view in generated_views.values() for finding in view.findings)
    return views, tuple(sorted(dict.fromkeys(findings), key=lambda finding: finding.sort_key))


def raise_problems(problems: Sequence[Diagnostic]) -> None:
    """Raise OutputError with all problems, if there are any."""
    if problems:
        message = "; ".join(f"{problem.span}: {problem.message}" for problem in problems)
        raise file_tree.OutputError(message, problems[0].help)
