"""The picture of changed components and their connections."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from archgen.compare import Comparison
from archgen.compare.agreements import find_partner_id
from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.views.changes.breaking_items import is_break_shown
from archgen.views.changes.change_wording import BREAK_SIGN, CHANGE_SIGNS
from archgen.views.changes.named_elements import name_each, name_partners
from archgen.views.elements import element_names
from archgen.views.graphs import element_boxes
from archgen.views.graphs.changes.merged_versions import (
    ChangeNotes,
    ConnectionLine,
    MergedEdge,
    PictureBudget,
    bundle_arrows,
    collect_change_notes,
    describe_changed_flows,
    fold_neighbours,
    fold_to_budget,
    merged_edges,
)
from archgen.views.graphs.graph_folding import add_legend_keys
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import Box, Cluster, ElementChange, Graph

GRAPH_ID = "changes/components"
_MAX_NAMES = 12
_MAX_LINES = 4
"""Ports without a connection that a box names."""


@dataclass(frozen=True, slots=True)
class _OverlaidComponents:
    """The two versions, laid over each other."""

    comparison: Comparison
    old_lookup: Lookup
    new_lookup: Lookup
    change_notes: ChangeNotes
    lines: Sequence[ConnectionLine]
    loose_ports: Mapping[str, tuple[str, ...]]
    """The outputs and inputs that came or went without a connection, with signs, by component."""

    @property
    def broken_components(self) -> Mapping[str, tuple[str, ...]]:
        """Return the components that a change breaks, with what people call their partners."""
        broken: dict[str, tuple[str, ...]] = {}
        for line in self.lines:
            if line.broken_partners:
                reader = line.tail if line.style in {"service", "action"} else line.head
                broken[reader] = tuple(dict.fromkeys((*broken.get(reader, ()), *line.broken_partners)))
        return broken

    @property
    def changed_components(self) -> frozenset[str]:
        """Return the components that changed themselves."""
        return frozenset(self.change_notes.component_changes)

    def group_of(self, name: str) -> str:
        """Return the group of a component, by common ids."""
        item = self.new_lookup.architecture.components.get(name)
        return item.group if item else self.comparison.matched_ids.common_id("group", name.partition(".")[0])


def _find_loose_ports(comparison: Comparison, lines: Sequence[ConnectionLine]) -> Mapping[str, tuple[str, ...]]:
    """Return the outputs and inputs that came or went without a connection, with signs, by component."""
    connected_ports = {port for line in lines for port in line.ports}
    ports: dict[str, list[str]] = {}
    for change in comparison.changes:
        is_port = change.element_kind in {"output", "input"} and change.kind in {"added", "removed"}
        if is_port and change.element_id not in connected_ports:
            component, _, name = change.element_id.rpartition(".")
            if change.kind == "removed":
                component = comparison.matched_ids.common_id("component", component)
            ports.setdefault(component, []).append(f"{CHANGE_SIGNS[change.kind]} {change.element_kind} {name}")
    return {name: tuple(fit_lines(words, _MAX_LINES, "{} more ports")) for name, words in ports.items()}


def draw_component_changes(comparison: Comparison, budget: PictureBudget) -> Graph | None:
    """Draw what changed and its surroundings; None if no component and no connection changed."""
    before, after = comparison.before.architecture, comparison.after.architecture
    change_notes = collect_change_notes(comparison)
    lines = tuple(_connection_lines(comparison, change_notes))
    overlay = _OverlaidComponents(
        comparison,
        make_lookup(before),
        make_lookup(after, comparison.new_findings),
        change_notes,
        lines,
        _find_loose_ports(comparison, lines),
    )
    ends = {end for line in overlay.lines if line.change or line.broken_partners for end in line.ends}
    changed_ids = {name for name in overlay.changed_components | ends if _component_exists(overlay, name)}
    if not changed_ids:
        return None
    neighbours = {
        end for line in overlay.lines if not changed_ids.isdisjoint(line.ends) for end in line.ends
    } - changed_ids
    nearest_neighbours = {
        end for line in overlay.lines if not overlay.changed_components.isdisjoint(line.ends) for end in line.ends
    } - changed_ids
    # `neighbours` includes those behind a changed connection only; they are counted, but never drawn.
    shown_components = (
        changed_ids | nearest_neighbours
        if len(changed_ids | nearest_neighbours) <= budget.boxes_with_neighbours
        else changed_ids
    )
    drawn_lines = [
        line
        for line in overlay.lines
        if shown_components.issuperset(line.ends)
        and (line.change or line.broken_partners or _is_worth_drawing(line, overlay, shown_components, changed_ids))
    ]
    undrawn_count = len(neighbours - shown_components)
    notes = (f"{count_noun(undrawn_count, 'unchanged neighbour')} not drawn.",) if undrawn_count else ()
    graph = Graph(
        GRAPH_ID,
        "What changed: components and connections",
        "framed",
        tuple(_draw_boxes(overlay, shown_components)),
        bundle_arrows(drawn_lines),
        tuple(_draw_frames(overlay, shown_components)),
        direction=after.layout.direction,
        notes=notes,
        alt=_alternative_text(overlay),
        kind="component-changes",
    )
    graph = fold_to_budget(fold_neighbours(graph), budget)
    return add_legend_keys(replace(graph, asked=sum(arrow.count for arrow in graph.arrows)))


def _is_worth_drawing(
    line: ConnectionLine, overlay: _OverlaidComponents, shown_components: set[str], changed_ids: set[str]
) -> bool:
    """Whether an unchanged connection is worth its line: it touches a changed component, or joins two drawn anyway."""
    return (
        not overlay.changed_components.isdisjoint(line.ends)
        or (shown_components == changed_ids and changed_ids.issuperset(line.ends))
        or len(shown_components) <= len(changed_ids)
    )


def _component_exists(overlay: _OverlaidComponents, name: str) -> bool:
    return name in overlay.new_lookup.architecture.components or _old_component_id(overlay, name) is not None


def _old_component_id(overlay: _OverlaidComponents, name: str) -> str | None:
    old_id = overlay.comparison.matched_ids.old_ids.get("component", {}).get(name, name)
    return old_id if old_id in overlay.old_lookup.architecture.components else None


def _connection_lines(comparison: Comparison, change_notes: ChangeNotes) -> Iterator[ConnectionLine]:
    """Yield all connections of both versions with their change, except those that may not have been read."""
    old_edges = merged_edges(comparison.before.architecture, comparison.matched_ids)
    new_edges = merged_edges(comparison.after.architecture, type(comparison.matched_ids)())
    may_be_unread = comparison.versions.may_be_unread
    broken_readers = BrokenReaders(comparison)

    def make_line(edge: MergedEdge, change: ElementChange | None, sentences: tuple[str, ...]) -> ConnectionLine:
        if change == "added":  # what is new gives instead of what was lost
            return _connection_line(edge, change, sentences)
        old_input_id = comparison.matched_ids.old_ids.get("input", {}).get(edge.input_id, edge.input_id)
        return replace(
            _connection_line(edge, change, sentences), broken_partners=broken_readers.find_partners(edge, old_input_id)
        )

    for key in (*new_edges, *(key for key in old_edges if key not in new_edges)):
        edge = new_edges.get(key) or old_edges[key]
        if key in new_edges and key in old_edges:
            sentences = tuple(describe_changed_flows(comparison.after.architecture, edge, change_notes))
            yield make_line(edge, "changed" if sentences else None, sentences)
        # In a part that could not be read: not known to be removed or added.
        elif may_be_unread(("output", edge.output_id)) or may_be_unread(("input", edge.input_id)):
            yield from [_connection_line(edge, None, ())] if key in new_edges else []
        elif edge.input_id in change_notes.sentences or not change_notes.component_changes.keys().isdisjoint(
            (edge.tail, edge.head)
        ):
            sentences = tuple(change_notes.sentences.get(edge.input_id, ()))
            yield make_line(edge, "added" if key in new_edges else "removed", sentences)


def _connection_line(edge: MergedEdge, change: ElementChange | None, sentences: tuple[str, ...]) -> ConnectionLine:
    connection_text = f"{edge.output_id} → {edge.input_id}" + (f" ({edge.label})" if edge.label else "")
    ports = edge.output_id, edge.input_id
    sentence = "\n".join((f"{CHANGE_SIGNS[change]} {connection_text}" if change else connection_text, *sentences))
    return ConnectionLine(edge.tail, edge.head, edge.style, edge.label, change, sentence, edge.optional, ports)


def _draw_boxes(overlay: _OverlaidComponents, shown_components: set[str]) -> Iterator[Box]:
    """Yield the components in the order of the second version, removed ones at the end of their group."""
    component_order = {name: position for position, name in enumerate(overlay.new_lookup.architecture.components)}
    group_order = {name: position for position, name in enumerate(overlay.new_lookup.architecture.groups)}
    last_position = len(component_order)
    for name in sorted(
        shown_components,
        key=lambda name: (
            group_order.get(overlay.group_of(name), last_position),
            component_order.get(name, last_position),
            name,
        ),
    ):
        yield _draw_box(overlay, name)


def _draw_box(overlay: _OverlaidComponents, name: str) -> Box:
    change = overlay.change_notes.component_changes.get(name)
    component = overlay.new_lookup.architecture.components.get(name)
    component_box = _draw_placed_box(overlay.new_lookup, component) if component else _draw_removed_box(overlay, name)
    group_id = overlay.group_of(name)
    plain_box = replace(
        component_box, id=name, style="component", colour=None, cluster=group_id, ref=f"changes:{group_id}"
    )
    broken_partners = overlay.broken_components.get(name, ())
    if broken_partners:
        sign = CHANGE_SIGNS[change] if change else BREAK_SIGN
        plain_box = replace(plain_box, lines=(*plain_box.lines, f"breaks {', '.join(broken_partners)}"), broken=True)
        if change is None:
            return replace(plain_box, title=f"{sign} {component_box.title}", badge=None)
    if change is None:
        return replace(plain_box, emphasis="neighbour", badge=None)
    # No arrow shows these.
    plain_box = replace(plain_box, lines=(*plain_box.lines, *overlay.loose_ports.get(name, ())))
    tooltip_lines = (*overlay.change_notes.sentences.get(name, ()), component_box.tooltip)
    return replace(
        plain_box,
        title=f"{CHANGE_SIGNS[change]} {component_box.title}",
        change=change,
        tooltip="\n".join(tooltip_lines),
    )


def _draw_placed_box(lookup: Lookup, component: Component) -> Box:
    """Draw a component with what it stands in below its title: instances hold components of equal titles."""
    place = element_names.join_surrounding_titles(lookup, component)
    return element_boxes.component_box(lookup, component, lines=(place,) if place else ())


def _draw_removed_box(overlay: _OverlaidComponents, name: str) -> Box:
    component = overlay.old_lookup.architecture.components[_old_component_id(overlay, name) or name]
    return replace(_draw_placed_box(overlay.old_lookup, component), badge=None)


def _draw_frames(overlay: _OverlaidComponents, shown_components: set[str]) -> Iterator[Cluster]:
    group_change_kinds = {
        (change.element_kind, change.element_id): change.kind
        for change in overlay.comparison.changes
        if change.element_kind == "group"
    }
    known_groups = {**overlay.old_lookup.architecture.groups, **overlay.new_lookup.architecture.groups}
    for name in dict.fromkeys(box.cluster for box in _draw_boxes(overlay, shown_components) if box.cluster):
        title = known_groups[name].title if name in known_groups else name
        change_kind = group_change_kinds.get(("group", name))
        sign = f"{CHANGE_SIGNS[change_kind]} " if change_kind and change_kind != "changed" else ""
        yield Cluster(name, f"{sign}{title}", emphasis="neighbour", ref=f"changes:{name}", tooltip=title)


def _alternative_text(overlay: _OverlaidComponents) -> str:
    titles = {
        name: _draw_box(overlay, name).title
        for name in sorted(overlay.changed_components)
        if _component_exists(overlay, name)
    }
    titles_by_kind: Mapping[str, list[str]] = {
        # Without the sign and the blank that `_draw_box` puts before the title.
        kind: [titles[name][2:] for name in titles if overlay.change_notes.component_changes[name] == kind]
        for kind in ("added", "removed", "changed", "renamed")
    }
    phrases = [
        f"{kind}: {', '.join(names[:_MAX_NAMES])}{', ...' if len(names) > _MAX_NAMES else ''}"
        for kind, names in titles_by_kind.items()
        if names
    ]
    counts = {kind: sum(line.change == kind for line in overlay.lines) for kind in ("added", "removed", "changed")}
    phrases += [f"{count_noun(count, 'connection')} {kind}" for kind, count in counts.items() if count]
    return "; ".join(phrases) + "."


_NAMES = re.compile(r"`([^`]+)`")


@dataclass(frozen=True, slots=True)
class PartnerLosses:
    """What a partner loses by a change: the outputs that it is about; inputs where no output is named; a type."""

    partner: str
    outputs: frozenset[str]
    inputs: frozenset[str]
    type_name: str | None

    def are_about(self, edge: MergedEdge, old_input_id: str) -> bool:
        """Return whether what is lost runs along a connection."""
        if self.type_name is not None:
            return self.type_name == edge.label
        # An input may read many outputs, of which one changed.
        return edge.output_id in self.outputs or (
            not self.outputs and not self.inputs.isdisjoint((edge.input_id, old_input_id))
        )


class BrokenReaders:
    """Tells for each connection which partners it breaks."""

    def __init__(self, comparison: Comparison) -> None:
        self._partner_names: Mapping[str, str] = name_partners(comparison)
        self._losses = tuple(_list_losses(comparison))
        # Those of the later version win: who reads it now is who is broken.
        self._owners = _collect_owners(comparison.before.architecture) | _collect_owners(comparison.after.architecture)

    def find_partners(self, edge: MergedEdge, old_input_id: str) -> tuple[str, ...]:
        """Return what people call the partners for whom a connection breaks."""
        owners = self._owners.get(edge.input_id) or self._owners.get(old_input_id, ())
        partners = [
            losses.partner
            for losses in self._losses
            if losses.partner in owners and losses.are_about(edge, old_input_id)
        ]
        return name_each(dict.fromkeys(partners), self._partner_names)


def _list_losses(comparison: Comparison) -> Iterator[PartnerLosses]:
    architectures = (comparison.before.architecture, comparison.after.architecture)
    outputs = {name for architecture in architectures for name in architecture.outputs}
    inputs = {name for architecture in architectures for name in architecture.inputs}
    for change in comparison.changes:
        for partner_break in change.breaks:
            if is_break_shown(partner_break.category, comparison):
                names = {change.element_id, *_NAMES.findall(partner_break.reason)}
                yield PartnerLosses(
                    find_partner_id(partner_break.partner, comparison.matched_ids),
                    frozenset(names & outputs),
                    frozenset(names & inputs),
                    change.element_id if change.element_kind == "type" else None,
                )


def _collect_owners(architecture: Architecture) -> dict[str, tuple[str, ...]]:
    """Return the owners of the component of each input."""
    return {name: tuple(architecture.components[port.component].owners) for name, port in architecture.inputs.items()}
