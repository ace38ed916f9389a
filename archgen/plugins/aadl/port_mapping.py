"""Features become inputs and outputs; feature groups are taken apart."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from archgen.plugin.importing import make_id, make_unique_id
from archgen.plugins.aadl.aadl_data_types import AadlDataTypes
from archgen.plugins.aadl.aadl_tree import Path
from archgen.plugins.aadl.archgen_words import find_own_text, is_marked, read_port_words
from archgen.plugins.aadl.property_values import PropertyScope
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPort

PORT_KINDS = frozenset({"data port", "event data port", "event port", "feature", "subprogram access"})
KEPT_ACCESSES = frozenset({"data access", "bus access", "virtual bus access", "subprogram group access"})
_MAX_GROUP_DEPTH = 10
_MAX_PORTS = 20_000
_OPPOSITE = {"in": "out", "out": "in", "requires": "provides", "provides": "requires"}


@dataclass(slots=True, eq=False)
class MappedPort:
    """An input or output that a feature became; `path` is the feature's name, below those of its groups."""

    id: str
    path: Path
    written_name: str
    is_input: bool
    is_call: bool
    kind: str
    type_name: str


@dataclass(slots=True)
class MappedPorts:
    """The ports of a classifier, and the accesses that are kept as hints."""

    scope: PropertyScope
    ports: list[MappedPort] = field(default_factory=list)
    accesses: dict[str, dict[str, str]] = field(default_factory=dict)
    internal: list[ResolvedPort] = field(default_factory=list)
    """What a node has that is no port of a component."""
    call_paths: set[Path] = field(default_factory=set)
    """What an export of archgen's wrote for flows through calls."""
    by_path: dict[Path, list[MappedPort]] = field(default_factory=dict)
    groups: dict[Path, list[MappedPort]] = field(default_factory=dict)
    """All ports in a feature group, by the group's path."""

    def make_section(self, *, is_input: bool) -> dict[str, dict[str, Any]]:
        """Return the inputs or the outputs as data of the language."""
        section: dict[str, dict[str, Any]] = {}
        for port in self.ports:
            if port.is_input == is_input:
                own_id = find_own_text(self.scope, port.path, "id")
                hints = {"name": port.written_name} if port.written_name != port.id and not own_id else {}
                body: dict[str, Any] = {"type": port.type_name} if port.type_name else {}
                body |= read_port_words(self.scope, port.path)
                if section.get(port.id, body).get("type") != body.get("type"):
                    # One input of several types: its sources tell them.
                    body.pop("type", None)
                    section[port.id].pop("type", None)
                section[port.id] = section.get(port.id, {}) | body
                if hints:
                    section[port.id]["hints"] = {"aadl": hints}
        return section


class PortMapper:
    """Maps the features of classifiers, each classifier once."""

    def __init__(self, resolver: ClassifierResolver, types: AadlDataTypes) -> None:
        self._resolver, self._types, self._notes = resolver, types, resolver.notes
        self._mapped: dict[int, MappedPorts] = {}

    def map_ports(self, resolved: ResolvedClassifier) -> MappedPorts:
        """Return the ports of a classifier."""
        if id(resolved) not in self._mapped:
            mapped = MappedPorts(PropertyScope(self._resolver, resolved))
            used: tuple[set[str], set[str]] = (set(), set())
            for port in resolved.ports.values():
                self._add_port(mapped, port, (), used, is_inverse=False)
            self._mapped[id(resolved)] = mapped
        return self._mapped[id(resolved)]

    def _add_port(
        self,
        mapped: MappedPorts,
        port: ResolvedPort,
        prefix: Path,
        used: tuple[set[str], set[str]],
        *,
        is_inverse: bool,
    ) -> list[MappedPort]:
        written = port.written
        path = (*prefix, written.name.lower())
        if port.kind == "feature group":
            mapped.groups[path] = self._add_group(mapped, port, path, used, is_inverse=is_inverse != written.inverse)
            return mapped.groups[path]
        if port.kind in KEPT_ACCESSES:
            access = {"kind": f"{port.direction} {port.kind}"}
            mapped.accesses[".".join(path)] = {**access, **({"type": port.use.full_name} if port.use.name else {})}
            return []
        if port.kind not in PORT_KINDS or not port.direction:
            words = (
                f"feature {written.name} has no direction" if port.kind in PORT_KINDS else f"{written.name} is no port"
            )
            self._notes.add_counted(port.kind, words, written.span)
            return []
        is_call = port.kind == "subprogram access"
        if is_marked(mapped.scope, path, "is_call"):
            # The request or the answer of a call, which has a port of its own.
            mapped.call_paths.add(path)
            return []
        if is_marked(mapped.scope, path, "is_internal"):
            mapped.internal.append(port)
            return []
        directions = port.direction.split()
        added = []
        for word in [_OPPOSITE[word] for word in directions] if is_inverse else directions:
            is_input = word in {"in", "requires"}
            own_id = find_own_text(mapped.scope, path, "id")
            # Features with one id of archgen's are one input, which reads several types.
            wanted = make_id(own_id or "_".join((*prefix, written.name)), "port")
            port_id = wanted if own_id else make_unique_id(wanted, used[is_input])
            used[is_input].add(port_id)
            type_name = self._types.name_use(port.use, "srv" if is_call else "msg")
            added.append(
                MappedPort(port_id, path, ".".join((*prefix, written.name)), is_input, is_call, port.kind, type_name)
            )
        if written.dimensions:
            self._notes.add_counted("array of ports", "an array of ports is taken as one", written.span, fate="noted")
        mapped.ports += added
        mapped.by_path.setdefault(path, []).extend(added)
        return added

    def _add_group(
        self, mapped: MappedPorts, port: ResolvedPort, path: Path, used: tuple[set[str], set[str]], *, is_inverse: bool
    ) -> list[MappedPort]:
        resolved = self._resolver.resolve(port.use)
        if resolved is None or len(path) > _MAX_GROUP_DEPTH:
            words = f"what is in feature group {port.written.name} is not known"
            self._notes.add("feature group", words, port.written.span)
            return []
        inner_ports = resolved.ports
        if not inner_ports and resolved.known.classifier.inverse_of:
            use = self._resolver.find_use(resolved.known.classifier.inverse_of, {}, resolved.known, {})
            inverse = self._resolver.resolve(use)
            inner_ports, is_inverse = (inverse.ports if inverse else {}), not is_inverse
        added: list[MappedPort] = []
        for inner in inner_ports.values():
            if len(mapped.ports) > _MAX_PORTS:
                self._notes.add(
                    "feature group",
                    f"feature groups in one another are more than {_MAX_PORTS:,} ports",
                    port.written.span,
                )
                break
            added += self._add_port(mapped, inner, path, used, is_inverse=is_inverse)
        return added
