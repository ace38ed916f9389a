"""What generators of code and configuration are made from: plain data, computed for the backends that name it.

Each view has a module of its own with a function `make_view(context)`, and a line in `GENERATION_VIEWS` by the name that
manifests write below `view`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.views.generation.generation_context import GeneratedView, GenerationContext


def _make_interfaces(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import interface_packages

    return interface_packages.make_view(context)


def _make_components(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import component_records

    return component_records.make_view(context)


def _make_plan(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import start_plan_view

    return start_plan_view.make_view(context)


def _make_ros1_launch(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import launch_view

    return launch_view.make_view(context, ros=1)


def _make_ros2_launch(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import launch_view

    return launch_view.make_view(context, ros=2)


def _make_simulation(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import simulation_view

    return simulation_view.make_view(context)


def _make_programs(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import node_programs

    return node_programs.make_view(context, ros=2)


def _make_ros1_programs(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import node_programs

    return node_programs.make_view(context, ros=1)


def _make_structure(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import structure_view

    return structure_view.make_view(context)


def _make_middleware(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import middleware_view

    return middleware_view.make_view(context)


def _make_aadl(context: GenerationContext) -> GeneratedView:
    from archgen.views.generation import aadl_view

    return aadl_view.make_view(context)


def _make_uml(context: GenerationContext) -> GeneratedView:
    from archgen.views.uml import uml_view

    return uml_view.make_view(context)


GENERATION_VIEWS: Mapping[str, Callable[[GenerationContext], GeneratedView]] = {
    "interfaces": _make_interfaces,
    "components": _make_components,
    "plan": _make_plan,
    "programs": _make_programs,
    "ros1_programs": _make_ros1_programs,
    "structure": _make_structure,
    "uml": _make_uml,
    "ros1_launch": _make_ros1_launch,
    "ros2_launch": _make_ros2_launch,
    "simulation": _make_simulation,
    "middleware": _make_middleware,
    "aadl": _make_aadl,
}
"""The functions that make the views, by name. Modules are imported for the views that a backend asks for."""


def make_generation_views(
    context: GenerationContext, names: Iterable[str]
) -> tuple[dict[str, object], tuple[Diagnostic, ...]]:
    """Return those of the named views that are for generators, and what they leave out, in the order of its places."""
    views = {name: GENERATION_VIEWS[name](context) for name in names if name in GENERATION_VIEWS}
    findings = dict.fromkeys(finding for view in views.values() for finding in view.findings)
    data: dict[str, object] = {name: view.data for name, view in views.items()}
    return data, tuple(sorted(findings, key=lambda finding: finding.sort_key))
