"""Text backends as products: how their templates get the views."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from archgen.diagnostics import Diagnostic
from archgen.emit import file_tree
from archgen.emit.backend_manifests import Backend
from archgen.products.backend_choice import make_generation_context, raise_problems
from archgen.products.product_inputs import FinishProduct, MadeProduct, Product, ProductInputs
from archgen.views.generation import make_generation_views
from archgen.views.generation.generation_context import GenerationContext
from archgen.views.graphs import list_graphs
from archgen.views.records import resolved_record
from archgen.views.requirement_exchange import make_requirement_exchange
from archgen.views.sequences.sequence_charts import make_sequence_charts
from archgen.views.tables import statistics_tables


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

    context = make_generation_context(inputs.checked_project, inputs.options, backend)
    views, findings = make_backend_views(inputs, backend, context)
    for finding in findings:
        inputs.options.warn(f"{finding.span}: {finding.message}")
    files, problems = text.render_backend(backend, views, text.DEFAULT_LIMITS.scale_to(context.element_count))
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
        "graphs": lambda: tuple(list_graphs(inputs.views.lookup, inputs.views.drawings.values())),
        "sequences": lambda: tuple(make_sequence_charts(inputs.views.lookup, inputs.views.lookup.scope.components)),
        "record": lambda: resolved_record.make_record(inputs.views.lookup),
        "tables": lambda: statistics_tables.make_statistics_tables(inputs.views.lookup.architecture),
    }
    views = {name: shapes[name]() for name in backend.views if name in shapes}
    generated_views, findings = make_generation_views(context, backend.views)
    return {**views, **generated_views}, findings
