"""What views for generators are made from, for a backend and a part of a project."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from archgen.emit.backend_manifests import find_backends
from archgen.pipeline import check_project
from archgen.products.backend_choice import make_generation_context
from archgen.products.backend_products import make_backend_views
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.products.project_views import select_elements

PROJECT = "{archgen: 1, project: {id: robot}, groups: {g: {components: {a: {functionality: Grips.}, b: {functionality: Looks.}}}}}"


def test_the_context_has_the_part_the_options_and_the_packed_project(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    project, backend = check_project(tmp_path), find_backends(tmp_path)[0]["structurizr"]
    whole = make_generation_context(project, OutputOptions(), backend)
    assert (whole.is_whole, whole.level, whole.backend) == (True, "implementation", "structurizr")
    assert whole.pack_project()["groups"]["g"]["components"].keys() == {"a", "b"}
    selection, problems = select_elements(project, "g.a")
    assert problems == ()
    options = OutputOptions(selection, "g.a", level="functional", types_only=True)
    part = make_generation_context(project, options, backend)
    assert (part.components, part.level, part.types_only) == (frozenset({"g.a"}), "functional", True)
    assert part.architecture is project.architecture


def test_a_document_has_views_of_documents_and_of_generators(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    project, backend = check_project(tmp_path), find_backends(tmp_path)[0]["structurizr"]
    asking = replace(backend, views=("record", "structure"))
    context = make_generation_context(project, OutputOptions(), asking)
    views, findings = make_backend_views(ProductInputs(project, OutputOptions()), asking, context)
    assert (views.keys(), findings) == ({"record", "structure"}, ())
