"""Look names of components up in what is composed around their writer, before they are looked up everywhere."""

from __future__ import annotations

from archgen.link.reference_resolution import ReferenceResolver


def find_inner_component(text: str, resolver: ReferenceResolver, writer_id: str) -> str | None:
    """Return the component that a text names inside of its writer or of what is around it, the innermost one; not the writer.

    So a name in a component type means one of its own components in each instance.
    """
    around = writer_id
    # What has no dot is a group: in it names are looked up as everywhere.
    while "." in around:
        if f"{around}.{text}" != writer_id and f"{around}.{text}" in resolver.spans["component"]:
            return f"{around}.{text}"
        around = around.rpartition(".")[0]
    return None
