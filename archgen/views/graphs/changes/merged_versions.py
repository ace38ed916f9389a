"""Two versions as one: the change of each component, connection and type, by common ids.

Common ids are those of the second version; what was removed keeps its old one.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.compare import Change, Comparison
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.views.changes.change_wording import BREAK_SIGN, CHANGE_SIGNS, is_textual
from archgen.views.graphs.drawn_level import FlowStyle, flow_style
from archgen.views.picture_shapes import Arrow, ElementChange

_PORT_KINDS = frozenset({"input", "output"})


@dataclass(frozen=True, slots=True)
class MergedEdge:
    """A connection from one output to one input. `tail` and `head` are components, in the direction of drawing."""

    output_id: str
    input_id: str
    tail: str
    head: str
    style: FlowStyle
    label: str
    optional: bool


@dataclass(slots=True)
class ChangeNotes:
    """What changed, by common ids: kinds of changes, and the sentences that describe them."""

    component_changes: dict[str, ElementChange] = field(default_factory=dict)
    sentences: defaultdict[str, list[str]] = field(default_factory=lambda: defaultdict(list))
    """Sentences by component, and by input for connections."""
    flow_sentences: dict[str, str] = field(default_factory=dict)
    """The sentence for each output, input and type with a change of what flows."""
    text_only_components: set[str] = field(default_factory=set)
    """Components with changes of texts only."""


def collect_change_notes(comparison: Comparison) -> ChangeNotes:
    """Collect the changes by the elements that they happened to."""
    change_notes = ChangeNotes()
    for change in comparison.changes:
        _note_change(change, comparison.matched_ids, change_notes)
    return change_notes


def _note_change(change: Change, matched_ids: MatchedIds, change_notes: ChangeNotes, whole_sentence: str = "") -> None:
    """Note a change and its parts; parts of an added or removed element are described by the whole."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    common_id = matched_ids.common_id(kind, change.element_id) if change.kind == "removed" else change.element_id
    sentence = whole_sentence or change.text
    if kind == "component":
        _note_component(change, common_id, sentence, change_notes)
    elif kind in _PORT_KINDS:
        _note_port(change, common_id, sentence, change_notes)
    elif kind in {"type", "message"} and not is_textual(change):
        change_notes.flow_sentences[common_id] = sentence
    for part in change.parts:
        # A group is no box here: what was added with it is described part by part.
        inner_sentence = sentence if change.kind in {"added", "removed"} and change.element_kind != "group" else ""
        _note_change(part, matched_ids, change_notes, inner_sentence)


def _note_component(change: Change, component_id: str, sentence: str, change_notes: ChangeNotes) -> None:
    if is_textual(change):
        change_notes.text_only_components.add(component_id)
        return
    change_notes.sentences[component_id].append(sentence)
    change_kind: ElementChange = "renamed" if change.kind == "moved" else change.kind
    # Added, removed and renamed win over changed, whichever comes first.
    if change_kind != "changed" or component_id not in change_notes.component_changes:
        change_notes.component_changes[component_id] = change_kind


def _note_port(change: Change, port_id: str, sentence: str, change_notes: ChangeNotes) -> None:
    component_id = port_id.rpartition(".")[0]
    change_notes.sentences[port_id].append(sentence)
    if change.element_kind == "connection":
        return
    if is_textual(change):
        change_notes.text_only_components.add(component_id)
        return
    if sentence not in change_notes.sentences[component_id]:
        change_notes.sentences[component_id].append(sentence)
    change_notes.component_changes.setdefault(component_id, "changed")
    if change.kind == "changed":
        change_notes.flow_sentences[port_id] = sentence


def merged_edges(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[tuple[str, str], MergedEdge]:
    """Return all connections of a version by the common ids of their ends."""
    return {(edge.output_id, edge.input_id): edge for edge in _list_edges(architecture, matched_ids)}


def _list_edges(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[MergedEdge]:
    for connection in architecture.connections:
        port = architecture.inputs[connection.input]
        reader = matched_ids.common_id("component", port.component)
        for name in connection.outputs:
            output = architecture.outputs.get(name)
            if output is None:
                continue
            style = flow_style(architecture, name)
            writer = matched_ids.common_id("component", output.component)
            # Services and actions are drawn from client to server, against the direction of the output.
            ends = (reader, writer) if style in {"service", "action"} else (writer, reader)
            label = output.type or output.name
            yield MergedEdge(
                matched_ids.common_id("output", name),
                matched_ids.common_id("input", port.id),
                *ends,
                style,
                label,
                optional=port.optional,
            )


def describe_changed_flows(architecture: Architecture, edge: MergedEdge, change_notes: ChangeNotes) -> Iterable[str]:
    """Return the sentences about a change of what flows along a connection that is in both versions."""
    output = architecture.outputs.get(edge.output_id)
    carrier_names = [edge.output_id, edge.input_id]
    if output is not None:
        carrier_names += [name for name in (output.type, architecture.message_of(output)) if name]
    return [
        change_notes.flow_sentences[name]
        for name in dict.fromkeys(carrier_names)
        if name in change_notes.flow_sentences
    ]


_MAX_LABELS = 3
ArrowKey = tuple[str, str, FlowStyle, ElementChange | None, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class ConnectionLine:
    """One connection of either version with its change; `sentence` describes it."""

    tail: str
    head: str
    style: FlowStyle
    label: str
    change: ElementChange | None
    sentence: str
    optional: bool = False
    ports: tuple[str, str] = ("", "")
    """The output and the input that it connects."""
    broken_partners: tuple[str, ...] = ()
    """What people call the partners for whom it breaks."""

    @property
    def ends(self) -> frozenset[str]:
        """Return both ends."""
        return frozenset((self.tail, self.head))


def bundle_arrows(lines: Iterable[ConnectionLine]) -> tuple[Arrow, ...]:
    """Return one arrow for each bundle of lines; only changed ones have a label."""
    bundles: dict[ArrowKey, list[ConnectionLine]] = {}
    for line in lines:
        bundles.setdefault((line.tail, line.head, line.style, line.change, line.broken_partners), []).append(line)
    return tuple(_draw_bundle(key, bundle) for key, bundle in bundles.items())


def _draw_bundle(key: ArrowKey, bundle: Sequence[ConnectionLine]) -> Arrow:
    tail, head, style, change, broken_partners = key
    label = _bundle_label(bundle, BREAK_SIGN if broken_partners else CHANGE_SIGNS[change or "changed"])
    return Arrow(
        f"{tail}>{head}:{style}:{change or 'same'}{':broken' if broken_partners else ''}",
        tail,
        head,
        label if change or broken_partners else "",
        style=style,
        count=len(bundle),
        optional=all(line.optional for line in bundle),
        faded=change is None and not broken_partners,
        flows=tuple(line.sentence for line in bundle),
        change=change,
        broken=bool(broken_partners),
    )


def _bundle_label(bundle: Sequence[ConnectionLine], sign: str) -> str:
    labels = list(dict.fromkeys(line.label for line in bundle if line.label))
    return "\n".join(f"{sign} {name}" for name in fit_lines(labels, _MAX_LABELS, "{} more"))
