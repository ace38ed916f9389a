"""Find the ports of composed components that nothing inside carries: there the design is not finished inside."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.compose.expanded_project import ComponentShell
from archgen.link.element_outline import ElementOutline
from archgen.link.port_sources import PortKey, PortSources


class OpenShells:
    """Which ports of composed components are carried inside, and which count as a leaf's."""

    def __init__(self, outline: ElementOutline, sources: PortSources) -> None:
        """Take what the project declares, and what its ports take their data from."""
        self._outline = outline
        self._sources = sources
        self._readers: dict[str, list[str]] = {}
        for reader in self._list_inner_ports():
            for source in sources.list_sources(reader):
                if source.target.kind == "input":
                    self._readers.setdefault(source.target.id, []).append(reader[1])
        self._open_shells: dict[str, list[ComponentShell]] = {}
        for shell in outline.shells.values():
            if any(map(self.is_open, self._list_ports(shell))):
                self._open_shells.setdefault(shell.group, []).append(shell)

    def is_open(self, port: PortKey) -> bool:
        """Whether nothing inside reads an input, or feeds an output."""
        if port[0] == "input":
            return port[1] not in self._readers
        return not self._sources.list_sources(port)

    def list_in_group(self, group_id: str) -> Sequence[ComponentShell]:
        """Return the composed components of a group that have open ports."""
        return self._open_shells.get(group_id, ())

    def list_carried_ports(self) -> dict[str, tuple[str, ...]]:
        """Return what stands behind each port: the outputs that an output passes on, the ports that read an input."""
        carried: dict[str, tuple[str, ...]] = {}
        for shell in self._outline.shells.values():
            for kind, port_id in self._list_ports(shell):
                behind = (
                    tuple(self._readers.get(port_id, ()))
                    if kind == "input"
                    else tuple(source.target.id for source in self._sources.list_sources((kind, port_id)))
                )
                carried[f"{kind} {port_id}"] = behind
        return carried

    def _list_ports(self, shell: ComponentShell) -> Iterator[PortKey]:
        yield from (("input", f"{shell.id}.{name}") for name in self._outline.inputs[shell.id])
        yield from (("output", f"{shell.id}.{name}") for name in self._outline.outputs[shell.id])

    def _list_inner_ports(self) -> Iterator[PortKey]:
        for component_id, inputs in self._outline.inputs.items():
            yield from (("input", f"{component_id}.{name}") for name in inputs)
        for shell in self._outline.shells.values():
            yield from (("output", f"{shell.id}.{name}") for name in self._outline.outputs[shell.id])
