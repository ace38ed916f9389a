"""Components that were split, merged or copied: recognised by what became of their outputs, stated with a confidence.

What is recognised below `MIN_LIKENESS` stays what it is to the comparison: elements added and removed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.comparison import Change, Comparison
from archgen.compare.element_likeness import MIN_LIKENESS, Feature, FeatureMap, find_likely_pairs, measure_likeness
from archgen.compare.element_relations import ElementRelations
from archgen.compare.kinds.functional_kinds import COMPONENT, OUTPUT
from archgen.compare.match_elements import describe_element, look_up_pair
from archgen.compare.sentence_words import shown_id, tick_names
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics.common_wording import join_words

_FOLLOWING_KEYS = ("requirements", "functionality", "title", "description", "tags", "timing.wcet", "timing.bcet")
"""Keys of a component that a split or a merger shares out or adds up."""
_COPIED_FEATURES = frozenset({"ports", "text", "group", "owner", "requirements", "performance", "timing", "tags"})
"""The features of a component that are copied with it: not its name, its node, its readers."""
_MIN_COPY_LIKENESS = 0.7


@dataclass(frozen=True, slots=True)
class OutputHeir:
    """An output that is gone, and the output of another component that took its place. Common ids."""

    old_id: str
    new_id: str
    old_component: str
    new_component: str
    likeness: float


@dataclass(frozen=True, slots=True)
class Reshaping:
    """A component that was split or copied, or that others were merged into, with all components that take part."""

    kind: Literal["split", "merged", "copied"]
    component_id: str
    related_ids: tuple[str, ...]
    text: str
    confidence: float
    component_ids: frozenset[str]
    heirs: tuple[OutputHeir, ...]
    versions: VersionPair

    def brought_about(self, change: Change) -> bool:
        """Whether a change is nothing but a part of this one."""
        if self.kind == "copied":
            return (change.kind, change.element_kind, change.element_id) == ("added", "component", self.component_id)
        common_id = _common_id(change, self.versions)
        is_whole = change.kind != "changed"
        match change.element_kind:
            case "component":
                return common_id in self.component_ids and (is_whole or _follows_reshaping(change.key or ""))
            case "output" | "input":
                key = change.element_kind, common_id
                return is_whole and component_of(key, self.versions) in self.component_ids
            case "connection":
                return self._only_follows_heirs(common_id)
            case "node":
                refs = _component_refs(change, common_id, self.versions)
                return bool(refs) and refs <= self.component_ids and (is_whole or change.key == "implements")
            case "port":
                port_components = {
                    port.rpartition(".")[0] for port in _component_refs(change, common_id, self.versions)
                }
                return bool(port_components) and is_whole and port_components <= self.component_ids
            case "chain":
                return change.key == "through" and self._only_other_waypoints(change)
        return False

    def _only_follows_heirs(self, input_id: str) -> bool:
        """Whether an input reads nothing else than before, but the heirs of what it read."""
        if component_of(("input", input_id), self.versions) in self.component_ids:
            return True
        heirs = {heir.old_id: heir.new_id for heir in self.heirs}
        before, after = (
            connections.sources_by_input.get(input_id, frozenset())
            for connections in (self.versions.connections_before, self.versions.connections_after)
        )
        return bool(before) and {heirs.get(source, source) for source in before} == after

    def _only_other_waypoints(self, change: Change) -> bool:
        old_points, new_points = (
            set(value) if isinstance(value, list) else set[object]() for value in (change.before, change.after)
        )
        waypoints = {str(point) for point in old_points ^ new_points}
        return bool(waypoints) and all(
            point in self.component_ids or point.rpartition(".")[0] in self.component_ids for point in waypoints
        )


def find_reshapings(comparison: Comparison) -> Iterator[Reshaping]:
    """Yield the components that were split, merged or copied; none takes part in two of them."""
    versions = comparison.versions
    added_ids = [
        name for (kind, name) in versions.elements_after if kind == "component" and versions.is_added(kind, name)
    ]
    removed_ids = [
        name for (kind, name) in versions.elements_before if kind == "component" and versions.is_removed(kind, name)
    ]
    if not added_ids and not removed_ids:
        return
    relations = look_up_pair(comparison.before.architecture, comparison.after.architecture, comparison.matched_ids)
    used_ids = set[str]()
    if _has_lost_outputs(versions):
        heirs = list(_find_heirs(versions, relations))
        for reshaping in (*_find_splits(heirs, versions), *_find_mergers(heirs, versions)):
            if used_ids.isdisjoint(reshaping.component_ids):
                used_ids |= reshaping.component_ids
                yield reshaping
    yield from _find_copies([name for name in added_ids if name not in used_ids], versions, relations[1])


def _has_lost_outputs(versions: VersionPair) -> bool:
    return any(kind == "output" and versions.is_removed(kind, name) for kind, name in versions.elements_before)


def _find_heirs(versions: VersionPair, relations: tuple[ElementRelations, ElementRelations]) -> Iterator[OutputHeir]:
    """Yield the outputs that another component has now: of one type, one topic, with the same readers."""
    lost_outputs = {
        name: _describe_output(relations[0], element.own_id)
        for (kind, name), element in versions.elements_before.items()
        if kind == "output" and versions.is_removed(kind, name)
    }
    new_outputs = {
        name: _describe_output(relations[1], name)
        for kind, name in versions.elements_after
        if kind == "output" and versions.is_added(kind, name)
    }
    for old_id, new_id, likeness in find_likely_pairs(lost_outputs, new_outputs):
        old_component, new_component = (component_of(("output", output_id), versions) for output_id in (old_id, new_id))
        if old_component != new_component:
            yield OutputHeir(old_id, new_id, old_component, new_component, likeness)


def _describe_output(relations: ElementRelations, output_id: str) -> FeatureMap:
    output = relations.architecture.outputs[output_id]
    # Unlike in `match_elements`, types are matched by now: one with another name is the same.
    types = relations.common_ids("type", [output.type]) or frozenset(filter(None, [output.type]))
    features = describe_element(OUTPUT, relations, output)
    return {**features, "type": Feature(features["type"].weight, types)}


def _find_splits(heirs: Sequence[OutputHeir], versions: VersionPair) -> Iterator[Reshaping]:
    heirs_by_component: dict[str, dict[str, list[OutputHeir]]] = defaultdict(lambda: defaultdict(list))
    for heir in heirs:
        if versions.is_added("component", heir.new_component):
            heirs_by_component[heir.old_component][heir.new_component].append(heir)
    for old_component, heirs_by_part in sorted(heirs_by_component.items()):
        stays = ("component", old_component) in versions.elements_after
        if not (stays or _are_several(heirs_by_part)):
            continue
        confidence = min(
            _judge_part(old_component, part, part_heirs, versions) for part, part_heirs in heirs_by_part.items()
        )
        if confidence >= MIN_LIKENESS:
            yield Reshaping(
                "split",
                old_component,
                tuple(sorted([*heirs_by_part, *([old_component] if stays else [])])),
                _describe_split(old_component, heirs_by_part, versions),
                confidence,
                frozenset([old_component, *heirs_by_part]),
                tuple(heir for part_heirs in heirs_by_part.values() for heir in part_heirs),
                versions,
            )


def _are_several(heirs_by_part: Mapping[str, object]) -> bool:
    return len(heirs_by_part) > 1


def _judge_part(old_component: str, part: str, heirs: Sequence[OutputHeir], versions: VersionPair) -> float:
    """Return how sure it is that a new component is a part of an old one: its outputs are, and it reads what that did."""
    outputs = _outputs_of(part, versions.elements_after)
    mean_likeness = sum(heir.likeness for heir in heirs) / len(heirs)
    sources = _sources_of(part, versions, side=1)
    own_components = {old_component, *(heir.new_component for heir in heirs)}
    old_sources = _sources_of(old_component, versions, side=0)
    # The second half of what was one pipeline reads the first.
    known_sources = {
        source
        for source in sources
        if source in old_sources or component_of(("output", source), versions) in own_components
    }
    source_share = len(known_sources) / len(sources) if sources else 1.0
    return _truncate(0.5 * mean_likeness + 0.25 * source_share + 0.25 * len(heirs) / max(len(outputs), 1))


def _describe_split(
    old_component: str, heirs_by_part: Mapping[str, Sequence[OutputHeir]], versions: VersionPair
) -> str:
    element = versions.elements_before["component", old_component]
    if ("component", old_component) not in versions.elements_after or element.own_id != old_component:
        phrases = {part: f"`{part}` ({_name_outputs(part_heirs)})" for part, part_heirs in heirs_by_part.items()}
        if ("component", old_component) in versions.elements_after:
            left_outputs = [name.rpartition(".")[2] for name in _outputs_of(old_component, versions.elements_after)]
            phrases[old_component] = f"`{old_component}` ({_count_outputs(left_outputs)})"
        return f"component `{element.own_id}` is split into {join_words([phrases[part] for part in sorted(phrases)])}"
    clauses = [
        f"`{part}` takes over the {_name_outputs(part_heirs)}" for part, part_heirs in sorted(heirs_by_part.items())
    ]
    return f"component `{old_component}` is split: {join_words(clauses)}"


def _name_outputs(heirs: Sequence[OutputHeir]) -> str:
    names = []
    for heir in heirs:
        old_name, new_name = (output.rpartition(".")[2] for output in (heir.old_id, heir.new_id))
        names.append(f"`{old_name}`" if old_name == new_name else f"`{old_name}` as `{new_name}`")
    return f"{'output' if len(names) == 1 else 'outputs'} {join_words(sorted(names))}"


def _count_outputs(names: Sequence[str]) -> str:
    return f"{'output' if len(names) == 1 else 'outputs'} {tick_names(names)}" if names else "no output"


def _find_mergers(heirs: Sequence[OutputHeir], versions: VersionPair) -> Iterator[Reshaping]:
    heirs_by_whole: dict[str, dict[str, list[OutputHeir]]] = defaultdict(lambda: defaultdict(list))
    for heir in heirs:
        if versions.is_removed("component", heir.old_component):
            heirs_by_whole[heir.new_component][heir.old_component].append(heir)
    for whole, heirs_by_part in sorted(heirs_by_whole.items()):
        was_there = ("component", whole) in versions.elements_before
        if not (was_there or _are_several(heirs_by_part)):
            continue
        confidence = min(_judge_merged(part, whole, part_heirs, versions) for part, part_heirs in heirs_by_part.items())
        if confidence >= MIN_LIKENESS:
            yield Reshaping(
                "merged",
                whole,
                tuple(sorted(shown_id("component", part, versions) for part in heirs_by_part)),
                _describe_merger(whole, list(heirs_by_part), versions),
                confidence,
                frozenset([whole, *heirs_by_part]),
                tuple(heir for part_heirs in heirs_by_part.values() for heir in part_heirs),
                versions,
            )


def _judge_merged(part: str, whole: str, heirs: Sequence[OutputHeir], versions: VersionPair) -> float:
    """Return how sure it is that a component is a part of another one now: that has its outputs, and reads what it did."""
    outputs = _outputs_of(part, versions.elements_before)
    likeness = sum(heir.likeness for heir in heirs) / max(len(outputs), 1)
    sources = _sources_of(part, versions, side=0)
    own_outputs = {
        *_outputs_of(part, versions.elements_before),
        *_outputs_of(whole, versions.elements_before),
    }
    outer_sources = [source for source in sources if source not in own_outputs]
    new_sources = _sources_of(whole, versions, side=1)
    source_share = sum(source in new_sources for source in outer_sources) / len(outer_sources) if outer_sources else 1.0
    return _truncate(0.6 * likeness + 0.4 * source_share)


def _describe_merger(whole: str, parts: Sequence[str], versions: VersionPair) -> str:
    old_ids = [shown_id("component", part, versions) for part in sorted(parts)]
    old_whole = versions.elements_before.get(("component", whole))
    if old_whole and old_whole.own_id != whole:
        old_ids = sorted([*old_ids, old_whole.own_id])
    noun, verb = ("component", "is") if len(old_ids) == 1 else ("components", "are")
    return f"{noun} {tick_names(old_ids)} {verb} merged into `{whole}`"


def _find_copies(added_ids: Sequence[str], versions: VersionPair, relations: ElementRelations) -> Iterator[Reshaping]:
    """Yield the new components that have the ports of one that was there, and are like it in all that is copied."""
    components = relations.architecture.components
    for added_id in added_ids if len(added_ids) <= _MAX_COPIES else ():
        features = _copied_features(relations, added_id)
        if not features["ports"].marks:
            continue
        rated_originals = [
            (-measure_likeness(original_features, features), name)
            for name in components
            if ("component", name) in versions.elements_before
            and (original_features := _copied_features(relations, name))["ports"].marks == features["ports"].marks
        ]
        likeness, original = min(rated_originals, default=(0.0, ""))
        if -likeness >= _MIN_COPY_LIKENESS:
            yield Reshaping(
                "copied",
                added_id,
                (original,),
                f"a copy of `{original}`",
                _truncate(-likeness),
                frozenset([added_id]),
                (),
                versions,
            )


_MAX_COPIES = 20
"""With more new components than this a project is built up, and each would be compared with all."""


def _copied_features(relations: ElementRelations, component_id: str) -> FeatureMap:
    features = describe_element(COMPONENT, relations, relations.architecture.components[component_id])
    return {name: feature for name, feature in features.items() if name in _COPIED_FEATURES}


def _follows_reshaping(key: str) -> bool:
    return key in _FOLLOWING_KEYS or key.startswith("performance.")


def _common_id(change: Change, versions: VersionPair) -> str:
    """Return the common id of what changed; what was removed is known by its own id."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    if change.kind != "removed":
        return change.element_id
    return next(
        (
            name
            for (other_kind, name), element in versions.elements_before.items()
            if other_kind == kind and element.own_id == change.element_id
        ),
        change.element_id,
    )


def _component_refs(change: Change, common_id: str, versions: VersionPair) -> frozenset[str]:
    """Return the components, or ports of components, behind a node or a port of it, in both versions."""
    key = change.element_kind, common_id
    elements = (versions.elements_before.get(key), versions.elements_after.get(key))
    return frozenset(ref for element in elements if element for ref in element.component_refs)


def component_of(port_key: ElementKey, versions: VersionPair) -> str:
    """Return the common id of a port's component, empty for no port: its path is the old one where the port is gone."""
    element = versions.elements_before.get(port_key) or versions.elements_after.get(port_key)
    return element.parent_key[1] if element and element.parent_key else ""


def _outputs_of(component: str, elements: Mapping[ElementKey, ComparedElement]) -> list[str]:
    return [
        name
        for (kind, name), element in elements.items()
        if kind == "output" and element.parent_key == ("component", component)
    ]


def _sources_of(component: str, versions: VersionPair, *, side: int) -> frozenset[str]:
    """Return what a component reads in one of the versions."""
    connections = (versions.connections_before, versions.connections_after)[side]
    return frozenset(
        source
        for reader, sources in connections.sources_by_input.items()
        if component_of(("input", reader), versions) == component
        for source in sources
    )


def _truncate(confidence: float) -> float:
    return int(min(confidence, 0.99) * 100) / 100
