"""The whole comparison, from two versions to changes, findings, chains and owners."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from archgen.compare.chains import chains
from archgen.compare.change import Comparison
from archgen.compare.differences import Differences
from archgen.compare.elements import Element, Key, elements
from archgen.compare.findings import findings
from archgen.compare.match import match
from archgen.compare.names import Names
from archgen.compare.owners import owners
from archgen.compare.told import Told
from archgen.compare.version import Version
from archgen.compare.wiring import wires


def compare(before: Version, after: Version) -> Comparison:
    """Compare two versions of an architecture."""
    names = match(before.architecture, after.architecture)
    listed = elements(before, names), elements(after, Names())
    old, new = wires(before.architecture, names), wires(after.architecture, Names())
    lost = before.architecture.lost, after.architecture.lost
    told = Told(old, new, *listed, (_serving(listed[0]), _serving(listed[1])), lost)
    changes = Differences(*listed, names, told).all(old, new)
    appeared, cured = findings(before.findings, after.findings, names)
    return Comparison(
        before,
        after,
        names,
        told,
        changes,
        appeared,
        cured,
        chains(before.architecture, after.architecture, names, changes),
        owners(changes, told),
    )


def _serving(listed: Mapping[Key, Element]) -> Mapping[str, frozenset[str]]:
    """Give the components that name each requirement."""
    found: dict[str, set[str]] = defaultdict(set)
    for (sort, name), element in listed.items():
        named = element.values.get("requirements") if sort == "component" else None
        for requirement in named if isinstance(named, frozenset) else ():
            found[requirement].add(name)
    return {requirement: frozenset(names) for requirement, names in found.items()}
