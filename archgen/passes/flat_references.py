"""References to components from the rest of a project once the components around them are gone."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from archgen.analyses import analyse_timing
from archgen.link import mapping_values
from archgen.link.declare.handed_parameters import HandedParameters
from archgen.link.element_outline import ElementOutline
from archgen.model.architecture import Architecture
from archgen.model.coordinate_frames import Frame
from archgen.model.path_resolver import ElementRef
from archgen.passes.flat_sources import FlatSteps
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.selector_rewriting import list_selected, rewrite_selectors
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlNode,
    change_at,
    list_entries,
)
from archgen.timing.analysis import Analysis
from archgen.timing.run_analysis import AnalysisMemory

_WAYPOINT_KINDS = ("node", "component", "output")
_DEVICE_KINDS = ("component",)
_SELECTED_KINDS = ("group", "component", "output")


@dataclass
class FlatReferences:
    """Rewrites the sections that name components and outputs."""

    linked: LinkedTree
    flat_ids: Mapping[str, str]
    architecture: Architecture
    """With the low level derived: the worst way of a chain through a composed component is looked up in it."""

    @cached_property
    def frames(self) -> FlatFrames:
        """What writes frames."""
        return FlatFrames(self.architecture, self.linked.outline, self.flat_ids)

    def rewrite_sections(self, sections: Mapping[str, MappingEntry]) -> dict[str, MappingEntry]:
        """Return the sections in which something is called otherwise now."""
        rewritten: dict[str, MappingEntry] = {}
        for name, key in (("chains", "through"), ("links", "connects")):
            if name in sections:
                rewritten[name] = self._rewrite_elements(sections[name], key)
        frames = self.frames.write_section(sections.get("frames"))
        if frames is not None:
            rewritten["frames"] = frames
        if "use_cases" in sections:
            rewritten["use_cases"] = FlatSteps(self.architecture, self.flat_ids).rewrite_use_cases(
                sections["use_cases"]
            )
        for name in ("views", "policies"):
            if name in sections:
                rewritten[name] = rewrite_selectors(sections[name], self._rename_word)
        if "policies" in rewritten:
            # Exceptions name the inputs of leaves.
            policies = rewritten["policies"]
            rewritten["policies"] = policies.with_value(
                change_at(policies.value, ("*", "accepted"), self._rewrite_accepted)
            )
        return rewritten

    def rewrite_start(self, body: MappingNode, own_leaves: Collection[str]) -> MappingNode:
        """Return what a node says, with the components that it waits for, or that bring it up, called as now.

        `own_leaves` are the components that the node implements: it waits for the others of what is around them.
        """

        def rename(entry: MappingEntry) -> MappingEntry:
            scalars = mapping_values.list_scalars(entry.value)
            named = {name: each.span for each in scalars for name in self._name_started(each.text, own_leaves)}
            items = [ScalarNode(name, name, span) for name, span in named.items()]
            if not items:
                return entry
            return entry.with_value(SequenceNode([*items], entry.value.span) if entry.key == "after" else items[0])

        return body.change_keys({"start": lambda start: start.change_keys(dict.fromkeys(("after", "by"), rename))})

    def _name_started(self, text: str, own_leaves: Collection[str]) -> list[str]:
        """Return what is started where a component is: all leaves inside of a composed one."""
        target = self.linked.resolver.names.resolve_path(text, ("component",)).unique_element
        if target is None:
            return [text]
        inside = [target.id, *self.linked.outline.list_inside(target.id)]
        leaves = [each for each in inside if each in self.linked.outline.components]
        others = [each for each in leaves if each not in own_leaves]
        return [self.flat_ids[each] for each in others or leaves or inside if each in self.flat_ids]

    def _rewrite_accepted(self, accepted: YamlNode) -> YamlNode:
        inputs: dict[str, MappingEntry] = {}
        for each in list_entries(accepted):
            for name in self._name_inputs(each.key):
                inputs.setdefault(name, MappingEntry(name, each.key_span, each.value))
        return MappingNode(inputs, accepted.span) if isinstance(accepted, MappingNode) else accepted

    def _name_inputs(self, text: str) -> list[str]:
        target = self.linked.resolver.names.resolve_path(text, ("input",)).unique_element
        if target is None:
            return [text]
        leaf_ports = [each.rpartition(".") for each in self.architecture.leaf_ports_of("input", target.id)]
        return [f"{self.flat_ids[leaf]}.{name}" for leaf, _, name in leaf_ports if leaf in self.flat_ids] or [text]

    def _rewrite_elements(self, section: MappingEntry, key: str) -> MappingEntry:
        # In a chain a node of a name goes before a component, in a link a host.
        is_chain = key == "through"
        kinds = _WAYPOINT_KINDS if is_chain else _DEVICE_KINDS

        def rewrite(element: MappingEntry) -> MappingEntry:
            def rewrite_ends(ends: MappingEntry) -> MappingEntry:
                worst_leaves = self._list_worst_leaves(element.key) if is_chain else ()
                return ends.with_value(self._rewrite_value(ends.value, kinds, worst_leaves))

            return element.change_keys({key: rewrite_ends})

        return section.change_each(rewrite)

    def _rewrite_value(self, node: YamlNode, kinds: tuple[str, ...], worst_leaves: tuple[str, ...]) -> YamlNode:
        items = node.items if isinstance(node, SequenceNode) else [node]
        rewritten = [new for item in items for new in self._rewrite_item(item, kinds, worst_leaves)]
        is_one = len(rewritten) == 1 and not isinstance(node, SequenceNode)
        return rewritten[0] if is_one else SequenceNode(rewritten, node.span)

    def _rewrite_item(
        self, item: YamlNode, kinds: tuple[str, ...], worst_leaves: tuple[str, ...]
    ) -> Iterator[YamlNode]:
        """Yield what stands in the place of a reference: the leaves of a composed component that it is about."""
        if not isinstance(item, ScalarNode) or item.value is None:
            yield item
            return
        if kinds == _DEVICE_KINDS and item.text in self.architecture.hosts:
            yield item
            return
        target = self.linked.resolver.names.resolve_path(item.text, kinds).unique_element
        texts = list(self._name_target(target, worst_leaves)) if target else []
        if not texts or texts == [target.id if target else ""]:
            yield item
            return
        yield from (ScalarNode(text, text, item.span) for text in texts)

    def _name_target(self, target: ElementRef, worst_leaves: tuple[str, ...]) -> Iterator[str]:
        if target.kind == "output":
            component_id, _, name = target.id.rpartition(".")
            if component_id in self.flat_ids:
                yield f"{self.flat_ids[component_id]}.{name}"
                return
            behind = [each for each in self.linked.joined_sources.leaf_outputs_of(target.id) if each != target.id]
            if len(behind) == 1:
                leaf_id, _, leaf_name = behind[0].rpartition(".")
                yield f"{self.flat_ids[leaf_id]}.{leaf_name}"
            else:
                yield from self._name_leaves(component_id, worst_leaves)
        elif target.kind == "component" and target.id in self.flat_ids:
            yield self.flat_ids[target.id]
        elif target.kind == "component":
            yield from self._name_leaves(target.id, worst_leaves)

    def _name_leaves(self, shell_id: str, worst_leaves: tuple[str, ...]) -> Iterator[str]:
        inside = [each for each in self.linked.outline.list_inside(shell_id) if each in self.flat_ids]
        on_way = [each for each in worst_leaves if each in inside]
        yield from (self.flat_ids[each] for each in on_way or inside[:1])

    def _list_worst_leaves(self, chain_id: str) -> tuple[str, ...]:
        """Return the leaves on the worst way of a chain, in the order in which it passes them."""
        from archgen.timing.chains.chain_bounds import bound_chain

        chain = self.architecture.chains.get(chain_id)
        if chain is None or not any(each.id in self.linked.outline.shells for each in chain.through):
            return ()
        analysis = self._analysis
        if analysis is None:
            return ()
        leaves: list[str] = []
        for term in bound_chain(analysis, self.architecture, chain).terms:
            activity = analysis.system.activities.get(term.activity)
            node = self.architecture.nodes.get(activity.node) if activity else None
            own_name = activity.component if activity else None
            leaves += (
                each for each in (node.implements if node else ()) if own_name in {None, each, each.rpartition(".")[2]}
            )
        return tuple(dict.fromkeys(leaves))

    @cached_property
    def _analysis(self) -> Analysis | None:
        return analyse_timing(self.architecture, AnalysisMemory())

    def _rename_word(self, word: str) -> list[str] | None:
        """Return the paths that stand in the place of one in a selector; None where it stays."""
        if "*" in word and ":" not in word:
            return [self.flat_ids[each] for each in list_selected(self.architecture, word) if each in self.flat_ids]
        target = None if ":" in word else self.linked.resolver.names.resolve_path(word, _SELECTED_KINDS).unique_element
        if target is None or target.kind == "group":
            return None
        texts = self._name_all(target)
        return None if texts == [target.id] else texts

    def _name_all(self, target: ElementRef) -> list[str]:
        if target.kind == "component" and target.id not in self.flat_ids:
            return [self.flat_ids[each] for each in self.linked.outline.list_inside(target.id) if each in self.flat_ids]
        return list(self._name_target(target, ()))


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

        def rewrite(written: MappingEntry) -> MappingEntry:
            frame = self._architecture.frames.get(self._parameters.fill_in_name(written.key, leaf_id, written.key_span))
            is_own = frame is not None and frame.component == leaf_id and frame.by_written
            return self._rewrite_frame(written, frame) if is_own else written

        return section.change_each(rewrite)

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
        return entry.with_value(MappingNode(entries, body.span))

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
