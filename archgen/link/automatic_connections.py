"""Join what follows by itself: `from` of an instance, and `autoconnect` of groups and composed components.

Innermost first, so that what is inside has its types when what is around is joined.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.diagnostics import Span, join_words
from archgen.link import mapping_values
from archgen.link.element_outline import ElementOutline
from archgen.link.port_sources import PortKey, PortSource, PortSources
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.path_resolver import ElementRef
from archgen.syntax.yaml_tree import MappingNode

_MAX_NAMED = 4
"""So many candidates are named where several fit."""


def join_ports(outline: ElementOutline, sources: PortSources, resolver: ReferenceResolver) -> None:
    """Add to `sources` what follows by itself, and report what could follow in several ways."""
    _AutomaticConnections(outline, sources, resolver).join_all()


class _AutomaticConnections:
    """Joins the ports of a project."""

    def __init__(self, outline: ElementOutline, sources: PortSources, resolver: ReferenceResolver) -> None:
        self._outline = outline
        self._sources = sources
        self._resolver = resolver

    def join_all(self) -> None:
        instances = self._outline.expansion.instances if self._outline.expansion else {}
        for component_id in instances:
            self._feed_instance(component_id)
        self._sources.forget_outputs()
        # Outer ones come first in the outline: what is around asks for types that are known only when the inside is joined.
        for shell in reversed(tuple(self._outline.shells.values())):
            mode = mapping_values.get_text(mapping_values.get_body(shell.entry), "autoconnect")
            if mode:
                self._join_inside(shell.children, shell.id, mode)
        for group_id, entry in self._outline.groups.items():
            mode = mapping_values.get_text(mapping_values.get_body(entry), "autoconnect")
            if mode:
                self._join_inside(self._outline.members[group_id], None, mode)

    def _feed_instance(self, component_id: str) -> None:
        """Give each input without a source every output of equal type of the components that the instance names."""
        feeders = list(self._sources.resolve_feeders(component_id))
        for port in self._list_open_inputs(component_id) if feeders else ():
            wanted_type = self._sources.type_of_input(port[1])
            matches = [
                (feeder, output_id)
                for feeder in feeders
                for output_id in self._list_outputs(feeder.target, component_id)
                if wanted_type is not None and self._sources.type_of_output(output_id) == wanted_type
            ]
            for feeder, output_id in matches:
                self._sources.add_source(port, PortSource(ElementRef("output", output_id), feeder.written, feeder.at))
            if len(matches) > 1:
                self._warn_several(port, [output_id for _, output_id in matches], matches[0][0])

    def _list_outputs(self, target: ElementRef, reader_id: str) -> list[str]:
        members = [target.id] if target.kind == "component" else self._outline.members[target.id]
        return [output.id for each in members if each != reader_id for output in self._outline.outputs[each].values()]

    def _join_inside(self, children: Sequence[str], shell_id: str | None, mode: str) -> None:
        self._sources.forget_outputs()
        offered = [("output", output.id) for child in children for output in self._outline.outputs[child].values()]
        if shell_id is not None:
            offered += [("input", f"{shell_id}.{name}") for name in self._outline.inputs[shell_id]]
        by_mark: dict[str, list[PortKey]] = {}
        for port in offered:
            mark = _name_of(port) if mode == "ports" else self._type_of(port)
            by_mark.setdefault(mark or "", []).append(port)
        for child in children:
            for port in self._list_open_inputs(child):
                mark = _name_of(port) if mode == "ports" else self._type_of(port)
                others = (
                    [each for each in by_mark.get(mark or "", ()) if each[1].rpartition(".")[0] != child]
                    if mark
                    else []
                )
                self._join_port(port, [each for each in others if self._agree(port, each)])
        if shell_id is not None:
            self._give_on(children, shell_id, mode)

    def _give_on(self, children: Sequence[str], shell_id: str, mode: str) -> None:
        """Let each output of a composed component pass on the output inside that nobody there reads but sinks."""
        self._sources.forget_outputs()
        read_inside = {
            source.target.id
            for child in children
            if self._outline.outputs[child]
            for name in self._outline.inputs[child]
            for source in self._sources.list_sources(("input", f"{child}.{name}"))
            if source.target.kind == "output"
        }
        for output in self._outline.outputs[shell_id].values():
            port = ("output", output.id)
            if self._outline.given_outputs.get(shell_id, {}).get(output.name, _NOTHING).get("from") is not None:
                continue
            candidates = [
                ("output", inner.id)
                for child in children
                for inner in self._outline.outputs[child].values()
                if inner.id not in read_inside and (mode == "types" or inner.name == output.name)
            ]
            self._join_port(port, [each for each in candidates if self._agree(port, each, needs_type=mode == "types")])
        self._sources.forget_outputs()

    def _list_open_inputs(self, component_id: str) -> Iterator[PortKey]:
        """Yield the inputs of a component that name no source, neither inside nor outside of the system."""
        for name, entry in self._outline.inputs[component_id].items():
            body, port = mapping_values.get_body(entry), ("input", f"{component_id}.{name}")
            if body.get("from") is None and body.get("external") is None and not self._sources.list_sources(port):
                yield port

    def _type_of(self, port: PortKey) -> str | None:
        return self._sources.type_of_output(port[1]) if port[0] == "output" else self._sources.type_of_input(port[1])

    def _agree(self, reader: PortKey, source: PortKey, *, needs_type: bool = False) -> bool:
        """Whether two ports are of one type; what is not known contradicts nothing."""
        reader_type, source_type = self._type_of(reader), self._type_of(source)
        if reader_type is None or source_type is None:
            return not needs_type
        return reader_type == source_type

    def _join_port(self, port: PortKey, candidates: Sequence[PortKey]) -> None:
        if len(candidates) == 1:
            kind, source_id = candidates[0]
            self._sources.add_source(
                port, PortSource(ElementRef(kind, source_id), source_id, self._place_of(port), is_made=True)
            )
        elif candidates:
            names = [f"`{each[1]}`" for each in candidates[:_MAX_NAMED]]
            rest = [f"{len(candidates) - _MAX_NAMED} more"] if len(candidates) > _MAX_NAMED else []
            self._sources.ambiguous_ports.add(port)
            # Any of them may be what was meant: rules on what nobody reads keep quiet about all of them.
            self._resolver.suspect_ids.update(each[1] for each in candidates)
            self._resolver.report(
                "ambiguous-connection",
                f"`{port[1]}` can be joined to {join_words([*names, *rest], 'or')}",
                self._place_of(port),
                help_line="write `from` at it: where several fit, nothing is joined",
                element=port[1].rpartition(".")[0],
            )

    def _warn_several(self, port: PortKey, output_ids: Sequence[str], feeder: PortSource) -> None:
        names = join_words([f"`{each}`" for each in output_ids[:_MAX_NAMED]])
        self._resolver.report(
            "several-sources",
            f"`{port[1]}` takes {len(output_ids)} outputs of its type: {names}",
            feeder.at,
            help_line="write `from` at the input if it is one of them, or a list there if it is all",
            element=port[1].rpartition(".")[0],
        )

    def _place_of(self, port: PortKey) -> Span:
        return self._resolver.spans[port[0]][port[1]]


_NOTHING = MappingNode({}, mapping_values.EMPTY_MAPPING.span)


def _name_of(port: PortKey) -> str:
    return port[1].rpartition(".")[2]
