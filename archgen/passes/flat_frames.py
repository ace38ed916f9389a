"""Coordinate frames once the components around others are gone: those of composed components become the project's."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.link import mapping_values
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.element_outline import ElementOutline
from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode


class FlatFrames:
    """Writes frames with the writers that are left."""

    def __init__(self, architecture: Architecture, outline: ElementOutline, flat_ids: Mapping[str, str]) -> None:
        """Take what the linker knows, and the complete ids that leaves get."""
        self._architecture = architecture
        self._outline = outline
        self._flat_ids = flat_ids
        self._parameters = HandedParameters(outline, [])

    def write_section(self, section: MappingEntry | None) -> MappingEntry | None:
        """Return the frames of the project, with those of composed components that are gone."""
        entries = dict(mapping_values.get_body(section).entries) if section else {}
        entries = {key: self._rewrite_frame(each, self._architecture.frames.get(key)) for key, each in entries.items()}
        first_place = section.key_span if section else None
        for shell in self._outline.shells.values():
            if shell.id in self._flat_ids:
                continue
            for written in mapping_values.get_mapping(mapping_values.get_body(shell.entry), "frames"):
                name = self._parameters.fill_in_name(written.key, shell.id, written.key_span)
                frame = self._architecture.frames.get(name)
                if frame is not None and frame.component == shell.id:
                    entries[name] = self._rewrite_frame(MappingEntry(name, written.key_span, written.value), frame)
                    first_place = first_place or written.key_span
        if first_place is None or not entries:
            return section
        return MappingEntry("frames", first_place, MappingNode(entries, section.value.span if section else first_place))

    def rewrite_own(self, section: MappingEntry, leaf_id: str) -> MappingEntry:
        """Return the frames of a leaf."""
        entries: dict[str, MappingEntry] = {}
        for written in mapping_values.get_body(section):
            name = self._parameters.fill_in_name(written.key, leaf_id, written.key_span)
            frame = self._architecture.frames.get(name)
            is_own = frame is not None and frame.component == leaf_id and frame.by_written
            entries[written.key] = self._rewrite_frame(written, frame) if is_own else written
        return MappingEntry(section.key, section.key_span, MappingNode(entries, section.value.span))

    def _rewrite_frame(self, entry: MappingEntry, frame: Frame | None) -> MappingEntry:
        if frame is None or frame.by is None:
            return entry
        body = mapping_values.get_body(entry)
        entries = dict(body.entries)
        if frame.parent is not None and (parent := entries.get("parent")) is not None:
            entries["parent"] = _write_text("parent", frame.parent, parent)
        writer = self._name_writer(frame)
        if writer != frame.by or "by" not in entries:
            entries["by"] = _write_text("by", writer, entries.get("by") or entry)
        return MappingEntry(entry.key, entry.key_span, MappingNode(entries, body.span))

    def _name_writer(self, frame: Frame) -> str:
        """Return who writes a frame: of a composed component its only node, else its first leaf."""
        if frame.by is None or frame.by_kind == "node":
            return frame.by or ""
        leaves = [each for each in self._architecture.leaves_of(frame.by) if each in self._flat_ids]
        if frame.by not in self._outline.shells or not leaves:
            return self._flat_ids.get(frame.by, frame.by)
        nodes = [node.id for node in self._architecture.nodes.values() if not set(leaves).isdisjoint(node.implements)]
        is_one_node = len(nodes) == 1 and len(leaves) > 1
        return nodes[0] if is_one_node else self._flat_ids[leaves[0]]


def _write_text(key: str, text: str, source: MappingEntry) -> MappingEntry:
    return MappingEntry(key, source.key_span, ScalarNode(text, text, source.value.span))
