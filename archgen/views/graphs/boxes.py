"""Make the boxes and frames of the model's elements, the same in every picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Literal

from archgen.model.component import Component
from archgen.views.index import Index
from archgen.views.shapes import Box, Cluster
from archgen.views.words import plural

_SEVERITIES: tuple[Literal["error", "warning", "note"], ...] = ("error", "warning", "note")


def component(view: Index, item: Component, *, lines: tuple[str, ...] = ()) -> Box:
    """Return the box of a component, in the hue of its group."""
    return Box(
        item.id,
        item.title,
        lines,
        style=_style(item),
        colour=hue(view, item.group),
        cluster=item.group,
        ref=f"component:{item.id}",
        tooltip=_tooltip(view, item),
        badge=badge(view, item.id),
    )


def _style(item: Component) -> Literal["component", "source", "sink", "reactive"]:
    return "component" if item.role is None or item.role == "filter" else item.role


def _tooltip(view: Index, item: Component) -> str:
    said = [f"{item.title} ({item.id})", f"Group: {view.architecture.groups[item.group].title}"]
    said += [f"Role: {item.role}"] if item.role else []
    said += [f"Owner: {owners(view, item.owners)}"] if item.owners else []
    said += [item.functionality] if item.functionality else []
    return "\n".join(said)


def owners(view: Index, partners: Iterable[str]) -> str:
    """Join the titles of partners; empty where there are none."""
    # An owner that is no declared partner is a finding, not an error: it is shown as written.
    found = view.architecture.partners
    return ", ".join(found[partner].title if partner in found else partner for partner in partners)


def hue(view: Index, group: str) -> int:
    """Return a group's colour, an index of the palette's ten hues."""
    # Ten as in `palette.HUES`, which views must not import: emitters are above them.
    return view.hues[group] % 10


def badge(view: Index, element: str) -> Literal["error", "warning", "note"] | None:
    """Return the severity of an element's worst finding."""
    severities = {str(finding.severity) for finding in view.findings_of.get(element, ())}
    return next((each for each in _SEVERITIES if each in severities), None)


def neighbour(view: Index, item: Component, side: Literal["left", "right"] | None, suffix: str = "") -> Box:
    """Return the box of a component of another group: grey, with its group's title below its own."""
    return replace(
        component(view, item, lines=(view.architecture.groups[item.group].title,)),
        id=item.id + suffix,
        style="component",
        emphasis="neighbour",
        cluster=None,
        side=side,
        badge=None,
    )


def whole_group(view: Index, group: str, *, lines: Iterable[str] = ()) -> Box:
    """Return a group as one box."""
    found = view.architecture.groups[group]
    count = plural(len(found.components), "component")
    said = [line for line in (owners(view, found.owners), count) if line]
    return Box(
        group,
        found.title,
        (*said, *lines),
        style="group",
        colour=hue(view, group),
        ref=f"group:{group}",
        tooltip="\n".join([f"{found.title} ({group})", *said, *(c.title for c in found.components.values())]),
    )


def frame(view: Index, group: str, *, subject: bool = False, grey: bool = False) -> Cluster:
    """Return a group as a frame round its components."""
    found = view.architecture.groups[group]
    return Cluster(
        group,
        found.title,
        colour=hue(view, group),
        emphasis="subject" if subject else "neighbour" if grey else "normal",
        ref=f"group:{group}",
        tooltip=found.title,
    )
