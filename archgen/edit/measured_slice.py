"""The slice `measured.yaml`: execution times that were measured, for everything that no other file writes.

It is whole or nothing. What a slice of this name holds already stays in it.

Sort measured execution times: which of them a slice may hold, and which of them other files write already.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from archgen import pipeline
from archgen.compose import list_type_entries
from archgen.diagnostics import NO_SPAN, Diagnostic, Span
from archgen.edit.edit_proof import list_new_errors, list_written_nodes, load_with_text
from archgen.emit.own_file_marks import MEASURED_HEADER
from archgen.frozen import dataclass, field, replace
from archgen.model.declared_timing import Timing
from archgen.model.node import Node
from archgen.model.quantity import parse_quantity
from archgen.pipeline import CheckedProject
from archgen.project.project_loading import LoadedProject
from archgen.project.slice_parsing import parse_slice
from archgen.syntax import yaml_parser
from archgen.syntax.project_files import read_text_file
from archgen.syntax.yaml_tree import node_to_data
from archgen.syntax.yaml_writer import ElementPath, format_flow, write_yaml
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.system.activity_builder import name_activities


@dataclass(frozen=True, slots=True)
class MeasuredSlice:
    """The text of the slice; which figures are in it, which are not; the errors that it would cause."""

    file: str
    text: str
    adopted: tuple[tuple[str, str], ...]
    left_out: tuple[LeftOutFigure, ...]
    errors: tuple[Diagnostic, ...]
    is_read: bool
    """Whether the project reads the file, by its `sources`."""


def make_measured_slice(
    checked_project: CheckedProject, observations: Iterable[Observation], file: str
) -> MeasuredSlice:
    """Return the slice that adopts what was measured; `file` is its path in the project."""
    files = checked_project.loaded_project.files
    old_file = read_text_file(files, file) if files.has_path(file) else None
    old_text = old_file.text if old_file else ""
    data, diagnostics = _read_data(file, old_text)
    errors = [*diagnostics, *([old_file.problem] if old_file and old_file.problem else [])]
    if errors:
        # What cannot be read cannot be kept either.
        return MeasuredSlice(file, "", (), (), tuple(errors), is_read=True)
    # Without the slice itself, so that what it holds already is not taken for written elsewhere.
    others = pipeline.judge_project(load_with_text(checked_project, file, "{}\n")) if old_text else checked_project
    sorter = FigureSorter(others, data)
    adopted = [entry for times in collect_times(observations) for entry in sorter.add_times(times)]
    text = MEASURED_HEADER + write_yaml(data, dict.fromkeys(sorter.storing_paths, "measured, not proven"))
    loaded_project = load_with_text(checked_project, file, text)
    is_read = file in loaded_project.sources.file_names()
    if not is_read:
        loaded_project = _add_slice(loaded_project, file, text)
    new_errors = tuple(list_new_errors(checked_project, pipeline.judge_project(loaded_project)))
    return MeasuredSlice(file, text, tuple(adopted), tuple(sorter.left_out), new_errors, is_read)


def _read_data(file: str, text: str) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return what a slice holds, and why it cannot be read."""
    if not text.strip():
        return {}, ()
    document, diagnostics = yaml_parser.parse_yaml(file, text)
    data = node_to_data(document.root) if document else None
    return (data, ()) if isinstance(data, dict) else ({}, diagnostics)


def _add_slice(loaded_project: LoadedProject, file: str, text: str) -> LoadedProject:
    """Return a project that reads a slice which its `sources` do not name."""
    parsed_slice = parse_slice(file, text)
    diagnostics = (*loaded_project.diagnostics, *parsed_slice.diagnostics, *parsed_slice.validate_once().diagnostics)
    loaded_project.sources.add_text(file, text)
    documents = (*loaded_project.documents, *([parsed_slice.document] if parsed_slice.document else []))
    return replace(loaded_project, documents=documents, diagnostics=diagnostics)


_US = 1000
_MS = 10**6
_TimingData = dict[str, Any]


@dataclass(frozen=True, slots=True)
class LeftOutFigure:
    """A measured figure that the slice does not get: why, and where it is written already.

    `proposal` is what to write there instead, for those who want the measured figure to count.
    """

    element: str
    key: str
    why: str
    proposal: str
    at: Span


@dataclass(frozen=True, slots=True)
class AdoptedTimes:
    """What was measured of an activity, or of the callback that stores an input (`is_input`); in ns."""

    element: str
    is_input: bool
    longest: Fraction | None = None
    shortest: Fraction | None = None
    percentiles: Mapping[str, int] = field(default_factory=dict)


def collect_times(observations: Iterable[Observation]) -> tuple[AdoptedTimes, ...]:
    """Return what was measured of each element: several observations of one count together."""
    times_by_element: dict[str, AdoptedTimes] = {}
    for observation in observations:
        is_input = "storing" in observation.figures
        samples = observation.samples.get("storing" if is_input else "execution")
        longest = observation.figures.get("storing" if is_input else "wcet")
        shortest = observation.figures.get("bcet")
        # Of an activity the reader says whether the shortest run was a whole one.
        shortest_ns = Fraction(samples.least) if is_input and samples else shortest.value if shortest else None
        if longest is None and shortest_ns is None:
            continue
        known = times_by_element.get(observation.id) or AdoptedTimes(observation.id, is_input)
        times_by_element[observation.id] = replace(
            known,
            longest=_choose_known(max, known.longest, longest.value if longest else None),
            shortest=_choose_known(min, known.shortest, shortest_ns),
            percentiles=samples.percentiles if samples and shortest else known.percentiles,
        )
    return tuple(times_by_element.values())


class FigureSorter:
    """Puts measured times into the data of a slice, and lists those that have no place in it."""

    def __init__(self, checked_project: CheckedProject, data: dict[str, Any]) -> None:
        """Take the project without the slice, and the slice's data, which are added to."""
        self.left_out: list[LeftOutFigure] = []
        self.storing_paths: list[ElementPath] = []
        """Where times of storing callbacks stand in the slice."""
        self._architecture = checked_project.architecture
        self._data = data
        self._owners = {name: key for key, name in name_activities(self._architecture).items()}
        self._written_nodes = {node.id for node in list_written_nodes(checked_project)}
        self._type_spans = [entry.value.span for entry in list_type_entries(checked_project.merged_table).values()]

    def add_times(self, times: AdoptedTimes) -> Iterator[tuple[str, str]]:
        """Add what was measured of one element; yield the element and the key of what is in the slice now."""
        if times.is_input:
            yield from self._add_input_times(times)
            return
        node_id, component = self._owners[times.element]
        node = self._architecture.nodes[node_id]
        path = self._find_timing_path(node, component)
        if path is None:
            yield from self._leave_out_homeless(times)
            return
        timing = node.timing.get(component or "", Timing())
        for key in ("wcet", "bcet"):
            yield from self._add_time(times, path, timing, key)

    def _add_time(self, times: AdoptedTimes, path: ElementPath, timing: Timing, key: str) -> Iterator[tuple[str, str]]:
        """Add the longest time (`wcet`) or the shortest (`bcet`), unless what is written says it, or says otherwise."""
        is_longest = key == "wcet"
        measured = times.longest if is_longest else times.shortest
        if measured is None:
            return
        value = _write_longest(times) if is_longest else _write_down(measured)
        own, other, other_key = timing.wcet, timing.bcet, "bcet"
        if not is_longest:
            own, other, other_key = timing.bcet, timing.wcet, "wcet"
        if (written_at := timing.places.get(key)) is not None:
            why = f"written already: {own or ('without a maximum' if is_longest else 'nothing')}"
            self._leave_out(times, key, why, value, written_at)
        elif other is not None and (other.value > measured if is_longest else other.value < measured):
            why = f"the {other_key} that is written, {other}, is {'longer' if is_longest else 'shorter'}"
            self._leave_out(times, key, why, value, timing.places[other_key])
        else:
            body = self._find_body(path)
            old = body.get(key)
            body[key] = _extend_longest(old, value) if isinstance(value, dict) else _choose_text(min, old, value)
            yield times.element, key

    def _add_input_times(self, times: AdoptedTimes) -> Iterator[tuple[str, str]]:
        port = self._architecture.inputs.get(times.element)
        nodes = [node for node in self._architecture.nodes.values() if port and port.component in node.implements]
        path = self._find_timing_path(nodes[0], port.component) if port and len(nodes) == 1 else None
        if port is None or path is None:
            yield from self._leave_out_homeless(times)
            return
        written = nodes[0].timing.get(port.component, Timing()).inputs.get(times.element)
        key = times.element.rpartition(".")[2]
        figures = (
            {"wcet": _write_up(times.longest), "bcet": _write_down(times.shortest)}
            if (times.longest is not None and times.shortest is not None)
            else {}
        )
        if written is not None:
            self._leave_out(times, f"inputs.{key}", "written already", format_flow(figures), written.at)
            return
        input_path = (*path, "inputs", key)
        body = self._find_body(input_path)
        for name, choose in (("wcet", max), ("bcet", min)):
            body[name] = _choose_text(choose, body.get(name), figures[name])
        self.storing_paths.append(input_path)
        yield times.element, "wcet"

    def _find_timing_path(self, node: Node, component: str | None) -> ElementPath | None:
        """Return where an activity's timing is written: at its node, or at the component of which it has several."""
        if node.id in self._written_nodes and len(node.implements) <= 1:
            return ("nodes", node.id, "timing")
        sharing_nodes = [other for other in self._architecture.nodes.values() if component in other.implements]
        if component is None or len(sharing_nodes) > 1 or self._find_reference(component):
            return None
        # Of a component inside of others the whole path is one key: that changes this one, and never its type.
        group, _, inner_path = component.partition(".")
        return ("groups", group, "components", inner_path, "timing")

    def _find_reference(self, component_id: str | None) -> str | None:
        """Return the component that is exactly its type (`same_as`), of a component and those around it."""
        component = self._architecture.components.get(component_id or "")
        around = (component, *self._architecture.list_around(component)) if component else ()
        return next((each.id for each in around if each.is_reference), None)

    def _find_body(self, path: ElementPath) -> _TimingData:
        body: _TimingData = self._data
        for key in path:
            inner = body.get(str(key))
            if not isinstance(inner, dict):
                inner = body[str(key)] = {}
            body = inner
        return body

    def _leave_out(self, times: AdoptedTimes, key: str, why: str, value: object, at: Span) -> None:
        text = value if isinstance(value, str) else format_flow(value)
        proposal = f"{key}: {text}"
        component = times.element.rpartition(".")[0] if times.is_input else self._owners[times.element][1]
        if component and any(_contains_span(type_span, at) for type_span in self._type_spans):
            why = f"{why}, in its type"
            if not self._find_reference(component):
                # Written into the type it would hold for all instances.
                group, _, inner_path = component.partition(".")
                proposal = f"{inner_path}: {{timing: {{{proposal}}}}}, below `components` of `{group}`"
        self.left_out.append(LeftOutFigure(times.element, key, why, proposal, at))

    def _leave_out_homeless(self, times: AdoptedTimes) -> Iterator[tuple[str, str]]:
        component = times.element.rpartition(".")[0] if times.is_input else self._owners[times.element][1]
        reference = self._find_reference(component)
        why = (
            f"`{reference}` is exactly its type (`same_as`): only the type can have it"
            if reference
            else "the language has no place for it: it is no input of a component, or several nodes share the component"
        )
        self._leave_out(times, "wcet", why, _write_up(times.longest or Fraction(0)), NO_SPAN)
        return iter(())


def _contains_span(outer: Span, inner: Span) -> bool:
    return outer.file == inner.file and (outer.line, outer.column) <= (inner.line, inner.column) < (
        outer.end_line,
        outer.end_column,
    )


def _write_longest(times: AdoptedTimes) -> dict[str, object]:
    """Return the longest time as the language writes it, with its percentiles."""
    longest = times.longest or Fraction(0)
    percentiles = {name: _write_up(min(Fraction(value), longest)) for name, value in times.percentiles.items()}
    return {"max": _write_up(longest), **percentiles, "measured": True}


def _extend_longest(old: object, new: dict[str, object]) -> dict[str, object]:
    """Return the new times, with the longest that was ever seen."""
    old_body = old if isinstance(old, dict) else {"max": old}
    return {**old_body, **new, "max": _choose_text(max, old_body.get("max"), str(new["max"]))}


def _choose_text(choose: Callable[[Fraction, Fraction], Fraction], old: object, new: str) -> str:
    """Return one of two durations, as they are written."""
    old_quantity = parse_quantity(old, "duration") if isinstance(old, str) else None
    new_quantity = parse_quantity(new, "duration")
    if old_quantity is None or new_quantity is None:
        return new
    return str(old_quantity) if choose(old_quantity.value, new_quantity.value) == old_quantity.value else new


def _choose_known(
    choose: Callable[[Fraction, Fraction], Fraction], first: Fraction | None, second: Fraction | None
) -> Fraction | None:
    return choose(first, second) if first is not None and second is not None else second if first is None else first


def _write_up(ns: Fraction) -> str:
    """Write a duration, rounded up to a microsecond."""
    return _write_us(-(-ns // _US))


def _write_down(ns: Fraction) -> str:
    """Write a duration, rounded down to a microsecond."""
    return _write_us(ns // _US)


def _write_us(us: int) -> str:
    if 0 < us < _US:
        return f"{us} us"
    decimals = f"{us % _US:03}".rstrip("0")
    return f"{us // _US}{'.' if decimals else ''}{decimals} ms"
