"""Resolve keys that name ports: of one component, or of all components that a node implements."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import chain

from archgen.diagnostics import Diagnostic, Label, Span
from archgen.frozen import dataclass
from archgen.link.path_guesses import take_path_end
from archgen.link.reference_resolution import ReferenceResolver, list_known_names
from archgen.model.path_resolver import ElementRef, PathMatch, PathResolver


@dataclass(slots=True)
class PortResolver:
    """Resolves keys that name ports: of one component, or of all components that a node implements."""

    resolver: ReferenceResolver
    owner_id: str
    """The element whose keys they are, for diagnostics."""
    component_ids: tuple[str, ...]
    port_names: Mapping[str, Mapping[str, Collection[str]]]
    """The names of ports by kind (`input`, `output`) and component."""
    is_free: bool = False
    """Whether the node implements nothing, so that its keys are names of its own."""
    _names: PathResolver | None = None

    @property
    def names(self) -> PathResolver:
        """The look-up of ports by the ends of their ids, built on first use: most keys are found without it."""
        if self._names is None:
            self._names = PathResolver(
                {kind: list(_complete_ids(self.component_ids, names)) for kind, names in self.port_names.items()}
            )
        return self._names

    def resolve_port(self, key: str, span: Span, kind: str) -> str | None:
        """Return the complete id of the port (`kind` is `input` or `output`) that a key means, or None."""
        if not self.component_ids:  # what it implements is not known: that is reported already
            return key if self.is_free else None
        # The usual case, one component and the plain name of a port, needs no look-up of its own.
        if len(self.component_ids) == 1 and key in self.port_names[kind].get(self.component_ids[0], ()):
            port_id = f"{self.component_ids[0]}.{key}"
            self.resolver.tell(span, key, kind, port_id, self.owner_id)
            return port_id
        match = self.names.resolve_path(key, (kind,))
        if match.count == 1:
            self.resolver.tell(span, key, *match.elements[0], self.owner_id)
            return match.elements[0].id
        if match.count:
            self.resolver.suspect_ids.update(name.id for name in match.elements)
            self.resolver.diagnostics.append(self._diagnose_ambiguous(key, span, match))
        elif not self.resolver.is_lost(key) and self.resolver.damaged_elements.isdisjoint(self.component_ids):
            self.resolver.diagnostics.append(self._diagnose_unknown(key, span, kind))
        return None

    def _diagnose_ambiguous(self, key: str, span: Span, match: PathMatch) -> Diagnostic:
        self.resolver.suspect_ids.update(name.id for name in match.elements)
        paths, form = [take_path_end(name.id, 2) for name in match.elements], "component.port"
        # Components of one name in two groups: only the complete ids tell their ports apart.
        if len(set(paths)) < len(paths):
            paths, form = [name.id for name in match.elements], "group.component.port"
        return Diagnostic(
            "ambiguous-reference",
            f"`{key}` can mean {' or '.join(f'`{path}`' for path in paths)}",
            span,
            labels=tuple(Label(self._span_of(name), f"`{name.id}`") for name in match.elements),
            help=f"write `{form}` where several components of a node have a port of this name",
            element=self.owner_id,
        )

    def _diagnose_unknown(self, key: str, span: Span, kind: str) -> Diagnostic:
        other_kind = "input" if kind == "output" else "output"
        other_ports = self.names.resolve_path(key, (other_kind,)).elements
        message = f"no {kind} named `{key}` in {' or '.join(f'`{c}`' for c in self.component_ids[:3])}"
        if other_ports:
            label = Label(self._span_of(other_ports[0]), f"an {other_kind}")
            return Diagnostic(
                "unknown-reference",
                message,
                span,
                labels=(label,),
                help=f"`{key}` is an {other_kind}",
                element=self.owner_id,
            )
        # An ambiguous end would be no help as a guess.
        unique_paths = [
            path for path in self.names.path_endings(kind) if len(self.names.ids_ending_in(kind, path)) == 1
        ]
        guess = self.resolver.guesser.guess_name(key, unique_paths)
        guessed_port = self.names.resolve_path(guess, (kind,)).unique_element if guess else None
        self.resolver.suspect_ids.update([guessed_port.id] if guessed_port else ())
        labels = (Label(self._span_of(guessed_port), "declared here"),) if guessed_port else self._label_components()
        ports = dict.fromkeys(chain.from_iterable(self.port_names[kind].get(id_, ()) for id_ in self.component_ids))
        help_line = f"did you mean `{guess}`?" if guess else list_known_names(tuple(ports))
        return Diagnostic("unknown-reference", message, span, labels=labels, help=help_line, element=self.owner_id)

    def _label_components(self) -> tuple[Label, ...]:
        spans = self.resolver.spans["component"]
        return tuple(Label(spans[component], "declared here") for component in self.component_ids[:3])

    def _span_of(self, port: ElementRef) -> Span:
        return self.resolver.spans[port.kind][port.id]


def _complete_ids(component_ids: Iterable[str], names: Mapping[str, Iterable[str]]) -> Iterator[str]:
    for component in component_ids:
        yield from (f"{component}.{name}" for name in names.get(component, ()))
