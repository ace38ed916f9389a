"""What is known of each requirement: served, verified, met; each computed once for the whole architecture."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.frozen import dataclass, field
from archgen.model.architecture import Architecture
from archgen.model.requirement import add_above, add_wholes, index_parts
from archgen.views.shapes import Status


@dataclass(frozen=True, slots=True)
class RequirementTrace:
    """The ids of requirements by what holds of them. A requirement with parts has what all of its parts have."""

    parts: Mapping[str, list[str]] = field(default_factory=dict)
    """The direct parts of each requirement that has any."""
    served: frozenset[str] = frozenset()
    verified: frozenset[str] = frozenset()
    missed: frozenset[str] = frozenset()
    """Those that a chain serves or verifies which misses its deadline, and all that these are part of."""
    unfinished: frozenset[str] = frozenset()
    """Those of which a part is not served, or a chain is not proven to meet its deadline."""
    is_verification_told: bool = False
    """Whether the project says of any requirement what verifies it. One that says it nowhere is not asked."""

    def judge(self, requirement_id: str) -> Status:
        """Return the state of a requirement: uncovered, missed, open (nothing shows yet that it is met), or met."""
        if requirement_id not in self.served:
            return "uncovered"
        if requirement_id in self.missed:
            return "missed"
        is_unverified = self.is_verification_told and requirement_id not in self.verified
        return "open" if is_unverified or requirement_id in self.unfinished else "met"


def trace_requirements(
    architecture: Architecture, served_ids: Iterable[str], chain_verdicts: Mapping[str, str]
) -> RequirementTrace:
    """Return what is known of all requirements.

    `served_ids` are those that a component or chain names, `chain_verdicts` the verdicts on chains (met, missed, not
    proven, open) by id, as far as timing was analysed.
    """
    requirements = architecture.requirements
    if not requirements:
        return RequirementTrace()
    parts = index_parts(requirements)
    served = add_wholes(requirements, served_ids)
    own_verified = {each.id for each in requirements.values() if each.verified_by}
    verified = add_wholes(requirements, own_verified)
    missed = set(_list_judged(architecture, chain_verdicts, {"missed"}))
    unproven = set(_list_judged(architecture, chain_verdicts, {"not proven", "open"}))
    unfinished = unproven.union(each for each in requirements if each not in served)
    return RequirementTrace(
        parts,
        served,
        verified,
        add_above(requirements, missed) | missed,
        add_above(requirements, unfinished) | unproven,
        bool(own_verified),
    )


def _list_judged(architecture: Architecture, chain_verdicts: Mapping[str, str], verdicts: set[str]) -> Iterator[str]:
    """Yield the requirements that a chain with such a verdict serves or verifies."""
    chain_ids = {
        chain
        for chain, verdict in chain_verdicts.items()
        if verdict in verdicts and architecture.chains[chain].deadline is not None
    }
    for chain in sorted(chain_ids):
        yield from (name for name in architecture.chains[chain].requirements if name in architecture.requirements)
    for requirement in architecture.requirements.values() if chain_ids else ():
        if any(each.kind == "chain" and each.text in chain_ids for each in requirement.verified_by):
            yield requirement.id
