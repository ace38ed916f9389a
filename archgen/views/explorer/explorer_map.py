"""Make the tables of the explorer: every element that the documents show, with what a reader asks of it first."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property

from archgen.cache.layout_memory import NO_MEMORY, LayoutMemory
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Group
from archgen.model.component_nesting import list_surrounding
from archgen.model.deployment import Host
from archgen.model.node import Node
from archgen.timing.analysis import EventPace
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system.timing_system import Activity
from archgen.views.explorer import element_keys, map_shapes
from archgen.views.explorer.column_layout import NO_HOME, MapPlaces, Path, Place, find_places
from archgen.views.explorer.element_keys import Key, list_composed_keys
from archgen.views.explorer.map_shapes import (
    ExplorerMap,
    Numbers,
    Row,
    describe_paces,
    find_shortest_step,
    list_passed_leaves,
    list_path,
    list_places,
    shorten_description,
)
from archgen.views.graphs.element_boxes import join_owner_titles, type_lines, worst_severity
from archgen.views.graphs.group_columns import (
    FEWEST_CROSSINGS,
    ColumnItem,
    GroupColumns,
    Lane,
    align_columns,
    arrange_groups,
    count_least_crossings,
)
from archgen.views.graphs.group_graphs import weigh_group_flows
from archgen.views.inline_text import count_noun
from archgen.views.lookup import Lookup
from archgen.views.search.search_entry import join_entry_parts
from archgen.views.tables.statistics_tables import PROGRESS_STEPS
from archgen.views.timing import chain_status, value_format


def make_timing_tables(lookup: Lookup, components: Numbers, nodes: Numbers) -> dict[str, tuple[Row, ...]]:
    """Make the tables of activities and of the steps between them; both are empty where nothing was analysed."""
    if lookup.timing is None:
        return {"activities": (), "steps": ()}
    network = CostNetwork.of_analysis(lookup.timing.analysis)
    activities = [each for each in lookup.timing.analysis.system.activities.values() if each.node in nodes]
    numbers = {activity.id: number for number, activity in enumerate(activities)}
    return {
        "activities": tuple(
            _make_activity_row(lookup.architecture, network, each, components, nodes) for each in activities
        ),
        "steps": tuple(_list_step_rows(network, numbers)),
    }


def _make_activity_row(
    architecture: Architecture, network: CostNetwork, activity: Activity, components: Numbers, nodes: Numbers
) -> Row:
    start = network.steps.start_delay(activity.id)
    return (
        activity.id,
        nodes[activity.node],
        tuple(components[name] for name in _list_components(architecture, activity) if name in components),
        _write_time(start.value),
        _write_time(network.start_response(activity.id)),
        start.why,
    )


def _list_components(architecture: Architecture, activity: Activity) -> Iterator[str]:
    """Yield the components that an activity works for: where it names none, all that its node implements."""
    for name in architecture.nodes[activity.node].implements:
        if activity.component in {None, name, name.rpartition(".")[2]}:
            yield from architecture.leaves_of(name)


def _list_step_rows(network: CostNetwork, numbers: Numbers) -> Iterator[Row]:
    """Yield the steps as a chain's page has them: over the link, waiting, at work. Answers fire nobody."""
    for arc in network.arcs:
        if arc.role != "answer" and arc.source in numbers and arc.target in numbers:
            delay = network.steps.sampling_delay(arc)
            times = (network.steps.link_latency(arc), delay.value, network.step_response(arc))
            ends = (numbers[arc.source], numbers[arc.target])
            yield (*ends, int(arc.role == "request"), *map(_write_time, times), delay.why)


def _write_time(value: TimingValue) -> object:
    """Return an upper bound in ns: None for what nobody knows, in brackets what is only a part of it."""
    if value.value is None:
        return None
    time = value.value.numerator if value.value.denominator == 1 else float(value.value)
    return time if value.complete or value.side == "at most" else (time,)


def make_composed_rows(
    lookup: Lookup,
    shells: Sequence[Component],
    component_numbers: Mapping[str, int],
    key_numbers: Mapping[Key, int],
    places: Mapping[Path, Place],
) -> tuple[Row, ...]:
    """Make the rows of composed components; the look-ups are the positions of components and keys in their tables."""
    architecture = lookup.architecture
    shell_numbers = {shell.id: number for number, shell in enumerate(shells)}
    group_numbers = {group: number for number, group in enumerate(lookup.shown_groups())}
    leaves: dict[str, list[int]] = {shell.id: [] for shell in shells}
    for component_id, number in component_numbers.items() if shells else ():
        around = list_path(architecture, architecture.components[component_id])[-2]
        if around in leaves:
            leaves[around].append(number)
    return tuple(
        (
            f"component:{shell.id}",
            shell.id,
            shell.title,
            group_numbers[shell.group],
            shell_numbers.get(shell.parent or "", -1),
            tuple(leaves[shell.id]),
            "".join(type_lines(lookup, shell)),
            shorten_description(shell.functionality, shell.description),
            tuple(key_numbers[key] for key in list_composed_keys(architecture, shell)),
            worst_severity(lookup, shell.id) or "",
            places[shell.group, *list_surrounding(architecture, shell.id), shell.id],
            list_places(lookup, shell.at),
        )
        for shell in shells
    )


def make_explorer_map(lookup: Lookup, memory: LayoutMemory = NO_MEMORY) -> ExplorerMap:
    """Make the tables of what is shown; the columns of groups come from the memory of layouts where they are there."""
    maker = _MapMaker(lookup, memory)
    return ExplorerMap(
        {
            "keys": tuple(maker.key_numbers),
            "names": tuple(maker.list_names()),
            "types": tuple((name, known.message or "") for name, known in lookup.architecture.types.items()),
            "groups": tuple(maker.group_row(group) for group in maker.groups),
            "ways": tuple(maker.way_rows()),
            "hosts": tuple(maker.host_row(host) for host in maker.hosts),
            "components": tuple(maker.component_row(component) for component in maker.components),
            "nodes": tuple(maker.node_row(node) for node in maker.nodes),
            **map_shapes.make_flow_tables(lookup, maker.component_numbers, maker.node_numbers, maker.shells),
            **make_timing_tables(lookup, maker.component_numbers, maker.node_numbers),
            "shells": maker.shell_rows(),
            "chains": tuple(maker.chain_rows()),
            "requirements": tuple(maker.requirement_rows()),
            "findings": tuple(maker.finding_rows()),
        }
    )


@dataclass(frozen=True)
class _MapMaker:
    """Makes the rows of elements. Its look-ups are the positions of elements in their tables."""

    lookup: Lookup
    memory: LayoutMemory

    @cached_property
    def groups(self) -> list[Group]:
        return [self.lookup.architecture.groups[name] for name in self.lookup.shown_groups()]

    @cached_property
    def components(self) -> list[Component]:
        return [component for group in self.groups for component in self.lookup.shown_components(group.id)]

    @cached_property
    def shells(self) -> list[Component]:
        """The composed components, outer ones first."""
        return [shell for shell in self.lookup.architecture.shells.values() if self.lookup.shows_part(shell.id)]

    @cached_property
    def nodes(self) -> list[Node]:
        return self.lookup.shown_nodes()

    @cached_property
    def hosts(self) -> list[Host]:
        used_ids = {node.host for node in self.nodes}
        is_whole = self.lookup.scope.nodes is None
        return [host for host in self.lookup.architecture.hosts.values() if is_whole or host.id in used_ids]

    @cached_property
    def component_numbers(self) -> Mapping[str, int]:
        return {component.id: number for number, component in enumerate(self.components)}

    @cached_property
    def node_numbers(self) -> Mapping[str, int]:
        return {node.id: number for number, node in enumerate(self.nodes)}

    @cached_property
    def group_numbers(self) -> Mapping[str, int]:
        return {group.id: number for number, group in enumerate(self.groups)}

    @cached_property
    def host_numbers(self) -> Mapping[str, int]:
        return {host.id: number for number, host in enumerate(self.hosts)}

    @cached_property
    def component_keys(self) -> Mapping[str, tuple[element_keys.Key, ...]]:
        return element_keys.list_component_keys(self.lookup)

    @cached_property
    def node_keys(self) -> Mapping[str, tuple[element_keys.Key, ...]]:
        variants = element_keys.find_changed_by_variants(self.lookup.architecture)
        return {node.id: element_keys.list_node_keys(self.lookup, node, variants) for node in self.nodes}

    @cached_property
    def key_numbers(self) -> Mapping[element_keys.Key, int]:
        """The position of each key and value, in order of appearance."""
        used_keys = [key for component in self.components for key in self.component_keys[component.id]]
        used_keys += [key for node in self.nodes for key in self.node_keys[node.id]]
        used_keys += [
            key for shell in self.shells for key in element_keys.list_composed_keys(self.lookup.architecture, shell)
        ]
        return {key: number for number, key in enumerate(dict.fromkeys(used_keys))}

    @cached_property
    def node_groups(self) -> Mapping[str, str]:
        """The group of each node: that of the first shown component that it implements."""
        groups = {component.id: component.group for component in self.components}
        homes = ((node.id, next((groups[c] for c in node.implements if c in groups), "")) for node in self.nodes)
        return {node_id: group for node_id, group in homes if group}

    @cached_property
    def node_hosts(self) -> Mapping[str, str]:
        """The host of each node that runs on one that is shown."""
        return {node.id: node.host for node in self.nodes if node.host and node.host in self.host_numbers}

    @cached_property
    def map_places(self) -> MapPlaces:
        return find_places(
            self.lookup,
            {component.id: list_path(self.lookup.architecture, component) for component in self.components},
            self.node_groups,
            self.node_hosts,
            self.node_numbers,
        )

    @cached_property
    def arranged_groups(self) -> GroupColumns | None:
        """The columns of the overview; None where so many lines would cross that they are no picture."""
        names = [group.id for group in self.groups]
        weights = weigh_group_flows(self.lookup)
        pairs = {frozenset(ends) for ends in weights if ends[0] in self.group_numbers and ends[1] in self.group_numbers}
        if count_least_crossings(len(names), len(pairs)) > FEWEST_CROSSINGS:
            return None
        return arrange_groups(names, weights, self.memory)

    @cached_property
    def group_places(self) -> Mapping[ColumnItem, Place]:
        """The place of each group and lane, heights in steps of a box, where groups are in the columns of the overview."""
        arranged = self.arranged_groups
        if arranged is None:
            return {
                group.id: self.map_places.components[group.id,]
                for group in self.groups
                if (group.id,) in self.map_places.components
            }
        heights = align_columns(arranged, _measure_distance)
        return {
            item: (number, round(heights[item], 2)) for number, column in enumerate(arranged.columns) for item in column
        }

    def way_rows(self) -> Iterator[Row]:
        """Yield the lines between groups with the places that they pass."""
        for line in self.arranged_groups.lines if self.arranged_groups else ():
            ends = (self.group_numbers[str(line[0])], self.group_numbers[str(line[-1])])
            yield (*ends, tuple(self.group_places[lane] for lane in line[1:-1]))

    @cached_property
    def progress_bits(self) -> Mapping[str, int]:
        """How far each component is, a bit for each of the steps of progress, the first one lowest."""
        return measure_steps(self.lookup, self.components)

    def list_names(self) -> Iterator[Row]:
        """Yield the titles of values that people know by another name."""
        architecture = self.lookup.architecture
        yield from (("owner", partner.id, partner.title) for partner in architecture.partners.values())
        yield from (("host", host.id, host.title) for host in self.hosts)
        used_requirements = (value for key, value in self.key_numbers if key == "requirement")
        for name in used_requirements:
            if name in architecture.requirements:
                yield ("requirement", name, f"{name} {architecture.requirements[name].title}")
        yield from self._list_property_names()
        yield from (("period", step, words) for step, words in value_format.PERIOD_STEP_WORDS.items())
        yield from (("progress", str(number), step) for number, step in enumerate(PROGRESS_STEPS))

    def _list_property_names(self) -> Iterator[Row]:
        """Yield the titles of declared properties that anything on the map has, each with its choices in their order."""
        used_names = {value.partition("=")[0] for key, value in self.key_numbers if key == "property"}
        for declared in self.lookup.architecture.properties.values():
            if declared.id in used_names:
                yield ("property", declared.id, declared.title)
                yield from ((f"property:{declared.id}", choice, choice) for choice in declared.choices)

    def group_row(self, group: Group) -> Row:
        """Return the row of a group."""
        return (
            f"group:{group.id}",
            group.id,
            group.title,
            join_owner_titles(self.lookup, group.owners),
            shorten_description(group.description),
            self.group_places.get(group.id, ()) if (group.id,) in self.map_places.components else (),
            self.map_places.nodes_by_group.get((group.id,), ()),
            list_places(self.lookup, group.at),
        )

    def host_row(self, host: Host) -> Row:
        """Return the row of a host."""
        line = join_entry_parts(count_noun(host.cores, "core") if host.cores else "", host.scheduling)
        return (
            f"host:{host.id}",
            host.id,
            host.title,
            line,
            shorten_description(host.description),
            self.map_places.nodes_by_host.get((host.id,), ()),
            list_places(self.lookup, host.at),
        )

    def component_row(self, component: Component) -> Row:
        """Return the row of a component."""
        paces = self._list_paces(component.id, self.lookup.nodes_of.get(component.id, ()))
        return (
            f"component:{component.id}",
            component.id,
            component.title,
            self.group_numbers[component.group],
            describe_paces(paces),
            shorten_description(component.functionality, component.description),
            tuple(self.key_numbers[key] for key in self.component_keys[component.id]),
            find_shortest_step(paces),
            self.progress_bits[component.id],
            # Of a composed one that is not designed to its end, its own row has the findings.
            ("" if component.id in self.lookup.architecture.shells else worst_severity(self.lookup, component.id))
            or "",
            self.map_places.components[list_path(self.lookup.architecture, component)],
            list_places(self.lookup, component.at),
        )

    def shell_rows(self) -> tuple[Row, ...]:
        """Return the rows of the composed components."""
        places = self.map_places.components
        return make_composed_rows(self.lookup, self.shells, self.component_numbers, self.key_numbers, places)

    def node_row(self, node: Node) -> Row:
        """Return the row of a node."""
        paces = self._list_paces(None, (node,))
        return (
            f"node:{node.id}",
            node.id,
            node.id,
            tuple(self.component_numbers[name] for name in node.implements if name in self.component_numbers),
            self.group_numbers.get(self.node_groups.get(node.id, ""), -1),
            self.host_numbers.get(node.host or "", -1),
            describe_paces(paces),
            shorten_description(node.description),
            tuple(self.key_numbers[key] for key in self.node_keys[node.id]),
            find_shortest_step(paces),
            worst_severity(self.lookup, node.id) or "",
            self.map_places.nodes_by_group[self.node_groups.get(node.id, NO_HOME), node.id],
            self.map_places.nodes_by_host.get((self.node_hosts.get(node.id, NO_HOME), node.id), ()),
            list_places(self.lookup, node.at),
        )

    def _list_paces(self, component_id: str | None, nodes: Iterable[Node]) -> list[EventPace | None]:
        """Return how often the activities of nodes happen; with a component, only those that are of it."""
        timing = self.lookup.timing
        if timing is None:
            return []
        return [
            timing.analysis.paces.get(activity.id)
            for node in nodes
            for activity in timing.activities_of_node.get(node.id, ())
            if component_id is None or activity.component in {None, component_id}
        ]

    def chain_rows(self) -> Iterator[Row]:
        """Yield the chains of effect, the worst first, with what they lead through."""
        architecture = self.lookup.architecture
        results = self.lookup.timing.chains if self.lookup.timing else ()
        ranks = {result.id: (rank, result) for rank, result in enumerate(results)}
        for chain in sorted(architecture.chains.values(), key=lambda chain: ranks.get(chain.id, (len(ranks),))[0]):
            chip = chain_status.chain_chip(ranks[chain.id][1])[0] if chain.id in ranks else None
            names = [leaf for w in chain.through for leaf in list_passed_leaves(architecture, w.kind, w.id)]
            yield (
                f"chain:{chain.id}",
                chain.id,
                chain.title,
                chip.status or "" if chip else "",
                chip.text if chip else "",
                tuple(dict.fromkeys(self.component_numbers[name] for name in names if name in self.component_numbers)),
                tuple(dict.fromkeys(self.node_numbers[name] for name in names if name in self.node_numbers)),
            )

    def requirement_rows(self) -> Iterator[Row]:
        """Yield the requirements that shown components serve, and composed ones as a whole."""
        served_ids = {use.text for shell in self.shells for use in shell.requirements if use.is_id}
        for requirement in self.lookup.architecture.requirements.values():
            servers = self.lookup.components_for_requirement.get(requirement.id, ())
            leaves = (each for each in servers if each.id not in self.lookup.architecture.shells)
            numbers = tuple(self.component_numbers[each.id] for each in leaves if each.id in self.component_numbers)
            if numbers or requirement.id in served_ids:
                yield (f"requirement:{requirement.id}", requirement.id, requirement.title, numbers)

    def finding_rows(self) -> Iterator[Row]:
        """Yield the findings about shown components, nodes and composed components."""
        shell_numbers = {shell.id: number for number, shell in enumerate(self.shells)}
        # A composed one that is not designed to its end is among the components as well.
        tables = ((2, shell_numbers), (0, self.component_numbers), (1, self.node_numbers))
        for element_id, findings in self.lookup.findings_of.items():
            kind, numbers = next((each for each in tables if element_id in each[1]), (0, {}))
            if element_id in numbers:
                yield from (
                    (kind, numbers[element_id], finding.effective_severity.value, finding.message.replace("`", ""))
                    for finding in findings
                )


def _measure_distance(one: ColumnItem, other: ColumnItem) -> float:
    """Return how far apart two items of a column stand at least, in steps of a box."""
    return (1.0, 0.5, 0.25)[isinstance(one, Lane) + isinstance(other, Lane)]


def measure_steps(lookup: Lookup, components: Iterable[Component]) -> dict[str, int]:
    """Return the steps of progress that components have done, as bits: described, typed, mapped, timed, traced."""
    declared = lookup.architecture.requirements
    steps = {}
    for component in components:
        outputs = component.outputs.values()
        nodes = [node for node in lookup.nodes_of.get(component.id, ()) if node.written]
        done = (
            bool(component.functionality),
            bool(component.inputs or outputs) and all(output.type is not None for output in outputs),
            bool(nodes),
            component.timing is not None or (bool(nodes) and all(component.id in node.timing for node in nodes)),
            any(use.is_id and use.text in declared for use in component.requirements),
        )
        steps[component.id] = int("".join("01"[is_done] for is_done in reversed(done)), base=2)
    return steps
