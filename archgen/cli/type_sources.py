"""Where the facts about a component type that ships were read, as `archgen explain ros.TYPE` tells it."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.project.library_reading import SHIPPED_ID, load_shipped_component_types
from archgen.project.shipped_sources import ShippedSource, read_shipped_sources


def list_shipped_names() -> tuple[str, ...]:
    """Return the names of all types that ship for any distribution, as one writes them with the library's usual name."""
    return tuple(
        sorted({f"{SHIPPED_ID}.{name}" for distro in KNOWN_DISTROS for name in load_shipped_component_types(distro)})
    )


def list_source_lines(name: str, distro: str | None) -> Iterator[str]:
    """Yield lines about the sources of a type: each distribution's repository and version, and the facts of one of them.

    Nothing for a name that does not ship for it, or for any where none is asked for.
    """
    type_name = name.removeprefix(f"{SHIPPED_ID}.")
    for each in (distro,) if distro else KNOWN_DISTROS:
        for source in read_shipped_sources(each).get(type_name, ()):
            yield f"{each}: {_describe_source(source)}"
            if distro:
                for file, facts in source.files.items():
                    for fact, line in facts.items():
                        yield f"  {fact}: {source.format_link(file, line)}"


def _describe_source(source: ShippedSource) -> str:
    released = "" if source.version == source.released else f" ({source.released} is released)"
    return f"{source.kind} of version {source.version}{released}, {source.date}, {source.format_link()}"
