"""Compare two versions as a whole: changes, findings, chains and the owners concerned."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from archgen.compare.breaking import breaking, idle, severity
from archgen.compare.chains import chains
from archgen.compare.change import Comparison
from archgen.compare.differences import Differences
from archgen.compare.elements import Element, Key, both
from archgen.compare.findings import findings
from archgen.compare.losses.both import Both
from archgen.compare.match import match
from archgen.compare.names import Names
from archgen.compare.owners import owners
from archgen.compare.timed import timed
from archgen.compare.told import Told
from archgen.compare.version import Version
from archgen.compare.wiring import wires
from archgen.diagnostic import Severity
from archgen.model.architecture import Architecture
from archgen.model.review import Accepted


def compare(before: Version, after: Version) -> Comparison:
    """Compare two versions of an architecture."""
    # Matching comes first: everything below lists the first version under the ids of the second.
    names = match(before.architecture, after.architecture)
    listed = both(before, after, names)
    old, new = wires(before.architecture, names), wires(after.architecture, Names())
    lost = before.architecture.lost, after.architecture.lost
    told = Told(old, new, *listed, (_serving(listed[0]), _serving(listed[1])), lost, _unnamed(after.architecture))
    changes = Differences(*listed, names, told).all(old, new)
    judged = findings(before, after, names)
    timing = timed(before.architecture, after.architecture, changes)
    # Chains are needed twice: for the report, and as causes of losses in `mark_breaking_changes`.
    moved = chains(before.architecture, after.architecture, names, timing)
    policy = severity(before.architecture.review, after.architecture.review)
    unused: tuple[Accepted, ...] = ()
    if policy is not Severity.OFF:
        changes = breaking(Both(before.architecture, after.architecture, names, told, changes), moved, timing)
        unused = idle(changes, after.architecture.review)
    return Comparison(
        before,
        after,
        names,
        told,
        changes,
        judged.new,
        judged.cured,
        moved,
        owners(changes, told),
        judged.silenced,
        breaking=policy,
        idle=unused,
    )


def _unnamed(found: Architecture) -> frozenset[str]:
    """Return the outputs of written nodes whose topic, service or action has no written name."""
    written = {node.id for node in found.nodes.values() if node.written}
    ends = (end for end in found.endpoints if end.node in written and end.use in {"publishes", "serves"})
    return frozenset(end.port for end in ends if end.port and not end.name_written)


def _serving(listed: Mapping[Key, Element]) -> Mapping[str, frozenset[str]]:
    """Return for each requirement the components that name it."""
    found: dict[str, set[str]] = defaultdict(set)
    for (sort, name), element in listed.items():
        named = element.values.get("requirements") if sort == "component" else None
        for requirement in named if isinstance(named, frozenset) else ():
            found[requirement].add(name)
    return {requirement: frozenset(names) for requirement, names in found.items()}
