"""What readers may count on in figures: promises, deadlines and freshness; and how two versions keep them.

The timing of both versions is analysed only if a change can affect it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.analyses.kept_promises import PROMISED_WORDS, judge_promises, judge_sent_limits, list_sent_limits
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.comparison import Change, LimitChange
from archgen.compare.key_phrases import tick_names
from archgen.compare.kinds import Effect, find_effect
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import NamedTuple, dataclass
from archgen.model.architecture import Architecture
from archgen.model.component_nesting import list_described_outputs, list_relied_outputs
from archgen.model.promise import FIGURE_KEYS, Promise
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis, HostLoad, LinkLoad
from archgen.timing.chains.chain_verdicts import LimitState, find_read_ages, find_worst_state
from archgen.timing.figures.figure_wording import format_compared, format_duration, format_rate
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture


@dataclass(frozen=True, slots=True)
class TimingPair:
    """The timing analyses of both versions."""

    before: Analysis
    after: Analysis


def analyse_timing_pair(
    old_version: ArchitectureVersion, new_version: ArchitectureVersion, changes: Sequence[Change]
) -> TimingPair | None:
    """Analyse both versions if there are chains or interfaces of partners to compare, or an overloaded host or link; else
    return None.
    """
    before, after = old_version.architecture, new_version.architecture
    if before.unread_keys or after.unread_keys:  # of what could not be read nobody knows how long it takes
        return None
    has_figures = before.chains or after.chains or before.partners or after.partners
    is_asked = any(can_affect_timing(change) or _asks_for_figures(change) for change in changes)
    if not (has_figures or after.hosts or after.links) or not is_asked:
        return None
    new_analysis = _analysis_of(new_version)
    loads: list[HostLoad | LinkLoad] = [*new_analysis.hosts.values(), *new_analysis.links.values()]
    if not has_figures and not any(map(is_overloaded, loads)):
        return None
    return TimingPair(_analysis_of(old_version), new_analysis)


def _analysis_of(version: ArchitectureVersion) -> Analysis:
    return version.analysis or analyse_architecture(version.architecture, judging=True)


def can_affect_timing(change: Change) -> bool:
    """Whether a change can affect a figure of timing."""
    # Renames and moves change no figure.
    return (
        change.kind in {"added", "removed", "changed"} and find_effect(change.element_kind, change.key) is Effect.TIMING
    )


_WORD_KEYS = frozenset({"title", "functionality", "description"})
"""Not `external`, a text as well: from outside nobody may be served any more."""


def is_rewording(change: Change) -> bool:
    """Whether a change gives an element another title or text: no figure and no connection depends on these."""
    is_text = change.key in _WORD_KEYS and find_effect(change.element_kind, change.key) is Effect.TEXT
    return is_text and change.kind == "changed"


def _asks_for_figures(change: Change) -> bool:
    """Whether a change says what figures have to keep, and changes none of them."""
    return change.key is not None and (change.key == "qos" or "promise." in change.key)


def is_overloaded(load: HostLoad | LinkLoad) -> bool:
    """Whether a host or a link is asked for more than it has."""
    if isinstance(load, LinkLoad):
        return load.share.value is not None and load.share.value >= 1
    return any(used_cores.value is not None and used_cores.value >= cores for _, cores, used_cores in load.core_loads)


def find_activity_owners(names: Iterable[str], architecture: Architecture, analysis: Analysis) -> frozenset[str]:
    """Return who owns any of the activities: the owners of their components, else of their nodes."""
    return frozenset(owner for name in names for owner in _owners_of(name, architecture, analysis))


def _owners_of(name: str, architecture: Architecture, analysis: Analysis) -> tuple[str, ...]:
    # A chain of which no way is known names its points as written, and these may be ports.
    activity = analysis.system.activities.get(name)
    component = architecture.components.get(activity.component or "" if activity else name)
    return component.owners if component else architecture.nodes[activity.node].owners if activity else ()


AskedLimits = Mapping[tuple[str, str], Quantity]
"""The limits of a version by port (its common id) and key, as `LimitChange` has them."""


class LimitKey(NamedTuple):
    """A limit as `LimitChange` has it: by common ids."""

    port: str
    key: str
    reader: str = ""


@dataclass(frozen=True, slots=True)
class JudgedLimit:
    """A limit with what follows from the figures of a version: a rate in Hz, or a duration in ns."""

    limit: Quantity
    bound: TimingValue
    state: LimitState


def read_limits(architecture: Architecture, matched_ids: MatchedIds) -> dict[tuple[str, str], Quantity]:
    """Return what a version asks for and promises."""
    limits: dict[tuple[str, str], Quantity] = {}
    for _, output in list_described_outputs(architecture):
        for key in FIGURE_KEYS if output.promise else ():
            if limit := getattr(output.promise, key):
                limits[_name_output(architecture, matched_ids, output.id), key] = limit
    for endpoint in architecture.endpoints:
        for key, limit in list_sent_limits(architecture, endpoint):
            # Where several nodes send it, whoever promises most binds all.
            known = limits.get((port := matched_ids.common_id("output", endpoint.port or ""), key))
            limits[port, key] = _find_stricter(key, limit, known) if known else limit
    for entry in architecture.inputs.values():
        if entry.freshness:
            limits[matched_ids.common_id("input", entry.id), "freshness"] = entry.freshness
    return limits


def combine_stricter(first: AskedLimits, second: AskedLimits) -> AskedLimits:
    """Return the limits of two versions, of each the stricter one."""
    both = {key: _find_stricter(key[1], limit, second[key]) for key, limit in first.items() if key in second}
    # A written gap is a figure as well: that it is longer, or gone, is a weaker promise in so many words.
    written = {key: limit for key, limit in second.items() if key[1] == "timing.max_gap"}
    return {**{key: limit for key, limit in first.items() if key[1] != "timing.max_gap"}, **second, **both, **written}


def _find_stricter(key: str, first: Quantity, second: Quantity) -> Quantity:
    return (max if key == "rate" else min)((first, second), key=lambda limit: limit.value)


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
    judged: dict[LimitKey, list[JudgedLimit]] = defaultdict(list)
    asked_ports = {port for port, _ in limits}
    names = {
        each.id: _name_output(architecture, matched_ids, each.id) for _, each in list_described_outputs(architecture)
    }
    promises = {
        own_id: Promise(**{key: limits[name, key] for key in FIGURE_KEYS if (name, key) in limits})  # type: ignore[arg-type]
        for own_id, name in names.items()
        if name in asked_ports
    }
    for each in judge_promises(architecture, analysis, promises):
        reader = matched_ids.common_id("input", each.read_over.input) if each.read_over else ""
        judged[LimitKey(names[each.port], each.key, reader)].append(JudgedLimit(each.limit, each.bound, each.state))
    for port, key, limit, gap, state in judge_sent_limits(
        architecture, analysis, lambda port, key: limits.get((matched_ids.common_id("output", port), key))
    ):
        judged[LimitKey(matched_ids.common_id("output", port), key)].append(JudgedLimit(limit, gap, state))
    inputs = {port: matched_ids.common_id("input", port) for port in architecture.inputs}
    asked = {port: needed for port, name in inputs.items() if (needed := limits.get((name, "freshness")))}
    for read_age in find_read_ages(analysis, {port: needed.value for port, needed in asked.items()}):
        port = read_age.arc.input
        judged[LimitKey(inputs[port], "freshness")].append(JudgedLimit(asked[port], read_age.age, read_age.state))
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
    if not asked_before:
        return ()
    judged_before = judge_limits(before, timing_pair.before, matched_ids, asked_before)
    judged_after = judge_limits(after, timing_pair.after, MatchedIds(), combine_stricter(asked_before, asked_after))
    return tuple(
        LimitChange(
            *key,
            new.limit,
            old.bound,
            new.bound,
            old.state,
            new.state,
            asked_after.get(key[:2]) != old.limit,
            frozenset(_find_owners(after, key) if new.state == "broken" != old.state else ()),
        )
        for key, new in sorted(judged_after.items())
        if (old := judged_before.get(key)) and (old.state, old.bound) != (new.state, new.bound)
    )


def _find_owners(architecture: Architecture, key: LimitKey) -> Iterator[str]:
    """Yield who owns the port that asks or promises, and who reads an age."""
    for port in filter(None, (key.port, key.reader)):
        component = architecture.find_component(port.rpartition(".")[0])
        yield from component.owners if component else ()


def list_reliers(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[tuple[str, str]]:
    """Yield each output that an input of a leaf counts on, by common ids: as the reader names it, and that of the leaf."""
    for counted in list_relied_outputs(architecture):
        if counted.reader.id in architecture.inputs:
            reader = matched_ids.common_id("input", counted.reader.id)
            for port in dict.fromkeys((counted.port.id, counted.leaf.id)):
                yield _name_output(architecture, matched_ids, port), reader


def describe_limit(limit: LimitChange) -> str:
    """Name what is asked: `the promise of x of gaps of at most 130 ms`."""
    if limit.key == "freshness":
        return f"the freshness of {limit.limit} of what {tick_names([limit.port])} reads"
    if limit.key == "qos.deadline":
        return f"the deadline of {limit.limit} that is offered for {tick_names([limit.port])}"
    if limit.key == "timing.max_gap":
        return f"the largest gap of {limit.limit} of {tick_names([limit.port])}"
    return f"the promise of {tick_names([limit.port])} of {PROMISED_WORDS[limit.key]}{limit.limit}"


def describe_growth(limit: LimitChange) -> str:
    """Return what followed from the figures before, and what does now: `112 ms → 172 ms`."""
    values = [value.value for value in (limit.before, limit.after) if value.value is not None]
    is_rate = limit.key == "rate"
    write = format_rate if is_rate else format_duration
    texts = iter(format_compared(values, write, upwards=not is_rate, limit=limit.limit.value))
    phrases = [_describe_value(value, texts) for value in (limit.before, limit.after)]
    return phrases[1] if phrases[0] == phrases[1] else " → ".join(phrases)


def _describe_value(value: TimingValue, texts: Iterator[str]) -> str:
    text = next(texts) if value.value is not None else "no bound"
    if value.missing and not value.complete:
        return f"not known without figures of {tick_names(sorted(value.missing), 4)}"
    return text
