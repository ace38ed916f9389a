"""What people call the elements of a comparison, and where on the web these are written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.compare import Comparison
from archgen.compare.key_phrases import name_partner
from archgen.diagnostics import Span
from archgen.model.architecture import Architecture
from archgen.model.component import Input, Output
from archgen.model.source_repository import SourceRepository


def name_elements(comparison: Comparison) -> Mapping[str, str]:
    """Return the titles of groups, components and ports by their ids, those of now where both versions have one."""
    titles: dict[str, str] = {}
    for architecture in (comparison.before.architecture, comparison.after.architecture):
        titles |= {name: group.title for name, group in architecture.groups.items()}
        titles |= {name: component.title for name, component in architecture.components.items()}
        ports: tuple[Input | Output, ...] = (*architecture.inputs.values(), *architecture.outputs.values())
        titles |= {port.id: f"{architecture.components[port.component].title} · {port.name}" for port in ports}
    return titles


def list_element_addresses(
    before: tuple[Architecture, SourceRepository | None], after: tuple[Architecture, SourceRepository | None]
) -> Mapping[str, str]:
    """Return the addresses of groups, components and ports by their ids: what is gone, where it was before."""
    addresses: dict[str, str] = {}
    for architecture, repository in (before, after):
        for element_id, span in _list_spans(architecture) if repository else ():
            address = repository.file_address(span.file, span.line) if repository else None
            addresses |= {element_id: address} if address else {}
    return addresses


def _list_spans(architecture: Architecture) -> Iterator[tuple[str, Span]]:
    for elements in (architecture.groups, architecture.components, architecture.inputs, architecture.outputs):
        yield from ((element.id, element.at) for element in elements.values())


def name_each(partners: Iterable[str], partner_names: Mapping[str, str]) -> tuple[str, ...]:
    """Return what people call partners."""
    return tuple(name_partner(partner, partner_names) for partner in partners)


def name_partners(comparison: Comparison) -> Mapping[str, str]:
    """Return the name of each partner of either version, by id."""
    return comparison.versions.partner_names
