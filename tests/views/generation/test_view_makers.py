"""Views for generators by their names: the core's, and those that plug-ins which ship bring."""

from __future__ import annotations

from pathlib import Path

from archgen.installed_plugins import list_shipped_facts
from archgen.pipeline import check_project
from archgen.views.generation import CORE_VIEWS, DOCUMENT_VIEWS, find_view_maker, list_view_names, make_generation_views
from archgen.views.generation.generation_context import GeneratedView, GenerationContext

PROJECT = "{archgen: 1, project: {id: robot}, groups: {g: {components: {a: {functionality: Grips.}}}}}"


def test_views_are_made_by_name(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT)
    context = GenerationContext(check_project(tmp_path).architecture)
    names = [*CORE_VIEWS, *(name for _, name, _ in list_shipped_facts("views"))]
    made = {name: make(context) for name in names if (make := find_view_maker(name))}
    assert list(made) == names
    assert all(isinstance(each, GeneratedView) and each.data for each in made.values())
    views, findings = make_generation_views(context, ("record", "structure"))
    assert (list(views), findings) == (["structure"], ())


def test_plug_ins_are_asked_for_what_the_core_does_not_have() -> None:
    core = (*DOCUMENT_VIEWS, *CORE_VIEWS)
    assert list_view_names(["pages", "structure"]) == core
    shipped = tuple(name for _, name, _ in list_shipped_facts("views"))
    assert list_view_names([*shipped, "pages"]) == (*core, *shipped)
    assert len({*core, *shipped}) == len(core) + len(shipped)
