"""Declare use cases: their actors, and the steps between these and the components."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics import Diagnostic, Label
from archgen.frozen import replace
from archgen.link import mapping_values
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_element
from archgen.model.architecture import UseCase
from archgen.model.use_case_steps import Actor, Step, StepEnd
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode

_END_KINDS = ("component", "output")


def declare_use_cases(root: MappingNode, resolver: ReferenceResolver) -> dict[str, UseCase]:
    """Declare the use cases."""
    use_cases: dict[str, UseCase] = {}
    for name, entry, body in mapping_values.iterate_elements(root, "use_cases"):
        values = read_element("use_case", UseCase, entry, body)
        steps = tuple(_declare_steps(body, values.get("actors", {}), name, resolver))
        use_cases[name] = UseCase(**values, steps=steps)
    return use_cases


def _declare_steps(
    body: MappingNode, actors: Mapping[str, Actor], use_case_id: str, resolver: ReferenceResolver
) -> Iterator[Step]:
    """Yield the steps, without those that lack an end, which merging has reported."""
    steps = body.get("steps")
    for item in steps.items if isinstance(steps, SequenceNode) else ():
        if not isinstance(item, MappingNode):
            continue
        source, target = mapping_values.get_scalar(item, "from"), mapping_values.get_scalar(item, "to")
        if source is not None and target is not None:
            yield Step(
                _resolve_end(source, actors, use_case_id, resolver),
                _resolve_end(target, actors, use_case_id, resolver),
                mapping_values.get_text(item, "say"),
                source.span,
            )


def _resolve_end(
    written_end: ScalarNode, actors: Mapping[str, Actor], use_case_id: str, resolver: ReferenceResolver
) -> StepEnd:
    """Return what an end of a step names: an actor of the use case wins over what the architecture has of that name."""
    text = written_end.text
    if text in actors:
        _warn_hidden(written_end, actors[text], use_case_id, resolver)
        return StepEnd("actor", text, written_end.span)
    guess = resolver.guesser.guess_name(text, actors) if "." not in text and not _is_known(text, resolver) else None
    if guess is not None:
        resolver.report(
            "unknown-reference",
            f"no actor, component or output named `{text}`",
            written_end.span,
            labels=(Label(actors[guess].at, "declared here"),),
            help_line=f"did you mean `{guess}`?",
            element=use_case_id,
        )
        return StepEnd("unknown", text, written_end.span)
    count = len(resolver.diagnostics)
    target = resolver.resolve_reference(written_end, _END_KINDS, use_case_id)
    if target is None:
        resolver.diagnostics[count:] = [_mention_actors(each, text, resolver) for each in resolver.diagnostics[count:]]
        return StepEnd("unknown", text, written_end.span)
    return StepEnd("output" if target.kind == "output" else "component", target.id, written_end.span)


def _is_known(text: str, resolver: ReferenceResolver) -> bool:
    return resolver.names.resolve_path(text, _END_KINDS).count > 0


def _warn_hidden(written_end: ScalarNode, actor: Actor, use_case_id: str, resolver: ReferenceResolver) -> None:
    """Warn where an actor has the name of a component: the actor is meant."""
    component_ids = resolver.names.ids_ending_in("component", actor.id)
    if component_ids:
        resolver.report(
            "hidden-reference",
            f"`{actor.id}` is the actor, which hides the component `{component_ids[0]}`",
            written_end.span,
            labels=(Label(actor.at, "the actor"), Label(resolver.spans["component"][component_ids[0]], "hidden")),
            help_line=f"write `{component_ids[0]}` if that is meant, or call the actor otherwise",
            element=use_case_id,
        )


def _mention_actors(diagnostic: Diagnostic, text: str, resolver: ReferenceResolver) -> Diagnostic:
    """Return a finding about an unknown name with what a step can name: a component, or an actor that is declared."""
    if diagnostic.rule != "unknown-reference":
        return diagnostic
    inputs = resolver.names.ids_ending_in("input", text)
    if inputs:
        component_id = inputs[0].rpartition(".")[0]
        return replace(diagnostic, help=f"a step ends at a component, whatever input it enters by: `{component_id}`")
    if diagnostic.help is not None or "." in text:
        return diagnostic
    return replace(diagnostic, help=f"who stands outside is declared in the use case: `actors: {{{text}: ...}}`")
