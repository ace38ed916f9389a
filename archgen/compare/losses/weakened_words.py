"""Outputs that promise less than before to those who read them, have another version, or are going away.

What counts is the port that a reader names: of a composed component its own output, not what is inside.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cached_property

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.component import ComponentType, Output
from archgen.model.component_nesting import list_relied_outputs
from archgen.model.message_types import ConceptualType
from archgen.model.project_settings import BreakCategory
from archgen.model.promise import Deprecation, Promise, format_range


class _Weakening(NamedTuple):
    """What is promised less, in words: it stands behind the name of the output. `key` is what says it."""

    words: str
    key: str
    category: BreakCategory = "promise"


_Living = Output | ConceptualType | ComponentType
_Reading = tuple[str, str]
"""An input and the leaf's output that it reads, by common ids."""


def find_weakened_words(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs of which less is promised than before, that have another version, or are deprecated now."""
    if not any(
        output.promise is not None or output.version is not None or output.deprecated is not None
        for output in _list_outputs(context.before)
    ) and not any(output.deprecated for output in _list_outputs(context.after)):
        return
    yield from _WordComparison(context).list_losses()


def _list_outputs(architecture: Architecture) -> Iterator[Output]:
    yield from architecture.outputs.values()
    yield from (output for shell in architecture.shells.values() for output in shell.outputs.values())


class _WordComparison:
    """What is said of outputs in two versions, as their readers see it."""

    def __init__(self, context: ChangeContext) -> None:
        self._context = context

    def list_losses(self) -> Iterator[PartnerLoss]:
        """Yield what partners lose, output by output."""
        context = self._context
        for leaf, new_leaf, inputs_by_partner in context.lasting_outputs:
            readers: dict[tuple[str, str], dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
            for partner, inputs in inputs_by_partner.items():
                for reader in inputs:
                    old_port = self._ports_before.get((reader, leaf))
                    new_port = self._find_new_port(reader, leaf, new_leaf, old_port)
                    if old_port is not None and new_port is not None:
                        readers[old_port.id, new_port.id][partner].append(reader)
            for (old_id, new_id), parts in readers.items():
                old_port, new_port = self._outputs_before[old_id], self._outputs_after[new_id]
                for weakening in _find_weakenings(context.matched_ids, old_port, new_port):
                    causes = self._find_causes(leaf, new_port, weakening.key)
                    reason_text = f"{weakening.words.replace('{}', tick_name(old_id), 1)}; {{}} it"
                    yield from context.shared_losses(causes, parts, reason_text, "reads", weakening.category)

    @cached_property
    def _ports_before(self) -> Mapping[_Reading, Output]:
        return _index_readings(self._context.before, self._context.matched_ids)

    @cached_property
    def _ports_after(self) -> Mapping[_Reading, Output]:
        return _index_readings(self._context.after, MatchedIds())

    @cached_property
    def _outputs_before(self) -> Mapping[str, Output]:
        # Composed ones last: what is open of one has its id, and the same words.
        return {output.id: output for output in _list_outputs(self._context.before)}

    @cached_property
    def _outputs_after(self) -> Mapping[str, Output]:
        return {output.id: output for output in _list_outputs(self._context.after)}

    def _find_new_port(self, reader: str, leaf: str, new_leaf: str, old_port: Output | None) -> Output | None:
        """Return the port that a reader counts on now; if it reads no more, the one that it counted on before."""
        if (reader, new_leaf) in self._ports_after:
            return self._ports_after[reader, new_leaf]
        if old_port is None or old_port.id == self._context.old_id("output", leaf):
            return self._outputs_after.get(new_leaf)
        component_id, _, name = old_port.id.rpartition(".")
        common_id = f"{self._context.matched_ids.common_id('composed', component_id)}.{name}"
        return self._outputs_after.get(common_id) or self._outputs_after.get(new_leaf)

    def _find_causes(self, leaf: str, new_port: Output, key: str) -> list[int]:
        """Return the indices of the changes that say it: at the output, at the composed component, or what it passes on."""
        context = self._context
        group = key.partition(".")[0]
        shell, _, name = new_port.id.rpartition(".")
        for kind, element, beginning in (
            ("output", new_port.id, key),
            ("composed", shell, f"outputs.{name}:{key}"),
            ("output", leaf, key),
            ("output", new_port.id, group),
            ("composed", shell, f"outputs.{name}:{group}"),
        ):
            if indices := context.indices_below(kind, element, beginning):
                return indices
        return find_output_causes(context, leaf)


def _index_readings(architecture: Architecture, matched_ids: MatchedIds) -> dict[_Reading, Output]:
    readings: dict[_Reading, Output] = {}
    for counted in list_relied_outputs(architecture):
        if counted.reader.id in architecture.inputs:
            reading = (
                matched_ids.common_id("input", counted.reader.id),
                matched_ids.common_id("output", counted.leaf.id),
            )
            readings.setdefault(reading, counted.port)
    return readings


def _find_weakenings(matched_ids: MatchedIds, old: Output, new: Output) -> Iterator[_Weakening]:
    yield from _compare_promises(matched_ids, old.promise or Promise(), new.promise or Promise())
    yield from compare_lives(old, new)


def compare_lives(old: _Living, new: _Living) -> Iterator[_Weakening]:
    """Yield that something has another version, is deprecated now, or until an earlier day; `{}` stands for its name."""
    if old.version is not None and old.version != new.version:
        after = f"the version {tick_name(new.version)}" if new.version else "no version any more"
        yield _Weakening(f"gives {{}} {after} instead of {tick_name(old.version)}", "version", "meaning")
    yield from _compare_deprecations(old.deprecated, new.deprecated)


def _compare_deprecations(old: Deprecation | None, new: Deprecation | None) -> Iterator[_Weakening]:
    if new is None:
        return
    until = f"until {new.until}" if new.until else "without a day"
    instead = f", and names {tick_name(new.use)} instead" if new.use else ""
    if old is None:
        yield _Weakening(
            f"keeps {{}} {until} only{instead}" if new.until else f"deprecates {{}} {until}{instead}",
            "deprecated.until",
        )
    elif new.until and (old.until is None or new.until < old.until):
        before = f"instead of {old.until}" if old.until else "only"
        yield _Weakening(f"keeps {{}} {until} {before}", "deprecated.until")


def _compare_promises(matched_ids: MatchedIds, old: Promise, new: Promise) -> Iterator[_Weakening]:
    for key, noun in (("rate", "rate"), ("max_gap", "largest gap"), ("max_age", "greatest age")):
        before, after = getattr(old, key), getattr(new, key)
        if before is None:
            continue
        if after is None:
            yield _Weakening(f"promises for {{}} no {noun} any more (it was {before})", f"promise.{key}")
        elif (after.value < before.value) if key == "rate" else (after.value > before.value):
            yield _Weakening(f"promises for {{}} a {noun} of {after} instead of {before}", f"promise.{key}")
    if old.range is not None and (new.range is None or new.range[0] < old.range[0] or new.range[1] > old.range[1]):
        before = format_range(old.range, old.unit)
        if new.range is None:
            yield _Weakening(f"promises for {{}} no range any more (it was {before})", "promise.range")
        else:
            yield _Weakening(
                f"promises for {{}} values of {format_range(new.range, new.unit)} instead of {before}", "promise.range"
            )
    if old.unit is not None and new.unit != old.unit:
        after = f"in {tick_name(new.unit)}" if new.unit else "in no named unit"
        yield _Weakening(f"gives {{}} {after} instead of {tick_name(old.unit)}", "promise.unit", "meaning")
    if old.frame is not None and matched_ids.common_id("frame", old.frame) != new.frame:
        after = f"in the frame {tick_name(new.frame)}" if new.frame else "in no named frame"
        yield _Weakening(f"gives {{}} {after} instead of {tick_name(old.frame)}", "promise.frame", "meaning")
