"""Declare coordinate frames: those of the project, and those that components say they write."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics import Diagnostic, Label
from archgen.frozen import NamedTuple
from archgen.link import mapping_values, sanity_checks
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.reference_resolution import ReferenceResolver, find_inner_component
from archgen.link.value_readers import read_values
from archgen.model.coordinate_frames import Frame
from archgen.model.path_resolver import ElementRef
from archgen.model.quantity import Quantity
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode


class _WrittenFrame(NamedTuple):
    """A frame as it is written: below the project, or below a component."""

    component_id: str | None
    entry: MappingEntry
    body: MappingNode


def declare_frames(
    root: MappingNode,
    components: Mapping[str, MappingEntry],
    resolver: ReferenceResolver,
    parameters: HandedParameters | None = None,
) -> dict[str, Frame]:
    """Declare the frames of the project, then those of `components` (by complete id). The first of a name counts.

    `parameters` fill in `$(self.prefix)` in names, so that each instance of a type has frames of its own.
    """
    frames: dict[str, Frame] = {}
    for written_frame in _list_written_frames(root, components):
        frame = _declare_frame(written_frame, resolver, parameters)
        first_frame = frames.setdefault(frame.id, frame)
        if first_frame is not frame:
            resolver.diagnostics.append(_diagnose_duplicate(frame, first_frame))
    return frames


def _list_written_frames(root: MappingNode, components: Mapping[str, MappingEntry]) -> Iterator[_WrittenFrame]:
    for _, entry, body in mapping_values.iterate_elements(root, "frames"):
        yield _WrittenFrame(None, entry, body)
    for component_id, component in components.items():
        for _, entry, body in mapping_values.iterate_elements(mapping_values.get_body(component), "frames"):
            yield _WrittenFrame(component_id, entry, body)


def _declare_frame(
    written_frame: _WrittenFrame, resolver: ReferenceResolver, parameters: HandedParameters | None
) -> Frame:
    component_id, entry, body = written_frame
    name, values = entry.key, read_values("frame", Frame, body)
    if parameters and component_id:
        name = parameters.fill_in_name(name, component_id, entry.key_span)
        parent = values.get("parent")
        values["parent"] = parameters.fill_in_name(parent, component_id, values["parent_at"]) if parent else None
    reference = mapping_values.get_scalar(body, "by")
    own_component = ElementRef("component", component_id) if component_id else None
    writer = _resolve_writer(reference, name, component_id, resolver) if reference else own_component
    return Frame(
        **{"title": name, **values},
        id=name,
        by=writer.id if writer else None,
        by_kind="node" if writer and writer.kind == "node" else "component",
        rate=_read_rate(body, component_id or name, resolver, is_static=values.get("static", False)),
        component=component_id,
        by_written=reference is not None,
        at=entry.key_span,
    )


def _resolve_writer(
    reference: ScalarNode, name: str, component_id: str | None, resolver: ReferenceResolver
) -> ElementRef | None:
    """Return the component that `by` names; where no component is called so, the node."""
    # The own id is refused to other references, since it would be a loop there.
    if component_id and component_id.rpartition(".")[2] == reference.text:
        return ElementRef("component", component_id)
    inner_id = find_inner_component(reference.text, resolver, component_id) if component_id else None
    if inner_id is not None:
        return ElementRef("component", inner_id)
    # A node often has the name of the component that it implements: both would be meant by one word.
    has_component = resolver.names.resolve_path(reference.text, ("component",), component_id=component_id).count > 0
    kinds = ("component",) if has_component else ("component", "node")
    return resolver.resolve_reference(reference, kinds, component_id or name, component_id)


def _read_rate(body: MappingNode, element_id: str, resolver: ReferenceResolver, *, is_static: bool) -> Quantity | None:
    rate = sanity_checks.read_positive(body, "rate", "frequency", element_id, resolver.diagnostics)
    if rate is None or not is_static:
        return rate
    sanity_checks.report_rate_of_static(body, element_id, resolver.diagnostics)
    return None


def _diagnose_duplicate(second_frame: Frame, first_frame: Frame) -> Diagnostic:
    writers = [frame.by for frame in (first_frame, second_frame) if frame.by]
    both = f", by `{writers[0]}` and by `{writers[1]}`" if len(set(writers)) > 1 else ""
    return Diagnostic(
        "duplicate-frame",
        f"the frame `{second_frame.id}` is declared twice{both}",
        second_frame.at,
        labels=(Label(first_frame.at, "first declared here"),),
        help="a frame has one parent and one writer: keep one of them, or give each robot's frames names of their own",
        element=second_frame.answering_element,
    )
