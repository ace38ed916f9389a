"""Components that were split, merged or copied: recognised by who has their outputs now, stated with a confidence; and
which changes are nothing but a part of that.

What is recognised below `MIN_LIKENESS` stays what it is to the comparison: elements added and removed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from archgen.compare.comparison import Change, Comparison
from archgen.compare.element_likeness import MIN_LIKENESS, Feature, FeatureMap, find_likely_pairs, measure_likeness
from archgen.compare.element_relations import ElementRelations
from archgen.compare.key_phrases import format_value, name_partner, shown_id, tick_names
from archgen.compare.kinds.functional_kinds import COMPONENT, OUTPUT
from archgen.compare.match_elements import describe_element, look_up_pair
from archgen.compare.normal_values import to_plain_data
from archgen.compare.text_meaning import describe_text_difference
from archgen.compare.version_pair import ComparedElement, ElementKey, VersionPair
from archgen.diagnostics import join_words
from archgen.frozen import dataclass

_MESSAGE_WEIGHT = 3
"""What is on the wire counts apart from the type, which may have got another name with the output."""


@dataclass(frozen=True, slots=True)
class OutputHeir:
    """An output that is gone, and the output of another component that took its place. Common ids."""

    old_id: str
    new_id: str
    old_component: str
    new_component: str
    likeness: float


def _has_lost_outputs(versions: VersionPair) -> bool:
    """Whether any output is gone."""
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
    message = relations.architecture.message_of(output)
    messages = relations.common_ids("message", [message]) or frozenset(filter(None, [message]))
    return {
        **features,
        "type": Feature(features["type"].weight, types),
        "message": Feature(_MESSAGE_WEIGHT, messages),
    }


def component_of(port_key: ElementKey, versions: VersionPair) -> str:
    """Return the common id of a port's component, empty for no port: its path is the old one where the port is gone."""
    element = versions.elements_before.get(port_key) or versions.elements_after.get(port_key)
    return element.parent_key[1] if element and element.parent_key else ""


def _outputs_of(component: str, elements: Mapping[ElementKey, ComparedElement]) -> list[str]:
    """Return the common ids of a component's outputs in one of the versions."""
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


_FOLLOWING_KEYS = {
    "component": ("requirements", "functionality", "title", "description", "tags", "timing.wcet", "timing.bcet"),
    "node": ("implements",),
}
"""Keys that a split or a merger shares out or adds up, by kind of element."""


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
        if change.element_kind == "connection":
            return self._only_follows_heirs(common_id)
        if change.element_kind == "chain":
            return change.key == "through" and self._only_other_waypoints(change)
        component_ids = self._component_ids_of(change.element_kind, common_id)
        is_inside = bool(component_ids) and component_ids <= self.component_ids
        if is_inside and change.element_kind == "node" and change.kind == "added":
            return self._has_known_place(common_id)
        return is_inside and (change.kind != "changed" or _follows_reshaping(change))

    def _has_known_place(self, node_id: str) -> bool:
        """Whether a new node runs where those ran that it is a part of: another computer is news."""
        old_places = {
            _place_of(element)
            for (kind, _), element in self.versions.elements_before.items()
            if kind == "node" and not self.component_ids.isdisjoint(element.component_refs)
        }
        return _place_of(self.versions.elements_after["node", node_id]) in old_places

    def _component_ids_of(self, kind: str, common_id: str) -> frozenset[str]:
        """Return the components behind a component, a port, a node or what a node says of a port; else nothing."""
        if kind in {"component", "output", "input", "node", "port"}:
            elements = self.versions.find_both(kind, common_id)
            refs = frozenset(ref for element in elements if element for ref in element.component_refs)
            return refs if kind != "port" else _components_of_ports(refs, self.versions)
        return frozenset()

    def _only_follows_heirs(self, input_id: str) -> bool:
        """Whether an input reads nothing else than before, but the heirs of what it read."""
        heirs = {heir.old_id: heir.new_id for heir in self.heirs}
        before, after = (
            connections.sources_by_input.get(input_id, frozenset())
            for connections in (self.versions.connections_before, self.versions.connections_after)
        )
        is_inside = component_of(("input", input_id), self.versions) in self.component_ids
        # What was one component may have become a pipeline: one part reads the other.
        outer_sources = (
            {
                source
                for source in side
                if not is_inside or component_of(("output", source), self.versions) not in self.component_ids
            }
            for side in ({heirs.get(source, source) for source in before}, after)
        )
        return bool(before or is_inside) and frozenset(next(outer_sources)) == frozenset(next(outer_sources))

    def _only_other_waypoints(self, change: Change) -> bool:
        old_points, new_points = (
            set(value) if isinstance(value, list) else set[object]() for value in (change.before, change.after)
        )
        waypoints = sorted(map(str, old_points ^ new_points))
        return bool(waypoints) and all(map(self._is_waypoint_inside, waypoints))

    def _is_waypoint_inside(self, waypoint: str) -> bool:
        """Whether what a chain leads through is a component that takes part, an output or a node of it."""
        return any(
            element and element.component_refs and self.component_ids.issuperset(element.component_refs)
            for kind in ("component", "output", "node")
            for element in self.versions.find_both(kind, waypoint)
        )


def _place_of(node: ComparedElement) -> tuple[object, object]:
    return node.values.get("host"), node.values.get("container")


def _follows_reshaping(change: Change) -> bool:
    """Whether a key is one that a split or a merger shares out or adds up."""
    key = change.key or ""
    return key in _FOLLOWING_KEYS.get(change.element_kind, ()) or (
        change.element_kind == "component" and key.startswith("performance.")
    )


def _components_of_ports(ports: frozenset[str], versions: VersionPair) -> frozenset[str]:
    components = {component_of((kind, port), versions) for port in ports for kind in ("output", "input")}
    return frozenset(components - {""})


def _common_id(change: Change, versions: VersionPair) -> str:
    """Return the common id of what changed; what was removed is known by its own id."""
    kind = "input" if change.element_kind == "connection" else change.element_kind
    return versions.find_common_id(kind, change.element_id) if change.kind == "removed" else change.element_id


def truncate_confidence(confidence: float) -> float:
    """Return a confidence with two digits, below 1: nothing is certain that was recognised by likeness."""
    return int(min(confidence, 0.99) * 100) / 100


_PACE_KEYS = {"timing.behaviour": "behaviour", "timing.rate": "rate"}
"""Keys that readers of an output notice, with what sentences call them."""


def _describe_split(
    old_component: str, heirs_by_part: Mapping[str, Sequence[OutputHeir]], versions: VersionPair
) -> str:
    """Describe which outputs of a component are where now, and what else is not as it was."""
    heirs = [heir for part_heirs in heirs_by_part.values() for heir in part_heirs]
    components = [old_component, *sorted(heirs_by_part)]
    return "; ".join(
        (_describe_parts(old_component, heirs_by_part, versions), *_describe_rest(components, heirs, versions))
    )


def _describe_parts(
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


def _describe_merger(whole: str, heirs_by_part: Mapping[str, Sequence[OutputHeir]], versions: VersionPair) -> str:
    """Describe which components are one now, and what else is not as it was."""
    old_ids = [shown_id("component", part, versions) for part in sorted(heirs_by_part)]
    old_whole = versions.elements_before.get(("component", whole))
    if old_whole and old_whole.own_id != whole:
        old_ids = sorted([*old_ids, old_whole.own_id])
    noun, verb = ("component", "is") if len(old_ids) == 1 else ("components", "are")
    heirs = [heir for part_heirs in heirs_by_part.values() for heir in part_heirs]
    rest = _describe_rest([whole, *sorted(heirs_by_part)], heirs, versions)
    return "; ".join((f"{noun} {tick_names(old_ids)} {verb} merged into `{whole}`", *rest))


def _describe_rest(components: Sequence[str], heirs: Sequence[OutputHeir], versions: VersionPair) -> Iterator[str]:
    """Describe what came and went beside: nothing of it may hide in a sentence about something else."""
    old_outputs, new_outputs = (
        [name for component in components for name in _outputs_of(component, elements)]
        for elements in versions.elements
    )
    gone = set(old_outputs) - set(new_outputs) - {heir.old_id for heir in heirs}
    added = set(new_outputs) - set(old_outputs) - {heir.new_id for heir in heirs}
    if gone:
        yield f"{tick_names(shown_id('output', name, versions) for name in sorted(gone))} {_is_or_are(gone)} gone"
    if added:
        yield f"{tick_names(sorted(added))} {_is_or_are(added)} new"
    yield from _describe_other_sources(components, {*old_outputs, *new_outputs}, versions)
    yield from _describe_other_owners(heirs, versions)
    for heir in heirs:
        yield from _describe_heir(heir, versions)


def _describe_other_owners(heirs: Sequence[OutputHeir], versions: VersionPair) -> Iterator[str]:
    """Describe which components belong to another partner than those whose outputs they have."""
    for old_component, new_component in dict.fromkeys((heir.old_component, heir.new_component) for heir in heirs):
        old_element = versions.elements_before.get(("component", old_component))
        new_element = versions.elements_after.get(("component", new_component))
        old_owner, new_owner = (element.owner if element else None for element in (old_element, new_element))
        if new_owner and old_owner != new_owner:
            former_note = f" instead of {name_partner(old_owner, versions.partner_names)}" if old_owner else ""
            yield f"`{new_component}` belongs to {name_partner(new_owner, versions.partner_names)}{former_note}"


def _describe_other_sources(components: Sequence[str], own_outputs: set[str], versions: VersionPair) -> Iterator[str]:
    old_sources, new_sources = (
        {source for component in components for source in _sources_of(component, versions, side=side)} - own_outputs
        for side in (0, 1)
    )
    for verb, sources in (("also read", new_sources - old_sources), ("no longer read", old_sources - new_sources)):
        if sources:
            yield f"they {verb} {tick_names(shown_id('output', name, versions) for name in sorted(sources))}"


def _describe_heir(heir: OutputHeir, versions: VersionPair) -> Iterator[str]:
    """Describe in what an output is not what it was."""
    old_output = versions.elements_before["output", heir.old_id]
    new_output = versions.elements_after["output", heir.new_id]
    old_type, new_type = old_output.values.get("type"), new_output.values.get("type")
    if old_type != new_type:
        yield f"`{heir.new_id}` carries {format_value(new_type)} instead of {format_value(old_type)}"
    old_text, new_text = (str(each.values.get("description") or "") for each in (old_output, new_output))
    if old_text != new_text:
        yield f"the description of `{heir.new_id}` is another: {describe_text_difference(old_text, new_text)}"
    yield from _describe_pace(
        versions.elements_before.get(("component", heir.old_component)),
        versions.elements_after.get(("component", heir.new_component)),
        heir.new_id,
    )


def _describe_pace(
    old_component: ComparedElement | None, new_component: ComparedElement | None, output_id: str
) -> Iterator[str]:
    for key, noun in _PACE_KEYS.items():
        old_value, new_value = (each and each.values.get(key) for each in (old_component, new_component))
        old_plain, new_plain = to_plain_data(old_value), to_plain_data(new_value)
        if old_plain != new_plain:
            new_phrase = f"has the {noun} {format_value(new_plain)}" if new_plain else f"has no {noun}"
            yield f"`{output_id}` {new_phrase}" + (f" instead of {format_value(old_plain)}" if old_plain else "")


def _is_or_are(names: set[str]) -> str:
    return "is" if len(names) == 1 else "are"


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
        for reshaping in (*_find_reshaped("split", heirs, versions), *_find_reshaped("merged", heirs, versions)):
            if used_ids.isdisjoint(reshaping.component_ids):
                used_ids |= reshaping.component_ids
                yield reshaping
    yield from find_copies([name for name in added_ids if name not in used_ids], versions, relations[1])


def _find_reshaped(
    kind: Literal["split", "merged"], heirs: Sequence[OutputHeir], versions: VersionPair
) -> Iterator[Reshaping]:
    """Yield the old components that were split into new ones, or the new ones that old ones were merged into."""
    is_split = kind == "split"
    heirs_by_whole: dict[str, dict[str, list[OutputHeir]]] = defaultdict(lambda: defaultdict(list))
    for heir in heirs:
        whole, part = heir.old_component, heir.new_component
        if not is_split:
            whole, part = part, whole
        if versions.is_added("component", part) if is_split else versions.is_removed("component", part):
            heirs_by_whole[whole][part].append(heir)
    elements = versions.elements_after if is_split else versions.elements_before
    judge = _judge_part if is_split else _judge_merged
    for whole, heirs_by_part in sorted(heirs_by_whole.items()):
        is_on_both_sides = ("component", whole) in elements
        if not is_on_both_sides and len(heirs_by_part) == 1:
            continue
        confidence = min(judge(whole, part, part_heirs, versions) for part, part_heirs in heirs_by_part.items())
        if confidence >= MIN_LIKENESS:
            if is_split:
                parts = [*heirs_by_part, *([whole] if is_on_both_sides else [])]
            else:
                parts = [shown_id("component", part, versions) for part in heirs_by_part]
            yield Reshaping(
                kind,
                whole,
                tuple(sorted(parts)),
                (_describe_split if is_split else _describe_merger)(whole, heirs_by_part, versions),
                confidence,
                frozenset([whole, *heirs_by_part]),
                tuple(heir for part_heirs in heirs_by_part.values() for heir in part_heirs),
                versions,
            )


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
    return truncate_confidence(0.5 * mean_likeness + 0.25 * source_share + 0.25 * len(heirs) / max(len(outputs), 1))


def _judge_merged(whole: str, part: str, heirs: Sequence[OutputHeir], versions: VersionPair) -> float:
    """Return how sure it is that a component is a part of another one now: that has its outputs, and reads what it did."""
    outputs = _outputs_of(part, versions.elements_before)
    likeness = sum(heir.likeness for heir in heirs) / max(len(outputs), 1)
    own_outputs = {
        *_outputs_of(part, versions.elements_before),
        *_outputs_of(whole, versions.elements_before),
    }
    outer_sources = _sources_of(part, versions, side=0) - own_outputs
    read_sources = outer_sources & _sources_of(whole, versions, side=1)
    source_share = len(read_sources) / len(outer_sources) if outer_sources else 1.0
    return truncate_confidence(0.6 * likeness + 0.4 * source_share)


_COPIED_FEATURES = frozenset({"ports", "text", "group", "owner", "requirements", "performance", "timing", "tags"})
"""The features of a component that are copied with it: not its name, its node, its readers."""
_MIN_COPY_LIKENESS = 0.7
_MAX_COPIES = 20
"""With more new components than this a project is built up, and each would be compared with all."""


def find_copies(added_ids: Sequence[str], versions: VersionPair, relations: ElementRelations) -> Iterator[Reshaping]:
    """Yield the new components that have the ports of one that was there, and are like it in all that is copied."""
    if not added_ids or len(added_ids) > _MAX_COPIES:
        return
    originals_by_ports = _group_by_ports(
        [name for name in relations.architecture.components if ("component", name) in versions.elements_before],
        relations,
    )
    for added_id in added_ids:
        features = _copied_features(relations, added_id)
        rated_originals = [
            (-measure_likeness(original_features, features), name)
            for name, original_features in originals_by_ports.get(features["ports"].marks, {}).items()
        ]
        likeness, original = min(rated_originals, default=(0.0, ""))
        if -likeness >= _MIN_COPY_LIKENESS:
            yield Reshaping(
                "copied",
                added_id,
                (original,),
                f"a copy of `{original}`",
                truncate_confidence(-likeness),
                frozenset([added_id]),
                (),
                versions,
            )


def _group_by_ports(
    component_ids: Sequence[str], relations: ElementRelations
) -> Mapping[frozenset[str], Mapping[str, FeatureMap]]:
    groups: dict[frozenset[str], dict[str, FeatureMap]] = defaultdict(dict)
    for component_id in component_ids:
        features = _copied_features(relations, component_id)
        if features["ports"].marks:
            groups[features["ports"].marks][component_id] = features
    return groups


def _copied_features(relations: ElementRelations, component_id: str) -> FeatureMap:
    features = describe_element(COMPONENT, relations, relations.architecture.components[component_id])
    return {name: feature for name, feature in features.items() if name in _COPIED_FEATURES}
