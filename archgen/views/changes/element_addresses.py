"""Where on the web the elements of a comparison are written: what the comment on a pull request links to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics.source_span import Span
from archgen.model.architecture import Architecture
from archgen.model.source_repository import SourceRepository


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
