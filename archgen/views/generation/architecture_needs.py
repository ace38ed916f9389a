"""What a generator takes for granted of an architecture (`needs` of its manifest), checked with the user's lines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from archgen.diagnostics.diagnostic import Diagnostic, Label, Rule, Severity
from archgen.diagnostics.source_span import first_written_span
from archgen.model.architecture import Architecture
from archgen.views.generation import property_needs
from archgen.views.generation.generation_context import GenerationContext

UNMET_NEED = Rule(
    "unmet-need",
    Severity.ERROR,
    "A generator takes something for granted that does not hold.",
    fixed=True,
)
"""What `archgen generate` says where `needs` of a backend do not hold. `archgen check` never says it."""


def find_unmet_needs(context: GenerationContext, needs: tuple[str, ...]) -> Iterator[Diagnostic]:
    """Yield what of the `needs` of a backend does not hold."""
    for need in needs:
        yield from _FINDERS[need](context)


def _find_composed(context: GenerationContext) -> Iterator[Diagnostic]:
    for shell in context.architecture.shells.values():
        yield _diagnose_need(
            f"`{shell.id}` holds components, and what is generated here knows no components inside of others",
            shell.id,
            context.architecture,
            help_line="`archgen transform flatten -o flat.yaml` makes a project without; generate from that",
        )


def _find_generics(context: GenerationContext) -> Iterator[Diagnostic]:
    """Yield the component types and types of data that stand for many."""
    architecture = context.architecture
    generic_types = [
        *((each.id, each.at) for each in architecture.component_types.values() if each.generic),
        *((each.name, each.at) for each in architecture.types.values() if each.generic),
    ]
    for name, span in generic_types:
        yield Diagnostic(
            UNMET_NEED.name,
            f"`{name}` stands for many types, and what is generated here knows no such types",
            span,
            UNMET_NEED.severity,
            help="`archgen transform remove_generics -o plain.yaml` makes a project without; generate from that",
            element=name,
        )


def _find_several_sources(context: GenerationContext) -> Iterator[Diagnostic]:
    architecture = context.architecture
    for component_id in context.wanted_components:
        for port in architecture.components[component_id].inputs.values():
            outputs = list(dict.fromkeys(output for each in port.connections for output in each.outputs))
            if len(outputs) > 1:
                named_outputs = " and ".join(f"`{each}`" for each in outputs[:3])
                labels = tuple(Label(each.at, "a source") for each in port.connections[1:])
                yield Diagnostic(
                    UNMET_NEED.name,
                    f"`{port.id}` has {len(outputs)} sources, {named_outputs}{', ...' if len(outputs) > 3 else ''}: "  # noqa: PLR2004
                    "what is generated here knows one",
                    first_written_span(port.connections[0].at, port.at),
                    UNMET_NEED.severity,
                    labels=labels,
                    help="give it an input for each source, or put a component between that joins them",
                    element=port.id,
                )


def _find_repeated_names(context: GenerationContext) -> Iterator[Diagnostic]:
    architecture = context.architecture
    first_ids = dict[str, str]()
    for component in architecture.list_described_components():
        first_id = first_ids.setdefault(component.name, component.id)
        if first_id != component.id:
            first = architecture.find_component(first_id)
            yield _diagnose_need(
                f"`{first_id}` and `{component.id}` are both called `{component.name}`, and what is generated here knows "
                "components by their last names",
                component.id,
                architecture,
                help_line="give one of them another id; `archgen transform flatten -o flat.yaml` gives names of their own",
                labels=(Label(first.at, "the first one"),) if first else (),
            )


def _diagnose_need(
    message: str, component_id: str, architecture: Architecture, *, help_line: str, labels: tuple[Label, ...] = ()
) -> Diagnostic:
    component = architecture.find_component(component_id)
    assert component is not None  # noqa: S101 - both callers have it from the architecture
    return Diagnostic(
        UNMET_NEED.name, message, component.at, UNMET_NEED.severity, labels=labels, help=help_line, element=component_id
    )


def _find_unfit_tags(context: GenerationContext) -> Iterator[Diagnostic]:
    return property_needs.find_unfit_tags(context, UNMET_NEED)


def _find_unfit_values(context: GenerationContext) -> Iterator[Diagnostic]:
    return property_needs.find_unfit_values(context, UNMET_NEED)


_FINDERS: Mapping[str, Callable[[GenerationContext], Iterator[Diagnostic]]] = {
    "flat": _find_composed,
    "no_generics": _find_generics,
    "one_source": _find_several_sources,
    "unique_names": _find_repeated_names,
    "distinct_tags": _find_unfit_tags,
    "one_line_values": _find_unfit_values,
}
