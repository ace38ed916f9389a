"""What readers may count on in figures: promises of rate, gap and age, and freshness; how two versions keep them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from archgen.analyses.kept_promises import judge_promises
from archgen.compare.figure_changes import LimitChange
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.timing_pair import TimingPair
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.promise import FIGURE_KEYS, Promise
from archgen.model.quantity import Quantity
from archgen.model.relied_outputs import list_described_outputs, list_relied_outputs
from archgen.timing.analysis import Analysis
from archgen.timing.chains.limit_states import LimitState, find_worst_state
from archgen.timing.chains.read_ages import find_read_ages
from archgen.timing.figures.timing_values import TimingValue


class LimitKey(NamedTuple):
    """A limit by common ids: the port that asks or promises, `rate`, `max_gap`, `max_age` or `freshness`, and of an age
    the input where it is read.
    """

    port: str
    key: str
    reader: str = ""


@dataclass(frozen=True, slots=True)
class AskedLimits:
    """The limits of a version by port: what outputs promise, and the freshness that inputs ask for."""

    promises: Mapping[str, Promise]
    freshness: Mapping[str, Quantity]

    @classmethod
    def of_one(cls, key: LimitKey, limit: Quantity) -> AskedLimits:
        """Return limits of which there is one alone."""
        if key.key == "freshness":
            return cls({}, {key.port: limit})
        return cls({key.port: Promise(**{key.key: limit})}, {})  # type: ignore[arg-type]

    def find(self, key: LimitKey) -> Quantity | None:
        """Return a limit, None where nobody asks for it."""
        if key.key == "freshness":
            return self.freshness.get(key.port)
        limit: Quantity | None = getattr(self.promises.get(key.port), key.key, None)
        return limit

    def combine_stricter(self, other: AskedLimits) -> AskedLimits:
        """Return the limits of both, of each the stricter one."""
        promises = dict(other.promises)
        for port, promise in self.promises.items():
            pairs = {key: (getattr(promise, key), getattr(other.promises.get(port), key, None)) for key in FIGURE_KEYS}
            promises[port] = Promise(**{key: _stricter(key, *pair) for key, pair in pairs.items()})
        freshness = {**other.freshness}
        for port, limit in self.freshness.items():
            freshness[port] = _stricter("freshness", limit, other.freshness.get(port)) or limit
        return AskedLimits(promises, freshness)


def _stricter(key: str, first: Quantity | None, second: Quantity | None) -> Quantity | None:
    if first is None or second is None:
        return first or second
    return (max if key == "rate" else min)((first, second), key=lambda limit: limit.value)


@dataclass(frozen=True, slots=True)
class JudgedLimit:
    """A limit with what follows from the figures of a version: a rate in Hz, or a duration in ns."""

    limit: Quantity
    bound: TimingValue
    state: LimitState


def read_limits(architecture: Architecture, matched_ids: MatchedIds) -> AskedLimits:
    """Return what a version asks for, by common ids."""
    promises = {
        _name_output(architecture, matched_ids, output.id): output.promise
        for _, output in list_described_outputs(architecture)
        if output.promise
    }
    freshness = {
        matched_ids.common_id("input", port.id): port.freshness
        for port in architecture.inputs.values()
        if port.freshness
    }
    return AskedLimits(promises, freshness)


def _name_output(architecture: Architecture, matched_ids: MatchedIds, port: str) -> str:
    """Return the common id of an output of a leaf, or of a composed component."""
    shell, _, name = port.rpartition(".")
    if shell in architecture.shells:
        return f"{matched_ids.common_id('composed', shell)}.{name}"
    return matched_ids.common_id("output", port)


def judge_limits(
    architecture: Architecture, analysis: Analysis, matched_ids: MatchedIds, limits: AskedLimits
) -> dict[LimitKey, JudgedLimit]:
    """Return how a version keeps limits, by common ids; without those whose ends it does not have."""
    own_ports = {
        output.id: _name_output(architecture, matched_ids, output.id)
        for _, output in list_described_outputs(architecture)
    }
    promises = {own: limits.promises[port] for own, port in own_ports.items() if port in limits.promises}
    judged: dict[LimitKey, list[JudgedLimit]] = defaultdict(list)
    for each in judge_promises(architecture, analysis, promises):
        reader = matched_ids.common_id("input", each.read_over.input) if each.read_over else ""
        key = LimitKey(own_ports[each.port], each.key, reader)
        judged[key].append(JudgedLimit(each.limit, each.bound, each.state))
    asked = {
        port: limit
        for port in architecture.inputs
        if (limit := limits.freshness.get(matched_ids.common_id("input", port)))
    }
    for read_age in find_read_ages(analysis, {port: limit.value for port, limit in asked.items()}):
        port = read_age.arc.input
        key = LimitKey(matched_ids.common_id("input", port), "freshness")
        judged[key].append(JudgedLimit(asked[port], read_age.age, read_age.state))
    return {key: _find_worst(each) for key, each in judged.items()}


def _find_worst(judged: list[JudgedLimit]) -> JudgedLimit:
    """Return the one of several figures that is farthest from keeping a limit."""
    state = find_worst_state(each.state for each in judged)
    worst = [each for each in judged if each.state == state]
    return max(worst, key=lambda each: (each.bound.value is None, each.bound.value or 0))


def compare_limits(
    before: Architecture, after: Architecture, matched_ids: MatchedIds, timing_pair: TimingPair | None
) -> tuple[LimitChange, ...]:
    """Return the limits that are kept otherwise than before, sorted; the stricter one of both versions counts.

    Nobody can say so where a version could not be read.
    """
    if timing_pair is None:
        return ()
    asked_before, asked_after = read_limits(before, matched_ids), read_limits(after, MatchedIds())
    judged_before = judge_limits(before, timing_pair.before, matched_ids, asked_before)
    if not (judged_before or asked_after.promises or asked_after.freshness):
        return ()
    judged_after = judge_limits(after, timing_pair.after, MatchedIds(), asked_before.combine_stricter(asked_after))
    return tuple(
        LimitChange(*key, new.limit, old.bound, new.bound, old.state, new.state, asked_after.find(key) != old.limit)
        for key, new in sorted(judged_after.items())
        if (old := judged_before.get(key)) and (old.state, old.bound) != (new.state, new.bound)
    )


def list_reliers(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[tuple[str, str]]:
    """Yield each output as its readers name it with an input of a leaf that counts on its word, by common ids."""
    for counted in list_relied_outputs(architecture):
        if counted.reader.id in architecture.inputs:
            port = _name_output(architecture, matched_ids, counted.port.id)
            yield port, matched_ids.common_id("input", counted.reader.id)
