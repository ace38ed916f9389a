"""The site's matrices: components folded into groups, nodes into hosts, partners, and requirements against components."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.frozen import dataclass, replace
from archgen.model.feedback_order import MAX_EXACT, FeedbackOrder, order_by_feedback
from archgen.model.partner_interfaces import PartnerPair
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.lookup import Lookup
from archgen.views.matrix_shapes import Matrix, MatrixEntry, MatrixFlow
from archgen.views.pages.context_pages import HOME_CRUMB
from archgen.views.shapes import Page, Section
from archgen.views.tables import requirement_tables

Flow = tuple[str, str, str, str]
"""Who gives, who takes, what, and the page that this leads to; both by id."""
_MATRIX_CRUMB = ("Matrix", "page:matrix")
_EXACT_ORDER = "the order with the least feedback, found by exact search"
_GREEDY_ORDER = f"little feedback: loops above {MAX_EXACT} are ordered by the greedy rule of Eades, Lin and Smyth"


def make_matrix_pages(lookup: Lookup, *, with_nodes: bool) -> Iterator[Page]:
    """Make a page for each matrix that has something to show: components first, which the others lead back to."""
    component_matrix = make_component_matrix(lookup)
    if not component_matrix.rows:
        return
    others = [make_requirement_matrix(lookup)]
    if with_nodes:
        others.insert(0, make_node_matrix(lookup))
    matrices = [matrix for matrix in (component_matrix, *others) if matrix.flows or matrix is component_matrix]
    related = [
        ("page:matrix" if matrix is component_matrix else f"page:matrix/{matrix.id}", matrix.title)
        for matrix in matrices
    ]
    if len(lookup.architecture.partners) > 1:
        related.append(("page:partners", "Who owes whom"))
    for (anchor, _), matrix in zip(related, matrices, strict=False):
        linked = replace(matrix, related=tuple((title, ref) for ref, title in related if ref != anchor))
        yield _make_page(anchor, linked)


def _make_page(anchor: str, matrix: Matrix) -> Page:
    """Make the page of a matrix; that of components is the one to begin with."""
    if anchor == _MATRIX_CRUMB[1]:
        lead = "Who gives what to whom: components, folded into groups" if matrix.groups else "Who gives what to whom"
        return Page(
            "matrix.html", anchor, "Matrix", "spanning", Section(anchor, "Matrix"), (HOME_CRUMB,), lead, matrix=matrix
        )
    path = f"matrix/{matrix.id}.html"
    crumbs = (HOME_CRUMB, _MATRIX_CRUMB)
    return Page(path, anchor, matrix.title, "matrices", Section(anchor, matrix.title), crumbs, "Matrix", matrix=matrix)


def make_component_matrix(lookup: Lookup) -> Matrix:
    """Make the matrix of the shown components: rows give, columns take."""
    architecture = lookup.architecture
    groups = {component.id: component.group for component in architecture.components.values()}
    flows = [
        (
            architecture.outputs[edge.output].component,
            architecture.inputs[edge.input].component,
            architecture.outputs[edge.output].type or architecture.outputs[edge.output].name,
            f"table:outputs/{architecture.outputs[edge.output].component}",
        )
        for edge in architecture.edges
    ]
    shown_ids = [c.id for group in lookup.shown_groups() for c in lookup.shown_components(group)]
    entries = {
        name: MatrixEntry(
            architecture.components[name].title,
            f"component:{name}",
            join_owner_titles(lookup, architecture.components[name].owners),
        )
        for name in shown_ids
    }
    group_entries = {
        name: MatrixEntry(group.title, f"group:{name}", join_owner_titles(lookup, group.owners))
        for name, group in architecture.groups.items()
    }
    return _make_square(
        _SquareKind("components", "Components", "component", "group"), entries, flows, _Grouping(groups, group_entries)
    )


def make_node_matrix(lookup: Lookup) -> Matrix:
    """Make the matrix of the shown nodes, folded into hosts: who writes what others read."""
    architecture = lookup.architecture
    flows = [
        (writer.node, reader.node, topic.name, f"topic:{topic.name}")
        for topic in architecture.topics.values()
        # What everybody shares, such as /tf, would join each node to each other one.
        if not topic.shared
        for writer in topic.writers
        for reader in topic.readers
    ]
    nodes = lookup.shown_nodes()
    entries = {node.id: MatrixEntry(node.id, f"node:{node.id}", node.package or "") for node in nodes}
    hosts = {node.id: node.host for node in nodes if node.host}
    host_entries = {name: MatrixEntry(host.title, f"host:{name}", "") for name, host in architecture.hosts.items()}
    return _make_square(_SquareKind("nodes", "Nodes", "node", "host"), entries, flows, _Grouping(hosts, host_entries))


def make_partner_matrix(
    lookup: Lookup, counts: Mapping[PartnerPair, int], references: Mapping[PartnerPair, str]
) -> Matrix:
    """Make the matrix of partners: how many interfaces each gives to each, leading to the page of the pair."""
    partners = [name for name in lookup.architecture.partners if any(name in pair for pair in counts)]
    places = {name: place for place, name in enumerate(partners)}
    flows = (
        MatrixFlow(places[giver], places[taker], "interface", references[giver, taker])
        for (giver, taker), count in counts.items()
        for _ in range(count)
    )
    return Matrix(
        "partners",
        "Who owes whom",
        tuple(MatrixEntry(join_owner_titles(lookup, [name]), f"partner:{name}") for name in partners),
        tuple(flows),
        row_word="partner",
        flow_word="interface",
        order="as the project declares them",
        # Between partners neither direction is one to avoid.
        marks_back=False,
        related=(("Components", "page:matrix"),),
    )


@dataclass(frozen=True, slots=True)
class _SquareKind:
    """What a square matrix is of: its id and title, what a row and a group are called, and what is counted."""

    id: str
    title: str
    row_word: str
    group_word: str = ""
    flow_word: str = "flow"


@dataclass(frozen=True, slots=True)
class _Grouping:
    """The group of each entry that has one, and the entry of each group; both by id."""

    groups: Mapping[str, str]
    entries: Mapping[str, MatrixEntry]


def _make_square(
    kind: _SquareKind, entries: Mapping[str, MatrixEntry], flows: Iterable[Flow], grouping: _Grouping
) -> Matrix:
    """Make a square matrix in the order with the least feedback: of groups, and within each group."""
    shown_flows = [flow for flow in flows if flow[0] in entries and flow[1] in entries and flow[0] != flow[1]]
    order, group_order, is_exact = _order_entries(list(entries), shown_flows, grouping.groups)
    places = {name: place for place, name in enumerate(order)}
    group_places = {name: place for place, name in enumerate(group_order)}
    rows = (replace(entries[name], group=group_places.get(grouping.groups.get(name, ""))) for name in order)
    return Matrix(
        kind.id,
        kind.title,
        tuple(rows),
        tuple(MatrixFlow(places[giver], places[taker], what, ref) for giver, taker, what, ref in shown_flows),
        groups=tuple(grouping.entries[name] for name in group_order),
        row_word=kind.row_word,
        group_word=kind.group_word,
        flow_word=kind.flow_word,
        order=_EXACT_ORDER if is_exact else _GREEDY_ORDER,
    )


def _order_entries(
    names: Sequence[str], flows: Sequence[Flow], groups: Mapping[str, str]
) -> tuple[list[str], list[str], bool]:
    """Return the order of entries and of their groups, and whether both are the best there are."""

    def find_outer(name: str) -> tuple[str, bool]:
        group = groups.get(name)
        return (group, True) if group else (name, False)

    outer_weights = Counter((find_outer(giver), find_outer(taker)) for giver, taker, _, _ in flows)
    outer_order: FeedbackOrder[tuple[str, bool]] = order_by_feedback(
        dict.fromkeys(map(find_outer, names)), outer_weights
    )
    inner_weights = Counter((giver, taker) for giver, taker, _, _ in flows if find_outer(giver) == find_outer(taker))
    members: dict[tuple[str, bool], list[str]] = {}
    for name in names:
        members.setdefault(find_outer(name), []).append(name)
    inner_orders = [order_by_feedback(members[key], inner_weights) for key in outer_order.elements]
    order = [name for inner_order in inner_orders for name in inner_order.elements]
    is_exact = outer_order.is_exact and all(inner_order.is_exact for inner_order in inner_orders)
    return order, [key for key, is_group in outer_order.elements if is_group], is_exact


def make_requirement_matrix(lookup: Lookup) -> Matrix:
    """Make the matrix of requirements against the components and chains that serve them; what nobody serves comes first."""
    architecture = lookup.architecture
    requirements = requirement_tables.shown_requirements(lookup)
    requirements = sorted(requirements, key=lambda each: each.id in lookup.requirement_trace.served)
    servers = {r.id: lookup.components_for_requirement.get(r.id, ()) for r in requirements}
    chains = {r.id: lookup.chains_for_requirement.get(r.id, ()) for r in requirements}
    serving_ids = {component.id for served in servers.values() for component in served}
    components = [component for component in lookup.nested_components() if component.id in serving_ids]
    serving_chains = {chain.id: chain for served in chains.values() for chain in served}
    columns = [f"component:{component.id}" for component in components] + [f"chain:{name}" for name in serving_chains]
    places = {anchor: place for place, anchor in enumerate(columns)}
    group_places = {name: place for place, name in enumerate(dict.fromkeys(each.group for each in components))}
    links = [
        (row, requirement, f"{kind}:{server.id}", server.title)
        for row, requirement in enumerate(requirements)
        for kind, served in (("component", servers[requirement.id]), ("chain", chains[requirement.id]))
        for server in served
    ]
    chain_group = (MatrixEntry("Chains", "page:timing"),) if serving_chains else ()
    return Matrix(
        "requirements",
        "Requirements and components",
        tuple(MatrixEntry(f"{r.id} {r.title}", f"requirement:{r.id}") for r in requirements),
        tuple(
            MatrixFlow(row, places[anchor], f"{requirement.id} by {title}", anchor)
            for row, requirement, anchor, title in links
            if anchor in places
        ),
        (
            *(MatrixEntry(each.title, f"component:{each.id}", group=group_places[each.group]) for each in components),
            *(
                MatrixEntry(chain.title, f"chain:{chain.id}", group=len(group_places))
                for chain in serving_chains.values()
            ),
        ),
        (*(MatrixEntry(architecture.groups[name].title, f"group:{name}") for name in group_places), *chain_group),
        row_word="requirement",
        flow_word="link",
        giver_word="columns serve rows",
        order="as declared, what nobody serves first",
    )
